// What makes a mode forget: each cause is told once, for the frame it concerns; and nothing is created after
// the options are.
#include "tests/renderer/stage.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { WIDTH = 72, HEIGHT = 64, ALL_PX = 2 * WIDTH * HEIGHT };

struct place {
    struct stage stage;
    struct scene *scene;
    struct renderer_scene *uploaded;
};

static int open_place(void **state)
{
    char error[512];
    struct place *p = calloc(1, sizeof *p);
    if (!p || !stage_open(&p->stage, WIDTH, HEIGHT))
        return -1;
    p->scene = scene_open("town:triangles=20000", error, sizeof error);
    if (!p->scene)
        fail_msg("%s", error);
    p->uploaded = renderer_scene_create(p->stage.renderer, p->scene);
    *state = p;
    return p->uploaded ? 0 : -1;
}

static int close_place(void **state)
{
    struct place *p = *state;
    renderer_scene_destroy(p->uploaded);
    scene_destroy(p->scene);
    stage_close(&p->stage);
    free(p);
    return 0;
}

static void each_cause_is_told_once(void **state)
{
    struct place *p = *state;
    const struct {
        uint64_t number;
        bool cut, moving, returned;
        enum frame_redraw cause;
    } steps[] = {
        {7, true, true, true, FRAME_REDRAW_FIRST}, // whatever else it is
        {8, false, true, false, FRAME_REDRAW_NONE},
        {9, true, true, false, FRAME_REDRAW_CUT},
        {10, false, true, false, FRAME_REDRAW_NONE},
        {14, false, true, false, FRAME_REDRAW_GAP},
        {15, false, true, false, FRAME_REDRAW_NONE},
        {15, false, true, false, FRAME_REDRAW_GAP}, // the same again, and one back
        {14, false, true, false, FRAME_REDRAW_GAP},
        {15, false, true, false, FRAME_REDRAW_NONE},
        {16, false, false, false, FRAME_REDRAW_MOTION},
        {17, false, false, false, FRAME_REDRAW_NONE},
        {18, false, true, false, FRAME_REDRAW_MOTION},
        {19, false, true, true, FRAME_REDRAW_GAZE},
        {20, false, true, false, FRAME_REDRAW_NONE},
        {21, true, false, true, FRAME_REDRAW_CUT}, // one cause a frame, the first that holds
        {30, false, true, true, FRAME_REDRAW_GAP},
        {31, false, false, true, FRAME_REDRAW_MOTION},
        {32, false, false, false, FRAME_REDRAW_NONE},
    };
    const struct renderer_settings settings[2] = {{0}, {.ssao = true, .taa = true}};
    for (int set = 0; set < 2; set++) {
        struct renderer_option *warped =
            stage_option_set(&p->stage, p->uploaded, "time_warped", &settings[set]);
        struct renderer_option *regular = stage_option_set(&p->stage, p->uploaded, "regular", &settings[set]);
        for (size_t i = 0; i < sizeof steps / sizeof steps[0]; i++) {
            struct frame frame = stage_frame(&p->stage, p->scene, steps[i].number, 0.05 * (double)i, 0, 0);
            frame.cut = steps[i].cut;
            frame.moving = steps[i].moving;
            frame.gaze_returned = steps[i].returned;
            frame.animation_s = 0.02 * (double)i;
            struct frame_stats stats;
            assert_true(renderer_draw(warped, &frame, &stats));
            if (stats.redraw != steps[i].cause)
                fail_msg("step %zu: cause %d instead of %d", i, (int)stats.redraw, (int)steps[i].cause);
            assert_int_equal(stats.shaded_px == ALL_PX, steps[i].cause != FRAME_REDRAW_NONE);
            assert_true(renderer_draw(regular, &frame, &stats));
            assert_int_equal(stats.redraw, FRAME_REDRAW_NONE); // it has nothing to redraw
            if (steps[i].cause !=
                FRAME_REDRAW_NONE) // nothing of the past is left, in the filter's history neither
                assert_true(stage_differ(&p->stage, warped, regular).max <= set);
        }
        renderer_option_destroy(warped);
        renderer_option_destroy(regular);
    }
}

static void nothing_is_created_while_frames_are_drawn(void **state)
{
    struct place *p = *state;
    const struct renderer_settings all = {.ssao = true, .taa = true}, measured = {.motion = true};
    struct renderer_option *options[] = {
        stage_option_set(&p->stage, p->uploaded, "time_warped", &all),
        stage_option_set(&p->stage, p->uploaded, "time_warped:splat=points,dynamic_objects=regular", NULL),
        stage_option_set(&p->stage, p->uploaded, "regular", &measured),
    };
    enum { OPTIONS = sizeof options / sizeof options[0] };
    uint64_t memory = renderer_memory(p->stage.renderer), own[OPTIONS], told[FRAME_REDRAW_CAUSES] = {0};
    for (int i = 0; i < OPTIONS; i++)
        own[i] = renderer_option_memory(options[i]);
    for (uint64_t n = 0; n < 100; n++) {
        struct renderer_option *shown = options[n / 9 % OPTIONS]; // the participant switches
        struct frame frame =
            stage_frame(&p->stage, p->scene, n, 0.02 * (double)n, 10 * sin(0.2 * (double)n), 0);
        struct frame_stats stats;
        frame.moving = n < 70;
        frame.animation_s = 0.02 * (double)n;
        frame.cut = n % 31 == 30;
        frame.gaze_returned = n % 23 == 22;
        assert_true(renderer_draw(shown, &frame, &stats));
        assert_true(renderer_show(p->stage.renderer, shown, 0.3));
        told[stats.redraw]++;
        assert_int_equal(renderer_memory(p->stage.renderer), memory);
        for (int i = 0; i < OPTIONS; i++)
            assert_int_equal(renderer_option_memory(options[i]), own[i]);
    }
    // eight stretches of nine frames with history: two first ones, six after a gap; the rest as the frames say
    assert_int_equal(told[FRAME_REDRAW_FIRST], 2);
    assert_int_equal(told[FRAME_REDRAW_GAP], 6);
    assert_int_equal(told[FRAME_REDRAW_CUT], 3);
    assert_int_equal(told[FRAME_REDRAW_GAZE], 2);
    assert_int_equal(told[FRAME_REDRAW_MOTION], 1);
    uint64_t before = renderer_memory(p->stage.renderer);
    for (int i = 0; i < OPTIONS; i++)
        renderer_option_destroy(options[i]);
    assert_true(renderer_memory(p->stage.renderer) < before);
}

int main(void)
{
    struct stage probe;
    if (!stage_open(&probe, 16, 16))
        return 77;
    stage_close(&probe);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_cause_is_told_once),
        cmocka_unit_test(nothing_is_created_while_frames_are_drawn),
    };
    return cmocka_run_group_tests(tests, open_place, close_place);
}
