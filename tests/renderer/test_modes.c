// Laws of the modes, on whatever device there is, with the validation layer listening.
#include "tests/renderer/stage.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

static const double step_s = 1.0 / 90;

struct pair {
    struct stage stage;
    struct scene *scene;
    struct renderer_scene *uploaded;
};

static int open_pair(void **state)
{
    char error[512];
    struct pair *p = calloc(1, sizeof *p);
    // 168x181: no multiple of the 8-pixel tile, no power of two
    if (!p || !stage_open(&p->stage, 168, 181))
        return -1;
    p->scene = scene_open("atrium", error, sizeof error);
    if (!p->scene)
        fail_msg("%s", error);
    p->uploaded = renderer_scene_create(p->stage.renderer, p->scene);
    *state = p;
    return p->uploaded ? 0 : -1;
}

static int close_pair(void **state)
{
    struct pair *p = *state;
    renderer_scene_destroy(p->uploaded);
    scene_destroy(p->scene);
    stage_close(&p->stage);
    free(p);
    return 0;
}

static struct stage_difference difference(const struct pair *p, struct renderer_option *a,
                                          struct renderer_option *b)
{
    struct stage_difference worst = {0};
    for (int eye = 0; eye < EYES; eye++) {
        uint8_t *x = stage_read(&p->stage, a, eye), *y = stage_read(&p->stage, b, eye);
        struct stage_difference d = stage_compare(&p->stage, x, y);
        worst.mean += d.mean / EYES;
        worst.max = d.max > worst.max ? d.max : worst.max;
        free(x);
        free(y);
    }
    return worst;
}

static void draw(struct renderer_option *option, const struct frame *frame, struct frame_stats *out)
{
    assert_true(renderer_draw(option, frame, out));
}

static void epsilon_one_is_regular(void **state)
{
    struct pair *p = *state;
    struct renderer_option *warped = stage_option(&p->stage, p->uploaded, "time_warped:epsilon=1");
    struct renderer_option *regular = stage_option(&p->stage, p->uploaded, "regular");
    struct frame_stats stats;
    for (uint64_t n = 0; n < 4; n++) {
        struct frame frame = stage_frame(&p->stage, p->scene, n, 10 * step_s * (double)n, 5, -3);
        draw(warped, &frame, &stats);
        assert_int_equal(stats.shaded_px, 2ull * p->stage.width * p->stage.height);
        draw(regular, &frame, NULL);
        assert_true(difference(p, warped, regular).max <= 1);
    }
    renderer_option_destroy(warped);
    renderer_option_destroy(regular);
}

static void a_still_eye_sees_regular_from_the_first_frame(void **state)
{
    struct pair *p = *state;
    struct renderer_option *warped = stage_option(&p->stage, p->uploaded, "time_warped");
    struct renderer_option *regular = stage_option(&p->stage, p->uploaded, "regular");
    struct frame_stats stats;
    for (uint64_t n = 0; n < 5; n++) {
        struct frame frame = stage_frame(&p->stage, p->scene, n, 3, 0, 0);
        draw(warped, &frame, &stats);
        draw(regular, &frame, NULL);
        assert_int_equal(difference(p, warped, regular).max, 0);
        assert_int_equal(stats.redraw, n == 0 ? FRAME_REDRAW_FIRST : FRAME_REDRAW_NONE);
    }
    renderer_option_destroy(warped);
    renderer_option_destroy(regular);
}

