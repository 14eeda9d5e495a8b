// Shared by choice_factors*.c only.
#ifndef ANALYSIS_REPORT_CHOICE_FACTORS_PRIVATE_H
#define ANALYSIS_REPORT_CHOICE_FACTORS_PRIVATE_H

#include "analysis/report/choice_factors.h"

enum { FACTOR_LEVELS = 16 }; // as a protocol permits, and exchange.h

struct factor_set {
    const struct choice_cell *cells[FACTOR_LEVELS]; // in the order of their levels
    size_t count, level;                            // the index of the level in which they differ
    bool within, several; // somebody answered at two levels; somebody answered twice at one
    size_t most;          // people, each counted once per level
};

// A person's answers in a cell; NULL where there are none.
const struct stat_person *factor_counts(const struct choice_cell *cell, size_t person);

// Fill the numbers of a test whose words stand; false where memory ran out.
bool factor_test_between(struct choice_factor_test *test, const struct factor_set *set, double conf);
bool factor_test_within(struct choice_factor_test *test, const struct factor_set *set, double conf);

#endif
