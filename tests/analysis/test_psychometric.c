// Psychometric functions and their fits against R (tests/reference/psychometric.R, psychometric_multistart.R),
// and by law.
#include "analysis/stats/psychometric_fit.h"
#include "reference.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { MOST = 256 };

static enum stat_fit_status status_named(const char *name)
{
    static const char *const names[] = {"ok", "step", "no_effect", "one_level", "all_no", "all_yes", "open"};
    static const enum stat_fit_status statuses[] = {STAT_FIT_OK,        STAT_FIT_STEP,   STAT_FIT_NO_EFFECT,
                                                    STAT_FIT_ONE_LEVEL, STAT_FIT_ALL_NO, STAT_FIT_ALL_YES,
                                                    STAT_FIT_OPEN};
    for (size_t i = 0; i < 7; i++)
        if (strcmp(names[i], name) == 0)
            return statuses[i];
    fail_msg("%s is no status", name);
    return STAT_FIT_BAD_INPUT;
}

struct row {
    char name[64], status[16];
    struct stat_fit_desc desc;
    struct stat_answers answers[MOST];
    size_t count;
    char *rest; // of the line
    double threshold, slope, guess, lapse, log_likelihood, deviance, low, high;
};

// The columns that every file of data sets begins with.
static bool next_data(FILE *file, char *line, int size, struct row *row)
{
    double levels[MOST], k[MOST], n[MOST];
    if (!fgets(line, size, file))
        return false;
    line[strcspn(line, "\n")] = '\0';
    char *rest = line;
    snprintf(row->name, sizeof row->name, "%s", reference_field(&rest, ','));
    row->desc = (struct stat_fit_desc){0};
    assert_true(stat_family_find(reference_field(&rest, ','), &row->desc.family));
    row->desc.logarithmic = reference_number(reference_field(&rest, ',')) > 0;
    row->desc.falling = reference_number(reference_field(&rest, ',')) > 0;
    double *bounds[] = {&row->desc.guess_low, &row->desc.guess_high, &row->desc.lapse_low,
                        &row->desc.lapse_high};
    for (size_t i = 0; i < 4; i++)
        *bounds[i] = reference_number(reference_field(&rest, ','));
    row->count = reference_numbers(reference_field(&rest, ','), levels, MOST);
    assert_int_equal(reference_numbers(reference_field(&rest, ','), k, MOST), row->count);
    assert_int_equal(reference_numbers(reference_field(&rest, ','), n, MOST), row->count);
    for (size_t i = 0; i < row->count; i++)
        row->answers[i] = (struct stat_answers){levels[i], (int64_t)k[i], (int64_t)n[i]};
    row->rest = rest;
    return true;
}

static bool next_row(FILE *file, struct row *row)
{
    static char line[16384];
    if (!next_data(file, line, sizeof line, row))
        return false;
    snprintf(row->status, sizeof row->status, "%s", reference_field(&row->rest, ','));
    double *values[] = {&row->threshold,      &row->slope,    &row->guess, &row->lapse,
                        &row->log_likelihood, &row->deviance, &row->low,   &row->high};
    for (size_t i = 0; i < 8; i++)
        *values[i] = reference_number(reference_field(&row->rest, ','));
    return true;
}

// What is off on the threshold's axis, as a share of the range of levels there.
static double off_range(const struct row *row, double a, double b)
{
    bool logarithmic = row->desc.logarithmic || stat_family_logarithmic(row->desc.family);
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < row->count; i++) {
        double u = logarithmic ? log(row->answers[i].level) : row->answers[i].level;
        low = row->answers[i].n ? fmin(low, u) : low;
        high = row->answers[i].n ? fmax(high, u) : high;
    }
    return logarithmic ? fabs(log(a) - log(b)) / (high - low) : fabs(a - b) / (high - low);
}

