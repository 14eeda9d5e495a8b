// Effect sizes, the noncentral t and adjusted p-values against R (tests/reference/effect.R), and by law.
#include "analysis/stats/effect.h"
#include "analysis/stats/multiple.h"
#include "analysis/stats/noncentral_t.h"
#include "analysis/stats/ttest.h"
#include "reference.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { MOST = 64 };

static size_t compute(const char *what, double conf, const double *x, size_t n, const double *y, size_t n_y,
                      double *out)
{
    struct stat_effect e;
    if (strcmp(what, "lower") == 0) {
        out[0] = stat_noncentral_t_lower(x[0], x[1], x[2]);
        return 1;
    }
    if (strcmp(what, "holm") == 0)
        return stat_adjust_holm(x, n, out), n;
    if (strcmp(what, "hochberg") == 0)
        return stat_adjust_hochberg(x, n, out), n;
    if (strcmp(what, "bh") == 0)
        return stat_adjust_bh(x, n, out), n;
    if (strcmp(what, "exclusive") == 0) {
        size_t sets[MOST];
        assert_int_equal(n, n_y);
        for (size_t i = 0; i < n; i++)
            sets[i] = (size_t)y[i];
        return stat_adjust_exclusive(x, sets, n, out), n;
    }
    if (strcmp(what, "one") == 0) {
        e = stat_effect_one_sample(x, n, 0, conf);
    } else if (strcmp(what, "two") == 0) {
        e = stat_effect_two_samples(x, n, y, n_y, conf);
    } else {
        assert_int_equal(n, n_y);
        bool average = strcmp(what, "average") == 0;
        assert_true(average || strcmp(what, "paired") == 0);
        e = (average ? stat_effect_average : stat_effect_paired)(x, y, n, conf);
    }
    memcpy(out, (double[]){e.d, e.g, e.df, e.ci_low, e.ci_high}, 5 * sizeof out[0]);
    return 5;
}

static void agrees_with_r(void **state)
{
    (void)state;
    FILE *file = reference_open("effect.csv");
    static char line[8192];
    size_t rows = 0;
    double worst = 0;
    for (; fgets(line, sizeof line, file); rows++) {
        line[strcspn(line, "\n")] = '\0';
        char *rest = line;
        const char *what = reference_field(&rest, ',');
        double conf = reference_number(reference_field(&rest, ',')), expected[MOST], x[MOST], y[MOST],
               got[MOST];
        size_t count = reference_numbers(reference_field(&rest, ','), expected, MOST),
               n = reference_numbers(reference_field(&rest, ','), x, MOST),
               n_y = rest ? reference_numbers(reference_field(&rest, ','), y, MOST) : 0;
        assert_int_equal(compute(what, conf, x, n, y, n_y, got), count);
        for (size_t i = 0; i < count; i++) {
            double off = reference_distance(got[i], expected[i]);
            if (off > 1e-9 && fabs(got[i] - expected[i]) > 1e-12)
                fail_msg("%s, number %zu of row %zu: %.17g, R %.17g", what, i, rows + 1, got[i], expected[i]);
            worst = fmax(worst, fabs(got[i] - expected[i]) > 1e-12 ? off : 0);
        }
    }
    fclose(file);
    print_message("%zu rows within %.1e (relative, or 1e-12)\n", rows, worst);
    assert_true(rows > 450);
}

// A t of n values 1e9 apart by 1e-3 is that of the same values less 1e9; so are d and its limits.
static void large_offsets(void **state)
{
    (void)state;
    double near[40], far[40], near_y[30], far_y[30];
    for (int i = 0; i < 40; i++) {
        far[i] = 1e9 + (i * 7 % 23) * 1e-3;
        near[i] = far[i] - 1e9; // exact
    }
    for (int i = 0; i < 30; i++) {
        far_y[i] = 1e9 + (i * 5 % 19 + 2) * 1e-3;
        near_y[i] = far_y[i] - 1e9;
    }
    struct stat_ttest_options at = {.mean = 0.009}, at_far = {.mean = 1e9 + 0.009};
    at.mean = at_far.mean - 1e9;
    struct stat_ttest pairs[][2] = {
        {stat_ttest_welch(far, 40, far_y, 30, NULL), stat_ttest_welch(near, 40, near_y, 30, NULL)},
        {stat_ttest_paired(far, far_y, 30, NULL), stat_ttest_paired(near, near_y, 30, NULL)},
        {stat_ttest_one_sample(far, 40, &at_far), stat_ttest_one_sample(near, 40, &at)}};
    for (int i = 0; i < 3; i++) {
        assert_true(fabs(pairs[i][1].t) > 0.1 && reference_close(pairs[i][0].t, pairs[i][1].t, 1e-10));
        assert_true(reference_close(pairs[i][0].df, pairs[i][1].df, 1e-10));
        assert_true(reference_close(pairs[i][0].p_value, pairs[i][1].p_value, 1e-10));
        assert_true(i == 2 || reference_close(pairs[i][0].estimate, pairs[i][1].estimate, 1e-10));
        assert_true(i == 2 || reference_close(pairs[i][0].ci_low, pairs[i][1].ci_low, 1e-10));
    }
    struct stat_effect a = stat_effect_two_samples(far, 40, far_y, 30, 0.95),
                       b = stat_effect_two_samples(near, 40, near_y, 30, 0.95);
    assert_true(reference_close(a.d, b.d, 1e-10) && reference_close(a.ci_low, b.ci_low, 1e-10));
    a = stat_effect_average(far, far_y, 30, 0.95), b = stat_effect_average(near, near_y, 30, 0.95);
    assert_true(reference_close(a.d, b.d, 1e-10) && reference_close(a.ci_high, b.ci_high, 1e-10));
}

