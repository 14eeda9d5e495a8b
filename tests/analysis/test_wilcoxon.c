// Wilcoxon's signed-rank test against enumeration and R (tests/reference/wilcoxon.R), and by law.
#include "analysis/stats/wilcoxon.h"
#include "reference.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { MOST = 600 };

static enum stat_alternative alternative_of(const char *word)
{
    return strcmp(word, "less") == 0 ? STAT_LESS : strcmp(word, "greater") == 0 ? STAT_GREATER : STAT_TWO_SIDED;
}

// How far off row `line` is; fails the test beyond its tolerance. The Fourier sums are good to 1e-15 absolute.
static double check(char *line, size_t row)
{
    char *rest = line;
    const char *how = reference_field(&rest, ',');
    struct stat_wilcoxon_options o = {.alternative = alternative_of(reference_field(&rest, ','))};
    o.conf = reference_number(reference_field(&rest, ','));
    o.mean = reference_number(reference_field(&rest, ','));
    o.pratt = reference_number(reference_field(&rest, ',')) != 0;
    double expected[5], x[MOST], worst = 0;
    assert_int_equal(reference_numbers(reference_field(&rest, ','), expected, 5), 5);
    size_t n = reference_numbers(reference_field(&rest, ','), x, MOST);
    struct stat_wilcoxon w = stat_wilcoxon(x, n, &o);
    bool normal = strcmp(how, "normal") == 0, fourier = strcmp(how, "fourier") == 0;
    assert_true(w.exact == !normal);
    assert_int_equal(w.n + w.zeros, n);
    const double got[] = {w.statistic, w.p_value, w.estimate, w.ci_low, w.ci_high};
    for (int i = 0; i < (normal ? 2 : 5); i++) {
        double off = reference_distance(got[i], expected[i]);
        if (off > 1e-11 && !(fourier && i == 1 && fabs(got[i] - expected[i]) < 1e-14) &&
            fabs(got[i] - expected[i]) > 1e-15)
            fail_msg("%s, number %d of row %zu: %.17g, R %.17g", how, i, row, got[i], expected[i]);
        worst = fmax(worst, fabs(got[i] - expected[i]) > 1e-14 ? off : 0);
    }
    return worst;
}

static void agrees_with_enumeration_and_r(void **state)
{
    (void)state;
    FILE *file = reference_open("wilcoxon.csv");
    static char line[16384];
    size_t rows = 0;
    double worst = 0;
    for (; fgets(line, sizeof line, file); rows++) {
        line[strcspn(line, "\n")] = '\0';
        worst = fmax(worst, check(line, rows + 1));
    }
    fclose(file);
    print_message("%zu rows within %.1e (relative, or 1e-14)\n", rows, worst);
    assert_true(rows >= 130);
}

// Beyond the exact range the approximation takes over without a step: both answer the same to a few percent.
static void the_limit_is_smooth(void **state)
{
    (void)state;
    double x[STAT_WILCOXON_EXACT + 1];
    for (int i = 0; i <= STAT_WILCOXON_EXACT; i++)
        x[i] = (i * 37 % 101) - 47.1 + 0.25 * (i % 3); // no zero
    x[STAT_WILCOXON_EXACT] = 0.01;                     // the smallest: all other ranks move up by one
    struct stat_wilcoxon exact = stat_wilcoxon(x, STAT_WILCOXON_EXACT, NULL),
                         normal = stat_wilcoxon(x, STAT_WILCOXON_EXACT + 1, NULL);
    assert_true(exact.exact && !normal.exact);
    assert_true(exact.p_value > 1e-3 && exact.p_value < 0.5);
    print_message("p %.6f exact, %.6f normal\n", exact.p_value, normal.p_value);
    assert_true(fabs(log(exact.p_value / normal.p_value)) < 0.02);
    assert_true(fabs(exact.ci_low - normal.ci_low) < 0.3 && fabs(exact.ci_high - normal.ci_high) < 0.3);
}

// The interval holds exactly those means that the test of whole differences does not reject.
static void interval_is_the_test_turned_round(void **state)
{
    (void)state;
    const double x[] = {1.3, -0.4, 2.2, 0.9, 3.1, -1.7, 0.2, 4.6, 1.1, 2.7, 0.6};
    struct stat_wilcoxon w = stat_wilcoxon(x, 11, NULL);
    struct stat_wilcoxon_options in = {.mean = w.ci_low + 1e-9}, out = {.mean = w.ci_low - 1e-9};
    assert_true(stat_wilcoxon(x, 11, &in).p_value > 0.05 && stat_wilcoxon(x, 11, &out).p_value <= 0.05);
    in.mean = w.ci_high - 1e-9, out.mean = w.ci_high + 1e-9;
    assert_true(stat_wilcoxon(x, 11, &in).p_value > 0.05 && stat_wilcoxon(x, 11, &out).p_value <= 0.05);
}

static void pairs_and_mirrors(void **state)
{
    (void)state;
    const double x[] = {5, 7, 3, 9, 6, 6, 8}, y[] = {4, 7, 5, 5, 6, 3, 7}, d[] = {1, 0, -2, 4, 0, 3, 1};
    struct stat_wilcoxon a = stat_wilcoxon_paired(x, y, 7, NULL), b = stat_wilcoxon(d, 7, NULL),
                         c = stat_wilcoxon_paired(y, x, 7, NULL);
    assert_true(a.p_value == b.p_value && a.estimate == b.estimate && a.zeros == 2 && a.n == 5);
    assert_true(a.p_value == c.p_value && a.estimate == -c.estimate && a.ci_low == -c.ci_high);
    double far[7];
    for (int i = 0; i < 7; i++)
        far[i] = x[i] + 1e9;
    struct stat_wilcoxon shifted = stat_wilcoxon(far, 7, &(struct stat_wilcoxon_options){.mean = 1e9 + 6}),
                         plain = stat_wilcoxon(x, 7, &(struct stat_wilcoxon_options){.mean = 6});
    assert_true(shifted.p_value == plain.p_value && shifted.estimate == plain.estimate + 1e9);
}

static void bad_input(void **state)
{
    (void)state;
    const double zeros[] = {0, 0, 0}, missing[] = {1, (double)NAN, 2}, endless[] = {1, (double)INFINITY, 2},
                 some[] = {1, 2, 4};
    assert_true(isnan(stat_wilcoxon(NULL, 0, NULL).p_value));
    assert_true(isnan(stat_wilcoxon(missing, 3, NULL).p_value) &&
                isnan(stat_wilcoxon(endless, 3, NULL).estimate));
    struct stat_wilcoxon w = stat_wilcoxon(zeros, 3, NULL);
    assert_true(isnan(w.p_value) && w.n == 0 && w.zeros == 3 && w.estimate == 0);
    w = stat_wilcoxon(some, 1, NULL);
    assert_true(w.p_value == 1 && w.estimate == 1 && isinf(w.ci_low) && isinf(w.ci_high));
    const double levels[] = {1, -0.5, (double)NAN};
    for (int i = 0; i < 3; i++)
        assert_true(isnan(stat_wilcoxon(some, 3, &(struct stat_wilcoxon_options){.conf = levels[i]}).p_value));
    assert_true(isnan(stat_wilcoxon(some, 3, &(struct stat_wilcoxon_options){.mean = (double)NAN}).p_value));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(agrees_with_enumeration_and_r),
                                       cmocka_unit_test(the_limit_is_smooth),
                                       cmocka_unit_test(interval_is_the_test_turned_round),
                                       cmocka_unit_test(pairs_and_mirrors), cmocka_unit_test(bad_input)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
