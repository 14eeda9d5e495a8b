// Hard cases of all modes: far away, turned about, inside things, tiny, off the image, too bright.
#include "tests/renderer/blocks.h"
#include "tests/renderer/stage.h"

#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { SIZE = 64 };
static const struct renderer_settings all = {.ssao = true, .taa = true}, shaded = {.ssao = true};
static const struct block_key circle[] = {{0, 1, 0.5f, -3}, {0.5f, -1, 0.5f, -3.5f}, {1, 1, 0.5f, -3}};

// Boxes on a floor around the eye, every size from a room to nothing, one of them in motion. `away`: all of it.
static struct scene *yard(struct dvec3 away, bool moving)
{
    struct block list[40] = {
        {.middle = {0, -1.5, 0}, .half = {20, 0.1, 20}, .colour = {0.3f, 0.35f, 0.25f}},
        {.middle = {0, 0.5, -3}, .half = {0.3, 0.3, 0.3}, .colour = {0.7f, 0.1f, 0.1f}},
        {.middle = {0.4, 0.2, -2}, .half = {0, 0, 0}},           // nothing
        {.middle = {-0.4, 0.2, -2}, .half = {0.4, 0.2, 0}},      // a card
        {.middle = {-0.8, 0.6, -2}, .half = {0.3, 0, 0}},        // a line
        {.middle = {0.2, -0.3, -2}, .half = {0.03, 0.03, 0.03}}, // about a pixel
        {.middle = {0.3, -0.3, -2}, .half = {0.001, 0.001, 0.001}},
    };
    uint32_t count = 7;
    if (moving)
        list[1].keys = circle, list[1].key_count = 3;
    for (int i = 0; i < 24; i++) {
        const double angle = 0.2618 * i, r = 3.5 + i % 5;
        list[count++] =
            (struct block){.middle = {r * sin(angle), 0.2 * (i % 7) - 1, -r * cos(angle)},
                           .half = {0.3 + 0.1 * (i % 3), 0.4 + 0.1 * (i % 4), 0.4},
                           .colour = {0.1f + 0.1f * (float)(i % 8), 0.6f - 0.1f * (float)(i % 5), 0.3f}};
    }
    for (uint32_t i = 0; i < count; i++)
        list[i].middle = dvec3_add(list[i].middle, away);
    const struct scene_light light = {.position = dvec3_add(away, (struct dvec3){1, 2, -2}),
                                      .intensity = {3, 3, 2},
                                      .range_m = 9,
                                      .cos_outer = -2};
    return blocks_scene(&(struct blocks){.list = list,
                                         .count = count,
                                         .eye = away,
                                         .target = dvec3_add(away, (struct dvec3){0, 0, -1}),
                                         .lights = &light,
                                         .light_count = 1,
                                         .sky = 0.3f});
}

// The head of a scene's camera, moved, and turned to a side.
static struct frame frame_at(const struct stage *stage, const struct scene *scene, uint64_t n, struct dvec3 by,
                             double turn_rad)
{
    struct frame frame = stage_frame(stage, scene, n, 0, 0, 0);
    struct pose head = camera_path_pose(&scene->path, 0);
    head.position = dvec3_add(head.position, by);
    head.orientation = (struct dquat){0, sin(turn_rad / 2), 0, cos(turn_rad / 2)};
    for (int eye = 0; eye < EYES; eye++)
        frame.eyes[eye].pose = viewing_eye_pose(&head, eye, VIEWING_DEFAULT_IPD_M);
    return frame;
}

struct pair {
    struct scene *scene;
    struct renderer_scene *uploaded;
    struct renderer_option *warped, *regular;
};

static struct pair open_pair(struct stage *stage, struct scene *scene, const struct renderer_settings *settings)
{
    struct pair p = {.scene = scene, .uploaded = renderer_scene_create(stage->renderer, scene)};
    assert_non_null(p.uploaded);
    p.warped = stage_option_set(stage, p.uploaded, "time_warped", settings);
    p.regular = stage_option_set(stage, p.uploaded, "regular", settings);
    return p;
}

static void close_pair(struct pair *p)
{
    renderer_option_destroy(p->warped);
    renderer_option_destroy(p->regular);
    renderer_scene_destroy(p->uploaded);
    scene_destroy(p->scene);
}