// Where pt() of R stops being exact: nothing jumps, and the limits give back their probability.
static void beyond_r(void **state)
{
    (void)state;
    const double at[] = {-1e6, -60, -37.7, -37.5, -1, 0, 3, 37.5, 37.7, 60, 5e3, 1e6};
    for (size_t i = 0; i < sizeof at / sizeof at[0]; i++)
        for (double df = 1; df <= 1e6; df *= 10) {
            double high = stat_noncentral_t_limit(at[i], df, 0.025),
                   low = -stat_noncentral_t_limit(-at[i], df, 0.025);
            assert_true(low < high);
            assert_true(fabs(stat_noncentral_t_lower(at[i], df, high) - 0.025) < 1e-12);
            assert_true(fabs(stat_noncentral_t_lower(at[i], df, low) - 0.975) < 1e-12);
        }
    double below = stat_noncentral_t_lower(40, 20, 37.61), above = stat_noncentral_t_lower(40, 20, 37.63);
    assert_true(below > above && below - above < 2e-3);
}

static void adjusting_in_place(void **state)
{
    (void)state;
    double p[] = {0.04, 2, 0.01, (double)NAN, 0.03, -0.1}, q[6];
    stat_adjust_holm(p, 6, q);
    assert_true(fabs(q[2] - 0.03) < 1e-15 && fabs(q[4] - 0.06) < 1e-15 && fabs(q[0] - 0.06) < 1e-15);
    assert_true(isnan(q[1]) && isnan(q[3]) && isnan(q[5]));
    stat_adjust_holm(p, 6, p);
    for (int i = 0; i < 6; i++)
        assert_true(p[i] == q[i] || (isnan(p[i]) && isnan(q[i])));
    stat_adjust_bh(NULL, 0, NULL);
}

static void bad_input(void **state)
{
    (void)state;
    const double equal[] = {4, 4, 4}, missing[] = {1, (double)NAN, 3}, some[] = {1, 2, 4}, more[] = {2, 3, 5};
    assert_true(isnan(stat_effect_one_sample(equal, 3, 0, 0.95).d));
    assert_true(isnan(stat_effect_one_sample(some, 1, 0, 0.95).ci_low));
    assert_true(isnan(stat_effect_paired(some, more, 3, 0.95).d)); // all differences are the same
    assert_true(isnan(stat_effect_paired(some, missing, 3, 0.95).d));
    assert_true(isnan(stat_effect_average(some, equal, 0, 0.95).d));
    assert_true(isnan(stat_effect_two_samples(equal, 3, equal, 3, 0.95).d));
    assert_true(isnan(stat_effect_two_samples(some, 3, some, 1, 0.95).d));
    const double levels[] = {0, 1, -0.5, (double)NAN};
    for (int i = 0; i < 4; i++)
        assert_true(isnan(stat_effect_one_sample(some, 3, 0, levels[i]).ci_low));
    assert_true(isnan(stat_effect_one_sample(some, 2, 0, 0.95).g)); // df 1: d has no mean
    assert_true(isnan(stat_hedges_factor(1)) && isnan(stat_hedges_factor((double)NAN)));
    assert_true(reference_close(stat_hedges_factor(1e8), 1 - 0.75e-8, 1e-12));
    assert_true(isnan(stat_noncentral_t_lower((double)NAN, 3, 0)) && isnan(stat_noncentral_t_lower(1, 0.5, 0)));
    assert_true(isnan(stat_noncentral_t_limit(1, 3, 0)) && isnan(stat_noncentral_t_limit(1, 3, 1 - 1e-16)) &&
                isnan(stat_noncentral_t_limit((double)INFINITY, 3, 0.1)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(agrees_with_r), cmocka_unit_test(large_offsets),
                                       cmocka_unit_test(beyond_r), cmocka_unit_test(adjusting_in_place),
                                       cmocka_unit_test(bad_input)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
