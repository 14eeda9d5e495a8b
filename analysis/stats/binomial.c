// Exact binomial test.
//   Two-sided by the method of small p-values: the sum of P(j) over all j no more probable than k, where "no
//   more" carries a relative tolerance of 1e-7, as binom.test of R has it, so that j = n - k ties with k at p0
//   = 0.5 whatever the rounding of P. Interval: Clopper, C. J. & Pearson, E. S. (1934), Biometrika 26, 404-413,
//   by beta quantiles.
// P(j) falls away from the mode on both sides, so the far tail's edge and the null region's edges are found by
// bisection: O(log n) density calls where a scan would take O(n).
// Distributions are libRmath's (R's nmath), stable for n to 1e9; a p-value under about 1e-308 is 0 here.
#include "analysis/stats/binomial.h"

#include <Rmath.h>
#include <math.h>
#include <stdbool.h>

static const double tie_tolerance = 1 + 1e-7; // binom.test, R 4.2: relErr

static bool counts_ok(int64_t k, int64_t n)
{
    return n >= 1 && n <= STAT_BINOMIAL_MAX_N && k >= 0 && k <= n;
}

static bool probability_ok(double p0)
{
    return p0 >= 0 && p0 <= 1;
}

// 1 - conf must still differ from 1, else no k has p > 1 - conf.
static bool conf_ok(double conf)
{
    return conf > 0 && conf < 1 && 1 - conf < 1;
}

// How many j from ceil(n p0) to n have P(j) <= limit. P does not rise there, as the mode is at most ceil(n p0).
static int64_t upper_tail_count(int64_t n, double p0, double limit)
{
    int64_t low = (int64_t)ceil((double)n * p0), high = n + 1; // answer: first j with P(j) <= limit
    while (low < high) {
        int64_t middle = low + (high - low) / 2;
        if (dbinom((double)middle, (double)n, p0, false) <= limit)
            high = middle;
        else
            low = middle + 1;
    }
    return n + 1 - low;
}

// How many j from 0 to floor(n p0) have P(j) <= limit. P does not fall there.
static int64_t lower_tail_count(int64_t n, double p0, double limit)
{
    int64_t low = 0, high = (int64_t)floor((double)n * p0) + 1; // answer: first j with P(j) > limit
    while (low < high) {
        int64_t middle = low + (high - low) / 2;
        if (dbinom((double)middle, (double)n, p0, false) <= limit)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static double two_sided(int64_t k, int64_t n, double p0)
{
    double x = (double)k, size = (double)n, expected = size * p0;
    if (p0 == 0)
        return k == 0;
    if (p0 == 1)
        return k == n;
    if (x == expected)
        return 1;
    double limit = dbinom(x, size, p0, false) * tie_tolerance, p;
    if (x < expected) {
        double far = (double)upper_tail_count(n, p0, limit);
        p = pbinom(x, size, p0, true, false) + pbinom(size - far, size, p0, false, false);
    } else {
        double far = (double)lower_tail_count(n, p0, limit);
        p = pbinom(far - 1, size, p0, true, false) + pbinom(x - 1, size, p0, false, false);
    }
    return p < 1 ? p : 1;
}

double stat_binomial_p(int64_t k, int64_t n, double p0, enum stat_alternative alternative)
{
    if (!counts_ok(k, n) || !probability_ok(p0))
        return (double)NAN;
    switch (alternative) {
    case STAT_LESS:
        return pbinom((double)k, (double)n, p0, true, false);
    case STAT_GREATER:
        return pbinom((double)k - 1, (double)n, p0, false, false);
    case STAT_TWO_SIDED:
        return two_sided(k, n, p0);
    }
    return (double)NAN;
}

// Quantiles at `tail` from the bound's own end: 1 - tail would lose the digits of a small tail.
static double clopper_low(int64_t k, int64_t n, double tail)
{
    return k == 0 ? 0 : qbeta(tail, (double)k, (double)(n - k + 1), true, false);
}

static double clopper_high(int64_t k, int64_t n, double tail)
{
    return k == n ? 1 : qbeta(tail, (double)(k + 1), (double)(n - k), false, false);
}

struct stat_interval stat_clopper_pearson(int64_t k, int64_t n, double conf, enum stat_alternative alternative)
{
    if (!counts_ok(k, n) || !conf_ok(conf))
        return (struct stat_interval){(double)NAN, (double)NAN};
    switch (alternative) {
    case STAT_LESS:
        return (struct stat_interval){0, clopper_high(k, n, 1 - conf)};
    case STAT_GREATER:
        return (struct stat_interval){clopper_low(k, n, 1 - conf), 1};
    case STAT_TWO_SIDED:
        break;
    }
    return (struct stat_interval){clopper_low(k, n, (1 - conf) / 2), clopper_high(k, n, (1 - conf) / 2)};
}

// p(k) does not fall from 0 to `peak` and does not rise from there to n; p(peak) is 1.
static int64_t region_low(int64_t n, double p0, double alpha, enum stat_alternative alternative, int64_t peak)
{
    int64_t low = 0, high = peak; // answer: first k with p > alpha
    while (low < high) {
        int64_t middle = low + (high - low) / 2;
        if (stat_binomial_p(middle, n, p0, alternative) > alpha)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

static int64_t region_high(int64_t n, double p0, double alpha, enum stat_alternative alternative, int64_t peak)
{
    int64_t low = peak, high = n; // answer: last k with p > alpha
    while (low < high) {
        int64_t middle = low + (high - low + 1) / 2;
        if (stat_binomial_p(middle, n, p0, alternative) > alpha)
            low = middle;
        else
            high = middle - 1;
    }
    return low;
}

struct stat_region stat_null_region(int64_t n, double p0, double conf, enum stat_alternative alternative)
{
    if (!counts_ok(0, n) || !probability_ok(p0) || !conf_ok(conf))
        return (struct stat_region){1, 0};
    int64_t peak = (int64_t)floor((double)(n + 1) * p0); // the mode
    if (alternative == STAT_LESS || peak > n)
        peak = n;
    if (alternative == STAT_GREATER)
        peak = 0;
    return (struct stat_region){region_low(n, p0, 1 - conf, alternative, peak),
                                region_high(n, p0, 1 - conf, alternative, peak)};
}

struct stat_binomial stat_binomial_test(int64_t k, int64_t n, double p0, double conf,
                                        enum stat_alternative alternative)
{
    struct stat_binomial test = {.k = k, .n = n, .p0 = p0, .null_region = {1, 0}};
    test.p_value = stat_binomial_p(k, n, p0, alternative);
    test.estimate = counts_ok(k, n) ? (double)k / (double)n : (double)NAN;
    test.ci = stat_clopper_pearson(k, n, conf, alternative);
    if (counts_ok(k, n))
        test.null_region = stat_null_region(n, p0, conf, alternative);
    return test;
}