static struct stage_difference draw_both(const struct stage *stage, const struct pair *p,
                                         const struct frame *frame, struct frame_stats *out)
{
    assert_true(renderer_draw(p->warped, frame, out));
    assert_true(renderer_draw(p->regular, frame, NULL));
    return stage_differ(stage, p->warped, p->regular);
}

static void far_from_the_origin_looks_the_same(void **state)
{
    struct stage *stage = *state;
    const double metres[] = {10000, 100000};
    struct pair here = open_pair(stage, yard((struct dvec3){0, 0, 0}, false), &all);
    for (int i = 0; i < 2; i++) {
        const struct dvec3 away = {metres[i], 3.7, -metres[i] - 0.25};
        struct pair there = open_pair(stage, yard(away, false), &all);
        struct stage_difference warped = {0}, regular = {0};
        for (uint64_t n = 0; n < 31; n++) {
            const double t = (double)n;
            const struct dvec3 by = {0.01 * t, 0.02 * sin(0.3 * t), -0.02 * t};
            struct frame frame = frame_at(stage, here.scene, n, by, 0.01 * t);
            assert_true(renderer_draw(here.warped, &frame, NULL) && renderer_draw(here.regular, &frame, NULL));
            frame = frame_at(stage, there.scene, n, by, 0.01 * t);
            assert_true(renderer_draw(there.warped, &frame, NULL) &&
                        renderer_draw(there.regular, &frame, NULL));
        }
        warped = stage_differ(stage, here.warped, there.warped);
        regular = stage_differ(stage, here.regular, there.regular);
        print_message("%g km out after 30 frames: time_warped differs by %.4f, at most %d; regular %.4f, %d\n",
                      metres[i] / 1000, warped.mean, warped.max, regular.mean, regular.max);
        assert_true(regular.mean < 0.01);
        assert_true(warped.mean < 0.05); // points on the border of two pixels fall on the other side
        close_pair(&there);
    }
    close_pair(&here);
}

// Nothing kept is on the screen after a half-turn, so all of it is drawn anew; and nothing stays of what was
// there.
static void a_half_turn_is_drawn_anew(void **state)
{
    struct stage *stage = *state;
    const struct renderer_settings *settings[] = {NULL, &shaded, &all};
    for (int i = 0; i < 3; i++) {
        struct pair p = open_pair(stage, yard((struct dvec3){0, 0, 0}, true), settings[i]);
        for (uint64_t n = 0; n < 12; n++) {
            struct frame_stats stats;
            const bool back = n / 3 % 2, turned = n % 3 == 0;
            struct frame frame =
                frame_at(stage, p.scene, n, (struct dvec3){0, 0, 0}, back ? 3.14159265358979 : 0);
            const struct stage_difference d = draw_both(stage, &p, &frame, &stats);
            assert_int_equal(stats.redraw, n ? FRAME_REDRAW_NONE : FRAME_REDRAW_FIRST);
            assert_int_equal(stats.shaded_px == 2 * SIZE * SIZE, turned);
            if (i < 2 || turned)
                assert_true(d.max <= (i < 2 ? 0 : 1));
        }
        close_pair(&p);
    }
}

// Through the near plane into a box and out of its other side.
static void a_camera_goes_through_a_box(void **state)
{
    struct stage *stage = *state;
    for (int i = 0; i < 2; i++) {
        struct pair p = open_pair(stage, yard((struct dvec3){0, 0, 0}, true), i ? &all : NULL);
        double worst = 0;
        for (uint64_t n = 0; n < 60; n++) {
            struct frame frame = frame_at(stage, p.scene, n, (struct dvec3){0, 0.5, -2 - 0.03 * (double)n}, 0);
            worst = fmax(worst, draw_both(stage, &p, &frame, NULL).mean);
        }
        print_message("through a box: mean error %.2f at worst\n", worst);
        assert_true(worst < 4);
        // and standing in it is as good as standing elsewhere
        for (uint64_t n = 60; i == 0 && n < 64; n++) {
            struct frame frame = frame_at(stage, p.scene, n, (struct dvec3){0, 0.5, -3}, 0);
            frame.cut = n == 60;
            assert_int_equal(draw_both(stage, &p, &frame, NULL).max, 0);
        }
        close_pair(&p);
    }
}

