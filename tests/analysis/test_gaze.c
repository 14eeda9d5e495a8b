// Spread, angles, fixations, saccades and the main sequence against R (tests/reference/gaze.R), and by law.
#include "analysis/gaze/track.h"
#include "analysis/stats/main_sequence.h"
#include "reference.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { MOST = 512, FOUND = 128 };

struct found {
    size_t count;
    struct gaze_event events[FOUND];
};

static void keep(void *user, const struct gaze_event *event, const struct gaze_point *points)
{
    struct found *found = user;
    (void)points;
    assert_true(found->count < FOUND);
    found->events[found->count++] = *event;
}

// --- against R ---

struct row {
    char what[16], name[64];
    double a[MOST], b[MOST], c[MOST], d[MOST], e[MOST * 2];
    size_t a_count, d_count, e_count;
};

static void check_spread(const struct row *r)
{
    struct gaze_spread s = {.n = 0};
    for (size_t i = 0; i < r->a_count; i++)
        gaze_spread_add(&s, r->a[i], r->b[i]);
    const double ours[] = {(double)s.n, gaze_spread_sd_x(&s), gaze_spread_sd_y(&s), gaze_spread_sd(&s),
                           gaze_spread_bcea(&s, GAZE_BCEA_SHARE)};
    // far from 0 R's cor() has lost digits of its own
    double tolerance = strcmp(r->name, "far off") == 0 ? 1e-6 : 1e-12;
    for (size_t i = 0; i < 5; i++)
        if (!reference_close(ours[i], r->c[i], tolerance))
            fail_msg("%s, value %zu: %.17g, R has %.17g", r->name, i, ours[i], r->c[i]);
}

static void check_angle(const struct row *r)
{
    struct gaze_point p = gaze_point(0, r->a[0], r->a[1]), q = gaze_point(0, r->a[2], r->a[3]);
    // 1e-7 degrees are 2e-9 of a unit vector's length, of which a double holds 7 digits
    if (!reference_close(gaze_angle_deg(&p, &q), r->b[0], strcmp(r->name, "tiny") == 0 ? 1e-6 : 1e-12))
        fail_msg("%s: %.17g, R has %.17g", r->name, gaze_angle_deg(&p, &q), r->b[0]);
}

static void check_eye(const struct row *r)
{
    struct gaze_point middle = gaze_point(7, r->a[0], r->a[1]),
                      p = gaze_point_from_eye(&middle, r->a[2], r->a[3]);
    if (fabs(p.x_deg - r->b[0]) > 1e-11 || fabs(p.y_deg - r->b[1]) > 1e-11 || p.time_ns != 7)
        fail_msg("%s: %.17g, %.17g, R has %.17g, %.17g", r->name, p.x_deg, p.y_deg, r->b[0], r->b[1]);
}

static void check_sequence(const struct row *r)
{
    struct stat_main_sequence m = stat_main_sequence(r->a, r->b, r->a_count, 0.95);
    assert_null(m.problem);
    assert_null(m.power_problem);
    const double t = r->c[9];
    const double ours[] = {m.vmax.value,   m.vmax.std_error, m.c.value, m.c.std_error, m.residual_sd,
                           log(m.k.value), m.k.std_error,    m.b.value, m.b.std_error};
    for (size_t i = 0; i < 9; i++) // nls stops at a relative offset of 1e-7
        if (!reference_close(ours[i], r->c[i], i < 5 ? 1e-5 : 1e-10))
            fail_msg("%s, value %zu: %.17g, R has %.17g", r->name, i, ours[i], r->c[i]);
    assert_true(reference_close(m.vmax.high, m.vmax.value + t * m.vmax.std_error, 1e-10));
    assert_true(reference_close(m.k.low, exp(r->c[5] - t * r->c[6]), 1e-9));
}

