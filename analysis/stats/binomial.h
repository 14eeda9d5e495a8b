// Exact binomial test, mid-p, intervals and null region of k successes in n.
//
// Use: one call of stat_binomial_test(); the parts are there for those who need one of them.
// n is 1 to STAT_BINOMIAL_MAX_N and 0 <= k <= n; p0, the probability under the null hypothesis, is in [0, 1];
// conf is in (0, 1). Anything else gives NaN, and the empty region (1, 0). Assumes that the n answers are
// independent: one answer per person. It cannot see whether they are.
#ifndef ANALYSIS_STATS_BINOMIAL_H
#define ANALYSIS_STATS_BINOMIAL_H

#include "analysis/stats/alternative.h"

#include <stdint.h>

#define STAT_BINOMIAL_MAX_N INT64_C(1000000000)

struct stat_interval {
    double low, high;
};

struct stat_region {
    int64_t low, high; // both inside; empty where low > high
};

struct stat_binomial {
    int64_t k, n;
    double p0;
    double p_value;
    double log_p;            // natural logarithm of p; finite where p itself is too small for a double
    double estimate;         // k / n
    struct stat_interval ci; // Clopper-Pearson
    struct stat_region null_region;
};

double stat_binomial_p(int64_t k, int64_t n, double p0, enum stat_alternative alternative);
// Natural logarithm of the same; -infinity only where p is exactly 0, which p0 = 0 and 1 alone can do.
double stat_binomial_log_p(int64_t k, int64_t n, double p0, enum stat_alternative alternative);
// Half of what is as probable as k and all that is less: 0.0347 for 6 of 22. Does not keep its level for
// certain.
double stat_binomial_mid_p(int64_t k, int64_t n, double p0, enum stat_alternative alternative);

// Intervals; one-sided forms reach to 0 (less) or to 1 (greater). Clopper and Pearson's covers at least conf,
// for every probability; Wilson's and Jeffreys' cover conf on average and are shorter. With k = 0 the lower
// bound is 0, with k = n the upper one is 1.
struct stat_interval stat_clopper_pearson(int64_t k, int64_t n, double conf, enum stat_alternative alternative);
struct stat_interval stat_wilson(int64_t k, int64_t n, double conf, enum stat_alternative alternative);
struct stat_interval stat_jeffreys(int64_t k, int64_t n, double conf, enum stat_alternative alternative);

// Smallest and largest k with p > 1 - conf for the same alternative: 6 to 16 for n 22, p0 0.5, conf 0.95.
struct stat_region stat_null_region(int64_t n, double p0, double conf, enum stat_alternative alternative);

struct stat_binomial stat_binomial_test(int64_t k, int64_t n, double p0, double conf,
                                        enum stat_alternative alternative);

#endif
