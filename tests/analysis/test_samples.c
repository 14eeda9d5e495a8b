// t-tests, moments and quantiles against R, and by law.
#include "analysis/stats/moments.h"
#include "analysis/stats/quantile.h"
#include "analysis/stats/ttest.h"
#include "reference.h"

#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

struct row {
    char *test;
    struct stat_ttest_options options;
    double expected[6], x[64], y[64];
    size_t n_x, n_y;
};

static void compute(struct row *row, double out[6])
{
    struct stat_ttest t = {0};
    if (strcmp(row->test, "moments") == 0) {
        struct stat_moments m = stat_moments(row->x, row->n_x);
        memcpy(out, (double[]){(double)m.n, m.mean, m.sd, m.std_error, (double)NAN, (double)NAN},
               6 * sizeof out[0]);
        return;
    }
    if (strcmp(row->test, "quantile") == 0) {
        const double at[] = {0, 0.05, 0.5, 0.95, 0.99, 1};
        stat_sort(row->x, row->n_x);
        for (int i = 0; i < 6; i++)
            out[i] = stat_quantile(row->x, row->n_x, at[i]);
        return;
    }
    if (strcmp(row->test, "one") == 0)
        t = stat_ttest_one_sample(row->x, row->n_x, &row->options);
    else if (strcmp(row->test, "paired") == 0)
        t = stat_ttest_paired(row->x, row->y, row->n_x, &row->options);
    else if (strcmp(row->test, "welch") == 0)
        t = stat_ttest_welch(row->x, row->n_x, row->y, row->n_y, &row->options);
    else
        fail_msg("unknown test %s", row->test);
    memcpy(out, (double[]){t.estimate, t.t, t.df, t.p_value, t.ci_low, t.ci_high}, 6 * sizeof out[0]);
}

static void agrees_with_r(void **state)
{
    (void)state;
    FILE *file = reference_open("samples.csv");
    static char line[16384];
    size_t rows = 0;
    double worst = 0;
    while (fgets(line, sizeof line, file)) {
        line[strcspn(line, "\n")] = '\0';
        char *rest = line;
        struct row row = {.test = reference_field(&rest, ',')};
        const char *alternative = reference_field(&rest, ',');
        row.options.alternative = strcmp(alternative, "less") == 0      ? STAT_LESS
                                  : strcmp(alternative, "greater") == 0 ? STAT_GREATER
                                                                        : STAT_TWO_SIDED;
        row.options.conf = reference_number(reference_field(&rest, ','));
        assert_int_equal(reference_numbers(reference_field(&rest, ','), row.expected, 6), 6);
        row.n_x = reference_numbers(reference_field(&rest, ','), row.x, 64);
        row.n_y = reference_numbers(reference_field(&rest, ','), row.y, 64);
        double got[6];
        compute(&row, got);
        double scale = 0; // bounds and estimates near 0 are differences of values of this size
        for (size_t i = 0; i < row.n_x; i++)
            scale = fmax(scale, fabs(row.x[i]));
        for (int i = 0; i < 6; i++) {
            double distance = reference_distance(got[i], row.expected[i]);
            bool same = distance <= 1e-9 || fabs(got[i] - row.expected[i]) <= 1e-14 * scale;
            if (!same)
                fail_msg("%s, number %d of row %zu: %.17g, R %.17g", row.test, i, rows + 1, got[i],
                         row.expected[i]);
            worst = same && distance <= 1e-9 ? fmax(worst, distance) : worst;
        }
        rows++;
    }
    fclose(file);
    print_message("%zu rows within %.1e\n", rows, worst);
    assert_true(rows >= 200);
}

// Franke 2021, section 8.2: p 0.096 and 0.009.
static void known_answers(void **state)
{
    (void)state;
    const double better[] = {1, 1, 1, 1, 1, 1, 1, -1, -1, 0, 0}, worse[] = {-2, -2, -1, -1, -1, -1, 0, 0, 0};
    assert_true(fabs(stat_ttest_one_sample(better, 11, NULL).p_value - 0.0959) < 5e-5);
    assert_true(fabs(stat_ttest_one_sample(worse, 9, NULL).p_value - 0.0092) < 5e-5);
    struct stat_moments m = stat_moments(better, 11);
    assert_true(fabs(11 * m.mean - 5) < 1e-12);
}

