// The exact binomial test with its interval against the libRmath calls that binom.test of R makes: the same
// numbers always, and with FOVSTUDY_BENCH=FILE their times too, written there as CSV. ./run bench does so.
#include "analysis/stats/binomial.h"
#include "binomial_grid.h"
#include "reference.h"

#include <Rmath.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include <cmocka.h>

enum { TOGETHER = 32, WAYS = 3 }; // cases timed in one go; ours, R's, bare

struct answer {
    double p, low, high;
};

struct test_case {
    int64_t k, n;
    double p0;
};

// n is even in 1 to 10^4, p0 one half every other time and else even in 0.02 to 0.98, k within three standard
// deviations: a function of i alone, by the golden ratio's multiples.
static struct test_case case_of(int i)
{
    double u = fmod((i + 1) * 0.6180339887498949, 1), v = fmod((i + 1) * 0.7548776662466927, 1),
           w = fmod((i + 1) * 0.5698402909980532, 1);
    struct test_case c = {.n = 1 + (int64_t)(u * 10000), .p0 = i % 2 ? 0.5 : 0.02 + 0.96 * v};
    double sd = sqrt((double)c.n * c.p0 * (1 - c.p0)), k = round((double)c.n * c.p0 + (6 * w - 3) * sd);
    c.k = k < 0 ? 0 : k > (double)c.n ? c.n : (int64_t)k;
    return c;
}

static struct answer ours(struct test_case c)
{
    struct stat_interval ci = stat_clopper_pearson(c.k, c.n, 0.95, STAT_TWO_SIDED);
    return (struct answer){stat_binomial_p(c.k, c.n, c.p0, STAT_TWO_SIDED), ci.low, ci.high};
}

static struct answer interval_by_r(double x, double n)
{
    return (struct answer){.low = x == 0 ? 0 : qbeta(0.025, x, n - x + 1, true, false),
                           .high = x == n ? 1 : qbeta(0.975, x + 1, n - x, true, false)};
}

// binom.test of R 4.2: dbinom of every count on the other side, pbinom of both tails, qbeta of both bounds.
static struct answer by_r(struct test_case c)
{
    double x = (double)c.k, n = (double)c.n, m = n * c.p0, limit = dbinom(x, n, c.p0, false) * (1 + 1e-7),
           y = 0;
    struct answer out = interval_by_r(x, n);
    out.p = 1;
    if (x < m) {
        for (double i = ceil(m); i <= n; i++)
            y += dbinom(i, n, c.p0, false) <= limit;
        out.p = pbinom(x, n, c.p0, true, false) + pbinom(n - y, n, c.p0, false, false);
    } else if (x > m) {
        for (double i = 0; i <= floor(m); i++)
            y += dbinom(i, n, c.p0, false) <= limit;
        out.p = pbinom(y - 1, n, c.p0, true, false) + pbinom(x - 1, n, c.p0, false, false);
    }
    out.p = out.p < 1 ? out.p : 1;
    return out;
}

// What no implementation by these calls can do without: one density, two tails, two bounds. The far tail is
// guessed at the mirror image, so its numbers are right at one half only; they are not looked at.
static struct answer bare(struct test_case c)
{
    double x = (double)c.k, n = (double)c.n, far = 2 * n * c.p0 - x;
    struct answer out = interval_by_r(x, n);
    out.p = dbinom(x, n, c.p0, false) + pbinom(fmin(x, far), n, c.p0, true, false) +
            pbinom(fmax(x, far) - 1, n, c.p0, false, false);
    return out;
}

static void same_numbers(void **state)
{
    (void)state;
    for (int i = 0; i < 1000; i++) {
        struct test_case c = case_of(i);
        struct answer a = ours(c), b = by_r(c);
        if (!reference_close(a.p, b.p, 1e-11) || fabs(a.low - b.low) > 1e-12 || fabs(a.high - b.high) > 1e-12)
            fail_msg("%d of %d, %.17g: %.17g, %.17g to %.17g; R %.17g, %.17g to %.17g", (int)c.k, (int)c.n,
                     c.p0, a.p, a.low, a.high, b.p, b.low, b.high);
    }
}

// Processor time: others on the machine do not count.
static double seconds_of(struct answer (*way)(struct test_case), int from, double *keep)
{
    struct timespec start, end;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &start);
    for (int i = from; i < from + TOGETHER; i++) {
        struct answer a = way(case_of(i));
        *keep += a.p + a.low + a.high;
    }
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &end);
    return (double)(end.tv_sec - start.tv_sec) + 1e-9 * (double)(end.tv_nsec - start.tv_nsec);
}

static void write_figures(FILE *file, const double *seconds, int cases)
{
    struct binomial_grid grid = binomial_grid_errors();
    const struct {
        const char *name;
        double value;
    } figures[] = {{"ours_us", 1e6 * seconds[0] / cases},
                   {"binom_test_calls_us", 1e6 * seconds[1] / cases},
                   {"bare_calls_us", 1e6 * seconds[2] / cases},
                   {"ours_over_binom_test_calls", seconds[0] / seconds[1]},
                   {"ours_over_bare_calls", seconds[0] / seconds[2]},
                   {"grid_rows", (double)grid.rows},
                   {"largest_error_ln_p", grid.ln_p},
                   {"largest_error_ln_p_below_1e-300_relative", grid.deep},
                   {"largest_error_mid_p_relative", grid.mid_p},
                   {"largest_error_clopper_pearson_relative", grid.clopper},
                   {"largest_error_wilson_relative", grid.wilson},
                   {"largest_error_jeffreys_relative", grid.jeffreys},
                   {"largest_error_equivalence_ln_p", grid.equivalence},
                   {"largest_error_bayes_factor_ln", grid.bayes}};
    fprintf(file, "figure,value\n");
    for (size_t i = 0; i < sizeof figures / sizeof figures[0]; i++) {
        fprintf(file, "%s,%.3g\n", figures[i].name, figures[i].value);
        print_message("%s %.3g\n", figures[i].name, figures[i].value);
    }
}

// Ways take turns every few cases, so that a clock that changes its speed changes it for all.
static void times(void **state)
{
    (void)state;
    const char *path = getenv("FOVSTUDY_BENCH");
    if (!path)
        skip();
    struct answer (*const ways[WAYS])(struct test_case) = {ours, by_r, bare};
    const int cases = 16384;
    double seconds[WAYS] = {0}, keep = 0;
    for (int i = 0; i < cases; i += TOGETHER)
        for (int way = 0; way < WAYS; way++)
            seconds[way] += seconds_of(ways[way], i, &keep);
    assert_true(isfinite(keep));
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    write_figures(file, seconds, cases);
    assert_int_equal(fclose(file), 0);
    assert_true(seconds[0] <= seconds[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(same_numbers), cmocka_unit_test(times)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
