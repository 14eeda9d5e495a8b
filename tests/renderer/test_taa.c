// Temporal antialiasing and motion smoothing of time_warped, at a still, a shaking and a flying camera.
#include "tests/renderer/stage.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { SIZE = 64, COUNT = SIZE * SIZE };
static const double step_s = 1.0 / 90;
static const struct renderer_settings taa = {.taa = true}, plain = {0};

struct place {
    struct stage stage;
    struct scene *scene;
    struct renderer_scene *uploaded;
    uint8_t part[COUNT]; // PART of each pixel, gaze straight ahead
};

// By eccentricity: 8 degrees is 2 pixels and more inside the fovea of 10, 35 as much outside full trust at 30.
enum part { BETWEEN, FOVEA, PERIPHERY };

static int open_place(void **state)
{
    char error[512];
    struct place *p = calloc(1, sizeof *p);
    if (!p || !stage_open(&p->stage, SIZE, SIZE))
        return -1;
    p->scene = scene_open("town:triangles=20000", error, sizeof error);
    if (!p->scene)
        fail_msg("%s", error);
    p->uploaded = renderer_scene_create(p->stage.renderer, p->scene);
    const struct viewing_fov fov = viewing_symmetric_fov(VIEWING_DEFAULT_FOV_DEG, SIZE, SIZE);
    for (uint32_t i = 0; i < COUNT; i++) {
        const struct dvec3 d = viewing_pixel_direction(&fov, SIZE, SIZE, i % SIZE + 0.5, i / SIZE + 0.5);
        const double ecc = geometry_angle_deg(d, (struct dvec3){0, 0, -1});
        const uint32_t x = i % SIZE, y = i / SIZE;
        const bool rim = x < 4 || y < 4 || x >= SIZE - 4 || y >= SIZE - 4; // comes and goes with a shaking head
        p->part[i] = ecc < 8 ? FOVEA : ecc > 35 && !rim ? PERIPHERY : BETWEEN;
    }
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

// The left eye's picture; freed by the caller.
static uint8_t *draw(struct place *p, struct renderer_option *option, const struct frame *frame)
{
    assert_true(renderer_draw(option, frame, NULL));
    return stage_read(&p->stage, option, EYE_LEFT);
}

static double mean_error(const struct place *p, enum part part, const uint8_t *a, const uint8_t *b,
                         int *out_max)
{
    double sum = 0, count = 0;
    int max = 0;
    for (uint32_t i = 0; i < 4 * COUNT; i++) {
        if (p->part[i / 4] != part || i % 4 == 3)
            continue;
        const int d = abs(a[i] - b[i]);
        max = d > max ? d : max;
        sum += d;
        count++;
    }
    if (out_max)
        *out_max = max;
    return sum / count;
}

// Mean squared step to the right and down, of green.
static double sharpness(const struct place *p, const uint8_t *rgba)
{
    double sum = 0, count = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        if (p->part[i] != PERIPHERY)
            continue;
        const double right = rgba[4 * i + 5] - rgba[4 * i + 1],
                     down = rgba[4 * (i + SIZE) + 1] - rgba[4 * i + 1];
        sum += right * right + down * down;
        count++;
    }
    return sum / count;
}

// A head that trembles by `shake_px` pixels at the image's centre: two angles from a counter-based generator.
static struct frame trembling(const struct place *p, uint64_t n, double shake_px)
{
    struct frame frame = stage_frame(&p->stage, p->scene, n, 3, 0, 0);
    const double rad_per_px = 2 * tan(50 * 0.017453292519943295) / SIZE;
    double angle[2];
    for (uint64_t k = 0; k < 2; k++) {
        uint64_t z = (2 * n + k + 1) * 0x9e3779b97f4a7c15;
        z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
        z = (z ^ z >> 27) * 0x94d049bb133111eb;
        angle[k] = shake_px * rad_per_px * ((double)((z ^ z >> 31) >> 11) * 0x1p-52 - 1);
    }
    struct pose head = camera_path_pose(&p->scene->path, 3);
    const struct dvec3 ahead = {tan(angle[0]), tan(angle[1]), -1};
    head.orientation = dquat_look(dquat_rotate(head.orientation, ahead), (struct dvec3){0, 1, 0});
    for (int eye = 0; eye < EYES; eye++)
        frame.eyes[eye].pose = viewing_eye_pose(&head, eye, VIEWING_DEFAULT_IPD_M);
    return frame;
}

