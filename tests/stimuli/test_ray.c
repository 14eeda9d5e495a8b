// Rays hit what a plain search over all triangles hits, on scenes made by code.
#include "stimuli/builtin/random.h"
#include "stimuli/ray.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

static void expect_near(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%.12g is not %.12g", a, b);
}

#define FAR_M 200.0

struct soup {
    struct dvec3 (*triangles)[3]; // world, of what stands still
    size_t count;
};

static struct soup all_triangles(const struct scene *scene)
{
    struct dmat4 *world = calloc(scene->node_count, sizeof *world);
    struct soup soup = {malloc(scene->triangle_count * sizeof *soup.triangles), 0};
    scene_pose(scene, 0.0, false, world);
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        const struct scene_instance *instance = &scene->instances[i];
        const struct scene_mesh *mesh = &scene->meshes[instance->mesh];
        for (uint32_t k = 0; instance->moving_id == 0 && k < mesh->submodel_count; k++) {
            const struct scene_submodel *submodel = &scene->submodels[mesh->first_submodel + k];
            for (uint32_t at = 0; at < submodel->index_count; at++) {
                const float *p = scene->vertices[scene->indices[submodel->first_index + at]].position;
                soup.triangles[soup.count + at / 3][at % 3] = dmat4_point(
                    &world[instance->node], (struct dvec3){(double)p[0], (double)p[1], (double)p[2]});
            }
            soup.count += submodel->index_count / 3;
        }
    }
    free(world);
    return soup;
}

// Not Moller and Trumbore: the plane first, then on which side of each edge its point lies.
static double plain_hit(const struct dvec3 t[3], struct dvec3 from, struct dvec3 direction)
{
    const struct dvec3 normal = dvec3_cross(dvec3_sub(t[1], t[0]), dvec3_sub(t[2], t[0]));
    const double slope = dvec3_dot(normal, direction);
    const double at = dvec3_dot(normal, dvec3_sub(t[0], from)) / slope;
    if (!(fabs(slope) > 0) || !(at > 0))
        return INFINITY;
    const struct dvec3 p = dvec3_add(from, dvec3_scale(direction, at));
    for (int i = 0; i < 3; i++)
        if (dvec3_dot(normal, dvec3_cross(dvec3_sub(t[(i + 1) % 3], t[i]), dvec3_sub(p, t[i]))) < 0)
            return INFINITY;
    return at;
}

static struct dvec3 random_direction(uint64_t counter)
{
    const double z = 2.0 * (double)random_unit(5, 2 * counter) - 1.0, side = sqrt(1.0 - z * z);
    const double turn = 6.283185307179586 * (double)random_unit(5, 2 * counter + 1);
    return (struct dvec3){side * cos(turn), z, side * sin(turn)};
}

static void compare(const char *spec, uint32_t rays_wanted, uint32_t least_hits)
{
    char error[512];
    struct scene *scene = scene_open(spec, error, sizeof error);
    if (!scene)
        fail_msg("%s", error);
    struct ray_scene *rays = ray_scene_create(scene);
    assert_non_null(rays);
    struct soup soup = all_triangles(scene);
    uint32_t hits = 0, back = 0;
    for (uint32_t r = 0; r < rays_wanted; r++) {
        const struct pose head = camera_path_pose(&scene->path, r * scene->path.duration_s / rays_wanted);
        const struct dvec3 direction = random_direction(r);
        double nearest = FAR_M;
        bool from_behind = false;
        for (size_t i = 0; i < soup.count; i++) {
            const double at = plain_hit(soup.triangles[i], head.position, direction);
            if (at < nearest) {
                nearest = at;
                from_behind = dvec3_dot(dvec3_cross(dvec3_sub(soup.triangles[i][1], soup.triangles[i][0]),
                                                    dvec3_sub(soup.triangles[i][2], soup.triangles[i][0])),
                                        direction) > 0;
            }
        }
        const double found = ray_distance(rays, head.position, direction, FAR_M);
        if (!(fabs(found - nearest) <= 1e-6 * nearest))
            fail_msg("%s, ray %u: %.9f m, plainly %.9f m", spec, r, found, nearest);
        const bool hit = nearest < FAR_M;
        hits += hit;
        back += hit && from_behind;
        const struct dvec3 before = dvec3_add(head.position, dvec3_scale(direction, 0.999 * nearest)),
                           beyond = dvec3_add(head.position, dvec3_scale(direction, 1.001 * nearest));
        assert_true(ray_clear(rays, head.position, before));
        assert_true(ray_clear(rays, head.position, beyond) == !hit);
    }
    print_message("%s: %u of %u rays hit, %u from behind\n", spec, hits, rays_wanted, back);
    assert_true(hits >= least_hits);
    free(soup.triangles);
    ray_scene_destroy(rays);
    scene_destroy(scene);
}

static void rays_hit_what_a_plain_search_hits(void **state)
{
    (void)state;
    compare("town:triangles=20000", 400, 200);
    compare("atrium", 60, 40);
    compare("town:triangles=20000,moving=50", 100, 1); // half of it is not there
}

// A square of two triangles at z = -2, seen along the axes, where directions have zeros and the box is flat.
static void flat_boxes_and_axes_are_hit(void **state)
{
    (void)state;
    struct scene_vertex vertices[4] = {{.position = {-1, -1, -2}},
                                       {.position = {1, -1, -2}},
                                       {.position = {1, 1, -2}},
                                       {.position = {-1, 1, -2}}};
    uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
    struct scene_submodel submodel = {.index_count = 6, .bounds = {{-1, -1, -2}, {1, 1, -2}}};
    struct scene_mesh mesh = {0, 1};
    struct scene_node node = {.parent = -1, .local = dmat4_identity()};
    struct scene_instance instance = {0};
    struct scene scene = {.vertices = vertices,
                          .vertex_count = 4,
                          .indices = indices,
                          .index_count = 6,
                          .submodels = &submodel,
                          .submodel_count = 1,
                          .meshes = &mesh,
                          .mesh_count = 1,
                          .nodes = &node,
                          .node_count = 1,
                          .instances = &instance,
                          .instance_count = 1};
    struct ray_scene *rays = ray_scene_create(&scene);
    const struct dvec3 origin = {0.25, 0.1, 0}, behind = {0.25, 0.1, -5};
    expect_near(ray_distance(rays, origin, (struct dvec3){0, 0, -1}, 50), 2, 1e-9);
    expect_near(ray_distance(rays, behind, (struct dvec3){0, 0, 1}, 50), 3, 1e-9); // its back
    expect_near(ray_distance(rays, origin, (struct dvec3){0, 0, 1}, 50), 50, 0);
    expect_near(ray_distance(rays, origin, (struct dvec3){1, 0, 0}, 50), 50, 0);
    expect_near(ray_distance(rays, origin, (struct dvec3){0, 0, -1}, 1.5), 1.5, 0);
    assert_true(ray_clear(rays, origin, origin));
    ray_scene_destroy(rays);
    instance.moving_id = 1;
    rays = ray_scene_create(&scene); // nothing stands still
    expect_near(ray_distance(rays, origin, (struct dvec3){0, 0, -1}, 50), 50, 0);
    ray_scene_destroy(rays);
    ray_scene_destroy(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flat_boxes_and_axes_are_hit),
        cmocka_unit_test(rays_hit_what_a_plain_search_hits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