static void compare(const struct row *row, double worst[4])
{
    struct stat_fit fit = stat_psychometric_fit(row->answers, row->count, &row->desc);
    if (fit.status != status_named(row->status))
        fail_msg("%s (%s): status %d \"%s\", R %s", row->name, stat_family_name(row->desc.family), fit.status,
                 stat_fit_reason(fit.status), row->status);
    if (isnan(row->threshold)) {
        assert_true(isnan(fit.function.threshold));
        return;
    }
    // A maximum below R's is a maximum missed.
    if (!(fit.log_likelihood >= row->log_likelihood - 1e-7))
        fail_msg("%s (%s): log-likelihood %.12g, R %.12g", row->name, stat_family_name(row->desc.family),
                 fit.log_likelihood, row->log_likelihood);
    double off = off_range(row, fit.function.threshold, row->threshold);
    double slope = fabs(log(fit.function.slope / row->slope)),
           lapse = fmax(fabs(fit.function.lapse - row->lapse), fabs(fit.function.guess - row->guess));
    worst[0] = fmax(worst[0], off);
    worst[1] = fmax(worst[1], slope);
    worst[2] = fmax(worst[2], lapse);
    if (!(off <= 1e-4 && slope <= 1e-3 && lapse <= 1e-3))
        fail_msg("%s (%s): threshold %.9g slope %.9g guess %.6g lapse %.6g, R %.9g %.9g %.6g %.6g", row->name,
                 stat_family_name(row->desc.family), fit.function.threshold, fit.function.slope,
                 fit.function.guess, fit.function.lapse, row->threshold, row->slope, row->guess, row->lapse);
    assert_true(fabs(fit.deviance - row->deviance) <= 1e-6 * (1 + row->deviance));
    const double ends[2][2] = {{fit.threshold.low, row->low}, {fit.threshold.high, row->high}};
    for (int i = 0; i < 2; i++) {
        if (isnan(ends[i][1])) {
            assert_true(!isfinite(ends[i][0]) || (i == 0 && ends[i][0] == 0));
            continue;
        }
        double end = off_range(row, ends[i][0], ends[i][1]);
        worst[3] = fmax(worst[3], end);
        if (!(end <= 1e-4))
            fail_msg("%s (%s): interval end %d is %.9g, R %.9g", row->name, stat_family_name(row->desc.family),
                     i, ends[i][0], ends[i][1]);
    }
}

static void fits_agree_with_r(void **state)
{
    (void)state;
    static struct row row;
    char line[1024];
    double worst[4] = {0};
    size_t rows = 0, estimable = 0;
    FILE *file = reference_open("psychometric.csv");
    assert_non_null(fgets(line, sizeof line, file));
    for (; next_row(file, &row); rows++) {
        compare(&row, worst);
        estimable += isnan(row.threshold) ? 0 : 1;
    }
    fclose(file);
    print_message("%zu sets, %zu with a threshold: within %.1e of the range, ln slope %.1e, asymptotes %.1e, "
                  "interval ends %.1e of the range\n",
                  rows, estimable, worst[0], worst[1], worst[2], worst[3]);
    assert_true(rows >= 40 && estimable >= 25);
}

// Likelihoods with many peaks: ours is never below the best of R's many starts, and where it is the same, so is
// the threshold, within 1e-4 of the range of levels.
static void no_maximum_is_missed(void **state)
{
    (void)state;
    static char line[16384];
    double worst = 0, worst_likelihood = 0;
    size_t rows = 0, compared = 0;
    FILE *file = reference_open("psychometric_multistart.csv");
    assert_non_null(fgets(line, sizeof line, file));
    static struct row row;
    for (; next_data(file, line, sizeof line, &row); rows++) {
        double threshold = reference_number(reference_field(&row.rest, ',')),
               most = reference_number(reference_field(&row.rest, ',')),
               range = reference_number(reference_field(&row.rest, ','));
        struct stat_fit fit = stat_psychometric_fit(row.answers, row.count, &row.desc);
        const char *family = stat_family_name(row.desc.family);
        if (!(fit.log_likelihood >= most - 1e-7))
            fail_msg("%s (%s): log-likelihood %.12g, R %.12g", row.name, family, fit.log_likelihood, most);
        worst_likelihood = fmax(worst_likelihood, most - fit.log_likelihood);
        if (isnan(fit.function.threshold) || fit.log_likelihood > most + 1e-7)
            continue; // a step; or R's simplex stopped before the top
        double at = fit.function.threshold;
        double off = fabs((row.desc.family == STAT_WEIBULL ? log(at) : at) - threshold) / range;
        worst = fmax(worst, off);
        compared++;
        if (!(off <= 1e-4))
            fail_msg("%s (%s): threshold %.9g, R %.9g on the axis", row.name, family, at, threshold);
    }
    fclose(file);
    print_message("%zu sets, at most %.1e below R's likelihood; %zu thresholds within %.1e of the range\n",
                  rows, worst_likelihood, compared, worst);
    assert_true(rows >= 50 && compared >= 20);
}

