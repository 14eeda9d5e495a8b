// Standardised differences of means: Cohen's d, Hedges' correction, confidence intervals.
//
// conf is in (0, 1). NaN where the t-test has none: too few values, one not finite, no spread.
#ifndef ANALYSIS_STATS_EFFECT_H
#define ANALYSIS_STATS_EFFECT_H

#include <stddef.h>

struct stat_effect {
    double d;
    double g;               // d less its bias; NaN for df < 2
    double df;              // of the standard deviation
    double ci_low, ci_high; // of the population's d
};

// (mean - mean0) / SD. Exact interval.
struct stat_effect stat_effect_one_sample(const double *x, size_t n, double mean0, double conf);
// d_z: the mean of x - y in the SD of the differences. Exact interval.
struct stat_effect stat_effect_paired(const double *x, const double *y, size_t n, double conf);
// d_av: the same mean in the average of the two SDs, comparable with unpaired studies. Its interval is
// approximate: that of d_z in another unit.
struct stat_effect stat_effect_average(const double *x, const double *y, size_t n, double conf);
// The difference of two means in their pooled SD. Exact interval where both have one SD.
struct stat_effect stat_effect_two_samples(const double *x, size_t n_x, const double *y, size_t n_y,
                                           double conf);

// Hedges' factor J: g = J d. NaN for df < 2.
double stat_hedges_factor(double df);

#endif
