// Mean and standard deviation.
//
// NaN where undefined: no values for the mean, fewer than two for the others, or any value not finite.
#ifndef ANALYSIS_STATS_MOMENTS_H
#define ANALYSIS_STATS_MOMENTS_H

#include <stddef.h>

struct stat_moments {
    size_t n;
    double mean;
    double sd;        // of the sample, n - 1; 0 also where values differ by rounding only, 10 / 2^52 of them
    double std_error; // sd / sqrt(n)
};

struct stat_moments stat_moments(const double *values, size_t n);

// The same of the values less `origin`: near 0 where the values lie about it, so no digit of a small difference
// between large numbers is lost.
struct stat_moments stat_moments_about(const double *values, size_t n, double origin);

#endif
