// Small studies of one factor "a" with levels 1 to 3, one answer each or between people, as cells in memory.
#ifndef TESTS_ANALYSIS_FACTOR_STUDY_H
#define TESTS_ANALYSIS_FACTOR_STUDY_H

#include "analysis/report/choice_factors.h"

enum { FACTOR_STUDY_PEOPLE = 30, FACTOR_STUDY_LEVELS = 3 };

struct factor_study {
    struct choices choices;
    struct choice_cell cells[FACTOR_STUDY_LEVELS];
    struct stat_person counts[FACTOR_STUDY_LEVELS][FACTOR_STUDY_PEOPLE];
    size_t persons[FACTOR_STUDY_LEVELS][FACTOR_STUDY_PEOPLE];
    size_t planned[FACTOR_STUDY_LEVELS][FACTOR_STUDY_PEOPLE];
};

// The studies of tests/reference/choice_factors.R, by name. Everybody with an answer was to give it, and within
// people everybody was to answer at every level.
void factor_study_make(struct factor_study *study, const char *name);
size_t factor_study_tests(const char *name); // how many tests it gives, pairs too
// A person who was to answer at a level, and one who did: k of n for the test option.
void factor_study_plan(struct factor_study *study, int person, int level);
void factor_study_answer(struct factor_study *study, int person, int level, int64_t k, int64_t n);
// Somebody who was to answer at all levels and did, n times each.
void factor_study_stray(struct factor_study *study, int person, int64_t n);

// Fails the test where there are not as many tests.
struct choice_factors factor_study_load(const struct factor_study *study, size_t tests);
// The test of a pair of levels, or of all three for "0"; fails the test where there is none.
const struct choice_factor_test *factor_study_find(const struct choice_factors *factors, const char *a,
                                                   const char *b);

#endif
