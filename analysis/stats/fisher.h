// Fisher's exact test of independence: what the table's margins leave open.
//
// Assumes one answer of each person, as chi_squared.h.
#ifndef ANALYSIS_STATS_FISHER_H
#define ANALYSIS_STATS_FISHER_H

#include "analysis/stats/alternative.h"
#include "analysis/stats/binomial.h"
#include "analysis/stats/counts_table.h"

enum {
    STAT_FISHER_MAX_N = 100000,     // people in a table; 2 x 2 with interval takes about 0.5 s there
    STAT_FISHER_MAX_STEPS = 5000000 // columns tried for larger tables, a second or two
};

struct stat_fisher {
    double p_value;
    double odds_ratio; // conditional maximum likelihood; 0 or infinite at the ends of what the margins allow
    struct stat_interval ci; // of the odds ratio, by the two one-sided tests; 0 and infinity included
};

// counts: a b c d, the rows of a 2 x 2 table. `greater` is an odds ratio above 1. NaN for negative counts, none
// at all or more than STAT_FISHER_MAX_N; an empty row or column has p = 1, no odds ratio and the interval 0 to
// infinity.
struct stat_fisher stat_fisher_2x2(const int64_t counts[4], double conf, enum stat_alternative alternative);

// p of a table of any size: tables no more probable than this one. NaN for bad counts and where
// STAT_FISHER_MAX_STEPS are not enough: then permute people (people.h).
double stat_fisher_p(struct stat_counts table);

#endif
