// Whether a cell's preference lies within a margin of one half (of choices.p0), by what the data permit: two
// one-sided exact binomial tests of one answer each, two one-sided t-tests of the people's shares else.
#ifndef ANALYSIS_REPORT_CHOICE_EQUIVALENCE_H
#define ANALYSIS_REPORT_CHOICE_EQUIVALENCE_H

#include "analysis/report/choices.h"
#include "analysis/stats/equivalence.h"

// margin as in equivalence.h; 1 - choices.conf must lie below one half. NaN where there is nothing to test.
struct stat_equivalence choice_equivalence(const struct choices *choices, const struct choice_cell *cell,
                                           double margin);
// What both tests together show, "not estimable" where there is no p. `p_difference`: of the cell's own test.
const char *choice_equivalence_words(double p_difference, const struct stat_equivalence *equivalence,
                                     double alpha);
const char *choice_equivalence_method(const struct choice_cell *cell); // "" where nobody answered

#endif