static void check_events(const struct row *r, enum gaze_method method)
{
    static struct gaze_point points[MOST];
    double velocity[MOST];
    struct found found = {.count = 0};
    struct gaze_rules rules = gaze_rules(method);
    if (method == GAZE_IVT)
        rules = (struct gaze_rules){.method = method,
                                    .velocity_deg_s = r->d[0],
                                    .window_ms = r->d[1],
                                    .min_fixation_ms = r->d[2],
                                    .min_saccade_ms = r->d[3],
                                    .merge_ms = r->d[4],
                                    .merge_deg = r->d[5],
                                    .peak_ms = r->d[6]};
    else
        rules = (struct gaze_rules){.method = method, .dispersion_deg = r->d[0], .min_fixation_ms = r->d[1]};
    for (size_t i = 0; i < r->a_count; i++)
        points[i] = gaze_point((int64_t)llround(r->a[i] * 1e6), r->b[i], r->c[i]);
    gaze_events(&rules, points, r->a_count, velocity, keep, &found);
    if (found.count * 5 != r->e_count)
        fail_msg("%s: %zu events, R has %zu", r->name, found.count, r->e_count / 5);
    for (size_t i = 0; i < found.count; i++) {
        const struct gaze_event *e = &found.events[i];
        const double *theirs = &r->e[5 * i];
        if ((double)e->kind + 1 != theirs[0] || (double)e->first != theirs[1] || (double)e->last != theirs[2])
            fail_msg("%s: event %zu is %d from %zu to %zu, R has %g from %g to %g", r->name, i,
                     (int)e->kind + 1, e->first, e->last, theirs[0], theirs[1], theirs[2]);
        if (e->kind == GAZE_SACCADE) {
            assert_true(reference_close(e->amplitude_deg, theirs[3], 1e-9));
            assert_true(reference_close(e->peak_deg_s, theirs[4], 1e-9));
        }
        assert_int_equal(e->cut, e->first == 0 || e->last + 1 == r->a_count);
    }
}

static void agrees_with_r(void **state)
{
    static char line[65536];
    static struct row r;
    int seen = 0;
    (void)state;
    FILE *file = reference_open("gaze.csv");
    while (fgets(line, sizeof line, file)) {
        char *rest = line, *field;
        line[strcspn(line, "\n")] = '\0';
        snprintf(r.what, sizeof r.what, "%s", reference_field(&rest, ','));
        snprintf(r.name, sizeof r.name, "%s", reference_field(&rest, ','));
        double *into[] = {r.a, r.b, r.c, r.d, r.e};
        size_t counts[5] = {0};
        for (int i = 0; i < 5 && (field = reference_field(&rest, ',')); i++)
            counts[i] = reference_numbers(field, into[i], i == 4 ? MOST * 2 : MOST);
        r.a_count = counts[0];
        r.d_count = counts[3];
        r.e_count = counts[4];
        seen++;
        if (strcmp(r.what, "spread") == 0)
            check_spread(&r);
        else if (strcmp(r.what, "angle") == 0)
            check_angle(&r);
        else if (strcmp(r.what, "eye") == 0)
            check_eye(&r);
        else if (strcmp(r.what, "sequence") == 0)
            check_sequence(&r);
        else
            check_events(&r, strcmp(r.what, "ivt") == 0 ? GAZE_IVT : GAZE_IDT);
    }
    fclose(file);
    assert_int_equal(seen, 107);
}

// --- a track, by law ---

struct world {
    struct gaze_quality quality;
    struct gaze_track track;
    struct found found;
};

static void begin(struct world *w)
{
    struct gaze_rules rules = gaze_rules(GAZE_IVT);
    w->found.count = 0;
    assert_true(gaze_quality_init(&w->quality));
    assert_true(gaze_track_init(&w->track, &rules, 50, keep, &w->found));
    gaze_track_begin(&w->track, &w->quality);
}

static void end(struct world *w)
{
    gaze_track_finish(&w->track);
    gaze_quality_finish(&w->quality);
}

static void feed(struct world *w, double from_ms, int count, double step_ms, double x, double y, bool valid)
{
    for (int i = 0; i < count; i++)
        gaze_track_sample(&w->track, (int64_t)llround((from_ms + i * step_ms) * 1e6), x, y, valid);
}

