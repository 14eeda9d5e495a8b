// Both eyes drawn in one pass: the pictures of drawing them one after the other, byte for byte, and triangles
// counted as they are drawn, each for both eyes.
#include "tests/renderer/stage.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

static const char *const scene_names[] = {"atrium",
                                          "town:triangles=60000"}; // alpha tests in both, movers in the town
static const char *const ways[] = {"regular:eyes=instanced", "regular:eyes=multiview"};
static const uint32_t sizes[][2] = {{101, 67}, {64, 96}};
enum { SCENES = 2, WAYS = 2, SIZES = 2 };

struct bed {
    struct stage stage;
    struct scene *scene;
    struct renderer_scene *uploaded;
};

static void bed_open(struct bed *b, int size, int scene)
{
    char error[512];
    assert_true(stage_open(&b->stage, sizes[size][0], sizes[size][1]));
    b->scene = scene_open(scene_names[scene], error, sizeof error);
    assert_non_null(b->scene);
    b->uploaded = renderer_scene_create(b->stage.renderer, b->scene);
    assert_non_null(b->uploaded);
}

static void bed_close(struct bed *b)
{
    renderer_scene_destroy(b->uploaded);
    scene_destroy(b->scene);
    stage_close(&b->stage);
}

// NULL where the device refuses, which it says.
static struct renderer_option *one_pass(struct bed *b, const char *way,
                                        const struct renderer_settings *settings)
{
    struct mode_choice choice;
    char error[512];
    assert_true(mode_parse(way, &choice, error, sizeof error));
    struct renderer_option *option = renderer_option_create(b->stage.renderer, b->uploaded, &choice, settings);
    if (!option && !strstr(b->stage.log, "lacks or gets wrong"))
        fail_msg("%s: %s", way, b->stage.log);
    if (!option)
        print_message("%s: not on this device\n", way);
    return option;
}

static struct frame flight(const struct bed *b, uint64_t n)
{
    const double t = (double)n;
    struct frame frame = stage_frame(&b->stage, b->scene, n, 3 + 0.1 * t, 0, 0);
    frame.moving = b->scene->moving_count > 0;
    frame.animation_s = frame.moving ? 0.1 * t : 0;
    return frame;
}

static void compare(struct bed *b, const char *way, const struct renderer_settings *settings)
{
    struct renderer_option *together = one_pass(b, way, settings);
    if (!together)
        return;
    struct renderer_option *apart = stage_option_set(&b->stage, b->uploaded, "regular", settings);
    for (uint64_t n = 0; n < 6; n++) {
        struct frame_stats x, y;
        struct frame frame = flight(b, n);
        if (n == 5) // both eyes at one place: what one sees, the other does
            frame.eyes[1] = frame.eyes[0];
        assert_true(renderer_draw(together, &frame, &x) && renderer_draw(apart, &frame, &y));
        assert_int_equal(stage_differ(&b->stage, together, apart).max, 0);
        assert_true(x.triangles >= y.triangles && x.submodels >= y.submodels);
        assert_int_equal(x.triangles % 2, 0);
        if (n == 5)
            assert_true(x.triangles == y.triangles && x.submodels == y.submodels);
    }
    renderer_option_destroy(together);
    renderer_option_destroy(apart);
}

static void one_pass_gives_the_same_bytes(void **state)
{
    (void)state;
    static const struct renderer_settings all = {.ssao = true, .taa = true};
    for (int size = 0; size < SIZES; size++)
        for (int scene = 0; scene < SCENES; scene++) {
            struct bed b;
            bed_open(&b, size, scene);
            for (int way = 0; way < WAYS; way++) {
                compare(&b, ways[way], NULL);
                compare(&b, ways[way], &all);
            }
            bed_close(&b);
        }
}

// Each eye looks away from the other: what one list is drawn for both eyes is, but for boxes that reach around
// the head, what neither shares.
static void eyes_apart_draw_what_either_sees(void **state)
{
    (void)state;
    struct bed b;
    bed_open(&b, 0, 1);
    struct renderer_option *together = one_pass(&b, ways[0], NULL);
    if (together) {
        struct renderer_option *apart = stage_option_set(&b.stage, b.uploaded, "regular", NULL);
        struct frame_stats x, y;
        struct frame frame = flight(&b, 0);
        struct dquat *turned = &frame.eyes[1].pose.orientation;
        *turned = dquat_look(dquat_rotate(*turned, (struct dvec3){0, 0, 1}), (struct dvec3){0, 1, 0});
        assert_true(renderer_draw(together, &frame, &x) && renderer_draw(apart, &frame, &y));
        assert_int_equal(stage_differ(&b.stage, together, apart).max, 0);
        assert_in_range(x.triangles, y.triangles + y.triangles / 2, 2 * y.triangles);
        renderer_option_destroy(together);
        renderer_option_destroy(apart);
    }
    bed_close(&b);
}

int main(void)
{
    struct stage probe;
    if (!stage_open(&probe, 16, 16))
        return 77;
    stage_close(&probe);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_pass_gives_the_same_bytes),
        cmocka_unit_test(eyes_apart_draw_what_either_sees),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
