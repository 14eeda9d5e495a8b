// Exact sign-flip test of one half, for choices of several answers per person.
//
// Under the null hypothesis a person's count is as likely to be k of n as n - k of n, whatever people are like
// and however their own answers hang together; so each person's k - n / 2 may change its sign. The test is the
// sum of k - n / 2 over people against all 2^people signs. Other null preferences have no such symmetry: use
// stat_people_t().
// Counts are those of people.h. NaN for bad counts, for no person with an answer, and for more than
// STAT_SIGNFLIP_MAX_STEPS (people times answers, about), where the t-test does as well.
#ifndef ANALYSIS_STATS_SIGNFLIP_H
#define ANALYSIS_STATS_SIGNFLIP_H

#include "analysis/stats/alternative.h"
#include "analysis/stats/people.h"

enum { STAT_SIGNFLIP_MAX_STEPS = 1000000000 };

struct stat_signflip {
    size_t people;    // with an answer
    size_t uneven;    // of them, whose count is not n / 2: only their signs matter
    double statistic; // sum of k - n / 2
    double p_value;
    double least_p; // the smallest p that these people's counts could give, had all leaned the same way
};

struct stat_signflip stat_signflip(const struct stat_person *people, size_t count,
                                   enum stat_alternative alternative);

#endif