// Data 1e9 apart by 1e-3 have the SD of the same data without the offset.
static void large_offset(void **state)
{
    (void)state;
    double plain[50], far[50];
    for (int i = 0; i < 50; i++) {
        plain[i] = (i * 7 % 13) * 0.0009765625; // 2^-10: the sum with 1e9 is exact
        far[i] = plain[i] + 1e9;
    }
    struct stat_moments a = stat_moments(plain, 50), b = stat_moments(far, 50);
    assert_true(reference_close(b.sd, a.sd, 1e-14));
    assert_true(reference_close(b.mean - 1e9, a.mean, 1e-4));
}

// 0.225 as participants reach it by adding and taking steps of 0.05. Numbers that do differ keep their spread,
// however large they are.
static void rounding_is_no_spread(void **state)
{
    (void)state;
    double steps[] = {0.225, 0.225 + 0.05 - 0.05, 0.225 + 0.05 * 3 - 0.05 - 0.05 - 0.05, 0.425 - 0.05 * 4};
    assert_true(steps[0] != steps[2] || steps[0] != steps[3]);
    struct stat_moments m = stat_moments(steps, 4);
    assert_true(m.sd == 0 && m.std_error == 0 && fabs(m.mean - 0.225) < 1e-15);
    for (int i = 0; i < 4; i++)
        steps[i] *= -1e9;
    assert_true(stat_moments(steps, 4).sd == 0);
    struct stat_ttest t = stat_ttest_one_sample(steps, 4, NULL);
    assert_true(isnan(t.p_value) && isnan(t.ci_low));
    const double close[] = {1, 1 + 16 * DBL_EPSILON}, far[] = {1e9, 1e9 + 0.0009765625}, around[] = {0, 1e-30};
    assert_true(reference_close(stat_moments(close, 2).sd, 16 * DBL_EPSILON / sqrt(2), 1e-14));
    assert_true(reference_close(stat_moments(far, 2).sd, 0.0009765625 / sqrt(2), 1e-14));
    assert_true(reference_close(stat_moments(around, 2).sd, 1e-30 / sqrt(2), 1e-14));
}

static void bad_input(void **state)
{
    (void)state;
    const double equal[] = {4, 4, 4, 4}, missing[] = {1, (double)NAN, 3}, endless[] = {1, (double)INFINITY, 3};
    assert_true(isnan(stat_moments(NULL, 0).mean));
    assert_true(stat_moments(equal, 1).mean == 4 && isnan(stat_moments(equal, 1).sd));
    assert_true(isnan(stat_moments(missing, 3).mean) && isnan(stat_moments(endless, 3).mean));
    assert_true(stat_moments(equal, 4).sd == 0);
    struct stat_ttest t = stat_ttest_one_sample(equal, 4, NULL);
    assert_true(t.estimate == 4 && isnan(t.p_value) && isnan(t.ci_low));
    assert_true(isnan(stat_ttest_one_sample(equal, 1, NULL).p_value));
    assert_true(isnan(stat_ttest_one_sample(missing, 3, NULL).p_value));
    assert_true(isnan(stat_ttest_paired(equal, equal, 0, NULL).p_value));
    assert_true(isnan(stat_ttest_welch(equal, 4, equal, 4, NULL).p_value));
    const double some[] = {1, 2, 4};
    assert_true(isnan(stat_ttest_welch(some, 3, some, 1, NULL).p_value));
    const double levels[] = {1, -0.5, (double)NAN};
    for (int i = 0; i < 3; i++)
        assert_true(
            isnan(stat_ttest_one_sample(some, 3, &(struct stat_ttest_options){.conf = levels[i]}).p_value));
    assert_true(isnan(stat_quantile(NULL, 0, 0.5)));
    assert_true(isnan(stat_quantile(some, 3, -0.1)) && isnan(stat_quantile(some, 3, (double)NAN)));
    assert_true(stat_quantile(some, 1, 0.7) == 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(agrees_with_r), cmocka_unit_test(known_answers),
                                       cmocka_unit_test(large_offset), cmocka_unit_test(rounding_is_no_spread),
                                       cmocka_unit_test(bad_input)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
