// Whether a factor lies within or between people: by the design, not by who happened to answer.
//
// A session's planned trials are stored together before the first is shown, so that what a person was to answer
// is known of everybody, however few answers came of it: of a factor with `between: yes` a session plans one
// level. Cells that are the same but for one factor's level are a set. Where at least half of the people were
// to answer at several of its levels, the factor lies within people, else between them; one person with two
// sittings at different levels, or many who stopped early, change nothing.
#ifndef ANALYSIS_REPORT_CHOICE_DESIGN_H
#define ANALYSIS_REPORT_CHOICE_DESIGN_H

#include "analysis/report/choices.h"

struct choice_design {
    bool within;
    size_t one, several; // people who were to answer at one level of the set, and at several
};

// Whether two cells of one block are the same but for the level with the index `of`; that may be the same too.
bool choice_same_but(const struct choice_cell *a, const struct choice_cell *b, size_t of);

// Of the set of cells[cell] for the factor of its levels[level]. False where memory ran out.
bool choice_design(const struct choices *choices, size_t cell, size_t level, struct choice_design *out);

#endif