// The static confidence is c_e alone where nothing moved: the redraw map is the disc in which the smooth step
// of the eccentricity stays under epsilon, here by double precision from the pixel's direction.
static void the_redraw_map_is_the_disc_of_low_confidence(void **state)
{
    struct pair *p = *state;
    struct renderer_option *warped = stage_option(&p->stage, p->uploaded, "time_warped");
    struct frame_stats stats;
    const uint32_t w = p->stage.width, h = p->stage.height;
    uint8_t *map = malloc((size_t)w * h);
    struct frame frame;
    for (uint64_t n = 0; n < 2; n++) {
        frame = stage_frame(&p->stage, p->scene, n, 3, 20, 15);
        draw(warped, &frame, &stats);
    }
    uint32_t wrong = 0, redrawn = 0;
    struct dvec3 gaze = viewing_direction(20, 15);
    assert_true(renderer_read_redraw_map(warped, EYE_LEFT, map));
    for (uint32_t i = 0; i < w * h; i++) {
        struct dvec3 d = viewing_pixel_direction(&frame.eyes[0].fov, w, h, i % w + 0.5, i / w + 0.5);
        double t = (geometry_angle_deg(d, gaze) - 10) / 20;
        t = t < 0 ? 0 : t > 1 ? 1 : t;
        bool expected = t * t * (3 - 2 * t) < 0.2;
        wrong += expected != (map[i] != 0);
        redrawn += expected;
    }
    print_message("disc of %.2f %% of the pixels, %u decided otherwise\n", 100.0 * redrawn / (w * h), wrong);
    assert_true(wrong <= 2);                           // rounding at the rim
    assert_in_range(1000 * redrawn / (w * h), 62, 72); // 6.7 % at (20, 15), DESIGN section 3
    free(map);
    renderer_option_destroy(warped);
}

static void error_falls_with_epsilon_and_few_pixels_are_shaded(void **state)
{
    struct pair *p = *state;
    const char *names[] = {"time_warped:epsilon=0.05", "time_warped:epsilon=0.1", "time_warped:epsilon=0.2"};
    struct renderer_option *regular = stage_option(&p->stage, p->uploaded, "regular");
    struct renderer_option *warped[3];
    double mean[3] = {0};
    for (int i = 0; i < 3; i++)
        warped[i] = stage_option(&p->stage, p->uploaded, names[i]);
    for (uint64_t n = 0; n < 45; n++) {
        struct frame frame = stage_frame(&p->stage, p->scene, n, 3 * step_s * (double)n, 0, 0);
        struct frame_stats stats = {0};
        for (int i = 0; i < 3; i++)
            draw(warped[i], &frame, &stats); // the last: epsilon 0.2
        if (n >= 10)
            assert_true(stats.shaded_px < 2ull * p->stage.width * p->stage.height / 10);
        if (n % 5 != 4)
            continue;
        draw(regular, &frame, NULL);
        for (int i = 0; i < 3; i++)
            mean[i] += difference(p, warped[i], regular).mean / 9;
    }
    print_message("mean error at epsilon 0.05, 0.1, 0.2: %.4f %.4f %.4f of 255\n", mean[0], mean[1], mean[2]);
    assert_true(mean[0] >= mean[1] && mean[1] >= mean[2]);
    assert_true(mean[2] > 0); // it is a foveated mode
    for (int i = 0; i < 3; i++)
        renderer_option_destroy(warped[i]);
    renderer_option_destroy(regular);
}

static void runs_repeat_byte_for_byte(void **state)
{
    struct pair *p = *state;
    uint8_t *first = NULL;
    for (int run = 0; run < 2; run++) {
        struct renderer_option *warped = stage_option(&p->stage, p->uploaded, "time_warped");
        for (uint64_t n = 0; n < 6; n++) {
            struct frame frame = stage_frame(&p->stage, p->scene, n, 2 * step_s * (double)n, -8, 4);
            draw(warped, &frame, NULL);
        }
        uint8_t *pixels = stage_read(&p->stage, warped, EYE_RIGHT);
        if (run == 0)
            first = pixels;
        else {
            assert_memory_equal(first, pixels, 4ull * p->stage.width * p->stage.height);
            free(pixels);
        }
        renderer_option_destroy(warped);
    }
    free(first);
}

static void no_gaze_means_everything_is_drawn(void **state)
{
    struct pair *p = *state;
    struct renderer_option *warped = stage_option(&p->stage, p->uploaded, "time_warped");
    struct frame_stats stats = {0};
    for (uint64_t n = 0; n < 2; n++) {
        struct frame frame = stage_frame(&p->stage, p->scene, n, 0, NAN, 0);
        draw(warped, &frame, &stats);
        assert_int_equal(stats.shaded_px, 2ull * p->stage.width * p->stage.height);
    }
    renderer_option_destroy(warped);
}

