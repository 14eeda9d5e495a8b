// Spheres to count: as many as asked for in every scene, each seen whole for long enough, the same for a seed.
#include "stimuli/spheres.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

static void expect_near(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%.12g is not %.12g", a, b);
}

#define FADE_S 0.125

static struct spheres_desc flight(const struct scene *scene, const struct ray_scene *rays, double view_s,
                                  uint64_t seed, uint32_t count)
{
    return (struct spheres_desc){.rays = rays,
                                 .path = &scene->path,
                                 .length_s = view_s > 0 ? view_s + 2 * FADE_S : 0,
                                 .begin_s = view_s > 0 ? FADE_S : 0,
                                 .fov = viewing_symmetric_fov(100, 1280, 1440),
                                 .ipd_m = VIEWING_DEFAULT_IPD_M,
                                 .seed = seed,
                                 .count = count};
}

// By the stretch's own terms, with rays of another pattern than the ones it was found by.
static void check_stretch(const struct spheres_desc *desc, const struct sphere *sphere, const char *spec)
{
    static const double rim[8][2] = {{0.7, 0.7}, {-0.7, 0.7}, {0.7, -0.7}, {-0.7, -0.7},
                                     {0.5, 0},   {-0.5, 0},   {0, 0.5},    {0, -0.5}};
    uint32_t looks = 0, covered = 0;
    for (double t = sphere->from_s; t < sphere->to_s + 1e-9; t += SPHERES_SAMPLE_S) {
        const struct pose head = camera_path_pose(desc->path, desc->start_s + t);
        const struct dvec3 ahead = dquat_rotate(head.orientation, (struct dvec3){0, 0, -1});
        const double ecc = geometry_angle_deg(ahead, dvec3_sub(sphere->position, head.position));
        if (ecc > SPHERES_MOST_DEG + 1e-6)
            fail_msg("%s: a sphere at %.1f degrees", spec, ecc);
        for (int eye = 0; eye < EYES; eye++)
            for (int i = 0; i < 8; i++, looks++) {
                const struct pose pose = viewing_eye_pose(&head, eye, desc->ipd_m);
                const struct dvec3 side = {rim[i][0] * SPHERES_RADIUS_M, rim[i][1] * SPHERES_RADIUS_M, 0};
                covered += !ray_clear(desc->rays, pose.position,
                                      dvec3_add(sphere->position, dquat_rotate(pose.orientation, side)));
            }
    }
    if (covered > looks / 20) // something thin between the five rays
        fail_msg("%s: %u of %u looks at a sphere are covered", spec, covered, looks);
}

static void check_scene(const char *spec, double view_s, uint32_t count, enum spheres_relaxed most)
{
    char error[512];
    struct timespec begin, end;
    struct scene *scene = scene_open(spec, error, sizeof error);
    if (!scene)
        fail_msg("%s", error);
    struct ray_scene *rays = ray_scene_create(scene);
    uint32_t relaxed[SPHERES_RELAXED] = {0};
    double slowest_ms = 0;
    for (uint64_t seed = 100; seed < 103; seed++) {
        struct spheres spheres;
        const struct spheres_desc desc = flight(scene, rays, view_s, seed, count);
        clock_gettime(CLOCK_MONOTONIC, &begin);
        assert_true(spheres_place(&spheres, &desc));
        clock_gettime(CLOCK_MONOTONIC, &end);
        slowest_ms = fmax(slowest_ms, 1e3 * (double)(end.tv_sec - begin.tv_sec) +
                                          1e-6 * (double)(end.tv_nsec - begin.tv_nsec));
        assert_int_equal(spheres.count, count);
        for (uint32_t i = 0; i < count; i++) {
            const struct sphere *s = &spheres.all[i];
            relaxed[s->relaxed]++;
            assert_true(s->relaxed <= most);
            if (s->relaxed < SPHERES_BRIEFLY)
                assert_true(s->to_s - s->from_s >= SPHERES_SECONDS - 1e-9);
            assert_true(view_s <= 0 || (s->from_s >= FADE_S && s->to_s <= FADE_S + view_s + 1e-9));
            check_stretch(&desc, s, spec);
            for (double t = s->from_s; t < s->to_s; t += 0.04)
                for (int eye = 0; eye < EYES; eye++)
                    assert_true(spheres_seen(&spheres, i, eye, t) > 0.999);
        }
        spheres_finish(&spheres);
    }
    print_message("%s, %g s: %u, %u, %u, %u, %u, %u by relaxation; at most %.0f ms for %u\n", spec, view_s,
                  relaxed[0], relaxed[1], relaxed[2], relaxed[3], relaxed[4], relaxed[5], slowest_ms, count);
    ray_scene_destroy(rays);
    scene_destroy(scene);
}

static void built_in_scenes_have_places(void **state)
{
    (void)state;
    check_scene("town:triangles=300000", 8, 9, SPHERES_ANY_TIME);
    check_scene("town:triangles=20000", 8, 20, SPHERES_ANY_TIME);
    check_scene("atrium", 8, 9, SPHERES_ANY_TIME);
    check_scene("atrium", 0, 9, SPHERES_ANY_TIME);
}

