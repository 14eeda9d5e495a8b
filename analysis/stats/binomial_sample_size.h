// How many people a planned binomial test needs.
#ifndef ANALYSIS_STATS_BINOMIAL_SAMPLE_SIZE_H
#define ANALYSIS_STATS_BINOMIAL_SAMPLE_SIZE_H

#include <stdint.h>

struct stat_sample_size {
    int64_t first; // the smallest n whose power reaches the wanted one
    int64_t stays; // the smallest n from which on every larger n has it: power is a saw, and some n > first
                   // have less
};

// For the exact two-sided test of p0 at alpha where p is true (power.h: stat_binomial_power). p0 and p in [0,
// 1], alpha and power in (0, 1). Both are 0 for anything else, and where so many may be needed that more than
// STAT_POWER_MAX_N sizes would have to be looked at (p within about 0.003 of p0). Takes about 5 us a size
// looked at.
struct stat_sample_size stat_binomial_sample_size(double p0, double p, double alpha, double power);

#endif
