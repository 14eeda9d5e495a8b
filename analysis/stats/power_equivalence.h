// How often a planned study shows equivalence by the exact tests of equivalence.h, for one choice of each
// person.
#ifndef ANALYSIS_STATS_POWER_EQUIVALENCE_H
#define ANALYSIS_STATS_POWER_EQUIVALENCE_H

#include "analysis/stats/binomial_sample_size.h"

#include <stdint.h>

// How often two one-sided exact tests at alpha, of one half less and plus margin, both reject where p is true.
// margin in (0, 0.5], p in [0, 1], alpha in (0, 0.5), n as in power.h; NaN for anything else. 0 where no count
// of n rejects both.
double stat_binomial_equivalence_power(int64_t n, double margin, double p, double alpha);

// The people that it takes, `stays` within the first `most` sizes, which are all looked at. Both are 0 where
// the largest size has not the power or `stays` lies in the last tenth, and for bad input.
struct stat_sample_size stat_binomial_equivalence_size(double margin, double p, double alpha, double power,
                                                       int64_t most);

#endif
