// Marginal densities known at even points of a coordinate: mean, SD, quantiles of what the coordinate stands
// for.
#ifndef ANALYSIS_STATS_MARGINAL_H
#define ANALYSIS_STATS_MARGINAL_H

#include "analysis/stats/psychometric_bayes.h"

enum stat_scale {
    STAT_SCALE_PLAIN,
    STAT_SCALE_LN,       // of the value
    STAT_SCALE_CUBE_ROOT // of the value over its largest
};

struct stat_even {
    const double *mass; // at the points, by any factor; half of it at the first and last
    double low, high;
    size_t points; // at most 64
    enum stat_scale scale;
    double end;                                           // STAT_SCALE_CUBE_ROOT: the largest value
    double (*prior)(const void *user, double coordinate); // density, by any factor
    const void *user;
};

// Mean and SD are sums over the points. Between these, ln of mass over prior is read by cubics through the four
// nearest, which is exact for a bell, times the prior. NaN for fewer than four points with mass.
struct stat_marginal stat_even_marginal(const struct stat_even *even, double conf);

#endif