static void slope_intervals_follow_every_peak(void **state)
{
    (void)state;
    static char line[16384];
    static struct row row;
    double worst = 0;
    size_t rows = 0, closed = 0;
    FILE *file = reference_open("psychometric_slope.csv");
    assert_non_null(fgets(line, sizeof line, file));
    for (; next_data(file, line, sizeof line, &row); rows++) {
        struct stat_fit fit = stat_psychometric_fit(row.answers, row.count, &row.desc);
        if (fit.status != STAT_FIT_OK)
            continue;
        const double low = reference_number(reference_field(&row.rest, ',')),
                     high = reference_number(reference_field(&row.rest, ','));
        const double ends[2][2] = {{fit.slope.low, low}, {fit.slope.high, high}};
        for (int i = 0; i < 2; i++) {
            if (isnan(ends[i][1])) {
                assert_true(ends[i][0] == (i ? (double)INFINITY : 0));
                continue;
            }
            double off = fabs(log(ends[i][0] / ends[i][1]));
            worst = fmax(worst, off);
            closed++;
            if (!(off <= 1e-3))
                fail_msg("%s (%s): end %d of the slope is %.9g, R %.9g", row.name,
                         stat_family_name(row.desc.family), i, ends[i][0], ends[i][1]);
        }
    }
    fclose(file);
    print_message("%zu sets, %zu ends of slopes within %.1e of ln slope\n", rows, closed, worst);
    assert_true(rows >= 12 && closed >= 10);
}

// --- by law ---

static void functions_keep_their_word(void **state)
{
    (void)state;
    for (int family = 0; family < STAT_FAMILIES; family++)
        for (int falling = 0; falling < 2; falling++) {
            struct stat_psychometric f = {(enum stat_family)family, false, falling, 2, 0.7, 0.2, 0.1};
            double middle = 0.2 + 0.7 / 2, sign = falling ? -1 : 1;
            assert_true(fabs(stat_psychometric(&f, 2) - middle) < 1e-15);
            double axis = stat_family_logarithmic(f.family) ? 2 : 1; // d/d ln x = x d/dx
            double rise = (stat_psychometric(&f, 2 + 1e-5) - stat_psychometric(&f, 2 - 1e-5)) / 2e-5 * axis;
            assert_true(fabs(rise - sign * 0.7 * 0.7) < 1e-8);
            for (double x = 0.1; x < 8; x += 0.1) {
                double p = stat_psychometric(&f, x), back = stat_psychometric_level(&f, p);
                assert_true(p >= 0.2 && p <= 0.9);
                if (p > 0.21 && p < 0.89)
                    assert_true(fabs(back - x) < 1e-9);
                assert_true(sign * (stat_psychometric(&f, x + 0.1) - p) >= 0);
            }
            struct stat_tails t = stat_family_tails(f.family, -3);
            assert_true(fabs(t.lower + t.upper - 1) < 1e-15);
            enum stat_family found;
            assert_true(stat_family_find(stat_family_name(f.family), &found) && found == f.family);
        }
    struct stat_psychometric f = {STAT_WEIBULL, false, false, 2, 0.7, 0.5, 0};
    assert_true(isnan(stat_psychometric(&f, 0)) && isnan(stat_psychometric(&f, -1)));
    assert_true(isnan(stat_psychometric_level(&f, 0.4)));
    f.threshold = -1;
    assert_true(isnan(stat_psychometric(&f, 1)));
}

