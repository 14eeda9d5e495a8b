// The laws of a camera path: closed, continuous, within its speed and turn rate.
#include "stimuli/builtin/builtin.h"
#include "stimuli/camera_path.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#define FRAME_S (1.0 / 90)

// Independent of camera_path.c: the angle of the rotation between two orientations by its matrix trace.
static double turned_deg(struct dquat a, struct dquat b)
{
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        struct dvec3 axis = {i == 0, i == 1, i == 2};
        sum += dvec3_dot(dquat_rotate(a, axis), dquat_rotate(b, axis));
    }
    // acos is poor near 1; for small angles 3 - trace = 4 sin^2(angle / 2).
    return 2 * asin(fmin(sqrt(fmax(3 - sum, 0) / 4), 1)) * 180 / acos(-1);
}

static void check_laws(const struct camera_path *path)
{
    assert_true(path->duration_s > 0);
    struct pose before = camera_path_pose(path, 0);
    double fastest = 0, turning = 0;
    for (uint32_t i = 1; i * FRAME_S < 2.2 * path->duration_s; i++) {
        struct pose now = camera_path_pose(path, i * FRAME_S);
        double metres = dvec3_length(dvec3_sub(now.position, before.position));
        double degrees = turned_deg(now.orientation, before.orientation);
        fastest = fmax(fastest, metres / FRAME_S);
        turning = fmax(turning, degrees / FRAME_S);
        // The head's x axis stays level.
        assert_true(fabs(dquat_rotate(now.orientation, (struct dvec3){1, 0, 0}).y) < 1e-9);
        before = now;
    }
    if (fastest > path->speed_m_s * 1.01 || turning > CAMERA_PATH_MAX_DEG_S * 1.01)
        fail_msg("%g m/s (of %g), %g deg/s (of %g)", fastest, path->speed_m_s, turning, CAMERA_PATH_MAX_DEG_S);
    for (double t = -3; t < path->duration_s; t += 0.37) {
        struct pose a = camera_path_pose(path, t), b = camera_path_pose(path, t + path->duration_s);
        assert_true(dvec3_length(dvec3_sub(a.position, b.position)) < 1e-6);
        assert_true(turned_deg(a.orientation, b.orientation) < 1e-4);
    }
    struct pose end = camera_path_pose(path, path->duration_s - 1e-7), start = camera_path_pose(path, 0);
    assert_true(dvec3_length(dvec3_sub(end.position, start.position)) < 1e-5);
}

static void random_paths_keep_the_laws(void **state)
{
    (void)state;
    struct camera_path *path = malloc(sizeof *path);
    uint32_t bits = 1;
    for (int round = 0; round < 12; round++) {
        *path = (struct camera_path){.knot_count = 4 + (uint32_t)round, .speed_m_s = 0.2 + 0.1 * round};
        for (uint32_t i = 0; i < path->knot_count; i++) {
            double a = 2 * acos(-1) * i / path->knot_count, r[4];
            for (int k = 0; k < 4; k++) {
                bits = bits * 1664525u + 1013904223u;
                r[k] = bits / 4294967296.0;
            }
            path->knots[i].position =
                (struct dvec3){10 * cos(a) + 4 * r[0], 1.6 + 0.5 * r[1], 10 * sin(a) + 4 * r[2]};
            path->knots[i].target = (struct dvec3){30 * cos(a + 1 + r[3]), 2, 30 * sin(a + 1 + r[3])};
        }
        assert_true(camera_path_finish(path));
        check_laws(path);
    }
    free(path);
}

static void knots_are_passed(void **state)
{
    (void)state;
    struct camera_path *path = calloc(1, sizeof *path);
    path->knot_count = 4;
    path->speed_m_s = 1;
    for (uint32_t i = 0; i < 4; i++) {
        path->knots[i].position = (struct dvec3){i == 0 || i == 1 ? 5 : -5, 1.5, i == 1 || i == 2 ? 5 : -5};
        path->knots[i].target = (struct dvec3){0, 1.5, 0};
    }
    assert_true(camera_path_finish(path));
    for (uint32_t i = 0; i < 4; i++) {
        struct pose p = camera_path_pose(path, path->time_s[i * CAMERA_PATH_SAMPLES / 4]);
        assert_true(dvec3_length(dvec3_sub(p.position, path->knots[i].position)) < 1e-9);
        struct dvec3 view = dquat_rotate(p.orientation, (struct dvec3){0, 0, -1});
        assert_true(geometry_angle_deg(view, dvec3_sub(path->knots[i].target, p.position)) < 1e-5);
    }
    // Where only the speed limits, an even curve takes length / speed.
    double length = 0;
    for (int i = 0; i < 4000; i++) {
        struct pose a = camera_path_pose(path, path->duration_s * i / 4000),
                    b = camera_path_pose(path, path->duration_s * (i + 1) / 4000);
        length += dvec3_length(dvec3_sub(a.position, b.position));
    }
    assert_true(path->duration_s >= length * 0.999 && path->duration_s < length * 1.2);
    free(path);
}

static void still_camera(void **state)
{
    (void)state;
    struct camera_path *path = calloc(1, sizeof *path);
    path->knot_count = 1;
    path->speed_m_s = 1;
    path->knots[0] = (struct camera_path_knot){{1, 2, 3}, {1, 2, -3}};
    assert_true(camera_path_finish(path));
    assert_true(path->duration_s > 0);
    for (double t = -5; t < 5; t += 0.3)
        assert_true(dvec3_length(dvec3_sub(camera_path_pose(path, t).position, (struct dvec3){1, 2, 3})) <
                    1e-12);
    free(path);
}

static void bad_paths_are_refused(void **state)
{
    (void)state;
    struct camera_path *path = calloc(1, sizeof *path);
    path->speed_m_s = 1;
    assert_false(camera_path_finish(path)); // no knot
    path->knot_count = CAMERA_PATH_KNOTS + 1;
    assert_false(camera_path_finish(path));
    path->knot_count = 1;
    path->knots[0] = (struct camera_path_knot){{1, 2, 3}, {1, 2, 3}};
    assert_false(camera_path_finish(path)); // target on the curve
    path->knots[0].target = (struct dvec3){1, 9, 3};
    assert_false(camera_path_finish(path)); // straight up: no upright view
    path->knots[0].target = (struct dvec3){NAN, 0, 0};
    assert_false(camera_path_finish(path));
    path->knots[0].target = (struct dvec3){5, 2, 3};
    const double speeds[] = {0, -1, 1.6, NAN, INFINITY};
    for (int i = 0; i < 5; i++) {
        path->speed_m_s = speeds[i];
        assert_false(camera_path_finish(path));
    }
    free(path);
}

static void built_in_paths_keep_the_laws(void **state)
{
    (void)state;
    const char *specs[] = {"atrium", "town:triangles=20000"};
    for (int i = 0; i < 2; i++) {
        char error[256];
        struct scene *scene = builtin_scene_open(specs[i], error, sizeof error);
        assert_non_null(scene);
        check_laws(&scene->path);
        scene_destroy(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_paths_keep_the_laws),
        cmocka_unit_test(knots_are_passed),
        cmocka_unit_test(still_camera),
        cmocka_unit_test(bad_paths_are_refused),
        cmocka_unit_test(built_in_paths_keep_the_laws),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