static void a_cut_and_a_gap_forget_the_past(void **state)
{
    struct pair *p = *state;
    struct renderer_option *warped = stage_option(&p->stage, p->uploaded, "time_warped");
    struct frame_stats stats = {0};
    const uint64_t numbers[] = {0, 1, 5, 6, 7};
    const bool cuts[] = {false, false, false, false, true};
    const enum frame_redraw full[] = {FRAME_REDRAW_FIRST, FRAME_REDRAW_NONE, FRAME_REDRAW_GAP,
                                      FRAME_REDRAW_NONE, FRAME_REDRAW_CUT};
    for (int i = 0; i < 5; i++) {
        struct frame frame = stage_frame(&p->stage, p->scene, numbers[i], 0, 0, 0);
        frame.cut = cuts[i];
        draw(warped, &frame, &stats);
        assert_int_equal(stats.redraw, full[i]);
    }
    renderer_option_destroy(warped);
}

// The right half of an eye, drawn through its own asymmetric frustum, is the right half of the whole picture:
// the projection, the culling and the shading agree on where things are.
static void half_a_frustum_draws_half_the_picture(void **state)
{
    struct pair *p = *state;
    const uint32_t w = p->stage.width, h = p->stage.height;
    struct renderer_option *regular = stage_option(&p->stage, p->uploaded, "regular");
    struct frame frame = stage_frame(&p->stage, p->scene, 0, 4, 0, 0);
    struct frame_stats whole, half;
    draw(regular, &frame, &whole);
    uint8_t *all = stage_read(&p->stage, regular, EYE_LEFT);
    // the same pixel size: the field that w pixels cover from the axis to the right is twice as far as the edge
    for (int eye = 0; eye < EYES; eye++) {
        frame.eyes[eye].fov.tan_left = 0;
        frame.eyes[eye].fov.tan_right *= 2;
    }
    draw(regular, &frame, &half);
    uint8_t *right = stage_read(&p->stage, regular, EYE_LEFT);
    uint32_t off = 0;
    for (uint32_t y = 0; y < h; y++)
        for (uint32_t x = 0; x < w / 2; x++)
            for (int c = 0; c < 3; c++)
                off +=
                    abs(all[4 * (y * w + w / 2 + x) + (uint32_t)c] - right[4 * (y * w + x) + (uint32_t)c]) > 2;
    print_message("%u of %u values differ by more than 2\n", off, 3 * h * w / 2);
    assert_true(off < 3 * h * w / 2 / 200);         // edges whose rounding falls on the other side
    assert_true(half.triangles != whole.triangles); // the other frustum culls otherwise
    free(all);
    free(right);
    renderer_option_destroy(regular);
}

static void move_scene(struct scene *scene, struct dvec3 by)
{
    for (uint32_t i = 0; i < scene->node_count; i++) {
        if (scene->nodes[i].parent >= 0)
            continue;
        scene->nodes[i].local.m[12] += by.x;
        scene->nodes[i].local.m[13] += by.y;
        scene->nodes[i].local.m[14] += by.z;
        scene->nodes[i].translation = dvec3_add(scene->nodes[i].translation, by);
    }
    for (uint32_t i = 0; i < scene->light_count; i++)
        scene->lights[i].position = dvec3_add(scene->lights[i].position, by);
    for (uint32_t i = 0; i < scene->path.knot_count; i++) {
        scene->path.knots[i].position = dvec3_add(scene->path.knots[i].position, by);
        scene->path.knots[i].target = dvec3_add(scene->path.knots[i].target, by);
    }
}

static void ten_kilometres_out_looks_the_same(void **state)
{
    struct pair *p = *state;
    char error[512];
    struct scene *far_scene = scene_open("atrium", error, sizeof error);
    move_scene(far_scene, (struct dvec3){10000, 0, -10000.25});
    struct renderer_scene *far_uploaded = renderer_scene_create(p->stage.renderer, far_scene);
    struct renderer_option *near_option = stage_option(&p->stage, p->uploaded, "regular");
    struct renderer_option *far_option = stage_option(&p->stage, far_uploaded, "regular");
    struct frame frame = stage_frame(&p->stage, p->scene, 0, 7, 0, 0);
    draw(near_option, &frame, NULL);
    frame = stage_frame(&p->stage, far_scene, 0, 7, 0, 0);
    draw(far_option, &frame, NULL);
    struct stage_difference d = difference(p, near_option, far_option);
    print_message("10 km out: mean difference %.5f, largest %d of 255\n", d.mean, d.max);
    assert_true(d.mean < 0.02);
    renderer_option_destroy(near_option);
    renderer_option_destroy(far_option);
    renderer_scene_destroy(far_uploaded);
    scene_destroy(far_scene);
}