static void every_size_keeps_the_laws(void **state)
{
    (void)state;
    const uint32_t sizes[][2] = {{16, 16}, {17, 33}, {61, 45}, {129, 16}};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        struct stage stage;
        assert_true(stage_open(&stage, sizes[i][0], sizes[i][1]));
        struct pair still = open_pair(&stage, yard((struct dvec3){0, 0, 0}, false), &shaded);
        struct pair moving = open_pair(&stage, yard((struct dvec3){0, 0, 0}, true), &all);
        struct renderer_option *one = stage_option_set(&stage, moving.uploaded, "time_warped:epsilon=1", &all);
        for (uint64_t n = 0; n < 10; n++) {
            struct frame frame = frame_at(&stage, still.scene, n, (struct dvec3){0, 0, 0}, 0.3);
            assert_int_equal(draw_both(&stage, &still, &frame, NULL).max, 0);
            frame = frame_at(&stage, moving.scene, n, (struct dvec3){0.02 * (double)n, 0, 0}, 0.05 * (double)n);
            frame.moving = true;
            frame.animation_s = 0.05 * (double)n;
            draw_both(&stage, &moving, &frame, NULL);
            assert_true(renderer_draw(one, &frame, NULL));
            assert_true(stage_differ(&stage, one, moving.regular).max <= 1);
        }
        renderer_option_destroy(one);
        close_pair(&still);
        close_pair(&moving);
        stage_close(&stage);
    }
}

static void the_gaze_may_be_anywhere(void **state)
{
    struct stage *stage = *state;
    const double gazes[][2] = {{0, 0},     {50, 50},   {-49.9, -49.9},  {80, 0},  {0, -89.9999}, {180, 0},
                               {-180, 90}, {360, 720}, {1e300, -1e300}, {NAN, 0}, {0, INFINITY}};
    struct pair p = open_pair(stage, yard((struct dvec3){0, 0, 0}, false), NULL);
    uint64_t number = 0;
    for (size_t i = 0; i < sizeof gazes / sizeof gazes[0]; i++) {
        struct frame_stats stats;
        for (int k = 0; k < 2; k++) {
            struct frame frame = frame_at(stage, p.scene, number++, (struct dvec3){0, 0, 0}, 0);
            for (int eye = 0; eye < EYES; eye++) {
                frame.eyes[eye].gaze_x_deg = gazes[i][0];
                frame.eyes[eye].gaze_y_deg = gazes[i][1];
            }
            const int max = draw_both(stage, &p, &frame, &stats).max;
            // a fovea that left its place leaves holes nowhere in a still picture, so the law holds on
            if (max)
                fail_msg("gaze %g, %g: off by %d", gazes[i][0], gazes[i][1], max);
        }
        if (!isfinite(gazes[i][0]) || !isfinite(gazes[i][1]))
            assert_int_equal(stats.shaded_px, 2 * SIZE * SIZE);
        else if (fabs(gazes[i][0]) == 180 && gazes[i][1] == 0)
            assert_int_equal(stats.shaded_px, 0);
    }
    close_pair(&p);
}

// rgb of the left eye's middle pixel.
static void middle(const struct stage *stage, struct renderer_option *option, int out[3])
{
    uint8_t *pixels = stage_read(stage, option, EYE_LEFT);
    for (int k = 0; k < 3; k++)
        out[k] = pixels[4 * (SIZE / 2 * SIZE + SIZE / 2) + k];
    free(pixels);
}

