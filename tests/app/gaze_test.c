// Laws of the simulated eye and of what the fovea follows.
#include "app/gaze/eye_movement.h"
#include "app/gaze/fovea.h"
#include "app/gaze/gaze_source.h"
#include "app/gaze/script.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define assert_near(value, expected, most) assert_true(fabs((value) - (expected)) <= (most))

// TECHNIQUES D.3's own numbers: 10 deg take 43 ms and 20 deg 65 ms; peaks 339, 487 and 579 deg/s at 5, 10 and
// 20 deg.
static void saccades_keep_the_main_sequence(void **state)
{
    (void)state;
    assert_near(saccade_duration_s(10.0), 0.043, 1e-9);
    assert_near(saccade_duration_s(20.0), 0.065, 1e-9);
    assert_near(saccade_peak_deg_s(5.0), 339.0, 0.5);
    assert_near(saccade_peak_deg_s(10.0), 487.0, 0.5);
    assert_near(saccade_peak_deg_s(20.0), 579.0, 0.5);
}

// The path of a saccade itself has that duration and that peak velocity, measured by differences.
static void a_saccade_flies_as_the_main_sequence_says(void **state)
{
    (void)state;
    for (double amplitude = 1.0; amplitude <= 40.0; amplitude += 1.5) {
        double duration = saccade_duration_s(amplitude), step = duration / 20000.0, fastest = 0.0, last = 0.0;
        for (double t = step; t <= duration; t += step) {
            double now = saccade_progress(amplitude, t);
            assert_true(now >= last - 1e-12);
            fastest = fmax(fastest, (now - last) * amplitude / step);
            last = now;
        }
        assert_near(last, 1.0, 1e-3);
        assert_near(fastest / saccade_peak_deg_s(amplitude), 1.0, 2e-3);
        assert_near(saccade_progress(amplitude, 0.0), 0.0, 0.0);
        assert_near(saccade_progress(amplitude, duration), 1.0, 0.0);
    }
}

static void the_script_stays_in_bounds_and_repeats(void **state)
{
    (void)state;
    double left = 0.0, right = 0.0;
    for (int i = 0; i < 20000; i++) {
        double x = 0.0, y = 0.0, again_x = 0.0, again_y = 0.0;
        gaze_script(7, i * 0.01, &x, &y);
        gaze_script(7, i * 0.01, &again_x, &again_y);
        assert_true(fabs(x) <= 20.0 && fabs(y) <= 15.0);
        assert_true(x == again_x && y == again_y);
        left = fmin(left, x);
        right = fmax(right, x);
    }
    assert_true(left < -8.0 && right > 8.0); // it looks around
}

static void other_seeds_look_elsewhere(void **state)
{
    (void)state;
    int same = 0;
    for (int i = 0; i < 100; i++) {
        double x = 0.0, y = 0.0, other_x = 0.0, other_y = 0.0;
        gaze_script(1, i, &x, &y);
        gaze_script(2, i, &other_x, &other_y);
        same += fabs(x - other_x) < 0.1;
    }
    assert_true(same < 10);
}

// About three fixations a second, none shorter than a saccade lasts.
static void fixations_have_a_human_pace(void **state)
{
    (void)state;
    int saccades = 0;
    double last_onset = 0.0, shortest = 1e9;
    for (int i = 0; i < 100000; i++) {
        struct eye_movement_step step = eye_movement_step(3, i * 0.001);
        if (step.onset_s > last_onset) {
            double amplitude = hypot(step.x_deg - step.from_x_deg, step.y_deg - step.from_y_deg);
            if (saccades > 0)
                shortest = fmin(shortest, step.onset_s - last_onset - saccade_duration_s(amplitude));
            last_onset = step.onset_s;
            saccades++;
        }
    }
    assert_in_range(saccades, 280, 325);
    assert_true(shortest > 0.0);
}

static size_t collect(const char *kind, struct gaze_desc *desc, int64_t step_ns, int steps,
                      struct gaze_sample *out, size_t capacity)
{
    char error[256];
    size_t count = 0;
    struct gaze_source *source = gaze_open(kind, desc, error, sizeof error);
    assert_non_null(source);
    for (int i = 0; i < steps; i++)
        count += gaze_poll(source, i * step_ns, out + count, capacity - count);
    gaze_close(source);
    return count;
}

enum { SAMPLES = 20000 };
static struct gaze_sample first[SAMPLES], second[SAMPLES];

