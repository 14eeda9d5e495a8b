// Whether people's mean share lies within a margin of p0, where people answered several times.
//
// Two one-sided t-tests of the people's shares, each person counting the same. NaN where stat_people_t() has no
// t: fewer than two people, or all with the same share. For one answer each: equivalence.h, which is exact.
#ifndef ANALYSIS_STATS_PEOPLE_EQUIVALENCE_H
#define ANALYSIS_STATS_PEOPLE_EQUIVALENCE_H

#include "analysis/stats/equivalence.h"
#include "analysis/stats/people.h"

// margin > 0 with p0 - margin >= 0 and p0 + margin <= 1; 0 < alpha < 0.5; NaN for anything else. `ci` is the t
// interval with 1 - 2 alpha: within the margin exactly where p_value <= alpha.
struct stat_equivalence stat_people_equivalence(const struct stat_person *people, size_t count, double p0,
                                                double margin, double alpha);

#endif