// A black wall that glows: radiance e, at most the largest half float, tone-mapped by e / (1 + e) and encoded.
// What is not finite anywhere in between would not come out as this.
static void a_glow_of_any_strength_is_shown(void **state)
{
    struct stage *stage = *state;
    const float strengths[] = {1e-6f, 1e-4f, 1e-2f, 0.3f, 1, 100, 65504, 65536, 1e9f, 1e30f, FLT_MAX};
    for (size_t i = 0; i < sizeof strengths / sizeof strengths[0]; i++) {
        const float e = strengths[i];
        const struct block wall = {
            .middle = {0, 0, -3}, .half = {1, 1, 1}, .colour = {1e-5f, 1e-5f, 1e-5f}, .emissive = {e, e, e}};
        for (int set = 0; set < 2; set++) {
            struct pair p = open_pair(
                stage, blocks_scene(&(struct blocks){.list = &wall, .count = 1, .target = {0, 0, -1}}),
                set ? &all : NULL);
            for (uint64_t n = 0; n < 6; n++) {
                struct frame frame = frame_at(stage, p.scene, n, (struct dvec3){0.01 * (double)n, 0, 0}, 0);
                draw_both(stage, &p, &frame, NULL);
            }
            const double r = fmin(e, 65504), display = r / (1 + r);
            const double code =
                255 * (display <= 0.0031308 ? 12.92 * display : 1.055 * pow(display, 1 / 2.4) - 0.055);
            int a[3], b[3];
            middle(stage, p.warped, a);
            middle(stage, p.regular, b);
            for (int k = 0; k < 3; k++)
                if (fabs(a[k] - code) > 1 || fabs(b[k] - code) > 1)
                    fail_msg("a glow of %g: %d and %d instead of %.1f", (double)e, a[k], b[k], code);
            close_pair(&p);
        }
    }
}

// A light before a wall: the stronger, the brighter, up to white; and the picture around it stays what it was.
static void a_light_of_any_strength_is_shown(void **state)
{
    struct stage *stage = *state;
    const float strengths[] = {0, 1e-6f, 1e-3f, 1, 1e3f, 65504, 1e6f, 1e12f, 1e30f, FLT_MAX};
    const struct block wall = {.middle = {0, 0, -3}, .half = {1, 1, 1}};
    int before = 0;
    for (size_t i = 0; i < sizeof strengths / sizeof strengths[0]; i++) {
        const float e = strengths[i];
        // one shines on the wall, one stands in it, one behind the surfaces that are seen
        const struct scene_light lights[] = {
            {.position = {0, 0, -1.5}, .intensity = {e, e, e}, .range_m = 10, .cos_outer = -2},
            {.position = {0, 0, -2}, .intensity = {e, e, e}, .range_m = 10, .cos_outer = -2},
            {.position = {0, 0, -9}, .intensity = {e, e, e}, .range_m = 10, .cos_outer = -2}};
        struct pair p = open_pair(stage,
                                  blocks_scene(&(struct blocks){.list = &wall,
                                                                .count = 1,
                                                                .target = {0, 0, -1},
                                                                .lights = lights,
                                                                .light_count = 3,
                                                                .sky = 0.01f}),
                                  &all);
        for (uint64_t n = 0; n < 6; n++) {
            struct frame frame = frame_at(stage, p.scene, n, (struct dvec3){0.01 * (double)n, 0, 0}, 0);
            draw_both(stage, &p, &frame, NULL);
        }
        int a[3], b[3];
        middle(stage, p.warped, a);
        middle(stage, p.regular, b);
        print_message("a light of %g cd: %d and %d\n", (double)e, a[0], b[0]);
        assert_true(abs(a[0] - b[0]) <= 1 && a[0] >= before - 1);
        assert_true(e < 1e3f || a[0] >= 254);
        before = a[0];
        close_pair(&p);
    }
}

static int open_stage(void **state)
{
    struct stage *stage = calloc(1, sizeof *stage);
    *state = stage;
    return stage && stage_open(stage, SIZE, SIZE) ? 0 : -1;
}

static int close_stage(void **state)
{
    stage_close(*state);
    free(*state);
    return 0;
}

int main(void)
{
    struct stage probe;
    if (!stage_open(&probe, 16, 16))
        return 77;
    stage_close(&probe);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(far_from_the_origin_looks_the_same), cmocka_unit_test(a_half_turn_is_drawn_anew),
        cmocka_unit_test(a_camera_goes_through_a_box),        cmocka_unit_test(every_size_keeps_the_laws),
        cmocka_unit_test(the_gaze_may_be_anywhere),           cmocka_unit_test(a_glow_of_any_strength_is_shown),
        cmocka_unit_test(a_light_of_any_strength_is_shown),
    };
    return cmocka_run_group_tests(tests, open_stage, close_stage);
}
