// Intervals for a binomial probability.
//   Clopper, C. J. & Pearson, E. S. (1934), Biometrika 26, 404-413: beta quantiles.
//   Wilson, E. B. (1927), Journal of the American Statistical Association 22, 209-212: the score test inverted,
//   no continuity correction, as prop.test(correct = FALSE) of R. The smaller root is the product of both over
//   the larger, since their difference loses digits where k is small. Jeffreys: quantiles of Beta(k + 1/2, n -
//   k + 1/2), moved to 0 for k = 0 and to 1 for k = n: Brown, L. D., Cai, T. T. & DasGupta, A. (2001),
//   Statistical Science 16, 101-133, section 4.1.2.
#include "analysis/stats/binomial_private.h"

#include <Rmath.h>
#include <math.h>

typedef double (*bound_fn)(int64_t k, int64_t n, double tail);

// Quantiles at `tail` from the bound's own end: 1 - tail would lose the digits of a small tail.
static double clopper_low(int64_t k, int64_t n, double tail)
{
    return k == 0 ? 0 : qbeta(tail, (double)k, (double)(n - k + 1), true, false);
}

static double clopper_high(int64_t k, int64_t n, double tail)
{
    return k == n ? 1 : qbeta(tail, (double)(k + 1), (double)(n - k), false, false);
}

static double wilson_larger(double x, double n, double z)
{
    double e = x / n;
    return (e + z * z / (2 * n) + z * sqrt(e * (1 - e) / n + z * z / (4 * n * n))) / (1 + z * z / n);
}

static double wilson_low(int64_t k, int64_t n, double tail)
{
    double z = qnorm(tail, 0, 1, false, false), x = (double)k, size = (double)n;
    if (k == 0)
        return 0;
    if (z < 0) // one-sided, below one half: beyond the estimate
        return wilson_larger(x, size, -z);
    return x / size * (x / size) / ((1 + z * z / size) * wilson_larger(x, size, z));
}

static double wilson_high(int64_t k, int64_t n, double tail)
{
    double z = qnorm(tail, 0, 1, false, false), x = (double)k, size = (double)n;
    if (k == n)
        return 1;
    if (z < 0)
        return 1 - wilson_larger(size - x, size, -z);
    return wilson_larger(x, size, z);
}

static double jeffreys_low(int64_t k, int64_t n, double tail)
{
    return k == 0 ? 0 : qbeta(tail, (double)k + 0.5, (double)(n - k) + 0.5, true, false);
}

static double jeffreys_high(int64_t k, int64_t n, double tail)
{
    return k == n ? 1 : qbeta(tail, (double)k + 0.5, (double)(n - k) + 0.5, false, false);
}

static struct stat_interval interval(int64_t k, int64_t n, double conf, enum stat_alternative alternative,
                                     bound_fn low, bound_fn high)
{
    if (!binomial_counts_ok(k, n) || !binomial_conf_ok(conf))
        return (struct stat_interval){(double)NAN, (double)NAN};
    switch (alternative) {
    case STAT_LESS:
        return (struct stat_interval){0, high(k, n, 1 - conf)};
    case STAT_GREATER:
        return (struct stat_interval){low(k, n, 1 - conf), 1};
    case STAT_TWO_SIDED:
        break;
    }
    return (struct stat_interval){low(k, n, (1 - conf) / 2), high(k, n, (1 - conf) / 2)};
}

struct stat_interval stat_clopper_pearson(int64_t k, int64_t n, double conf, enum stat_alternative alternative)
{
    return interval(k, n, conf, alternative, clopper_low, clopper_high);
}

struct stat_interval stat_wilson(int64_t k, int64_t n, double conf, enum stat_alternative alternative)
{
    return interval(k, n, conf, alternative, wilson_low, wilson_high);
}

struct stat_interval stat_jeffreys(int64_t k, int64_t n, double conf, enum stat_alternative alternative)
{
    return interval(k, n, conf, alternative, jeffreys_low, jeffreys_high);
}
