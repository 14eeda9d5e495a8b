// Independence of group and answer where people answered several times: groups of whole people are exchanged.
//
// The pooled chi-squared test takes answers of one person for answers of several and finds too much; this one
// does not.
#ifndef ANALYSIS_STATS_EXCHANGE_H
#define ANALYSIS_STATS_EXCHANGE_H

#include "analysis/stats/permutation.h"

#include <stddef.h>

enum { STAT_EXCHANGE_GROUPS = 16, STAT_EXCHANGE_CATEGORIES = 64, STAT_EXCHANGE_MOST = 100000 };

struct stat_groups_of_people {
    size_t people, groups, categories; // 2 to the above; groups and categories at least 2
    const int *group;                  // of each person, from 0 on; borrowed
    const int64_t *counts;             // a person's answers by category, person by person, 0 to 1e6; borrowed
};

// The statistic is Pearson's chi-squared of the pooled groups x categories table. NaN where a group or category
// has no answer, for anything out of range and where memory runs out. An arrangement in which a group has no
// answers at all (people without any) counts with the other groups' terms.
struct stat_permutation stat_exchange_test(const struct stat_groups_of_people *people,
                                           struct stat_permuting how);

#endif
