// Exact sign-flip test of values that are no counts: one per person, symmetric about 0 under the null
// hypothesis.
//
// Each value may then change its sign, whatever its size: the sum is held against the sums of all 2^n signs.
// Sums that are apart by less than 1e-10 of the sum of all sizes count as ties, for rounding must not decide.
// NaN for no value, for one that is not finite, and for more than STAT_FLIP_VALUES, where the t-test does as
// well. Two-sided.
#ifndef ANALYSIS_STATS_SIGNFLIP_VALUES_H
#define ANALYSIS_STATS_SIGNFLIP_VALUES_H

#include <stddef.h>

enum { STAT_FLIP_VALUES = 36 }; // 2^18 sums in each half

struct stat_flip_values {
    size_t n, uneven; // values; those that are not 0: only their signs matter
    double p_value;
    double least_p; // the smallest p that these sizes could give, had all the same sign
};

struct stat_flip_values stat_signflip_values(const double *values, size_t n);

#endif