static void hard_samples(void **state)
{
    struct world w;
    (void)state;
    begin(&w); // no sample
    gaze_track_break(&w.track);
    assert_true(isnan(gaze_quality_rms(&w.quality)) && isnan(gaze_quality_interval(&w.quality)));
    assert_true(isnan(gaze_spread_bcea(&w.quality.within, 0.682)));
    feed(&w, 0, 1, 4, 1, 1, true); // one sample
    gaze_track_break(&w.track);
    assert_int_equal(w.found.count, 0);
    assert_true(isnan(gaze_quality_rms(&w.quality)) && isnan(gaze_quality_interval(&w.quality)));
    feed(&w, 1000, 100, 4, 1, 1, true); // constant
    gaze_track_break(&w.track);
    assert_int_equal(w.found.count, 1);
    assert_true(gaze_quality_rms(&w.quality) == 0 && gaze_spread_sd(&w.quality.within) == 0 &&
                gaze_spread_bcea(&w.quality.within, 0.682) == 0);
    assert_true(fabs(gaze_quality_interval(&w.quality) - 4) < 1e-9);
    feed(&w, 3000, 50, 4, (double)NAN, 0, true); // not finite is not valid
    feed(&w, 3200, 50, 4, 0, (double)INFINITY, true);
    assert_int_equal(w.quality.invalid, 100);
    assert_int_equal(w.quality.samples, 201);
    end(&w);
}

static void bad_clocks(void **state)
{
    struct world w;
    (void)state;
    begin(&w);
    feed(&w, 0, 50, 4, 0, 0, true);
    feed(&w, 196, 10, 0, 20, 0, true); // the last time again and again, elsewhere
    feed(&w, 200, 50, 4, 0, 0, true);
    gaze_track_break(&w.track);
    assert_int_equal(w.quality.disordered, 10);
    assert_int_equal(w.found.count, 1); // no saccade came of it
    assert_int_equal(w.found.events[0].end_ns, 396000000);
    // a clock that starts anew breaks the stretch, and all that follows is read
    feed(&w, 100000, 50, 4, 0, 0, true);
    feed(&w, 0, 50, 4, 0, 0, true);
    gaze_track_break(&w.track);
    assert_int_equal(w.found.count, 3);
    assert_int_equal(w.quality.disordered, 10);
    // times at the ends of what a clock can hold
    gaze_track_sample(&w.track, INT64_MIN, 0, 0, true);
    gaze_track_sample(&w.track, INT64_MAX, 0, 0, true);
    gaze_track_sample(&w.track, INT64_MIN, 0, 0, true);
    gaze_track_break(&w.track);
    assert_int_equal(w.found.count, 3);
    end(&w);
}

static void gaps_break(void **state)
{
    struct world w;
    (void)state;
    begin(&w);
    feed(&w, 0, 50, 4, 0, 0, true);
    feed(&w, 200, 40, 4, 0, 0, false);  // a blink
    feed(&w, 360, 50, 4, 15, 0, true);  // the eyes went elsewhere meanwhile: no saccade was seen
    feed(&w, 700, 50, 4, -15, 0, true); // 144 ms without a sample
    gaze_track_break(&w.track);
    assert_int_equal(w.found.count, 3);
    for (size_t i = 0; i < 3; i++)
        assert_true(w.found.events[i].kind == GAZE_FIXATION && w.found.events[i].cut);
    assert_int_equal(w.quality.fixations_cut, 3);
    assert_int_equal(w.quality.fixation_ms.n, 0);
    assert_int_equal(w.quality.invalid, 40);
    // 144 ms at 4 ms: 35 samples did not come; counted from bins, exactly
    assert_true(fabs(gaze_bins_missing(&w.quality.interval, 4) - 35) < 1e-9);
    end(&w);
}

// A saccade between two fixations of known place and time, and what a gap within it does.
static void a_saccade(void **state)
{
    struct world w;
    (void)state;
    begin(&w);
    feed(&w, 0, 100, 4, 0, 0, true);
    for (int i = 0; i < 10; i++)
        feed(&w, 400 + 4 * i, 1, 4, 1 + i, 0, true); // 250 deg/s
    feed(&w, 440, 100, 4, 10, 0, true);
    gaze_track_break(&w.track);
    assert_int_equal(w.quality.saccade_ms.n, 1);
    assert_true(fabs(w.quality.peak_deg_s.mean - 250) < 1e-6);
    assert_true(w.quality.amplitude_deg.mean > 9.9 && w.quality.amplitude_deg.mean < 10.0001);
    end(&w);
    begin(&w);
    feed(&w, 0, 100, 4, 0, 0, true);
    for (int i = 0; i < 5; i++)
        feed(&w, 400 + 4 * i, 1, 4, 1 + i, 0, true);
    feed(&w, 420, 20, 4, 0, 0, false);
    feed(&w, 500, 100, 4, 10, 0, true);
    gaze_track_break(&w.track);
    assert_int_equal(w.quality.saccade_ms.n, 0);
    assert_int_equal(w.quality.saccades_cut, 1);
    end(&w);
}

