// The binomial family against 256-bit integers (tests/reference/binomial_exact.py) and by law.
#include "analysis/stats/bayes_factor.h"
#include "analysis/stats/binomial.h"
#include "analysis/stats/equivalence.h"
#include "binomial_grid.h"
#include "reference.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

static void agrees_with_integers(void **state)
{
    (void)state;
    struct binomial_grid grid = binomial_grid_errors();
    print_message("%zu rows: ln p within %.1e, below 1e-300 %.1e of it, mid-p %.1e, Clopper-Pearson %.1e,\n"
                  "Wilson %.1e, Jeffreys %.1e, equivalence %.1e, Bayes factor %.1e\n",
                  grid.rows, grid.ln_p, grid.deep, grid.mid_p, grid.clopper, grid.wilson, grid.jeffreys,
                  grid.equivalence, grid.bayes);
    assert_true(grid.rows >= 150);
    assert_true(grid.ln_p <= 1e-8);
    assert_true(grid.deep <= 1e-12);
    assert_true(grid.mid_p <= 1e-8);
    assert_true(grid.clopper <= 1e-8);
    assert_true(grid.wilson <= 1e-8);
    assert_true(grid.jeffreys <= 1e-8);
    assert_true(grid.equivalence <= 1e-8);
    assert_true(grid.bayes <= 1e-8);
}

// C(n, k) p^k q^(n-k) by a product, without the library.
static double mass(int64_t k, int64_t n, double p)
{
    double m = 1;
    for (int64_t i = 1; i <= k; i++)
        m *= (double)(n - k + i) / (double)i * p;
    for (int64_t i = 0; i < n - k; i++)
        m *= 1 - p;
    return m;
}

static void mid_p_is_what_it_says(void **state)
{
    (void)state;
    const double shares[] = {0.1, 0.3, 0.5, 0.875};
    for (int i = 0; i < 4; i++)
        for (int64_t n = 1; n <= 40; n++)
            for (int64_t k = 0; k <= n; k++) {
                double here = mass(k, n, shares[i]), two = 0, less = 0;
                for (int64_t j = 0; j <= n; j++) {
                    double other = mass(j, n, shares[i]), ratio = other / here;
                    two += ratio < 1 / (1 + 1e-7) ? other : ratio <= 1 + 1e-7 ? other / 2 : 0;
                    less += j < k ? other : j == k ? other / 2 : 0;
                }
                assert_true(reference_close(stat_binomial_mid_p(k, n, shares[i], STAT_TWO_SIDED), two, 1e-11));
                assert_true(reference_close(stat_binomial_mid_p(k, n, shares[i], STAT_LESS), less, 1e-11));
                assert_true(fabs(stat_binomial_mid_p(k, n, shares[i], STAT_GREATER) - (1 - less)) < 1e-12);
            }
    double p = stat_binomial_mid_p(6, 22, 0.5, STAT_TWO_SIDED);
    assert_true(p > 0.03465 && p < 0.03475); // the definition that gives 0.0347, not 0.0436
}

// ln p falls with every step away from the middle, through 1e-280 where the way to compute it changes and
// beyond.
static void log_p_has_no_seam(void **state)
{
    (void)state;
    const double shares[] = {0.5, 0.31};
    const int64_t sizes[] = {3000, 100000};
    for (int i = 0; i < 2; i++)
        for (int s = 0; s < 2; s++) {
            int64_t n = sizes[s], middle = (int64_t)((double)n * shares[i]);
            double last = 1;
            for (int64_t k = middle - 1; k >= middle - 1200 && k >= 0; k--) {
                double ln_p = stat_binomial_log_p(k, n, shares[i], STAT_LESS),
                       two = stat_binomial_log_p(k, n, shares[i], STAT_TWO_SIDED),
                       p = stat_binomial_p(k, n, shares[i], STAT_LESS);
                assert_true(ln_p < last && ln_p <= two && two <= ln_p + log(2.5));
                if (p > 1e-300)
                    assert_true(fabs(log(p) - ln_p) < 1e-11);
                last = ln_p;
            }
            for (int64_t k = 0; k <= n; k += n / 50) { // one side is the other's mirror image
                double up = stat_binomial_log_p(n - k, n, 1 - shares[i], STAT_GREATER),
                       down = stat_binomial_log_p(k, n, shares[i], STAT_LESS);
                assert_true(fabs(up - down) <= 1e-11 * fmax(1, fabs(down)));
            }
        }
}