// The same answers in other units have the same fit.
static void units_do_not_matter(void **state)
{
    (void)state;
    const int64_t k[] = {1, 2, 6, 7, 10, 10};
    const struct stat_fit_desc desc = {.lapse_high = 0.06};
    struct stat_answers a[6], b[6], single[60];
    size_t count = 0;
    for (int i = 0; i < 6; i++) {
        a[i] = (struct stat_answers){i, k[i], 10};
        b[5 - i] = (struct stat_answers){1000 + 0.01 * i, k[i], 10};
        for (int j = 0; j < 10; j++)
            single[count++] = (struct stat_answers){i, j < k[i], 1};
    }
    struct stat_fit x = stat_psychometric_fit(a, 6, &desc), y = stat_psychometric_fit(b, 6, &desc),
                    z = stat_psychometric_fit(single, 60, &desc);
    assert_int_equal(x.status, STAT_FIT_OK);
    assert_true(fabs((y.function.threshold - 1000) * 100 - x.function.threshold) < 1e-6);
    assert_true(fabs(y.threshold.low * 100 - 1e5 - x.threshold.low) < 1e-5);
    assert_true(fabs(y.function.slope / 100 - x.function.slope) < 1e-5);
    assert_true(x.function.threshold == z.function.threshold && x.threshold.high == z.threshold.high);
    assert_true(x.threshold.low < x.function.threshold && x.function.threshold < x.threshold.high);
}

static void bootstrap_says_when_it_is_unreliable(void **state)
{
    (void)state;
    const struct stat_answers good[] = {{1, 3, 40}, {2, 8, 40}, {3, 21, 40}, {4, 33, 40}, {5, 38, 40}};
    const struct stat_answers bad[] = {{1, 12, 40}, {2, 2, 40}, {3, 31, 40}, {4, 20, 40}, {5, 39, 40}};
    struct stat_fit_desc desc = {0};
    struct stat_fit fit = stat_psychometric_fit(good, 5, &desc);
    struct stat_fit_bootstrap b = stat_psychometric_bootstrap(good, 5, &desc, &fit, 400, 1),
                              c = stat_psychometric_bootstrap(good, 5, &desc, &fit, 400, 1);
    assert_false(b.unreliable);
    assert_true(b.deviance_p > 0.05 && b.failed == 0);
    assert_true(b.threshold.low == c.threshold.low && b.deviance_p == c.deviance_p);
    double width = (b.threshold.high - b.threshold.low) / (fit.threshold.high - fit.threshold.low);
    assert_true(width > 0.8 && width < 1.25); // so much data that the intervals agree
    fit = stat_psychometric_fit(bad, 5, &desc);
    assert_int_equal(fit.status, STAT_FIT_OK);
    assert_true(stat_psychometric_bootstrap(bad, 5, &desc, &fit, 400, 1).deviance_p < 0.01);
    // Answers drawn with lapses and fitted without: all thresholds are off to one side, and the interval
    // misses.
    fit = stat_psychometric_fit(good, 5, &desc);
    fit.function.lapse = 0.3;
    b = stat_psychometric_bootstrap(good, 5, &desc, &fit, 400, 1);
    assert_true(b.threshold.low > fit.function.threshold && b.unreliable);
    // Five answers: many a replicate has no threshold.
    const struct stat_answers few[] = {{1, 0, 1}, {2, 1, 1}, {3, 0, 1}, {4, 1, 1}, {5, 1, 1}};
    fit.function = (struct stat_psychometric){.threshold = 3, .slope = 0.1};
    b = stat_psychometric_bootstrap(few, 5, &desc, &fit, 400, 1);
    assert_true(b.failed > 40 && b.unreliable);
    fit.status = STAT_FIT_STEP;
    assert_true(isnan(stat_psychometric_bootstrap(good, 5, &desc, &fit, 400, 1).deviance_p));
}

