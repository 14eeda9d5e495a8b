// How a permutation test is done, and what it gives.
#ifndef ANALYSIS_STATS_PERMUTATION_H
#define ANALYSIS_STATS_PERMUTATION_H

#include <stdbool.h>
#include <stdint.h>

struct stat_permuting {
    int64_t exact_most; // all arrangements are tried where there are no more than these; 0: 100,000, negative:
                        // never
    int64_t draws;      // else so many random ones, at most 1e9; 0: 100,000
    uint64_t seed;
};

struct stat_permutation {
    double statistic; // of the data
    double p_value;   // how often an arrangement's statistic is at least as large
    // Of p_value, 0 where every arrangement was tried. Random arrangements count the data's own as one of them,
    // so that p is never 0 and the test keeps its level.
    double standard_error;
    int64_t arrangements; // tried; 0 and NaN above for bad input
    bool exact;
};

struct stat_permuting stat_permuting_defaults(struct stat_permuting how); // with its zeros filled in

// Statistics that differ by rounding alone are equal: within 1e-9 of the data's own.
bool stat_permutation_reaches(double statistic, double data);
struct stat_permutation stat_permutation_done(double statistic, int64_t reached, int64_t arrangements,
                                              bool exact);
struct stat_permutation stat_permutation_none(void);

// 0 <= result < n, n at most 2^32; a function of seed and counter alone, so that a run repeats exactly.
uint32_t stat_permutation_below(uint64_t seed, uint64_t counter, uint32_t n);

#endif
