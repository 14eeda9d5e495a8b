// The rate and the missing samples of simulated trackers, whose interval and losses are known as they are made;
// and up to which rate a main sequence is told, against R's simulation (tests/reference/saccade_rate.R).
#include "analysis/gaze/track.h"
#include "reference.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

struct tracker {
    double hz, loss, jitter; // share of samples lost; SD of a sample's time, in intervals
    int samples;             // due
    int step;                // 2: every second sample is of the other eye
};

struct measured {
    double rate_hz, missing; // NaN: not measurable
    int lost;                // as made, between the first and the last sample that came
};

static double uniform(uint64_t *state)
{
    *state = *state * 6364136223846793005U + 1442695040888963407U;
    return (double)((*state >> 11) + 1) / 9007199254740993.0;
}

static double normal(uint64_t *state)
{
    double radius = sqrt(-2 * log(uniform(state)));
    return radius * cos(2 * M_PI * uniform(state));
}

static struct measured measure(const struct tracker *t, uint64_t seed)
{
    struct gaze_quality quality;
    struct gaze_track track;
    struct gaze_rules rules = gaze_rules(GAZE_IVT);
    struct measured out = {.lost = 0};
    uint64_t state = seed * 7919 + 1;
    int before = -1;
    assert_true(gaze_quality_init(&quality) && gaze_track_init(&track, &rules, 50, NULL, NULL));
    gaze_track_begin(&track, &quality);
    for (int i = 0; i < t->samples * t->step; i += t->step) {
        double at = (i + t->step * t->jitter * normal(&state)) / (t->hz * t->step);
        if (uniform(&state) < t->loss)
            continue;
        out.lost += before < 0 ? 0 : (i - before) / t->step - 1;
        before = i;
        gaze_track_sample(&track, (int64_t)llround(at * 1e9), 0, 0, true);
    }
    gaze_track_break(&track);
    double interval = gaze_quality_interval(&quality);
    out.rate_hz = 1000 / interval;
    out.missing = isnan(interval) ? (double)NAN : gaze_bins_missing(&quality.interval, interval);
    gaze_track_finish(&track);
    gaze_quality_finish(&quality);
    return out;
}

// 8 s of each tracker, five times: the rate to 1 %, the missing samples to 1 % of those due; without errors of
// time both exactly. Errors of time make a gap look longer or shorter by one sample now and then.
static void rates_are_found(void **state)
{
    static const double rates[] = {60, 90, 120, 250, 1000}, losses[] = {0, 0.3, 0.55, 0.8},
                        jitters[] = {0, 0.1};
    (void)state;
    for (size_t r = 0; r < 5; r++)
        for (size_t l = 0; l < 4; l++)
            for (size_t j = 0; j < 2; j++)
                for (int eyes = 1; eyes <= 2; eyes++)
                    for (uint64_t seed = 1; seed <= 5; seed++) {
                        const struct tracker t = {rates[r], losses[l], jitters[j], (int)(8 * rates[r]), eyes};
                        struct measured m = measure(&t, seed);
                        double rate = fabs(m.rate_hz / t.hz - 1), missing = fabs(m.missing - m.lost);
                        if (!(rate < (t.jitter > 0 ? 0.01 : 1e-6)) ||
                            !(missing <= (t.jitter > 0 ? 0.01 * t.samples : 1e-6)))
                            fail_msg("%g Hz, loss %g, jitter %g, seed %d: %.3f Hz, missing %.1f of %d", t.hz,
                                     t.loss, t.jitter, (int)seed, m.rate_hz, m.missing, m.lost);
                    }
}

// Where nearly everything is lost either nothing is said, or what is right.
static void no_wrong_rate_is_told(void **state)
{
    static const double rates[] = {60, 90, 120, 250, 1000}, losses[] = {0.85, 0.9, 0.95, 0.98};
    int told = 0, silent = 0;
    (void)state;
    for (size_t r = 0; r < 5; r++)
        for (size_t l = 0; l < 4; l++)
            for (int n = 300; n <= 3000; n += 900)
                for (uint64_t seed = 1; seed <= 20; seed++) {
                    const struct tracker t = {rates[r], losses[l], seed % 2 ? 0.1 : 0, n, 1};
                    double hz = measure(&t, seed).rate_hz;
                    told += !isnan(hz);
                    silent += isnan(hz);
                    if (!isnan(hz) && fabs(hz / t.hz - 1) > 0.02)
                        fail_msg("%g Hz, loss %g, %d due, seed %d: %.3f Hz", t.hz, t.loss, n, (int)seed, hz);
                }
    print_message("told %d, not measurable %d\n", told, silent);
    assert_true(silent > 100 && told > 100);
}