// `regular` repeats with its jitter, eight frames, once it has converged, so that eight of its pictures serve.
static void a_still_eye_converges_and_errs_no_more_in_the_end(void **state)
{
    struct place *p = *state;
    struct renderer_option *warped = stage_option_set(&p->stage, p->uploaded, "time_warped", &taa);
    struct renderer_option *regular = stage_option_set(&p->stage, p->uploaded, "regular", &taa);
    uint8_t *converged[8];
    for (uint64_t n = 0; n < 80; n++) {
        const struct frame frame = stage_frame(&p->stage, p->scene, n, 3, 0, 0);
        uint8_t *picture = draw(p, regular, &frame);
        if (n >= 72)
            converged[n % 8] = picture;
        else
            free(picture);
    }
    double start = 0, early = 0, late = 0;
    int fovea_max = 0;
    for (uint64_t n = 0; n < 1000; n++) {
        const struct frame frame = stage_frame(&p->stage, p->scene, n, 3, 0, 0);
        uint8_t *w = draw(p, warped, &frame);
        int max;
        const double fovea = mean_error(p, FOVEA, w, converged[n % 8], &max);
        fovea_max = n >= 50 && max > fovea_max ? max : fovea_max;
        start = n == 0 ? fovea : start;
        const double error = mean_error(p, PERIPHERY, w, converged[n % 8], NULL);
        early += n >= 50 && n < 100 ? error / 50 : 0;
        late += n >= 900 ? error / 100 : 0;
        free(w);
    }
    print_message("still: fovea off by %.2f in the first frame, by at most %d after 50; periphery by %.4f in "
                  "frames 50 to 99, %.4f in 900 to 999\n",
                  start, fovea_max, early, late);
    assert_true(start > 1 && fovea_max <= 2); // 2: the reference itself has 0.9^72 of its start left
    assert_true(late <= early * 1.01);
    for (int i = 0; i < 8; i++)
        free(converged[i]);
    renderer_option_destroy(warped);
    renderer_option_destroy(regular);
}

static void smoothing_changes_nothing_that_is_kept(void **state)
{
    struct place *p = *state;
    struct renderer_option *with = stage_option_set(&p->stage, p->uploaded, "time_warped", &taa);
    struct renderer_option *without = stage_option_set(&p->stage, p->uploaded, "time_warped", &plain);
    uint8_t *map[2] = {malloc(COUNT), malloc(COUNT)}, *fifth = NULL;
    for (uint64_t n = 0; n < 200; n++) {
        struct frame_stats a, b;
        const struct frame frame = stage_frame(&p->stage, p->scene, n, 3, 0, 0);
        assert_true(renderer_draw(with, &frame, &a));
        assert_true(renderer_draw(without, &frame, &b));
        assert_int_equal(a.shaded_px, b.shaded_px);
        if (n % 20 == 5) {
            assert_true(renderer_read_redraw_map(with, EYE_LEFT, map[0]));
            assert_true(renderer_read_redraw_map(without, EYE_LEFT, map[1]));
            assert_memory_equal(map[0], map[1], COUNT);
        }
        if (n == 5)
            fifth = stage_read(&p->stage, with, EYE_LEFT);
    }
    uint8_t *last = stage_read(&p->stage, with, EYE_LEFT);
    int max;
    const double changed = mean_error(p, PERIPHERY, fifth, last, &max);
    print_message("still: the periphery changes by %.4f, at most %d, from frame 5 to 199\n", changed, max);
    assert_true(max <= 1);
    free(map[0]);
    free(map[1]);
    free(fifth);
    free(last);
    renderer_option_destroy(with);
    renderer_option_destroy(without);
}

struct tremble {
    double variation; // mean squared change of a peripheral value from frame to frame
    double sharp_early, sharp_late;
};