static void real_scenes_have_places(void **state)
{
    static const char *const files[] = {"Sponza/Sponza.gltf",
                                        "KayKitCity_S/KayKitCity_S.gltf",
                                        "DreamApartment/DreamApartment.gltf",
                                        "PolyHavenFern/Fern02.gltf",
                                        "CesiumMilkTruck/CesiumMilkTruck.glb",
                                        "CesiumMan/CesiumMan.glb"};
    (void)state;
    bool any = false;
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        char path[1024];
        const char *folder = getenv("FOVSTUDY_SCENES");
        snprintf(path, sizeof path, "%s/%s", folder ? folder : SOURCE_DIR "/../shared/scenes", files[i]);
        if (access(path, R_OK) != 0)
            continue;
        any = true;
        check_scene(path, 8, 9, SPHERES_NEARER);
    }
    if (!any)
        skip();
}

static void the_seed_decides(void **state)
{
    (void)state;
    char error[512];
    struct scene *scene = scene_open("town:triangles=20000", error, sizeof error);
    struct ray_scene *rays = ray_scene_create(scene);
    struct spheres a, b, c;
    const struct spheres_desc desc = flight(scene, rays, 8, 5, 6), other = flight(scene, rays, 8, 6, 6);
    assert_true(spheres_place(&a, &desc) && spheres_place(&b, &desc) && spheres_place(&c, &other));
    assert_memory_equal(a.all, b.all, a.count * sizeof a.all[0]);
    assert_memory_equal(a.seen, b.seen, (size_t)a.count * EYES * a.samples);
    for (uint32_t i = 0; i < 6; i++)
        assert_true(dvec3_length(dvec3_sub(a.all[i].position, c.all[i].position)) > 1e-3);
    spheres_finish(&a);
    spheres_finish(&b);
    spheres_finish(&c);
    ray_scene_destroy(rays);
    scene_destroy(scene);
}

// In each sphere's own stretch no other one touches it.
static void spheres_are_told_apart(void **state)
{
    (void)state;
    char error[512];
    struct scene *scene = scene_open("atrium", error, sizeof error);
    struct ray_scene *rays = ray_scene_create(scene);
    struct spheres spheres;
    const struct spheres_desc desc = flight(scene, rays, 8, 77, 20);
    assert_true(spheres_place(&spheres, &desc));
    for (uint32_t i = 0; i < spheres.count; i++)
        for (uint32_t k = 0; k < spheres.count; k++)
            for (double t = spheres.all[i].from_s; i != k && t < spheres.all[i].to_s + 1e-9;
                 t += SPHERES_SAMPLE_S) {
                const struct pose head = camera_path_pose(&scene->path, t);
                const struct dvec3 x = dvec3_sub(spheres.all[i].position, head.position),
                                   y = dvec3_sub(spheres.all[k].position, head.position);
                assert_true(geometry_angle_deg(x, y) >
                            57.29 * (SPHERES_RADIUS_M / dvec3_length(x) + SPHERES_RADIUS_M / dvec3_length(y)));
            }
    spheres_finish(&spheres);
    ray_scene_destroy(rays);
    scene_destroy(scene);
}

// A box around the head, and a view of a tenth of a second: nothing that is wished for is there, but the number
// is.
static void the_number_holds_where_there_is_no_room(void **state)
{
    (void)state;
    struct scene_vertex vertices[8] = {0};
    static uint32_t indices[36] = {0, 1, 3, 0, 3, 2, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                   2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 3, 7, 1, 7, 5};
    for (int i = 0; i < 8; i++)
        for (int axis = 0; axis < 3; axis++)
            vertices[i].position[axis] = (i >> axis & 1 ? 0.4f : -0.4f);
    struct scene_submodel submodel = {.index_count = 36, .bounds = {{-0.4f, -0.4f, -0.4f}, {0.4f, 0.4f, 0.4f}}};
    struct scene_mesh mesh = {0, 1};
    struct scene_node node = {.parent = -1, .local = dmat4_identity()};
    struct scene_instance instance = {0};
    struct scene scene = {.vertices = vertices,
                          .vertex_count = 8,
                          .indices = indices,
                          .index_count = 36,
                          .submodels = &submodel,
                          .submodel_count = 1,
                          .meshes = &mesh,
                          .mesh_count = 1,
                          .nodes = &node,
                          .node_count = 1,
                          .instances = &instance,
                          .instance_count = 1,
                          .path = {.knots = {{{0, 0, 0}, {0, 0, -1}}}, .knot_count = 1, .speed_m_s = 1}};
    assert_true(camera_path_finish(&scene.path));
    struct ray_scene *rays = ray_scene_create(&scene);
    for (int still = 0; still < 2; still++) {
        struct spheres spheres;
        struct spheres_desc desc = flight(&scene, rays, 0.1, 3, SPHERES_MOST);
        desc.still = still;
        assert_true(spheres_place(&spheres, &desc));
        assert_int_equal(spheres.count, SPHERES_MOST);
        for (uint32_t i = 0; i < spheres.count; i++) {
            assert_int_equal(spheres.all[i].relaxed, SPHERES_IN_FRONT);
            assert_true(spheres_seen(&spheres, i, EYE_LEFT, spheres.all[i].from_s) > 0.999);
        }
        spheres_finish(&spheres);
    }
    struct spheres none;
    const struct spheres_desc desc = flight(&scene, rays, 8, 3, 0);
    assert_true(spheres_place(&none, &desc));
    expect_near(spheres_seen(&none, 0, EYE_LEFT, 1), 0, 0);
    spheres_finish(&none);
    ray_scene_destroy(rays);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_number_holds_where_there_is_no_room),
        cmocka_unit_test(the_seed_decides),
        cmocka_unit_test(spheres_are_told_apart),
        cmocka_unit_test(built_in_scenes_have_places),
        cmocka_unit_test(real_scenes_have_places),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
