// Pearson's chi-squared test of independence.
//
// Assumes that every count is another person: one answer each. For several answers of a person see exchange.h,
// for the same people under both conditions mcnemar.h and cochran.h.
#ifndef ANALYSIS_STATS_CHI_SQUARED_H
#define ANALYSIS_STATS_CHI_SQUARED_H

#include "analysis/stats/counts_table.h"

struct stat_chi_squared {
    double statistic, df, p_value;
    double corrected, p_corrected; // Yates, 2 x 2 only, else NaN
    double least_expected;         // below 5 the approximation is doubtful: fisher.h
};

// All NaN for negative counts, none at all or more than STAT_COUNTS_MAX_N, and where a row or column is empty.
struct stat_chi_squared stat_chi_squared_test(struct stat_counts table);

#endif
