// Whether a cell's preference lies within a margin of one half (of choices.p0), by what the data permit: two
// one-sided exact binomial tests of one answer each, two one-sided t-tests of the people's shares else.
#ifndef ANALYSIS_REPORT_CHOICE_EQUIVALENCE_H
#define ANALYSIS_REPORT_CHOICE_EQUIVALENCE_H

#include "analysis/report/choices.h"
#include "analysis/stats/equivalence.h"

// margin as in equivalence.h; 1 - choices.conf must lie below one half. NaN where there is nothing to test.
struct stat_equivalence choice_equivalence(const struct choices *choices, const struct choice_cell *cell,
                                           double margin);

struct choice_equality {
    struct stat_equivalence test;
    double holm;
};

// The same of every cell, with Holm's p over them: choices.cell_count, which the caller frees. `right`: cells
// of questions with a right answer too, which are NaN otherwise. NULL where memory ran out.
struct choice_equality *choice_equalities(const struct choices *choices, double margin, bool right);
// What the tests of difference and of equivalence show together, both by Holm's p over cells: a claim of
// equality is one of as many as there are cells. "not estimable" where there is no p.
const char *choice_equivalence_words(const struct choice_cell *cell, const struct choice_equality *equality,
                                     double alpha);
const char *choice_equivalence_method(const struct choice_cell *cell); // "" where nobody answered

#endif
