// Whether a cell's preference lies within a margin of one half (of choices.p0), by what the data permit: two
// one-sided exact binomial tests of one answer each, two one-sided t-tests of the people's shares else.
//
// What the protocol planned is claimed once: such a cell has the adjusted p and the verdict of the planned
// analyses (planned.h). All other cells are one family, of their tests of a difference and of equality
// together. No difference and a difference beyond the margin exclude each other, so that a cell counts once
// (stats/multiple.h) where the test of a difference is two-sided.
#ifndef ANALYSIS_REPORT_CHOICE_EQUIVALENCE_H
#define ANALYSIS_REPORT_CHOICE_EQUIVALENCE_H

#include "analysis/report/choices.h"
#include "analysis/report/planned.h"
#include "analysis/stats/equivalence.h"

// margin as in equivalence.h; 1 - choices.conf must lie below one half. NaN where there is nothing to test.
struct stat_equivalence choice_equivalence(const struct choices *choices, const struct choice_cell *cell,
                                           double margin);

struct choice_equality {
    struct stat_equivalence test;
    bool planned;            // the family of both: the planned analyses, else the cells that were not planned
    double difference, holm; // Holm's p of the test of a difference and of equality, in that family
};

// The same of every cell: choices.cell_count, which the caller frees. `planned`: of the same sample and
// confidence; NULL: nothing was. Its rows hold where they test the same margin about the same preference.
// `right`: cells of questions with a right answer too, which are NaN otherwise. NULL where memory ran out.
struct choice_equality *choice_equalities(const struct choices *choices, const struct planned *planned,
                                          double margin, bool right);
// What the tests of a difference and of equality show together, both by Holm's p. "not estimable" where there
// is no p.
const char *choice_equivalence_words(const struct choice_equality *equality, double alpha);
const char *choice_equivalence_method(const struct choice_cell *cell); // "" where nobody answered

#endif
