// Cochran's Q: whether several yes-or-no answers of the same people differ between conditions.
#ifndef ANALYSIS_STATS_COCHRAN_H
#define ANALYSIS_STATS_COCHRAN_H

#include "analysis/stats/permutation.h"

#include <stddef.h>

enum { STAT_COCHRAN_CONDITIONS = 64, STAT_COCHRAN_PEOPLE = 100000 };

struct stat_cochran {
    double statistic, df, p_value; // chi-squared, for many people
    struct stat_permutation
        permutation; // of each person's answers among the conditions: holds for few people too
};

// answers: 0 or 1, a person's conditions side by side, `conditions` of them (2 to STAT_COCHRAN_CONDITIONS);
// every person answered all. All NaN for anything else and where every person gave one answer to all
// conditions.
struct stat_cochran stat_cochran_q(const unsigned char *answers, size_t people, size_t conditions,
                                   struct stat_permuting how);

#endif