// Times without rhythm have no rate; few, or one, have none either.
static void no_rhythm_no_rate(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 20; seed++) {
        struct gaze_quality quality;
        uint64_t random = seed;
        assert_true(gaze_quality_init(&quality));
        for (int i = 0; i < 3000; i++)
            gaze_bins_add(&quality.interval, -4 * log(uniform(&random)));
        assert_true(isnan(gaze_quality_interval(&quality)));
        gaze_quality_finish(&quality);
    }
    const struct tracker few = {250, 0, 0, 6, 1};
    assert_true(isnan(measure(&few, 1).rate_hz));
}

// A tracker whose clock ticks in milliseconds: 8, 8 and 9 ms of 120 Hz.
static void coarse_clocks(void **state)
{
    struct gaze_quality quality;
    (void)state;
    assert_true(gaze_quality_init(&quality));
    for (int i = 1; i < 2000; i++)
        gaze_bins_add(&quality.interval, floor(i * 25 / 3.0) - floor((i - 1) * 25 / 3.0));
    assert_true(fabs(1000 / gaze_quality_interval(&quality) - 120) < 0.1);
    gaze_quality_finish(&quality);
}

// R's simulated saccades: what lies within our limits is as right as events.h says, and beyond them it is not.
static void limits_of_the_main_sequence(void **state)
{
    char line[256];
    double beyond_vmax = 0, beyond_c = 0;
    int rows = 0;
    (void)state;
    FILE *file = reference_open("saccade_rate.csv");
    while (fgets(line, sizeof line, file)) {
        char *rest = line;
        double v[12];
        line[strcspn(line, "\n")] = '\0';
        for (int i = 0; i < 12; i++) {
            const char *field = reference_field(&rest, ',');
            v[i] = i == 2 ? 0 : strtod(field, NULL); // the profile's name
        }
        double span = gaze_velocity_span_ms(1000 / v[4], v[5]), vmax = fabs(v[7] - 1);
        double shape = fmax(fabs(v[8] - 1), fmax(fabs(v[9] - 1), fabs(v[10] - 1)));
        assert_true(reference_close(span, v[6], 1e-5));
        assert_true(span > GAZE_VMAX_SPAN_MS || vmax <= 0.1);
        assert_true(span > GAZE_SHAPE_SPAN_MS || shape <= 0.16);
        beyond_vmax = span > GAZE_VMAX_SPAN_MS ? fmax(beyond_vmax, vmax) : beyond_vmax;
        beyond_c = span > GAZE_SHAPE_SPAN_MS ? fmax(beyond_c, fabs(v[8] - 1)) : beyond_c;
        rows++;
    }
    fclose(file);
    assert_int_equal(rows, 208);
    assert_true(beyond_vmax > 0.4 && beyond_c > 2);
    assert_true(isnan(gaze_velocity_span_ms((double)NAN, 10)) && isnan(gaze_velocity_span_ms(0, 10)));
}

// What the eyes follow is no measure of precision: the noise at rest is, and is known.
static void pursuit_is_no_precision(void **state)
{
    struct gaze_quality quality;
    struct gaze_track track;
    struct gaze_rules rules = gaze_rules(GAZE_IVT);
    uint64_t random = 3;
    (void)state;
    assert_true(gaze_quality_init(&quality) && gaze_track_init(&track, &rules, 50, NULL, NULL));
    gaze_track_begin(&track, &quality);
    for (int moving = 0; moving < 2; moving++) {
        gaze_track_break(&track);
        track.moving = moving;
        for (int i = 0; i < 2000; i++)
            gaze_track_sample(&track, (int64_t)(moving * 100 + i * 0.004 * 1e9),
                              moving * 2 * i * 0.004 + 0.05 * normal(&random), 0.05 * normal(&random), true);
        gaze_track_break(&track);
    }
    assert_int_equal(quality.fixations_cut, 2);
    assert_int_equal(quality.within.n, 2000);
    assert_true(fabs(gaze_spread_sd_x(&quality.within) - 0.05) < 0.004); // four standard errors
    assert_true(fabs(gaze_spread_bcea(&quality.within, GAZE_BCEA_SHARE) - 0.018) < 0.002);
    gaze_track_finish(&track);
    gaze_quality_finish(&quality);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rates_are_found),
        cmocka_unit_test(no_wrong_rate_is_told),
        cmocka_unit_test(no_rhythm_no_rate),
        cmocka_unit_test(coarse_clocks),
        cmocka_unit_test(limits_of_the_main_sequence),
        cmocka_unit_test(pursuit_is_no_precision),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
