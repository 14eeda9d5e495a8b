// What must be the same picture: epsilon 1 and `regular`, a still eye and `regular`, points and atomics, two
// runs.
#include "tests/renderer/stage.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { WIDTH = 104, HEIGHT = 92 }; // 104 is 13 tiles, 92 none
static const double step_s = 1.0 / 90;
static const char *const scene_names[] = {"atrium", "town:triangles=20000"};
enum { SCENES = 2 };

struct pair {
    struct stage stage;
    struct scene *scene[SCENES];
    struct renderer_scene *uploaded[SCENES];
};

static int open_pair(void **state)
{
    char error[512];
    struct pair *p = calloc(1, sizeof *p);
    if (!p || !stage_open(&p->stage, WIDTH, HEIGHT))
        return -1;
    for (int i = 0; i < SCENES; i++) {
        p->scene[i] = scene_open(scene_names[i], error, sizeof error);
        if (!p->scene[i])
            fail_msg("%s", error);
        p->uploaded[i] = renderer_scene_create(p->stage.renderer, p->scene[i]);
        assert_non_null(p->uploaded[i]);
    }
    *state = p;
    return 0;
}

static int close_pair(void **state)
{
    struct pair *p = *state;
    for (int i = 0; i < SCENES; i++) {
        renderer_scene_destroy(p->uploaded[i]);
        scene_destroy(p->scene[i]);
    }
    stage_close(&p->stage);
    free(p);
    return 0;
}

// Frame n of a flight with a wandering gaze and, where there are any, objects in motion.
static struct frame flight(const struct pair *p, int scene, uint64_t n)
{
    const double t = (double)n;
    struct frame frame =
        stage_frame(&p->stage, p->scene[scene], n, 4 + 2 * step_s * t, 20 * sin(0.7 * t), 12 * cos(0.45 * t));
    frame.moving = p->scene[scene]->moving_count > 0;
    frame.animation_s = frame.moving ? 2 * step_s * t : 0;
    return frame;
}

static struct renderer_settings settings_of(int bits)
{
    return (struct renderer_settings){.ssao = bits & 1, .taa = bits & 2};
}

static void epsilon_one_is_regular(void **state)
{
    struct pair *p = *state;
    for (int scene = 0; scene < SCENES; scene++)
        for (int bits = 0; bits < 4; bits++) {
            const struct renderer_settings settings = settings_of(bits);
            struct renderer_option *warped =
                stage_option_set(&p->stage, p->uploaded[scene], "time_warped:epsilon=1", &settings);
            struct renderer_option *regular =
                stage_option_set(&p->stage, p->uploaded[scene], "regular", &settings);
            struct stage_difference worst = {0};
            for (uint64_t n = 0; n < 8; n++) {
                struct frame_stats stats;
                const struct frame frame = flight(p, scene, n);
                assert_true(renderer_draw(warped, &frame, &stats));
                assert_true(renderer_draw(regular, &frame, NULL));
                assert_int_equal(stats.shaded_px, 2 * WIDTH * HEIGHT);
                const struct stage_difference d = stage_differ(&p->stage, warped, regular);
                worst.max = d.max > worst.max ? d.max : worst.max;
                worst.mean = fmax(worst.mean, d.mean);
            }
            print_message("%s, ssao %d, taa %d: epsilon 1 differs from regular by at most %d, mean %.5f\n",
                          scene_names[scene], settings.ssao, settings.taa, worst.max, worst.mean);
            assert_true(worst.max <= 1);
            renderer_option_destroy(warped);
            renderer_option_destroy(regular);
        }
}

static void a_still_eye_sees_regular_from_the_first_frame(void **state)
{
    struct pair *p = *state;
    for (int scene = 0; scene < SCENES; scene++)
        for (int ssao = 0; ssao < 2; ssao++) {
            const struct renderer_settings settings = {.ssao = ssao};
            struct renderer_option *warped =
                stage_option_set(&p->stage, p->uploaded[scene], "time_warped", &settings);
            struct renderer_option *regular =
                stage_option_set(&p->stage, p->uploaded[scene], "regular", &settings);
            for (uint64_t n = 0; n < 8; n++) {
                struct frame_stats stats;
                const struct frame frame = stage_frame(&p->stage, p->scene[scene], n, 5, -11, 6);
                assert_true(renderer_draw(warped, &frame, &stats));
                assert_true(renderer_draw(regular, &frame, NULL));
                assert_int_equal(stage_differ(&p->stage, warped, regular).max, 0);
                assert_true(n == 0 || stats.shaded_px < 2 * WIDTH * HEIGHT / 10);
            }
            renderer_option_destroy(warped);
            renderer_option_destroy(regular);
        }
}

static void assert_same(const struct pair *p, struct renderer_option *a, struct renderer_option *b, uint64_t n)
{
    const size_t count = (size_t)WIDTH * HEIGHT;
    for (int eye = 0; eye < EYES; eye++) {
        uint8_t *x = stage_read(&p->stage, a, eye), *y = stage_read(&p->stage, b, eye);
        uint8_t *map_x = malloc(count), *map_y = malloc(count);
        assert_true(map_x && map_y && renderer_read_redraw_map(a, eye, map_x) &&
                    renderer_read_redraw_map(b, eye, map_y));
        if (memcmp(x, y, 4 * count) != 0 || memcmp(map_x, map_y, count) != 0)
            fail_msg("frame %llu, eye %d: not the same", (unsigned long long)n, eye);
        free(x);
        free(y);
        free(map_x);
        free(map_y);
    }
}

static void two_options_agree(const struct pair *p, int scene, const char *first, const char *second,
                              const struct renderer_settings *settings)
{
    struct stage *stage = (struct stage *)&p->stage;
    struct renderer_option *a = stage_option_set(stage, p->uploaded[scene], first, settings);
    struct renderer_option *b = stage_option_set(stage, p->uploaded[scene], second, settings);
    for (uint64_t n = 0; n < 16; n++) {
        struct frame_stats x, y;
        const struct frame frame = flight(p, scene, n);
        assert_true(renderer_draw(a, &frame, &x));
        assert_true(renderer_draw(b, &frame, &y));
        assert_int_equal(x.shaded_px, y.shaded_px);
        assert_same(p, a, b, n);
    }
    renderer_option_destroy(a);
    renderer_option_destroy(b);
}

static void points_and_atomics_give_the_same_bytes(void **state)
{
    const struct renderer_settings all = {.ssao = true, .taa = true};
    for (int scene = 0; scene < SCENES; scene++)
        two_options_agree(*state, scene, "time_warped:splat=points", "time_warped:splat=atomic",
                          scene ? &all : NULL);
    two_options_agree(*state, 1, "time_warped:splat=points,dynamic_objects=regular",
                      "time_warped:splat=atomic,dynamic_objects=regular", NULL);
}

static void runs_repeat_byte_for_byte(void **state)
{
    const struct renderer_settings all = {.ssao = true, .taa = true};
    two_options_agree(*state, 1, "time_warped", "time_warped", &all);
    two_options_agree(*state, 1, "time_warped:dynamic_objects=regular", "time_warped:dynamic_objects=regular",
                      &all);
}

int main(void)
{
    struct stage probe;
    if (!stage_open(&probe, 16, 16))
        return 77;
    stage_close(&probe);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(epsilon_one_is_regular),
        cmocka_unit_test(a_still_eye_sees_regular_from_the_first_frame),
        cmocka_unit_test(points_and_atomics_give_the_same_bytes),
        cmocka_unit_test(runs_repeat_byte_for_byte),
    };
    return cmocka_run_group_tests(tests, open_pair, close_pair);
}