// Objects that stand still cost what the static scene costs; moving ones lose trust with age and are drawn
// anew, so that they are where `regular` has them.
static void moving_objects_are_followed_and_resting_ones_trusted(void **state)
{
    struct pair *p = *state;
    char error[512];
    struct scene *town = scene_open("town:triangles=60000", error, sizeof error);
    struct renderer_scene *uploaded = renderer_scene_create(p->stage.renderer, town);
    struct renderer_option *regular = stage_option(&p->stage, uploaded, "regular");
    uint64_t most[2] = {0, 0}, least[2] = {UINT64_MAX, UINT64_MAX};
    for (int moving = 0; moving < 2; moving++) {
        struct renderer_option *warped = stage_option(&p->stage, uploaded, "time_warped");
        for (uint64_t n = 0; n < 12; n++) {
            struct frame_stats stats;
            struct frame frame = stage_frame(&p->stage, town, n, 4, 0, 0);
            frame.moving = moving;
            frame.animation_s = moving ? 4 * step_s * (double)n : 0;
            draw(warped, &frame, &stats);
            draw(regular, &frame, NULL);
            if (n > 0) {
                most[moving] = stats.shaded_px > most[moving] ? stats.shaded_px : most[moving];
                least[moving] = stats.shaded_px < least[moving] ? stats.shaded_px : least[moving];
            }
            if (!moving)
                assert_int_equal(difference(p, warped, regular).max, 0);
        }
        struct stage_difference d = difference(p, warped, regular);
        print_message("objects %s: %llu to %llu px shaded, mean difference %.3f\n",
                      moving ? "moving" : "at rest", (unsigned long long)least[moving],
                      (unsigned long long)most[moving], d.mean);
        assert_true(d.mean < 0.5);
        renderer_option_destroy(warped);
    }
    assert_int_equal(least[0], most[0]);
    assert_true(most[1] > most[0]);
    renderer_option_destroy(regular);
    renderer_scene_destroy(uploaded);
    scene_destroy(town);
}

static double wall_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

static double pass_ms(const struct frame_stats *stats, const char *name)
{
    for (uint32_t i = 0; i < stats->timer_count; i++) {
        if (strcmp(stats->timers[i].name, name) == 0)
            return stats->timers[i].ms;
    }
    fail_msg("no pass is named '%s'", name);
    return 0;
}

// With one submission per pass the passes' times add up to what the caller waited for, and a compute pass after
// the G-buffer is not charged for it: of two sizes of the same view, the one with 16 times the pixels shades
// for longer by far more than it draws the same triangles for longer.
static void timers_tell_the_passes_apart(void **state)
{
    (void)state;
    char error[512];
    double shade[2] = {1e9, 1e9}, draw_ms[2] = {1e9, 1e9};
    struct scene *scene = scene_open("town:triangles=60000", error, sizeof error);
    for (int large = 0; large < 2; large++) {
        struct stage stage;
        assert_true(stage_open_timed(&stage, large ? 512 : 128, large ? 512 : 128, true));
        struct renderer_scene *uploaded = renderer_scene_create(stage.renderer, scene);
        struct renderer_option *regular = stage_option(&stage, uploaded, "regular");
        for (uint64_t n = 0; n < 5; n++) {
            struct frame_stats stats;
            struct frame frame = stage_frame(&stage, scene, n, 4, 0, 0);
            double sum = 0, start = wall_ms();
            draw(regular, &frame, &stats);
            double waited = wall_ms() - start;
            for (uint32_t i = 0; i < stats.timer_count; i++)
                sum += stats.timers[i].ms;
            assert_true(fabs(sum - stats.gpu_ms) < 1e-6 * sum);
            assert_true(sum <= waited);
            shade[large] = fmin(shade[large], pass_ms(&stats, "shade")); // the least disturbed of five
            draw_ms[large] = fmin(draw_ms[large], pass_ms(&stats, "g-buffer"));
        }
        renderer_option_destroy(regular);
        renderer_scene_destroy(uploaded);
        stage_close(&stage);
    }
    print_message("shade %.2f and %.2f ms, g-buffer %.2f and %.2f ms\n", shade[0], shade[1], draw_ms[0],
                  draw_ms[1]);
    assert_true(shade[1] / shade[0] > 4);
    assert_true(shade[1] / shade[0] > draw_ms[1] / draw_ms[0]);
    scene_destroy(scene);
}

