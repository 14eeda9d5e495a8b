// Whether k of n shows that a probability lies within a margin of p0: the test that "no difference" needs.
//
// A test of p0 that does not reject says nothing of the kind. Both tests together tell four cases apart.
#ifndef ANALYSIS_STATS_EQUIVALENCE_H
#define ANALYSIS_STATS_EQUIVALENCE_H

#include "analysis/stats/binomial.h"

struct stat_equivalence {
    double p_low;   // of p0 - margin or less, by P(K >= k)
    double p_high;  // of p0 + margin or more, by P(K <= k)
    double p_value; // the larger
    struct stat_interval
        ci; // Clopper and Pearson's with 1 - 2 alpha: within the margin exactly where p_value <= alpha
};

// k, n and p0 as in binomial.h; margin > 0 with p0 - margin >= 0 and p0 + margin <= 1; 0 < alpha < 0.5. NaN for
// anything else.
struct stat_equivalence stat_binomial_equivalence(int64_t k, int64_t n, double p0, double margin, double alpha);

enum stat_verdict {
    STAT_UNDECIDED,       // neither is shown; not a sign of equality
    STAT_DIFFERENT,       // a difference, and not shown to be within the margin
    STAT_WITHIN,          // within the margin
    STAT_DIFFERENT_WITHIN // a difference, though within the margin
};

// NaN shows nothing.
enum stat_verdict stat_verdict(double p_difference, double p_equivalence, double alpha);

#endif
