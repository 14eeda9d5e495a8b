// Numbers set while an option runs give byte for byte the pictures of an option made with them, and make
// nothing on the device.
#include "tests/renderer/creations.h"
#include "tests/renderer/stage.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { WIDTH = 100, HEIGHT = 76, BEFORE = 3, FRAMES = 5 };

struct room {
    struct stage stage;
    struct scene *scene;
    struct renderer_scene *uploaded;
    uint64_t number;
};

static int open_room(void **state)
{
    char error[512];
    struct room *r = calloc(1, sizeof *r);
    if (!r || !stage_open(&r->stage, WIDTH, HEIGHT))
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

static struct mode_choice choice_of(const char *spec)
{
    struct mode_choice choice;
    char error[512];
    if (!mode_parse(spec, &choice, error, sizeof error))
        fail_msg("%s", error);
    return choice;
}

static struct frame next_frame(struct room *r, bool moving, bool cut)
{
    const uint64_t number = ++r->number;
    struct frame frame = stage_frame(&r->stage, r->scene, number, (double)number / 30, 6, -4);
    frame.moving = moving;
    frame.animation_s = moving ? (double)number / 30 : 0;
    frame.cut = cut;
    return frame;
}

static void expect_same(const struct room *r, struct renderer_option *a, struct renderer_option *b,
                        const char *what)
{
    const size_t count = (size_t)WIDTH * HEIGHT;
    uint8_t *maps[2] = {malloc(count), malloc(count)};
    for (int eye = 0; eye < EYES; eye++) {
        uint8_t *x = stage_read(&r->stage, a, eye), *y = stage_read(&r->stage, b, eye);
        if (memcmp(x, y, 4 * count) != 0)
            fail_msg("%s: pictures differ", what);
        assert_true(renderer_read_redraw_map(a, eye, maps[0]) && renderer_read_redraw_map(b, eye, maps[1]));
        if (memcmp(maps[0], maps[1], count) != 0)
            fail_msg("%s: redraw maps differ", what);
        free(x);
        free(y);
    }
    free(maps[0]);
    free(maps[1]);
}

static void expect_set_is_made(struct room *r, const char *before, const char *after,
                               const struct renderer_settings *plain, bool moving)
{
    char what[256];
    struct renderer_settings adjustable = *plain;
    adjustable.adjustable = true;
    const struct mode_choice first = choice_of(before), second = choice_of(after);
    struct renderer_option *set = renderer_option_create(r->stage.renderer, r->uploaded, &first, &adjustable);
    struct renderer_option *made = renderer_option_create(r->stage.renderer, r->uploaded, &second, plain);
    assert_true(set && made);
    for (int i = 0; i < BEFORE; i++) {
        const struct frame frame = next_frame(r, moving, false);
        assert_true(renderer_draw(set, &frame, NULL));
    }
    creations_begin();
    const bool done = renderer_option_set(set, &second);
    const struct creations creations = creations_end();
    assert_true(done);
    assert_int_equal(creations_total(&creations), 0);
    snprintf(what, sizeof what, "%s to %s%s%s", before, after, moving ? ", moving" : "",
             plain->taa ? ", taa" : "");
    for (int i = 0; i < FRAMES; i++) {
        struct frame_stats a, b;
        const struct frame frame = next_frame(r, moving, i == 0);
        assert_true(renderer_draw(set, &frame, &a) && renderer_draw(made, &frame, &b));
        assert_int_equal(a.shaded_px, b.shaded_px);
        expect_same(r, set, made, what);
    }
    renderer_option_destroy(set);
    renderer_option_destroy(made);
}

static void numbers_set_are_numbers_made(void **state)
{
    static const char *const pairs[][2] = {
        {"time_warped", "time_warped:epsilon=0.05"},
        {"time_warped:epsilon=0.5", "time_warped:epsilon=0.02,hole_decay=0.9"},
        {"time_warped:epsilon=0.02,hole_decay=0.9", "time_warped:epsilon=0.6,hole_decay=0.3"},
        {"time_warped", "time_warped:epsilon=0"},
        {"time_warped:epsilon=0", "time_warped"},
        {"time_warped:epsilon=0.3", "time_warped:epsilon=1"},
        {"time_warped:epsilon=1", "time_warped:fovea_deg=3,periphery_deg=50"},
        {"time_warped", "time_warped:fovea_deg=20,periphery_deg=25,dynamic_decay=0.4"},
        {"time_warped:dynamic_objects=regular", "time_warped:dynamic_objects=regular,epsilon=0.07"},
        {"time_warped:dynamic_objects=regular,epsilon=0", "time_warped:dynamic_objects=regular"},
        {"vrs", "vrs:inner_deg=4,outer_deg=9"},
        {"vrs:inner_deg=0,outer_deg=0", "vrs:inner_deg=30,outer_deg=180"},
    };
    struct room *r = *state;
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        expect_set_is_made(r, pairs[i][0], pairs[i][1], &(struct renderer_settings){0}, false);
        expect_set_is_made(r, pairs[i][0], pairs[i][1], &(struct renderer_settings){.ssao = true, .taa = true},
                           true);
    }
}