// Wilson's bounds are where the score test has p = 1 - conf; both intervals turn with the counts.
static void intervals_by_law(void **state)
{
    (void)state;
    const double z = 1.959963984540054; // normal quantile of 0.975
    for (int64_t n = 1; n <= 60; n++)
        for (int64_t k = 0; k <= n; k++) {
            struct stat_interval w = stat_wilson(k, n, 0.95, STAT_TWO_SIDED),
                                 j = stat_jeffreys(k, n, 0.95, STAT_TWO_SIDED),
                                 w_turned = stat_wilson(n - k, n, 0.95, STAT_TWO_SIDED),
                                 j_turned = stat_jeffreys(n - k, n, 0.95, STAT_TWO_SIDED);
            double e = (double)k / (double)n;
            assert_true(w.low <= e && e <= w.high && j.low <= e && e <= j.high);
            assert_true(fabs(w.low + w_turned.high - 1) < 1e-14 && fabs(j.low + j_turned.high - 1) < 1e-14);
            if (k > 0)
                assert_true(fabs((e - w.low) / sqrt(w.low * (1 - w.low) / (double)n) - z) < 1e-9);
            double wide = stat_wilson(k, n, 0.3, STAT_GREATER).low; // below one half: above the estimate
            assert_true(k == 0 ? wide == 0 : wide > e - 1e-14);
            assert_true(fabs(stat_wilson(n - k, n, 0.3, STAT_LESS).high - (1 - wide)) < 1e-14);
        }
}

// Both hypotheses are distributions of k, so the factor's mean under p0 is 1.
static void bayes_factor_has_mean_one(void **state)
{
    (void)state;
    const double priors[4][2] = {{1, 1}, {0.5, 0.5}, {3, 0.2}, {40, 60}}, shares[] = {0.5, 0.03, 0.8};
    for (int i = 0; i < 12; i++)
        for (int64_t n = 1; n <= 50; n += 7) {
            double mean = 0, p0 = shares[i % 3];
            for (int64_t k = 0; k <= n; k++)
                mean +=
                    mass(k, n, p0) * exp(stat_binomial_log_bf10(k, n, p0, priors[i / 3][0], priors[i / 3][1]));
            assert_true(fabs(mean - 1) < 1e-11);
        }
}

// p of equivalence is at most alpha exactly where its interval lies within the margin.
static void equivalence_and_interval_agree(void **state)
{
    (void)state;
    int within = 0, outside = 0;
    for (int64_t n = 5; n <= 400; n += 13)
        for (int64_t k = 0; k <= n; k++) {
            struct stat_equivalence e = stat_binomial_equivalence(k, n, 0.5, 0.12, 0.05);
            bool inside = e.ci.low >= 0.5 - 0.12 && e.ci.high <= 0.5 + 0.12;
            assert_true((e.p_value <= 0.05) == inside);
            assert_true(e.p_value == fmax(e.p_low, e.p_high));
            within += inside;
            outside += !inside;
        }
    assert_true(within > 100 && outside > 100);
    assert_int_equal(stat_verdict(0.5, 0.5, 0.05), STAT_UNDECIDED);
    assert_int_equal(stat_verdict(0.01, 0.5, 0.05), STAT_DIFFERENT);
    assert_int_equal(stat_verdict(0.5, 0.05, 0.05), STAT_WITHIN);
    assert_int_equal(stat_verdict(0.05, 0.01, 0.05), STAT_DIFFERENT_WITHIN);
    assert_int_equal(stat_verdict((double)NAN, (double)NAN, 0.05), STAT_UNDECIDED);
}

static void bad_input(void **state)
{
    (void)state;
    const double nan = (double)NAN, inf = (double)INFINITY;
    assert_true(isnan(stat_binomial_log_p(3, 2, 0.5, STAT_TWO_SIDED)));
    assert_true(isnan(stat_binomial_log_p(1, 2, nan, STAT_LESS)));
    assert_true(isnan(stat_binomial_mid_p(-1, 2, 0.5, STAT_LESS)) &&
                isnan(stat_binomial_mid_p(1, 2, 2, STAT_GREATER)));
    const double levels[] = {0, 1, -1, nan};
    for (int i = 0; i < 4; i++) {
        assert_true(isnan(stat_wilson(1, 2, levels[i], STAT_TWO_SIDED).low));
        assert_true(isnan(stat_jeffreys(1, 2, levels[i], STAT_LESS).high));
        assert_true(isnan(stat_binomial_equivalence(1, 2, 0.5, 0.1, levels[i]).p_value));
    }
    assert_true(isnan(stat_jeffreys(3, 2, 0.95, STAT_TWO_SIDED).low));
    const double margins[] = {0, -0.1, 0.6, nan, inf};
    for (int i = 0; i < 5; i++)
        assert_true(isnan(stat_binomial_equivalence(1, 2, 0.5, margins[i], 0.05).p_value));
    assert_true(isnan(stat_binomial_equivalence(3, 2, 0.5, 0.1, 0.05).p_value));
    const double shapes[] = {0, -1, nan, inf};
    for (int i = 0; i < 4; i++) {
        assert_true(isnan(stat_binomial_log_bf10(1, 2, 0.5, shapes[i], 1)));
        assert_true(isnan(stat_binomial_log_bf10(1, 2, 0.5, 1, shapes[i])));
    }
    assert_true(isnan(stat_binomial_log_bf10(1, 0, 0.5, 1, 1)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_integers),
        cmocka_unit_test(mid_p_is_what_it_says),
        cmocka_unit_test(log_p_has_no_seam),
        cmocka_unit_test(intervals_by_law),
        cmocka_unit_test(bayes_factor_has_mean_one),
        cmocka_unit_test(equivalence_and_interval_agree),
        cmocka_unit_test(bad_input),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
