// Sample quantiles, type 7 of Hyndman & Fan: linear between order statistics, the default of R.
#ifndef ANALYSIS_STATS_QUANTILE_H
#define ANALYSIS_STATS_QUANTILE_H

#include <stddef.h>

// Sorts ascending in place, as stat_quantile() needs it. NaN has no order: leave such values out first.
void stat_sort(double *values, size_t n);

// `sorted` ascending; p in [0, 1]. NaN for no values or another p.
double stat_quantile(const double *sorted, size_t n, double p);

#endif
