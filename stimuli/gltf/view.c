// A camera path for a file: through its cameras where it has three or more, else a walk that suits its size.
#include "stimuli/gltf/build.h"

#include <math.h>

#define PI 3.14159265358979323846

enum { ORBIT_KNOTS = 16 };

#define EYE_HEIGHT_M 1.6
// Models whose floor plan is smaller across than this are looked at from outside; larger ones are walked in.
#define SMALL_M 9.0

static bool add_knot(struct camera_path *path, struct dvec3 position, struct dvec3 target)
{
    if (path->knot_count == CAMERA_PATH_KNOTS)
        return false;
    path->knots[path->knot_count++] = (struct camera_path_knot){position, target};
    return true;
}

static void through_cameras(struct gltf_build *build, const struct dmat4 *world, double reach_m)
{
    const struct gltf_document *d = build->document;
    for (uint32_t i = 0; i < d->node_count; i++) {
        int32_t at = build->scene_node[i];
        if (at < 0 || d->nodes[i].camera < 0)
            continue;
        struct dvec3 position = dmat4_point(&world[at], (struct dvec3){0.0, 0.0, 0.0});
        struct dvec3 forward = dvec3_normalise(dmat4_direction(&world[at], (struct dvec3){0.0, 0.0, -1.0}));
        add_knot(&build->scene->path, position, dvec3_add(position, dvec3_scale(forward, reach_m)));
    }
}

// Around a small model at a distance where it fills most of a view of 60 degrees.
static void around(struct scene *scene, struct dvec3 centre, double radius)
{
    for (int i = 0; i < ORBIT_KNOTS; i++) {
        double angle = 2.0 * PI * i / ORBIT_KNOTS;
        struct dvec3 position = {centre.x + 2.1 * radius * sin(angle), centre.y + 0.45 * radius,
                                 centre.z + 1.9 * radius * cos(angle)};
        add_knot(&scene->path, position, centre);
    }
}

static uint32_t scene_cameras(const struct gltf_build *build)
{
    uint32_t cameras = 0;
    for (uint32_t i = 0; i < build->document->node_count; i++)
        cameras += build->scene_node[i] >= 0 && build->document->nodes[i].camera >= 0;
    return cameras;
}

// Inside a large model: an ellipse at eye height, looking ahead and across.
static void inside(struct scene *scene, struct dvec3 centre, struct dvec3 extent)
{
    double height = scene->bounds_min.y + EYE_HEIGHT_M;
    for (int i = 0; i < ORBIT_KNOTS; i++) {
        double angle = 2.0 * PI * i / ORBIT_KNOTS, ahead = angle + 0.35 * PI;
        struct dvec3 position = {centre.x + 0.25 * extent.x * cos(angle), height,
                                 centre.z + 0.25 * extent.z * sin(angle)};
        struct dvec3 target = {centre.x + 0.25 * extent.x * cos(ahead), height,
                               centre.z + 0.25 * extent.z * sin(ahead)};
        add_knot(&scene->path, position, target);
    }
}

bool gltf_build_path(struct gltf_build *build, const struct dmat4 *world)
{
    struct scene *scene = build->scene;
    struct dvec3 extent = dvec3_sub(scene->bounds_max, scene->bounds_min);
    struct dvec3 centre = dvec3_scale(dvec3_add(scene->bounds_min, scene->bounds_max), 0.5);
    double radius = fmax(dvec3_length(extent) / 2.0, 1e-3);
    uint32_t cameras = scene_cameras(build);
    build->unused_cameras = cameras >= 3 ? 0 : cameras;
    if (cameras >= 3)
        through_cameras(build, world, radius);
    else if (hypot(extent.x, extent.z) < SMALL_M)
        around(scene, centre, radius);
    else
        inside(scene, centre, extent);
    scene->path.speed_m_s = fmin(1.2, 0.6 * radius);
    if (camera_path_finish(&scene->path))
        return true;
    gltf_at(&build->report, "cameras");
    return gltf_fail(&build->report, "no camera path can be laid: %u camera(s), scene radius %g m", cameras,
                     radius);
}
