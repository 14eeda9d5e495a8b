// Choices of several answers per person: the counts that signflip.h and mixed_logit.h take, their mean over
// people, and how much more they differ than independent answers would.
//
// A person with n = 0 is left out everywhere. Counts are 0 <= k <= n <= STAT_PEOPLE_MAX_N; a worse one gives
// NaN. p0, the preference under the null hypothesis, is in (0, 1), conf in (0, 1).
#ifndef ANALYSIS_STATS_PEOPLE_H
#define ANALYSIS_STATS_PEOPLE_H

#include "analysis/stats/ttest.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { STAT_PEOPLE_MAX_N = 1000000 };

struct stat_person {
    int64_t k, n; // answers for the option under test, of how many
};

struct stat_people {
    bool ok;                 // every count is
    size_t people;           // with n > 0
    int64_t k, n;            // summed
    int64_t least_n, most_n; // of one person; 0 where there are no people
};

struct stat_people stat_people_sum(const struct stat_person *people, size_t count);

// Student's t of the people's shares k / n, each person counting the same. NaN as in ttest.h: where fewer than
// two people answered, or all have the same share. The interval may reach beyond 0 and 1.
struct stat_ttest stat_people_t(const struct stat_person *people, size_t count,
                                const struct stat_ttest_options *options);
// The mean of the shares; NaN without people.
double stat_people_share(const struct stat_person *people, size_t count);

// Pearson's chi-squared of the people's counts over its degrees of freedom: 1 where answers are independent,
// more where people differ. NaN where it cannot be estimated: everybody answered once, fewer than two people,
// or all answers are the same.
double stat_overdispersion(const struct stat_person *people, size_t count);

#endif