static void the_tracker_samples_both_eyes_at_its_rate(void **state)
{
    (void)state;
    struct gaze_desc desc = {.seed = 5, .ipd_m = 0.063};
    size_t count = collect("sim", &desc, 11111111, 90 * 60 + 1, first, SAMPLES);
    assert_in_range(count, 2 * 120 * 60, 2 * 120 * 60 + 2);
    size_t wrong = 0;
    for (size_t i = 0; i + 1 < count; i += 2) {
        wrong += first[i].eye != GAZE_LEFT || first[i + 1].eye != GAZE_RIGHT;
        wrong += first[i].host_ns != first[i + 1].host_ns;
        wrong += i > 0 && llabs(first[i].host_ns - first[i - 2].host_ns - 8333333) > 1;
        // Both eyes meet two metres away: the left one is turned right, each by atan(0.0315 / 2) = 0.902
        // degrees.
        if (first[i].valid)
            wrong += fabs(first[i].x_deg - first[i + 1].x_deg - 1.805) > 0.45;
    }
    assert_int_equal(wrong, 0);
}

// How often it is asked does not matter, nor does anything but seed and time.
static void samples_do_not_depend_on_polling(void **state)
{
    (void)state;
    struct gaze_desc desc = {.seed = 5};
    size_t count = collect("sim", &desc, 11111111, 900, first, SAMPLES);
    size_t again = collect("sim", &desc, 33333333, 300, second, SAMPLES);
    size_t common = count < again ? count : again;
    assert_true(common > 2000);
    for (size_t i = 0; i < common; i++) {
        assert_int_equal(first[i].host_ns, second[i].host_ns);
        assert_true(first[i].valid == second[i].valid);
        if (first[i].valid)
            assert_true(first[i].x_deg == second[i].x_deg && first[i].y_deg == second[i].y_deg);
    }
}

static void blinks_last_100_to_300_ms_and_are_invalid(void **state)
{
    (void)state;
    struct gaze_desc desc = {.seed = 11, .rate_hz = 120.0};
    size_t count = collect("sim", &desc, 11111111, 90 * 60, first, SAMPLES);
    int blinks = 0;
    int64_t began = -1;
    for (size_t i = 0; i < count; i += 2) {
        if (!first[i].valid) {
            assert_true(isnan(first[i].x_deg) && isnan(first[i].y_deg) && !first[i + 1].valid);
            began = began < 0 ? first[i].host_ns : began;
        } else if (began >= 0) {
            int64_t lasted = first[i].host_ns - began;
            assert_in_range(lasted, 100000000 - 8400000, 300000000 + 8400000);
            blinks++;
            began = -1;
        }
    }
    assert_in_range(blinks, 12, 22);
}

static void the_fovea_holds_through_a_blink_then_is_lost(void **state)
{
    (void)state;
    struct fovea fovea = {0};
    struct fovea_use use;
    fovea_at(&fovea, 0, &use);
    assert_true(use.lost && !use.known && isnan(use.x_deg[EYE_LEFT]));
    struct gaze_sample left = {.host_ns = 1000, .eye = GAZE_LEFT, .x_deg = 3.0, .y_deg = -2.0, .valid = true};
    struct gaze_sample blink = {.host_ns = 2000, .eye = GAZE_BOTH, .x_deg = NAN, .y_deg = NAN};
    fovea_sample(&fovea, &left, 42);
    fovea_sample(&fovea, &blink, 43);
    fovea_at(&fovea, 500001000, &use);
    assert_false(use.lost);
    assert_int_equal(use.sample_id, 42);
    assert_int_equal(use.age_ns, 500000000);
    assert_true(use.x_deg[EYE_LEFT] == 3.0 && use.x_deg[EYE_RIGHT] == 3.0); // the unseen eye follows the other
    fovea_at(&fovea, 500001001, &use);
    assert_true(use.lost && use.x_deg[EYE_LEFT] == 3.0);
    struct gaze_sample right = {
        .host_ns = 600000000, .eye = GAZE_RIGHT, .x_deg = 1.0, .y_deg = 5.0, .valid = true};
    fovea_sample(&fovea, &right, 44);
    fovea_at(&fovea, 600000000, &use);
    assert_true(use.x_deg[EYE_LEFT] == 3.0 && use.x_deg[EYE_RIGHT] == 1.0 && use.y_deg[EYE_RIGHT] == 5.0);
    assert_int_equal(use.sample_id, 44);
}

struct cursor {
    bool over;
    double x, y;
};

static bool read_cursor(void *user, double *out_x, double *out_y)
{
    const struct cursor *cursor = user;
    *out_x = cursor->x;
    *out_y = cursor->y;
    return cursor->over;
}

