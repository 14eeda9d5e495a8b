// What the files of the binomial test share: which input counts, tails at any depth, edges by probability.
// n, k and p0 are not checked here but by those who ask.
#ifndef ANALYSIS_STATS_BINOMIAL_PRIVATE_H
#define ANALYSIS_STATS_BINOMIAL_PRIVATE_H

#include "analysis/stats/binomial.h"

#include <stdbool.h>

// Above it ln p is the logarithm of p: pbinom has all its digits there, and doubles lose theirs below 2.2e-308.
#define BINOMIAL_SHALLOW 1e-280

bool binomial_counts_ok(int64_t k, int64_t n);
bool binomial_probability_ok(double p0);
bool binomial_conf_ok(double conf);

// K <= low or K >= high.
struct binomial_tails {
    int64_t low, high;
};

// P(K <= k) and P(K >= k) for any whole k. In logarithms they do not run out of numbers.
double binomial_lower(int64_t k, int64_t n, double p0);
double binomial_upper(int64_t k, int64_t n, double p0);
double binomial_log_lower(int64_t k, int64_t n, double p0); // 0 < p0 < 1
double binomial_log_upper(int64_t k, int64_t n, double p0); // 0 < p0 < 1

// Both tails together, at most 1; tails that meet are everything.
double binomial_outside(struct binomial_tails tails, int64_t n, double p0);
double binomial_log_outside(struct binomial_tails tails, int64_t n, double p0);

// All j below n p0 and all above it with ln P(j) <= log_limit, for 0 < p0 < 1; `near` is about as far from n p0
// as they are, which only saves time.
int64_t binomial_low_edge(int64_t n, double p0, double log_limit, double near);
int64_t binomial_high_edge(int64_t n, double p0, double log_limit, double near);

#endif
