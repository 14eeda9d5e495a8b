// The exact binomial test against R's binom.test, and by law.
#include "analysis/stats/binomial.h"
#include "reference.h"

#include <inttypes.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

static enum stat_alternative alternative_of(const char *name)
{
    return strcmp(name, "less") == 0 ? STAT_LESS : strcmp(name, "greater") == 0 ? STAT_GREATER : STAT_TWO_SIDED;
}

static void agrees_with_r(void **state)
{
    (void)state;
    FILE *file = reference_open("binomial.csv");
    char line[512];
    double worst_p = 0, worst_bound = 0;
    size_t rows = 0;
    assert_non_null(fgets(line, sizeof line, file));
    while (fgets(line, sizeof line, file)) {
        line[strcspn(line, "\n")] = '\0';
        char *rest = line;
        int64_t k = strtoll(reference_field(&rest, ','), NULL, 10),
                n = strtoll(reference_field(&rest, ','), NULL, 10);
        double p0 = reference_number(reference_field(&rest, ','));
        enum stat_alternative alternative = alternative_of(reference_field(&rest, ','));
        double conf = reference_number(reference_field(&rest, ','));
        double p = reference_number(reference_field(&rest, ',')),
               low = reference_number(reference_field(&rest, ',')),
               high = reference_number(reference_field(&rest, ','));
        int64_t null_low = strtoll(reference_field(&rest, ','), NULL, 10);
        int64_t null_high = strtoll(reference_field(&rest, ','), NULL, 10);
        struct stat_binomial t = stat_binomial_test(k, n, p0, conf, alternative);
        if (p > 1e-300) // below, R counts what it rounds to 0 as ties; test_binomial_exact.c goes there
            worst_p = fmax(worst_p, reference_distance(t.p_value, p));
        else
            assert_true(t.p_value >= 0 && t.p_value <= 1e-300);
        worst_bound = fmax(worst_bound, fmax(fabs(t.ci.low - low), fabs(t.ci.high - high)));
        if (!(worst_p <= 1e-12 && worst_bound <= 1e-12))
            fail_msg("k %" PRId64 " n %" PRId64
                     " p0 %.17g conf %g: p %.17g, R %.17g; %.17g to %.17g, R %.17g to %.17g",
                     k, n, p0, conf, t.p_value, p, t.ci.low, t.ci.high, low, high);
        if (null_low >= 0 && (t.null_region.low != null_low || t.null_region.high != null_high))
            fail_msg("n %" PRId64 " p0 %.17g conf %g: region %" PRId64 " to %" PRId64 ", R %" PRId64
                     " to %" PRId64,
                     n, p0, conf, t.null_region.low, t.null_region.high, null_low, null_high);
        rows++;
    }
    fclose(file);
    print_message("%zu rows: p within %.1e (relative), bounds within %.1e (absolute)\n", rows, worst_p,
                  worst_bound);
    assert_true(rows > 500);
}

static void published_regions(void **state)
{
    (void)state;
    struct stat_region r = stat_null_region(22, 0.5, 0.95, STAT_TWO_SIDED);
    assert_int_equal(r.low, 6);
    assert_int_equal(r.high, 16);
    r = stat_null_region(19, 0.5, 0.95, STAT_TWO_SIDED);
    assert_int_equal(r.low, 5);
    assert_int_equal(r.high, 14);
}

// At p0 = 0.5 the counts k and n - k are mirror images, ties included, for every n.
static void mirror(void **state)
{
    (void)state;
    for (int64_t n = 1; n <= 300; n++)
        for (int64_t k = 0; 2 * k <= n; k++) {
            double a = stat_binomial_p(k, n, 0.5, STAT_TWO_SIDED),
                   b = stat_binomial_p(n - k, n, 0.5, STAT_TWO_SIDED);
            assert_true(reference_close(a, b, 1e-12));
            assert_true(a > 0 && a <= 1);
        }
}