// Frames 10 ms apart; the gaze is away for 400 ms, then for 600 ms. The first time there is none yet.
static void a_gaze_that_was_lost_comes_back_once(void **state)
{
    (void)state;
    struct fovea fovea = {0};
    bool was_lost = false;
    int returns = 0;
    int64_t last_ns = -1;
    for (int64_t now_ns = 0; now_ns < 3000000000; now_ns += 10000000) {
        const bool away = now_ns < 50000000 || (now_ns > 1000000000 && now_ns < 1400000000) ||
                          (now_ns > 2000000000 && now_ns < 2600000000);
        struct gaze_sample sample = {
            .host_ns = now_ns, .eye = GAZE_BOTH, .x_deg = 1, .y_deg = 1, .valid = !away};
        struct fovea_use use;
        fovea_sample(&fovea, &sample, 1);
        fovea_at(&fovea, now_ns, &use);
        if (fovea_returned(&was_lost, &use)) {
            returns++;
            last_ns = now_ns;
        }
    }
    assert_int_equal(returns, 2);
    assert_int_equal(last_ns, 2600000000);
}

static void the_mouse_points_through_the_projection(void **state)
{
    (void)state;
    char error[256];
    struct cursor cursor = {true, 320.0, 0.0};
    struct gaze_desc desc = {.cursor = read_cursor, .cursor_user = &cursor, .width = 640, .height = 720};
    desc.fov = viewing_symmetric_fov(100.0, 640, 720);
    struct gaze_sample sample;
    struct gaze_source *mouse = gaze_open("mouse", &desc, error, sizeof error);
    assert_non_null(mouse);
    assert_int_equal(gaze_poll(mouse, 0, &sample, 1), 1);
    assert_true(sample.valid && sample.eye == GAZE_BOTH);
    assert_near(sample.x_deg, 0.0, 1e-9);
    assert_near(sample.y_deg, 50.0, 1e-9);
    assert_int_equal(gaze_poll(mouse, 0, &sample, 1), 0); // once per instant
    cursor.over = false;
    assert_int_equal(gaze_poll(mouse, 5, &sample, 1), 1);
    assert_true(!sample.valid && isnan(sample.x_deg));
    gaze_close(mouse);
}

static void wrong_sources_get_a_sentence(void **state)
{
    (void)state;
    static const char *const specs[] = {"hid", "replay:x.csv", "sim:fast", "mouse", ""};
    for (size_t i = 0; i < sizeof specs / sizeof specs[0]; i++) {
        char error[256] = "";
        assert_null(gaze_open(specs[i], &(struct gaze_desc){0}, error, sizeof error));
        assert_true(strlen(error) > 20);
    }
}

// Both eyes' directions meet in the point.
static void a_fovea_on_a_point_converges(void **state)
{
    (void)state;
    const struct pose head = {.orientation = {0, 0, 0, 1}};
    const struct dvec3 points[] = {{0, 0, -0.5}, {0.3, -0.2, -1}, {-4, 6, -30}};
    for (size_t i = 0; i < sizeof points / sizeof *points; i++) {
        struct fovea_use use;
        fovea_on(points[i], 0.063, &use);
        assert_false(use.lost);
        assert_true(use.x_deg[EYE_LEFT] > use.x_deg[EYE_RIGHT]); // inwards
        for (int eye = 0; eye < EYES; eye++) {
            const struct dvec3 from = viewing_eye_pose(&head, eye, 0.063).position;
            const struct dvec3 way = dvec3_sub(points[i], from);
            assert_true(geometry_angle_deg(viewing_direction(use.x_deg[eye], use.y_deg[eye]), way) < 1e-9);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(saccades_keep_the_main_sequence),
        cmocka_unit_test(a_saccade_flies_as_the_main_sequence_says),
        cmocka_unit_test(the_script_stays_in_bounds_and_repeats),
        cmocka_unit_test(other_seeds_look_elsewhere),
        cmocka_unit_test(fixations_have_a_human_pace),
        cmocka_unit_test(the_tracker_samples_both_eyes_at_its_rate),
        cmocka_unit_test(samples_do_not_depend_on_polling),
        cmocka_unit_test(blinks_last_100_to_300_ms_and_are_invalid),
        cmocka_unit_test(the_fovea_holds_through_a_blink_then_is_lost),
        cmocka_unit_test(a_gaze_that_was_lost_comes_back_once),
        cmocka_unit_test(the_mouse_points_through_the_projection),
        cmocka_unit_test(wrong_sources_get_a_sentence),
        cmocka_unit_test(a_fovea_on_a_point_converges),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