// Joining in parts is adding all; a stretch longer than the buffer is broken, not lost.
static void parts_join(void **state)
{
    struct gaze_spread all = {.n = 0}, a = {.n = 0}, b = {.n = 0};
    struct gaze_running sum = {.n = 0}, c = {.n = 0}, d = {.n = 0};
    struct world w;
    (void)state;
    for (int i = 0; i < 1000; i++) {
        double x = sin(i) * 5 + 1e5, y = cos(i * 0.7) * 3;
        gaze_spread_add(&all, x, y);
        gaze_spread_add(i % 3 ? &a : &b, x, y);
        gaze_running_add(&sum, x);
        gaze_running_add(i % 3 ? &c : &d, x);
    }
    gaze_spread_join(&a, &b);
    gaze_running_join(&c, &d);
    assert_true(reference_close(gaze_spread_bcea(&a, 0.5), gaze_spread_bcea(&all, 0.5), 1e-9));
    assert_true(reference_close(gaze_running_sd(&c), gaze_running_sd(&sum), 1e-9));
    begin(&w);
    feed(&w, 0, GAZE_TRACK_SAMPLES + 1000, 1, 0, 0, true);
    gaze_track_break(&w.track);
    assert_int_equal(w.found.count, 2);
    assert_int_equal(w.quality.within.n, GAZE_TRACK_SAMPLES + 1000);
    end(&w);
}

// Quantiles of bins lie within a width of the sorted values'.
static void bins_hold(void **state)
{
    struct gaze_bins bins;
    (void)state;
    assert_true(gaze_bins_init(&bins, 0.1, 100));
    assert_true(isnan(gaze_bins_quantile(&bins, 0.5)));
    for (int i = 0; i < 1000; i++)
        gaze_bins_add(&bins, i * 0.009);
    gaze_bins_add(&bins, (double)NAN);
    assert_int_equal(bins.n, 1000);
    for (double p = 0; p <= 1; p += 0.05)
        assert_true(fabs(gaze_bins_quantile(&bins, p) - p * 8.991) <= 0.11);
    for (int i = 0; i < 2000; i++)
        gaze_bins_add(&bins, 1e9);
    assert_true(isinf(gaze_bins_quantile(&bins, 0.5)));
    gaze_bins_finish(&bins);
}

static void sequences_refuse(void **state)
{
    double a[40], v[40];
    (void)state;
    for (int i = 0; i < 40; i++) {
        a[i] = 1 + 0.01 * i;
        v[i] = 50 * a[i]; // a straight line never levels off
    }
    struct stat_main_sequence m = stat_main_sequence(a, v, 40, 0.95);
    assert_non_null(m.problem);
    assert_true(isnan(m.vmax.value) && isnan(m.c.value));
    assert_null(m.power_problem);
    assert_true(fabs(m.b.value - 1) < 1e-9 && fabs(m.k.value - 50) < 1e-6);
    m = stat_main_sequence(a, v, 9, 0.95);
    assert_true(m.problem && m.power_problem && isnan(m.b.value));
    for (int i = 0; i < 40; i++)
        a[i] = 5;
    m = stat_main_sequence(a, v, 40, 0.95);
    assert_true(m.problem && m.power_problem);
    v[3] = NAN;
    assert_int_equal(stat_main_sequence(a, v, 40, 0.95).n, 39);
    assert_non_null(stat_main_sequence(a, v, 40, 1).problem);
    assert_non_null(stat_main_sequence(NULL, NULL, 0, 0.95).problem);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_r), cmocka_unit_test(hard_samples),     cmocka_unit_test(bad_clocks),
        cmocka_unit_test(gaps_break),    cmocka_unit_test(a_saccade),        cmocka_unit_test(parts_join),
        cmocka_unit_test(bins_hold),     cmocka_unit_test(sequences_refuse),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
