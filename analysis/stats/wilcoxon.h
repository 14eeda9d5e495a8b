// Wilcoxon's signed-rank test with the Hodges-Lehmann estimate.
//
// Use: stat_wilcoxon() of one sample, or of the differences of pairs. Assumes differences that are independent
// and, under the null hypothesis, symmetric about `mean`. Exact whatever ties there are, for up to
// STAT_WILCOXON_EXACT differences that are not zero; beyond it the normal approximation with correction for
// ties and continuity, and `exact` is false. Two-sided p is twice the smaller tail, at most 1, as wilcox.test
// of R. NaN for no value, a value that is not finite or a conf outside (0, 1); p is NaN too where all
// differences are zero. Differences tie where they are the same double.
#ifndef ANALYSIS_STATS_WILCOXON_H
#define ANALYSIS_STATS_WILCOXON_H

#include "analysis/stats/alternative.h"

#include <stdbool.h>
#include <stddef.h>

enum { STAT_WILCOXON_EXACT = 500 };

struct stat_wilcoxon_options {
    double mean; // under the null hypothesis; 0 by default
    double conf; // 0 means 0.95
    enum stat_alternative alternative;
    bool pratt; // zeros take their ranks along before they are dropped; else they are dropped first
};

struct stat_wilcoxon {
    size_t n;         // differences that are not zero
    size_t zeros;     // dropped
    double statistic; // V, the sum of the ranks of positive differences
    double p_value;
    bool exact;
    double estimate; // the median of all averages of two values, each with itself too; of zeros as well
    // Of the estimate: holds its confidence or more, with ties too. Infinite where n is too small for it. Zeros
    // widen it and are no part of the test, so it may reach 0 where the test rejects 0.
    double ci_low, ci_high;
};

// `options` may be NULL: all defaults.
struct stat_wilcoxon stat_wilcoxon(const double *x, size_t n, const struct stat_wilcoxon_options *options);
// Of the differences x - y.
struct stat_wilcoxon stat_wilcoxon_paired(const double *x, const double *y, size_t n,
                                          const struct stat_wilcoxon_options *options);

#endif
