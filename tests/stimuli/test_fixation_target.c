// The fixation target's laws: straight paths within the stated angles, once per view, the same for a seed, at
// the scene's depth; and how long the depths take.
#include "stimuli/fixation_target.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <time.h>

#include <cmocka.h>

static void expect_near(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%.12g is not %.12g", a, b);
}

static const struct camera_path *still_path(void)
{
    static struct camera_path path = {.knots = {{{0, 1.6, 0}, {0, 1.6, -5}}}, .knot_count = 1, .speed_m_s = 1};
    assert_true(camera_path_finish(&path));
    return &path;
}

static void paths_are_straight_and_stay_inside(void **state)
{
    (void)state;
    const struct fixation_flight flight = {.path = still_path(), .view_s = 8, .begin_s = 0.125};
    double reach_x = 0, reach_y = 0;
    for (uint32_t seed = 0; seed < 2000; seed++) {
        struct fixation_target target;
        fixation_target_init(&target, FIXATION_MOVING, &flight, seed);
        const struct fixation_place first = fixation_target_at(&target, 0.125),
                                    last = fixation_target_at(&target, 8.125);
        const double length = geometry_angle_deg(first.point, last.point);
        assert_true(length > 18 && length < 24);
        double way = 0;
        for (int i = 0; i <= 16; i++) {
            const struct fixation_place at = fixation_target_at(&target, 0.125 + i * 0.5);
            assert_true(fabs(at.x_deg) <= FIXATION_MOST_X_DEG + 1e-9);
            assert_true(fabs(at.y_deg) <= FIXATION_MOST_Y_DEG + 1e-9);
            reach_x = fmax(reach_x, fabs(at.x_deg));
            reach_y = fmax(reach_y, fabs(at.y_deg));
            // on the line through both ends, in the image plane, and evenly
            const double x = at.point.x / -at.point.z, y = at.point.y / -at.point.z;
            way = i / 16.0;
            expect_near(x, target.from[0] + way * (target.to[0] - target.from[0]), 1e-12);
            expect_near(y, target.from[1] + way * (target.to[1] - target.from[1]), 1e-12);
        }
        const struct fixation_place before = fixation_target_at(&target, 0),
                                    after = fixation_target_at(&target, 99);
        expect_near(before.x_deg, first.x_deg, 0); // waits while the picture fades in
        expect_near(after.y_deg, last.y_deg, 0);
        fixation_target_finish(&target);
    }
    assert_true(reach_x > 10.2 && reach_y > 11.6); // paths of all slopes
}

static void the_seed_decides(void **state)
{
    (void)state;
    const struct fixation_flight flight = {.path = still_path(), .view_s = 4};
    struct fixation_target a, b, c;
    fixation_target_init(&a, FIXATION_MOVING, &flight, 7);
    fixation_target_init(&b, FIXATION_MOVING, &flight, 7);
    fixation_target_init(&c, FIXATION_MOVING, &flight, 8);
    for (int i = 0; i < 2; i++) {
        expect_near(a.from[i], b.from[i], 0);
        expect_near(a.to[i], b.to[i], 0);
    }
    assert_true(hypot(a.from[0] - c.from[0], a.from[1] - c.from[1]) > 1e-6);
}

static void a_cross_stays_in_the_middle(void **state)
{
    (void)state;
    const struct fixation_flight flight = {.path = still_path()};
    struct fixation_target target;
    fixation_target_init(&target, FIXATION_CROSS, &flight, 3);
    for (int i = 0; i < 50; i++) {
        const struct fixation_place at = fixation_target_at(&target, 0.7 * i);
        expect_near(at.x_deg, 0, 0);
        expect_near(at.y_deg, 0, 0);
    }
    fixation_target_finish(&target);
}

// Without an end it goes back and forth without a jump, and is where it was after the camera's round.
static void endless_paths_go_back_and_forth(void **state)
{
    (void)state;
    char error[512];
    struct scene *scene = scene_open("town:triangles=20000", error, sizeof error);
    assert_non_null(scene);
    struct fixation_target target;
    fixation_target_init(&target, FIXATION_MOVING, &(struct fixation_flight){.path = &scene->path}, 11);
    const double round_s = scene->path.duration_s;
    assert_true(target.sweep_s > 6 && target.sweep_s < 12);
    expect_near(fmod(round_s / (2 * target.sweep_s) + 0.25, 1), 0.25, 1e-9);
    const struct fixation_place ends[2] = {fixation_target_at(&target, 0),
                                           fixation_target_at(&target, target.sweep_s)};
    assert_true(geometry_angle_deg(ends[0].point, ends[1].point) > 18);
    for (double t = 0; t < 2 * round_s; t += 0.05) {
        const struct fixation_place a = fixation_target_at(&target, t),
                                    b = fixation_target_at(&target, t + 0.01);
        assert_true(geometry_angle_deg(a.point, b.point) < 0.06); // at most 5 degrees a second
    }
    fixation_target_finish(&target);
    scene_destroy(scene);
}

static void measured(const char *spec)
{
    char error[512];
    struct scene *scene = scene_open(spec, error, sizeof error);
    assert_non_null(scene);
    struct ray_scene *rays = ray_scene_create(scene);
    struct fixation_target target;
    struct timespec begin, end;
    fixation_target_init(&target, FIXATION_MOVING, &(struct fixation_flight){.path = &scene->path}, 21);
    clock_gettime(CLOCK_MONOTONIC, &begin);
    assert_true(fixation_target_measure(&target, rays));
    clock_gettime(CLOCK_MONOTONIC, &end);
    double nearest = 1e9, farthest = 0;
    for (uint32_t i = 0; i + 2 < target.count; i++) {
        const double time_s = i * FIXATION_SAMPLE_S;
        const struct fixation_place at = fixation_target_at(&target, time_s);
        const struct pose head = fixation_head(&target.flight, time_s);
        const struct dvec3 d = dquat_rotate(head.orientation, dvec3_normalise(at.point));
        const double there = ray_distance(rays, head.position, d, 1e9);
        expect_near(1 / at.distance_m, 1 / fmin(fmax(there, FIXATION_NEAREST_M), FIXATION_FARTHEST_M), 1e-6);
        nearest = fmin(nearest, at.distance_m);
        farthest = fmax(farthest, at.distance_m);
        // between two samples in dioptres
        const struct fixation_place half = fixation_target_at(&target, time_s + 0.5 * FIXATION_SAMPLE_S);
        expect_near(2 / half.distance_m, target.dioptres[i] + target.dioptres[i + 1], 1e-6);
    }
    print_message("%s: %u depths from %.2f to %.1f m in %.1f ms\n", spec, target.count, nearest, farthest,
                  1e3 * (double)(end.tv_sec - begin.tv_sec) + 1e-6 * (double)(end.tv_nsec - begin.tv_nsec));
    assert_true(nearest >= FIXATION_NEAREST_M && farthest <= FIXATION_FARTHEST_M && farthest > 2 * nearest);
    fixation_target_finish(&target);
    ray_scene_destroy(rays);
    scene_destroy(scene);
}

static void the_depth_is_the_scene_s(void **state)
{
    (void)state;
    measured("town");
    measured("atrium");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(paths_are_straight_and_stay_inside), cmocka_unit_test(the_seed_decides),
        cmocka_unit_test(a_cross_stays_in_the_middle),        cmocka_unit_test(endless_paths_go_back_and_forth),
        cmocka_unit_test(the_depth_is_the_scene_s),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
