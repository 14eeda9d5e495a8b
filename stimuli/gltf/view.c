// A camera path for a file: through its cameras where it has three or more, else one that suits its size.
#include "stimuli/gltf/build.h"
#include "stimuli/gltf/walk.h"

#include <math.h>

#define PI 3.14159265358979323846

// Models whose floor plan is smaller across than this are looked at from outside; larger ones are walked in.
#define SMALL_M 9.0

enum { ORBIT_KNOTS = 16 };

static void through_cameras(struct gltf_build *build, const struct dmat4 *world, double reach_m)
{
    const struct gltf_document *d = build->document;
    struct camera_path *path = &build->scene->path;
    for (uint32_t i = 0; i < d->node_count && path->knot_count < CAMERA_PATH_KNOTS; i++) {
        int32_t at = build->scene_node[i];
        if (at < 0 || d->nodes[i].camera < 0)
            continue;
        struct dvec3 position = dmat4_point(&world[at], (struct dvec3){0.0, 0.0, 0.0});
        struct dvec3 forward = dvec3_normalise(dmat4_direction(&world[at], (struct dvec3){0.0, 0.0, -1.0}));
        path->knots[path->knot_count++] =
            (struct camera_path_knot){position, dvec3_add(position, dvec3_scale(forward, reach_m))};
    }
}

// At a distance where a small model fills most of the default field of view's height.
static void around(struct scene *scene, struct dvec3 centre, double radius)
{
    scene->path.knot_count = ORBIT_KNOTS;
    for (int i = 0; i < ORBIT_KNOTS; i++) {
        double angle = 2.0 * PI * i / ORBIT_KNOTS;
        struct dvec3 position = {centre.x + 1.25 * radius * sin(angle), centre.y + 0.35 * radius,
                                 centre.z + 1.1 * radius * cos(angle)};
        scene->path.knots[i] = (struct camera_path_knot){position, centre};
    }
}

static uint32_t scene_cameras(const struct gltf_build *build)
{
    uint32_t cameras = 0;
    for (uint32_t i = 0; i < build->document->node_count; i++)
        cameras += build->scene_node[i] >= 0 && build->document->nodes[i].camera >= 0;
    return cameras;
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
    else if (hypot(extent.x, extent.z) >= SMALL_M)
        gltf_walk(scene, world);
    scene->path.speed_m_s = fmin(1.2, 0.6 * radius);
    if (scene->path.knot_count > 0 && camera_path_finish(&scene->path))
        return true;
    around(scene, centre, radius);
    if (camera_path_finish(&scene->path))
        return true;
    gltf_at(&build->report, "meshes");
    return gltf_fail(&build->report, "no camera path can be laid around a model of %g m radius", radius);
}