static struct tremble tremble(struct place *p, const char *mode, const struct renderer_settings *settings)
{
    struct tremble t = {0};
    struct renderer_option *warped = stage_option_set(&p->stage, p->uploaded, mode, settings);
    uint8_t *before = NULL;
    for (uint64_t n = 0; n < 220; n++) {
        const struct frame frame = trembling(p, n, 0.3);
        uint8_t *now = draw(p, warped, &frame);
        t.sharp_early += n >= 5 && n < 25 ? sharpness(p, now) / 20 : 0;
        t.sharp_late += n >= 200 ? sharpness(p, now) / 20 : 0;
        if (n >= 40) {
            double sum = 0, count = 0;
            for (uint32_t i = 0; i < COUNT; i++) {
                if (p->part[i] != PERIPHERY)
                    continue;
                const double d = now[4 * i + 1] - before[4 * i + 1];
                sum += d * d;
                count++;
            }
            t.variation += sum / count / 180;
        }
        free(before);
        before = now;
    }
    free(before);
    renderer_option_destroy(warped);
    return t;
}

static void a_trembling_head_sees_less_swirling_and_no_blur(void **state)
{
    const struct tremble on = tremble(*state, "time_warped", &taa),
                         off = tremble(*state, "time_warped", &plain);
    const struct tremble reference = tremble(*state, "regular", &taa);
    print_message(
        "trembling: squared change a frame %.3f with smoothing, %.3f without, %.3f of regular; sharpness "
        "%.2f, then %.2f; without %.2f, then %.2f; regular %.2f, then %.2f\n",
        on.variation, off.variation, reference.variation, on.sharp_early, on.sharp_late, off.sharp_early,
        off.sharp_late, reference.sharp_early, reference.sharp_late);
    assert_true(on.variation < 0.5 * off.variation);
    // Points that share a pixel are lost, so a trembling history loses detail without any filter; the filter's
    // output, were it reprojected, would blur on top of that.
    assert_true(on.sharp_late / on.sharp_early > 0.85 * off.sharp_late / off.sharp_early);
    assert_true(on.sharp_late > 0.65 * reference.sharp_late);
}

static void error_falls_with_epsilon_under_every_setting(void **state)
{
    struct place *p = *state;
    const char *names[] = {"time_warped:epsilon=0.05", "time_warped:epsilon=0.1", "time_warped:epsilon=0.2"};
    for (int bits = 1; bits < 4; bits++) {
        const struct renderer_settings settings = {.ssao = bits & 1, .taa = bits & 2};
        struct renderer_option *regular = stage_option_set(&p->stage, p->uploaded, "regular", &settings);
        struct renderer_option *warped[3];
        double mean[3] = {0};
        for (int i = 0; i < 3; i++)
            warped[i] = stage_option_set(&p->stage, p->uploaded, names[i], &settings);
        for (uint64_t n = 0; n < 45; n++) {
            const struct frame frame = stage_frame(&p->stage, p->scene, n, 3 * step_s * (double)n, 0, 0);
            assert_true(renderer_draw(regular, &frame, NULL)); // every frame: TAA has a history
            for (int i = 0; i < 3; i++) {
                assert_true(renderer_draw(warped[i], &frame, NULL));
                mean[i] += n % 5 == 4 ? stage_differ(&p->stage, warped[i], regular).mean / 9 : 0;
            }
        }
        print_message("ssao %d, taa %d: mean error at epsilon 0.05, 0.1, 0.2: %.4f %.4f %.4f of 255\n",
                      settings.ssao, settings.taa, mean[0], mean[1], mean[2]);
        assert_true(mean[0] >= mean[1] && mean[1] >= mean[2] && mean[2] > 0);
        for (int i = 0; i < 3; i++)
            renderer_option_destroy(warped[i]);
        renderer_option_destroy(regular);
    }
}

int main(void)
{
    struct stage probe;
    if (!stage_open(&probe, 16, 16))
        return 77;
    stage_close(&probe);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_still_eye_converges_and_errs_no_more_in_the_end),
        cmocka_unit_test(smoothing_changes_nothing_that_is_kept),
        cmocka_unit_test(a_trembling_head_sees_less_swirling_and_no_blur),
        cmocka_unit_test(error_falls_with_epsilon_under_every_setting),
    };
    return cmocka_run_group_tests(tests, open_place, close_place);
}