// An interval of Clopper and Pearson holds p0 exactly where neither one-sided test at half the error rejects
// it.
static void interval_inverts_test(void **state)
{
    (void)state;
    for (int64_t n = 1; n <= 40; n++)
        for (int64_t k = 0; k <= n; k++) {
            struct stat_interval ci = stat_clopper_pearson(k, n, 0.95, STAT_TWO_SIDED);
            assert_true(ci.low <= (double)k / (double)n && (double)k / (double)n <= ci.high);
            if (k > 0)
                assert_true(reference_close(stat_binomial_p(k, n, ci.low, STAT_GREATER), 0.025, 1e-9));
            if (k < n)
                assert_true(reference_close(stat_binomial_p(k, n, ci.high, STAT_LESS), 0.025, 1e-9));
        }
}

// The region by its definition, for every alternative.
static void region_is_what_it_says(void **state)
{
    (void)state;
    const double levels[] = {0, 0.03, 0.5, 0.7, 1};
    for (int alternative = STAT_TWO_SIDED; alternative <= STAT_GREATER; alternative++)
        for (int64_t n = 1; n <= 60; n++)
            for (int i = 0; i < 5; i++) {
                int64_t low = -1, high = -1;
                for (int64_t k = 0; k <= n; k++)
                    if (stat_binomial_p(k, n, levels[i], (enum stat_alternative)alternative) > 1 - 0.9) {
                        low = low < 0 ? k : low;
                        high = k;
                    }
                struct stat_region r = stat_null_region(n, levels[i], 0.9, (enum stat_alternative)alternative);
                assert_int_equal(r.low, low);
                assert_int_equal(r.high, high);
            }
}

static void bad_input(void **state)
{
    (void)state;
    assert_true(isnan(stat_binomial_p(1, 0, 0.5, STAT_TWO_SIDED)));
    assert_true(isnan(stat_binomial_p(-1, 5, 0.5, STAT_TWO_SIDED)));
    assert_true(isnan(stat_binomial_p(6, 5, 0.5, STAT_LESS)));
    assert_true(isnan(stat_binomial_p(2, 5, -0.1, STAT_TWO_SIDED)));
    assert_true(isnan(stat_binomial_p(2, 5, 1.1, STAT_GREATER)));
    assert_true(isnan(stat_binomial_p(2, 5, (double)NAN, STAT_TWO_SIDED)));
    assert_true(isnan(stat_binomial_p(2, STAT_BINOMIAL_MAX_N + 1, 0.5, STAT_TWO_SIDED)));
    const double levels[] = {0, 1, -1, 2, (double)NAN, 1e-20};
    for (int i = 0; i < 6; i++) {
        assert_true(isnan(stat_clopper_pearson(2, 5, levels[i], STAT_TWO_SIDED).low));
        struct stat_region r = stat_null_region(5, 0.5, levels[i], STAT_TWO_SIDED);
        assert_true(r.low > r.high);
    }
    struct stat_binomial t = stat_binomial_test(6, 5, 0.5, 0.95, STAT_TWO_SIDED);
    assert_true(isnan(t.p_value) && isnan(t.estimate) && t.null_region.low > t.null_region.high);
}

// A scan over n would take minutes for these; bisection takes well under a millisecond each.
static void large_n_is_quick(void **state)
{
    (void)state;
    clock_t start = clock();
    double sum = 0;
    for (int64_t i = 0; i < 200; i++)
        sum += stat_binomial_test(499000000 + i * 10000, 1000000000, 0.5, 0.95, STAT_TWO_SIDED).p_value;
    double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
    assert_true(isfinite(sum));
    assert_true(seconds < 20); // generous: sanitizers, a busy machine
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_r),
        cmocka_unit_test(published_regions),
        cmocka_unit_test(mirror),
        cmocka_unit_test(interval_inverts_test),
        cmocka_unit_test(region_is_what_it_says),
        cmocka_unit_test(bad_input),
        cmocka_unit_test(large_n_is_quick),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
