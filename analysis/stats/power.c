// Power of exact binomial tests and of t-tests.
//   Binomial: the rejection region of binomial.h's test, weighted with the true distribution; no approximation.
//   Equivalence: two one-sided tests, Schuirmann, D. J. (1987), J. Pharmacokinetics and Biopharmaceutics 15,
//   657-680. Both reject for counts from c to n - c, where c is the least with P(K >= c | 1/2 - m) <= alpha. So
//   the widest c that the power allows gives the margin in closed form: 1/2 minus the one-sided lower bound of
//   Clopper and Pearson for c of n, where that probability is alpha exactly. t: the noncentral t distribution
//   with both tails, as power.t.test of R with strict = TRUE.
// Distributions are libRmath's; its noncentral t (AS 243, Lenth 1989) is good to about 1e-12 and is asked for
// noncentralities under 37.62 only, beyond which it approximates.
#include "analysis/stats/power.h"

#include "analysis/stats/binomial.h"

#include <Rmath.h>
#include <math.h>
#include <stdbool.h>

enum { BISECTIONS = 200 }; // more than a double has bits

static bool levels_ok(double alpha, double power)
{
    return alpha > 0 && alpha < 1 && power > 0 && power < 1 && 1 - alpha < 1;
}

static bool n_ok(int64_t n)
{
    return n >= 1 && n <= STAT_POWER_MAX_N;
}

// Where the test does not reject. binomial.h leaves p > 1 - conf in; with conf = 1 - alpha the limit 1 - conf
// is off from alpha by a rounding, so the region's edges are asked again.
static struct stat_region accepted(int64_t n, double p0, double alpha)
{
    struct stat_region region = stat_null_region(n, p0, 1 - alpha, STAT_TWO_SIDED);
    while (region.low <= region.high && stat_binomial_p(region.low, n, p0, STAT_TWO_SIDED) <= alpha)
        region.low++;
    while (region.low <= region.high && stat_binomial_p(region.high, n, p0, STAT_TWO_SIDED) <= alpha)
        region.high--;
    return region;
}

static double outside(struct stat_region region, int64_t n, double p)
{
    return pbinom((double)region.low - 1, (double)n, p, true, false) +
           pbinom((double)region.high, (double)n, p, false, false);
}

double stat_binomial_power(int64_t n, double p0, double p, double alpha)
{
    if (!n_ok(n) || !(p0 >= 0 && p0 <= 1) || !(p >= 0 && p <= 1) || !levels_ok(alpha, 0.5))
        return (double)NAN;
    return outside(accepted(n, p0, alpha), n, p);
}

double stat_binomial_detectable(int64_t n, double alpha, double power)
{
    if (!n_ok(n) || !levels_ok(alpha, power))
        return (double)NAN;
    struct stat_region region = accepted(n, 0.5, alpha);
    if (region.high >= n)
        return (double)NAN; // not even n of n rejects
    double low = 0.5, high = 1;
    for (int i = 0; i < BISECTIONS; i++) {
        double middle = low + (high - low) / 2;
        if (outside(region, n, middle) >= power)
            high = middle;
        else
            low = middle;
    }
    return high;
}

// P(c <= K <= n - c) at one half.
static double between(int64_t c, int64_t n)
{
    return 1 - 2 * pbinom((double)c - 1, (double)n, 0.5, true, false);
}

double stat_binomial_margin(int64_t n, double alpha, double power)
{
    if (!n_ok(n) || !levels_ok(alpha, power))
        return (double)NAN;
    int64_t low = 0, high = n / 2; // the largest c that has the power
    while (low < high) {
        int64_t middle = low + (high - low + 1) / 2;
        if (between(middle, n) >= power)
            low = middle;
        else
            high = middle - 1;
    }
    // c = 0 rejects nothing, and with it no margin is wide enough
    return low == 0 ? (double)NAN : 0.5 - stat_clopper_pearson(low, n, 1 - alpha, STAT_GREATER).low;
}

// ncp = d x root(effective n)
static double t_power(double df, double ncp, double alpha)
{
    double limit = qt(alpha / 2, df, false, false);
    return pnt(limit, df, ncp, false, false) + pnt(-limit, df, ncp, true, false);
}

static double t_detectable(double df, double scale, double alpha, double power)
{
    const double most = 37.6;
    double low = 0, high = most / scale;
    if (!levels_ok(alpha, power) || t_power(df, most, alpha) < power)
        return (double)NAN;
    if (t_power(df, 0, alpha) >= power)
        return 0;
    for (int i = 0; i < BISECTIONS; i++) {
        double middle = low + (high - low) / 2;
        if (t_power(df, middle * scale, alpha) >= power)
            high = middle;
        else
            low = middle;
    }
    return high;
}

double stat_paired_t_power(int64_t n, double d, double alpha)
{
    if (n < 2 || !n_ok(n) || !isfinite(d) || !levels_ok(alpha, 0.5))
        return (double)NAN;
    return t_power((double)n - 1, fabs(d) * sqrt((double)n), alpha);
}

double stat_paired_t_detectable(int64_t n, double alpha, double power)
{
    return n < 2 || !n_ok(n) ? (double)NAN : t_detectable((double)n - 1, sqrt((double)n), alpha, power);
}

static double pooled(int64_t n_x, int64_t n_y)
{
    return sqrt((double)n_x * (double)n_y / ((double)n_x + (double)n_y));
}

double stat_two_sample_t_power(int64_t n_x, int64_t n_y, double d, double alpha)
{
    if (n_x < 2 || n_y < 2 || !n_ok(n_x) || !n_ok(n_y) || !isfinite(d) || !levels_ok(alpha, 0.5))
        return (double)NAN;
    return t_power((double)(n_x + n_y - 2), fabs(d) * pooled(n_x, n_y), alpha);
}

double stat_two_sample_t_detectable(int64_t n_x, int64_t n_y, double alpha, double power)
{
    if (n_x < 2 || n_y < 2 || !n_ok(n_x) || !n_ok(n_y))
        return (double)NAN;
    return t_detectable((double)(n_x + n_y - 2), pooled(n_x, n_y), alpha, power);
}