// Where all answers of a replicate are yes, its threshold lies below all levels, and above them where larger
// levels make a yes rarer: an end with more than 2.5 % of these is open.
static void replicates_beyond_the_levels_open_the_interval(void **state)
{
    (void)state;
    const struct stat_answers few[] = {{1, 0, 1}, {2, 1, 1}, {3, 1, 1}, {4, 1, 1}, {5, 1, 1}};
    const double all_yes = 0.24577; // R: prod(plogis(1:5 - 1.2)); standard error 0.0215 of 400 replicates
    struct stat_fit fit = {.function = {.threshold = 1.2, .slope = 0.25}};
    struct stat_fit_bootstrap b = stat_psychometric_bootstrap(few, 5, &(struct stat_fit_desc){0}, &fit, 400, 1);
    assert_true((double)b.below / 400 > all_yes - 3 * 0.0215 && b.threshold.low == -(double)INFINITY);
    assert_true(isfinite(b.threshold.high) && b.threshold.high > 1.2 && b.above + b.below + b.failed < 400);
    const struct stat_answers mirrored[] = {{5, 0, 1}, {4, 1, 1}, {3, 1, 1}, {2, 1, 1}, {1, 1, 1}};
    fit.function = (struct stat_psychometric){.falling = true, .threshold = 4.8, .slope = 0.25};
    b = stat_psychometric_bootstrap(mirrored, 5, &(struct stat_fit_desc){.falling = true}, &fit, 400, 1);
    assert_true((double)b.above / 400 > all_yes - 3 * 0.0215 && b.threshold.high == (double)INFINITY);
    // No more right than by guessing: beyond the hard end.
    const struct stat_fit_desc afc = {.guess_low = 0.5, .guess_high = 0.5, .lapse_high = 0.06};
    fit.function = (struct stat_psychometric){.threshold = 6, .slope = 1, .guess = 0.5};
    b = stat_psychometric_bootstrap(few, 5, &afc, &fit, 400, 1);
    assert_true(b.above > 100 && b.threshold.high == (double)INFINITY);
}

static void bad_input(void **state)
{
    (void)state;
    const struct stat_answers fine[] = {{1, 1, 10}, {2, 5, 10}, {3, 9, 10}};
    const struct stat_answers bad[][2] = {{{1, 11, 10}, {2, 5, 10}},
                                          {{1, -1, 10}, {2, 5, 10}},
                                          {{(double)NAN, 1, 10}, {2, 5, 10}},
                                          {{1, 1, 10}, {(double)INFINITY, 5, 10}},
                                          {{1, 0, -1}, {2, 5, 10}}};
    const struct stat_fit_desc descs[] = {{.guess_low = 0.6, .guess_high = 0.5},
                                          {.guess_high = 0.6, .lapse_high = 0.5},
                                          {.guess_low = (double)NAN},
                                          {.conf = 1},
                                          {.conf = (double)NAN},
                                          {.guess_low = -1, .guess_high = 0.5}};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct stat_fit fit = stat_psychometric_fit(bad[i], 2, &(struct stat_fit_desc){0});
        assert_int_equal(fit.status, STAT_FIT_BAD_INPUT);
        assert_true(isnan(fit.function.threshold) && isnan(fit.threshold.low));
    }
    for (size_t i = 0; i < sizeof descs / sizeof descs[0]; i++)
        assert_int_equal(stat_psychometric_fit(fine, 3, &descs[i]).status, STAT_FIT_BAD_INPUT);
    const struct stat_answers zero[] = {{0, 1, 10}, {2, 5, 10}}, none[] = {{1, 0, 0}};
    assert_int_equal(stat_psychometric_fit(zero, 2, &(struct stat_fit_desc){.family = STAT_WEIBULL}).status,
                     STAT_FIT_NOT_POSITIVE);
    assert_int_equal(stat_psychometric_fit(none, 1, &(struct stat_fit_desc){0}).status, STAT_FIT_NO_ANSWERS);
    assert_int_equal(stat_psychometric_fit(NULL, 0, &(struct stat_fit_desc){0}).status, STAT_FIT_NO_ANSWERS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fits_agree_with_r),
        cmocka_unit_test(no_maximum_is_missed),
        cmocka_unit_test(slope_intervals_follow_every_peak),
        cmocka_unit_test(functions_keep_their_word),
        cmocka_unit_test(units_do_not_matter),
        cmocka_unit_test(bootstrap_says_when_it_is_unreliable),
        cmocka_unit_test(replicates_beyond_the_levels_open_the_interval),
        cmocka_unit_test(bad_input),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
