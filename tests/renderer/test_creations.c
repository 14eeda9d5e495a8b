// No pipeline, target or buffer is made once the options are there: not by a frame of any kind, not by text.
#include "tests/renderer/creations.h"
#include "tests/renderer/stage.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { SIZE = 64, OPTIONS = 6, ROUNDS = 3 };

static const char *const names[OPTIONS] = {
    "regular", "time_warped",           "time_warped:dynamic_objects=regular", "time_warped:splat=points",
    "vrs",     "time_warped:epsilon=1",
};

struct room {
    struct stage stage;
    struct scene *scene;
    struct renderer_scene *uploaded;
};

static int open_room(void **state)
{
    char error[512];
    struct room *r = calloc(1, sizeof *r);
    if (!r || !stage_open(&r->stage, SIZE, SIZE))
        return -1;
    r->scene = scene_open("town:triangles=20000", error, sizeof error);
    if (!r->scene)
        fail_msg("%s", error);
    r->uploaded = renderer_scene_create(r->stage.renderer, r->scene);
    *state = r;
    return r->uploaded ? 0 : -1;
}

static int close_room(void **state)
{
    struct room *r = *state;
    renderer_scene_destroy(r->uploaded);
    scene_destroy(r->scene);
    stage_close(&r->stage);
    free(r);
    return 0;
}

static void draw_all(const struct room *r, struct renderer_option *const *options, const struct frame *frame)
{
    for (int i = 0; i < OPTIONS; i++) {
        assert_true(renderer_draw(options[i], frame, NULL));
        assert_true(renderer_show(r->stage.renderer, options[i], 0));
    }
}

// Everything that a trial may do to the options: plain frames, a cut, a gap as a switch leaves it, a gaze that
// is lost and comes back, objects that start and stop to move.
static void draw_a_trial(const struct room *r, struct renderer_option *const *options, uint64_t *number)
{
    enum { PLAIN, CUT, GAP, LOST, BACK, MOVING, STILL_MOVING, AT_REST, KINDS };
    for (int kind = 0; kind < KINDS; kind++) {
        const bool lost = kind == LOST;
        *number += kind == GAP ? 5 : 1;
        struct frame frame =
            stage_frame(&r->stage, r->scene, *number, 0.02 * (double)*number, lost ? NAN : 4, lost ? NAN : -3);
        frame.cut = kind == CUT;
        frame.gaze_returned = kind == BACK;
        frame.moving = kind == MOVING || kind == STILL_MOVING;
        frame.animation_s = frame.moving ? 0.01 * (double)*number : 0;
        draw_all(r, options, &frame);
    }
}

// A target and spheres in other places each time, and none.
static void show_marks(const struct room *r, struct renderer_option *option)
{
    struct renderer_mark marks[RENDERER_MARKS];
    for (uint32_t count = 0; count <= RENDERER_MARKS; count += 20) {
        for (uint32_t i = 0; i < count; i++)
            marks[i] =
                (struct renderer_mark){.kind = i % 2 ? RENDERER_MARK_BALL : RENDERER_MARK_CROSS,
                                       .place = {{i, 2, {{0.2, 0}, {0, -0.2}}}, {i, 3, {{0.2, 0}, {0, -0.2}}}},
                                       .opacity = {1, 1}};
        assert_true(renderer_set_marks(r->stage.renderer, marks, count));
        assert_true(renderer_show(r->stage.renderer, option, 0.5));
        assert_true(renderer_show(r->stage.renderer, NULL, 1));
    }
    assert_true(renderer_set_marks(r->stage.renderer, NULL, 0));
}

// Texts of several sizes over gray, as between two options; none is larger than an eye.
static void show_texts(const struct room *r)
{
    static const uint8_t rgba[4 * SIZE * SIZE];
    const uint32_t sizes[][2] = {{9, 7}, {SIZE, 3}, {2, SIZE}, {SIZE, SIZE}, {9, 7}};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        const struct renderer_overlay over = {.rgba = rgba, .width = sizes[i][0], .height = sizes[i][1]};
        assert_true(renderer_set_overlay(r->stage.renderer, &over));
        assert_true(renderer_show(r->stage.renderer, NULL, 1));
        assert_true(renderer_set_overlay(r->stage.renderer, NULL));
        assert_true(renderer_show(r->stage.renderer, NULL, 1));
    }
}

static void expect_nothing(const struct creations *c)
{
    if (creations_total(c))
        fail_msg("made in a trial: %u pipelines, %u shaders, %u images, %u views, %u buffers, %u allocations",
                 c->pipelines, c->shaders, c->images, c->views, c->buffers, c->allocations);
}

static void a_trial_makes_nothing(void **state)
{
    static const uint8_t dot[4];
    const struct room *r = *state;
    uint64_t number = 0;
    // the first text, which comes before every trial, makes room for all
    assert_true(renderer_set_overlay(r->stage.renderer,
                                     &(struct renderer_overlay){.rgba = dot, .width = 1, .height = 1}));
    for (int settings = 0; settings < 4; settings++) {
        const struct renderer_settings set = {.ssao = settings & 1, .taa = settings & 2};
        struct renderer_option *options[OPTIONS];
        for (int i = 0; i < OPTIONS; i++)
            options[i] = stage_option_set((struct stage *)&r->stage, r->uploaded, names[i], &set);
        creations_begin();
        for (int round = 0; round < ROUNDS; round++) {
            draw_a_trial(r, options, &number);
            show_texts(r);
            show_marks(r, options[0]);
        }
        const struct creations made = creations_end();
        for (int i = 0; i < OPTIONS; i++)
            renderer_option_destroy(options[i]);
        expect_nothing(&made);
    }
}

// The law above would hold of a counter that sees nothing.
static void an_option_s_things_are_counted(void **state)
{
    const struct room *r = *state;
    for (int i = 0; i < OPTIONS; i++) {
        creations_begin();
        struct renderer_option *option = stage_option((struct stage *)&r->stage, r->uploaded, names[i]);
        const struct creations made = creations_end();
        assert_true(made.pipelines && made.shaders && made.images && made.views && made.buffers &&
                    made.allocations >= made.images + made.buffers);
        renderer_option_destroy(option);
    }
}

int main(void)
{
    struct stage probe;
    if (!stage_open(&probe, 16, 16))
        return 77;
    stage_close(&probe);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_trial_makes_nothing),
        cmocka_unit_test(an_option_s_things_are_counted),
    };
    return cmocka_run_group_tests(tests, open_room, close_room);
}
