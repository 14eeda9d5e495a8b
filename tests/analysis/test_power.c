// Power of the planned tests against R (tests/reference/power.R), and by law.
#include "analysis/stats/binomial.h"
#include "analysis/stats/power.h"
#include "reference.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static double compute(const char *what, int64_t n, int64_t n2, double x, double alpha, double power)
{
    if (strcmp(what, "binomial_power") == 0)
        return stat_binomial_power(n, 0.5, x, alpha);
    if (strcmp(what, "binomial_detectable") == 0)
        return stat_binomial_detectable(n, alpha, power);
    if (strcmp(what, "binomial_margin") == 0)
        return stat_binomial_margin(n, alpha, power);
    if (strcmp(what, "paired_power") == 0)
        return stat_paired_t_power(n, x, alpha);
    if (strcmp(what, "paired_detectable") == 0)
        return stat_paired_t_detectable(n, alpha, power);
    if (strcmp(what, "two_power") == 0)
        return stat_two_sample_t_power(n, n2, x, alpha);
    assert_string_equal(what, "two_detectable");
    return stat_two_sample_t_detectable(n, n2, alpha, power);
}

static void agrees_with_r(void **state)
{
    (void)state;
    FILE *file = reference_open("power.csv");
    char line[512];
    double worst[2] = {0}; // binomial, t
    size_t rows = 0;
    assert_non_null(fgets(line, sizeof line, file));
    for (; fgets(line, sizeof line, file); rows++) {
        line[strcspn(line, "\n")] = '\0';
        char *rest = line;
        const char *what = reference_field(&rest, ',');
        int64_t n = strtoll(reference_field(&rest, ','), NULL, 10),
                n2 = strtoll(reference_field(&rest, ','), NULL, 10);
        double x = reference_number(reference_field(&rest, ',')),
               alpha = reference_number(reference_field(&rest, ',')),
               power = reference_number(reference_field(&rest, ',')),
               expected = reference_number(reference_field(&rest, ','));
        double value = compute(what, n, n2, x, alpha, power), off = reference_distance(value, expected);
        bool t = strncmp(what, "binomial", 8) != 0;
        worst[t] = fmax(worst[t], off);
        // R asks the same noncentral t; its searches stop at 1e-13 of their argument
        if (!(off <= 1e-12))
            fail_msg("%s n %d, %d x %g alpha %g power %g: %.17g, R %.17g", what, (int)n, (int)n2, x, alpha,
                     power, value, expected);
    }
    fclose(file);
    print_message("%zu rows: binomial within %.1e, t within %.1e (relative)\n", rows, worst[0], worst[1]);
    assert_true(rows > 900);
}

// What is found with the power is found by counting; what lies a little below is not.
static void detectable_has_its_power(void **state)
{
    (void)state;
    for (int64_t n = 1; n <= 120; n++) {
        double p = stat_binomial_detectable(n, 0.05, 0.8);
        assert_true(isnan(p) == (n < 6)); // 2 / 2^5 > 0.05
        if (isnan(p))
            continue;
        double found = 0;
        for (int64_t k = 0; k <= n; k++)
            if (stat_binomial_p(k, n, 0.5, STAT_TWO_SIDED) <= 0.05)
                found += exp(lgamma((double)n + 1) - lgamma((double)k + 1) - lgamma((double)(n - k) + 1)) *
                         pow(p, (double)k) * pow(1 - p, (double)(n - k));
        assert_true(fabs(found - 0.8) < 1e-9);
        assert_true(stat_binomial_power(n, 0.5, p - 1e-6, 0.05) < 0.8);
        assert_true(stat_binomial_power(n, 0.5, 0.5, 0.05) <= 0.05); // exact tests keep their level
        double d = n < 2 ? 1 : stat_paired_t_detectable(n, 0.05, 0.8);
        assert_true(n < 2 || fabs(stat_paired_t_power(n, d, 0.05) - 0.8) < 1e-9);
    }
}

// Both one-sided tests reject in the counts that the margin allows, and a narrower margin loses the power.
static void margin_is_the_smallest(void **state)
{
    (void)state;
    for (int64_t n = 2; n <= 120; n++) {
        double m = stat_binomial_margin(n, 0.05, 0.8), power[2] = {0};
        if (isnan(m))
            continue;
        for (int narrow = 0; narrow < 2; narrow++)
            for (int64_t k = 0; k <= n; k++) {
                double at = narrow ? m - 1e-9 : m + 1e-12;
                if (stat_binomial_p(k, n, 0.5 - at, STAT_GREATER) <= 0.05 &&
                    stat_binomial_p(k, n, 0.5 + at, STAT_LESS) <= 0.05)
                    power[narrow] += exp(lgamma((double)n + 1) - lgamma((double)k + 1) -
                                         lgamma((double)(n - k) + 1) - (double)n * log(2));
            }
        assert_true(power[0] >= 0.8 - 1e-9 && power[1] < 0.8);
    }
}

static void bad_input(void **state)
{
    (void)state;
    const double levels[] = {0, 1, -1, 2, (double)NAN, 1e-20};
    for (int i = 0; i < 6; i++) {
        assert_true(isnan(stat_binomial_power(20, 0.5, 0.7, levels[i])));
        assert_true(isnan(stat_binomial_detectable(20, levels[i], 0.8)));
        assert_true(isnan(stat_binomial_margin(20, levels[i], 0.8)));
        assert_true(isnan(stat_paired_t_power(20, 0.5, levels[i])));
        assert_true(isnan(stat_two_sample_t_detectable(20, 20, levels[i], 0.8)));
        if (i < 5)
            assert_true(isnan(stat_binomial_detectable(20, 0.05, levels[i])));
    }
    assert_true(isnan(stat_binomial_detectable(0, 0.05, 0.8)));
    assert_true(isnan(stat_binomial_margin(-1, 0.05, 0.8)));
    assert_true(isnan(stat_binomial_power(20, 0.5, 1.1, 0.05)));
    assert_true(isnan(stat_binomial_power(STAT_POWER_MAX_N + INT64_C(1), 0.5, 0.5, 0.05)));
    assert_true(isnan(stat_paired_t_detectable(1, 0.05, 0.8)));
    assert_true(isnan(stat_two_sample_t_power(1, 5, 1, 0.05)));
    assert_true(isnan(stat_paired_t_power(5, (double)INFINITY, 0.05)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_r),
        cmocka_unit_test(detectable_has_its_power),
        cmocka_unit_test(margin_is_the_smallest),
        cmocka_unit_test(bad_input),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
