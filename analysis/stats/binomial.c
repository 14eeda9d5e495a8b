// Exact binomial test.
//   Two-sided by the method of small p-values: k and all counts beyond it, and on the other side of n p0 all j
//   no more probable than k, where "no more" carries a relative tolerance of 1e-7, as binom.test of R has it,
//   so that j = n - k ties with k at p0 = 0.5 whatever the rounding of P. k = n p0 has p = 1.
//
//   Mid-p: Lancaster, H. O. (1961), Journal of the American Statistical Association 56, 223-234. Two-sided it
//   is the sum of P(j) < P(k) and half the sum of P(j) = P(k), on both sides and with the same tolerance: 6 of
//   22 is 0.0347, where halving P(k) alone would give 0.0436.
//
// Against 256-bit integers (tests/reference/binomial_exact.py), n up to 1e9 and p down to 1e-300, ln p is off
// by at most 6e-11; deeper by 2e-15 of itself.
#include "analysis/stats/binomial_private.h"

#include <Rmath.h>
#include <math.h>

static const double tie_tolerance = 1e-7; // binom.test, R 4.2: relErr

// What the two-sided test counts, for 0 < p0 < 1 and k other than n p0.
static struct binomial_tails counted(int64_t k, int64_t n, double p0)
{
    double x = (double)k, size = (double)n, expected = size * p0;
    bool below = x < expected;
    // At one half the mirror image is the edge, unless its neighbour towards the middle ties as well.
    double step = below ? (size - x) / (x + 1) : x / (size - x + 1);
    if (p0 == 0.5 && step > 1 + 4 * tie_tolerance)
        return below ? (struct binomial_tails){k, n - k} : (struct binomial_tails){n - k, k};
    double limit = dbinom(x, size, p0, true) + log1p(tie_tolerance), near = fabs(x - expected);
    if (below)
        return (struct binomial_tails){k, binomial_high_edge(n, p0, limit, near)};
    return (struct binomial_tails){binomial_low_edge(n, p0, limit, near), k};
}

static double two_sided(int64_t k, int64_t n, double p0)
{
    if (p0 == 0 || p0 == 1)
        return k == (p0 == 0 ? 0 : n);
    if ((double)k == (double)n * p0)
        return 1;
    return binomial_outside(counted(k, n, p0), n, p0);
}

double stat_binomial_p(int64_t k, int64_t n, double p0, enum stat_alternative alternative)
{
    if (!binomial_counts_ok(k, n) || !binomial_probability_ok(p0))
        return (double)NAN;
    switch (alternative) {
    case STAT_LESS:
        return binomial_lower(k, n, p0);
    case STAT_GREATER:
        return binomial_upper(k, n, p0);
    case STAT_TWO_SIDED:
        return two_sided(k, n, p0);
    }
    return (double)NAN;
}

// p is the test's; where it is deep, it is asked anew in logarithms.
static double log_p(double p, int64_t k, int64_t n, double p0, enum stat_alternative alternative)
{
    bool certain = p0 == 0 || p0 == 1; // then p is 0 or 1
    if (!(p <= BINOMIAL_SHALLOW) || certain)
        return log(p);
    if (alternative == STAT_TWO_SIDED)
        return binomial_log_outside(counted(k, n, p0), n, p0);
    return alternative == STAT_LESS ? binomial_log_lower(k, n, p0) : binomial_log_upper(k, n, p0);
}

double stat_binomial_log_p(int64_t k, int64_t n, double p0, enum stat_alternative alternative)
{
    return log_p(stat_binomial_p(k, n, p0, alternative), k, n, p0, alternative);
}

// The probability of all j with ln P(j) <= limit.
static double no_more_probable(double limit, int64_t n, double p0, double near)
{
    struct binomial_tails tails = {binomial_low_edge(n, p0, limit, near),
                                   binomial_high_edge(n, p0, limit, near)};
    return binomial_outside(tails, n, p0);
}

static double two_sided_mid_p(int64_t k, int64_t n, double p0)
{
    if (p0 == 0 || p0 == 1)
        return k == (p0 == 0 ? 0 : n) ? 0.5 : 0; // one count has all the probability
    double at_k = dbinom((double)k, (double)n, p0, true), near = fabs((double)k - (double)n * p0);
    return (no_more_probable(at_k + log1p(tie_tolerance), n, p0, near) +
            no_more_probable(at_k - log1p(tie_tolerance), n, p0, near)) /
           2;
}

double stat_binomial_mid_p(int64_t k, int64_t n, double p0, enum stat_alternative alternative)
{
    if (!binomial_counts_ok(k, n) || !binomial_probability_ok(p0))
        return (double)NAN;
    double half = dbinom((double)k, (double)n, p0, false) / 2;
    switch (alternative) {
    case STAT_LESS:
        return binomial_lower(k - 1, n, p0) + half;
    case STAT_GREATER:
        return binomial_upper(k + 1, n, p0) + half;
    case STAT_TWO_SIDED:
        return two_sided_mid_p(k, n, p0);
    }
    return (double)NAN;
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
    if (!binomial_counts_ok(0, n) || !binomial_probability_ok(p0) || !binomial_conf_ok(conf))
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
    test.log_p = log_p(test.p_value, k, n, p0, alternative);
    test.estimate = binomial_counts_ok(k, n) ? (double)k / (double)n : (double)NAN;
    test.ci = stat_clopper_pearson(k, n, conf, alternative);
    if (binomial_counts_ok(k, n))
        test.null_region = stat_null_region(n, p0, conf, alternative);
    return test;
}
