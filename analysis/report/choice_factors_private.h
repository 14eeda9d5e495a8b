// Shared by choice_factors*.c only.
#ifndef ANALYSIS_REPORT_CHOICE_FACTORS_PRIVATE_H
#define ANALYSIS_REPORT_CHOICE_FACTORS_PRIVATE_H

#include "analysis/report/choice_factors.h"

struct factor_set {
    const struct choice_cell *cells[CHOICE_FACTOR_LEVELS]; // in the order of their levels
    size_t count, level;                                   // the index of the level in which they differ
    struct choice_design design;
};

// People's answers at some levels of a set.
struct factor_people {
    size_t people, levels;
    size_t left_out;
    bool several;               // somebody who is not left out answered twice at one level
    struct stat_person *counts; // level after level, `people` of them each; n is 0 where there is no answer
    bool *stray;                // of factor_people_all(): answered at several levels of a set between people
};

// Everybody with an answer at a level of the set; nobody is left out yet. False where memory ran out.
bool factor_people_all(struct factor_people *out, const struct factor_set *set);
// Those of `all` whom a test of these levels takes: `count` indices in `levels`. The others are counted if they
// answered at one of them. False where memory ran out.
bool factor_people_take(struct factor_people *out, const struct factor_people *all, bool within,
                        const size_t *levels, size_t count);
void factor_people_free(struct factor_people *people);
const struct stat_person *factor_people_at(const struct factor_people *people, size_t level);

// Fill the numbers of a test whose words stand, or why there are none; false where memory ran out.
bool factor_test_between(struct choice_factor_test *test, const struct factor_people *people, double conf);
bool factor_test_within(struct choice_factor_test *test, const struct factor_people *people, double conf);

#endif
