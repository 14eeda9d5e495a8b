// How much k successes in n speak for a probability that may be anything against one that is p0.
#ifndef ANALYSIS_STATS_BAYES_FACTOR_H
#define ANALYSIS_STATS_BAYES_FACTOR_H

#include <stdint.h>

// Natural logarithm of BF10: above 0 the data is more probable under a Beta(a, b) prior than under p0, below 0
// it speaks for p0. +infinity where p0 is 0 or 1 and the data rules it out. k and n as in binomial.h, p0 in [0,
// 1], a and b in (0, 1e9]; NaN for anything else.
double stat_binomial_log_bf10(int64_t k, int64_t n, double p0, double a, double b);

#endif