static void a_bad_frame_is_refused(void **state)
{
    struct pair *p = *state;
    struct renderer_option *regular = stage_option(&p->stage, p->uploaded, "regular");
    struct frame frame = stage_frame(&p->stage, p->scene, 0, 0, 0, 0);
    frame.eyes[1].pose.position.y = NAN;
    assert_false(renderer_draw(regular, &frame, NULL));
    frame = stage_frame(&p->stage, p->scene, 0, 0, 0, 0);
    frame.eyes[0].fov.tan_right = -frame.eyes[0].fov.tan_left;
    assert_false(renderer_draw(regular, &frame, NULL));
    assert_non_null(strstr(p->stage.log, "pose or field of view"));
    p->stage.log[0] = '\0';
    renderer_option_destroy(regular);
}

static void the_screen_fades_to_gray_and_carries_the_overlay(void **state)
{
    struct pair *p = *state;
    const size_t count = (size_t)p->stage.width * p->stage.height;
    struct renderer_option *regular = stage_option(&p->stage, p->uploaded, "regular");
    struct frame frame = stage_frame(&p->stage, p->scene, 0, 0, 0, 0);
    draw(regular, &frame, NULL);
    uint8_t *image = stage_read(&p->stage, regular, EYE_RIGHT), *screen = malloc(4 * count);
    assert_true(renderer_show(p->stage.renderer, regular, 0));
    assert_true(renderer_read_screen(p->stage.renderer, EYE_RIGHT, screen));
    assert_memory_equal(image, screen, 4 * count);
    const uint8_t red[4] = {255, 0, 0, 255};
    assert_true(renderer_set_overlay(p->stage.renderer, &(struct renderer_overlay){red, 1, 1, {3, 5}, {4, 6}}));
    assert_true(renderer_show(p->stage.renderer, regular, 1));
    assert_true(renderer_read_screen(p->stage.renderer, EYE_RIGHT, screen));
    for (size_t i = 0; i < count; i++) {
        bool overlaid = i == 6 * (size_t)p->stage.width + 5;
        assert_int_equal(screen[4 * i], overlaid ? 255 : 128);
        assert_int_equal(screen[4 * i + 1], overlaid ? 0 : 128);
    }
    // half way is half way in linear light (IEC 61966-2-1 decoded and encoded in double precision)
    assert_true(renderer_set_overlay(p->stage.renderer, NULL));
    assert_true(renderer_show(p->stage.renderer, regular, 0.5));
    assert_true(renderer_read_screen(p->stage.renderer, EYE_RIGHT, screen));
    for (size_t i = 0; i < 4 * count; i += 97) {
        if (i % 4 == 3)
            continue;
        double v = image[i] / 255.0, linear = v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
        double mixed = 0.5 * linear + 0.5 * pow((0.5 + 0.055) / 1.055, 2.4);
        double expected = 255 * (1.055 * pow(mixed, 1 / 2.4) - 0.055);
        assert_true(fabs(screen[i] - expected) <= 1);
    }
    free(image);
    free(screen);
    renderer_option_destroy(regular);
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
        cmocka_unit_test(the_redraw_map_is_the_disc_of_low_confidence),
        cmocka_unit_test(error_falls_with_epsilon_and_few_pixels_are_shaded),
        cmocka_unit_test(runs_repeat_byte_for_byte),
        cmocka_unit_test(no_gaze_means_everything_is_drawn),
        cmocka_unit_test(a_cut_and_a_gap_forget_the_past),
        cmocka_unit_test(half_a_frustum_draws_half_the_picture),
        cmocka_unit_test(ten_kilometres_out_looks_the_same),
        cmocka_unit_test(moving_objects_are_followed_and_resting_ones_trusted),
        cmocka_unit_test(timers_tell_the_passes_apart),
        cmocka_unit_test(a_bad_frame_is_refused),
        cmocka_unit_test(the_screen_fades_to_gray_and_carries_the_overlay),
    };
    return cmocka_run_group_tests(tests, open_pair, close_pair);
}
