// Student's and Welch's t-tests with confidence intervals.
//
// conf is in (0, 1). NaN for too few values (two per sample), a value that is not finite, a conf outside (0,
// 1), or a standard error of 0: constant data have no t, which is not the same as a small p.
#ifndef ANALYSIS_STATS_TTEST_H
#define ANALYSIS_STATS_TTEST_H

#include "analysis/stats/alternative.h"

#include <stddef.h>

struct stat_ttest {
    double estimate; // the mean, or the difference of means
    double t, df, p_value;
    double ci_low, ci_high; // of the estimate; one-sided forms reach to -/+ infinity
    double std_error;       // of the estimate
};

struct stat_ttest_options {
    double mean;                       // under the null hypothesis (of the difference); 0 by default
    double conf;                       // 0 means 0.95
    enum stat_alternative alternative; // two-sided by default
};

// `options` may be NULL: all defaults.
struct stat_ttest stat_ttest_one_sample(const double *x, size_t n, const struct stat_ttest_options *options);

// Of the differences x - y, which must be pairs in the same order.
struct stat_ttest stat_ttest_paired(const double *x, const double *y, size_t n,
                                    const struct stat_ttest_options *options);

// Of mean x - mean y of independent samples with variances of their own.
struct stat_ttest stat_ttest_welch(const double *x, size_t n_x, const double *y, size_t n_y,
                                   const struct stat_ttest_options *options);

#endif