// They do change the picture, each one: else the law above would hold of a set that does nothing.
static void each_number_matters(void **state)
{
    static const char *const specs[][2] = {
        {"time_warped", "time_warped:epsilon=0.9"},
        {"time_warped", "time_warped:fovea_deg=1"},
        {"time_warped", "time_warped:periphery_deg=12"},
        {"vrs", "vrs:inner_deg=1"},
        {"vrs", "vrs:outer_deg=170"},
    };
    struct room *r = *state;
    for (size_t i = 0; i < sizeof specs / sizeof *specs; i++) {
        const struct mode_choice first = choice_of(specs[i][0]), second = choice_of(specs[i][1]);
        const struct renderer_settings settings = {.adjustable = true};
        struct renderer_option *set = renderer_option_create(r->stage.renderer, r->uploaded, &first, &settings),
                               *kept =
                                   renderer_option_create(r->stage.renderer, r->uploaded, &first, &settings);
        assert_true(set && kept && renderer_option_set(set, &second));
        struct frame_stats a, b;
        for (int k = 0; k < 3; k++) {
            const struct frame frame = next_frame(r, false, k == 0);
            assert_true(renderer_draw(set, &frame, &a) && renderer_draw(kept, &frame, &b));
        }
        if (a.shaded_px == b.shaded_px)
            fail_msg("%s and %s shade as much", specs[i][0], specs[i][1]);
        renderer_option_destroy(set);
        renderer_option_destroy(kept);
    }
}

static void expect_refused(struct room *r, struct renderer_option *option, const char *spec, double *value,
                           double becomes)
{
    struct mode_choice choice = choice_of(spec);
    if (value)
        choice.values[(size_t)*value] = becomes;
    assert_false(renderer_option_set(option, &choice));
    (void)r;
}

static void what_cannot_change_is_refused(void **state)
{
    struct room *r = *state;
    const struct mode_choice warped = choice_of("time_warped"), regular = choice_of("regular");
    const struct renderer_settings adjustable = {.adjustable = true};
    struct renderer_option *fixed = renderer_option_create(r->stage.renderer, r->uploaded, &warped, NULL);
    struct renderer_option *free_one =
        renderer_option_create(r->stage.renderer, r->uploaded, &warped, &adjustable);
    struct renderer_option *plain =
        renderer_option_create(r->stage.renderer, r->uploaded, &regular, &adjustable);
    expect_refused(r, fixed, "time_warped:epsilon=0.3", NULL, 0);     // not made for it
    expect_refused(r, plain, "regular", NULL, 0);                     // has no numbers
    expect_refused(r, free_one, "vrs", NULL, 0);                      // another mode
    expect_refused(r, free_one, "time_warped:splat=points", NULL, 0); // a switch
    expect_refused(r, free_one, "time_warped", &(double){0}, 1.5);    // out of range
    expect_refused(r, free_one, "time_warped", &(double){2}, 5);      // periphery within the fovea
    expect_refused(r, free_one, "time_warped", &(double){0}, (double)NAN);
    struct renderer_option *made = renderer_option_create(r->stage.renderer, r->uploaded, &warped, NULL);
    for (int i = 0; i < 3; i++) { // it stayed as it was
        const struct frame frame = next_frame(r, false, i == 0);
        assert_true(renderer_draw(free_one, &frame, NULL) && renderer_draw(made, &frame, NULL));
        expect_same(r, free_one, made, "after refusals");
    }
    renderer_option_destroy(made);
    renderer_option_destroy(plain);
    renderer_option_destroy(free_one);
    renderer_option_destroy(fixed);
}

int main(void)
{
    struct stage probe;
    if (!stage_open(&probe, 16, 16))
        return 77;
    stage_close(&probe);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_set_are_numbers_made),
        cmocka_unit_test(each_number_matters),
        cmocka_unit_test(what_cannot_change_is_refused),
    };
    return cmocka_run_group_tests(tests, open_room, close_room);
}
