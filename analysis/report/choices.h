// How often the test option was chosen, cell by cell.
//
// A cell is one combination of block, factor levels and the two options compared. Counted are answers to trials
// of the kinds toggle and sequential that are done and not excluded: cells that the protocol planned. Test and
// reference are told apart through the store's test slot, whatever the sides were. Answers "equal" are counted
// apart and are not part of n. Of questions with a right answer the right ones are counted, in cells of their
// own.
//
// The test follows the data. Where nobody answered more than once, answers are independent however people
// differ: the exact binomial test, with Clopper and Pearson's interval. Where somebody did, people are what is
// independent: the exact sign-flip test against one half, the t-test of the people's shares against another
// preference, and the t interval of the shares. The binomial test of all answers is then kept as the papers
// have it, with how much the people's counts are overdispersed, and a logistic mixed model stands beside it. A
// person's cells are never joined; levels of a factor are compared person by person. Holm's p is adjusted for
// all cells with an answer.
#ifndef ANALYSIS_REPORT_CHOICES_H
#define ANALYSIS_REPORT_CHOICES_H

#include "analysis/report/sample.h"
#include "analysis/stats/binomial.h"
#include "analysis/stats/mixed_logit.h"
#include "analysis/stats/moments.h"
#include "analysis/stats/people.h"
#include "analysis/stats/signflip.h"

enum { CHOICE_LEVELS = 6 };

struct choice_level {
    const char *factor, *value;
    double number; // NaN for a word
};

enum choice_method { CHOICE_NONE, CHOICE_BINOMIAL, CHOICE_SIGN_FLIP, CHOICE_T };

struct choice_cell {
    const char *block, *factors; // factors: the JSON text
    size_t test, reference;      // conditions
    struct choice_level levels[CHOICE_LEVELS];
    size_t level_count;
    const char *label;   // its levels, or its options where there are none
    const char *options; // words that tell it from another cell of the same levels; NULL where there is none
    bool right;          // the question has a right answer: `chosen` counts those, not preferences
    bool name_block;     // other cells are of other blocks
    int64_t n, chosen;   // without "equal"; for the test option
    int64_t equal;
    bool several; // somebody answered more than once
    // The test that the data ask for; NaN where n is 0:
    enum choice_method method;
    double p_value, holm;
    double estimate; // chosen of n; where somebody answered more than once, the mean of the people's shares
    struct stat_interval ci;       // of the estimate; by t it may reach beyond 0 and 1
    bool clear;                    // p <= 1 - conf
    struct stat_binomial binomial; // all answers as if they were independent
    // Only where somebody answered more than once, else NaN:
    struct stat_signflip flip; // of one half
    struct stat_ttest t;       // of the people's shares
    double overdispersion;
    struct stat_mixed_logit mixed;
    struct stat_moments toggles; // of trials with something to switch; NaN where there is none
    double reaction_median_s;    // NaN where none was stored
    // One entry per person with an answer, "equal" too:
    size_t people;
    size_t *person;             // index in the sample
    struct stat_person *counts; // without "equal"
    int64_t *equals;            // "equal"
    // Who was to answer: people whose sessions planned trials of this cell, whatever became of them.
    size_t planned_count;
    size_t *planned; // indices in the sample, rising
    // Working arrays, one entry per answer:
    size_t answers;
    size_t toggled;
    double *toggle, *reaction_s;
    size_t reactions;
};

// Two levels of a factor within people (choice_design.h), of a set of cells in which somebody answered several
// times at a level, whichever: shares at level a minus those at level b in cells that are otherwise the same.
// All pairs of such a set.
struct choice_contrast {
    const char *block, *factor, *a, *b;
    size_t cell_pairs;   // of them the mean
    size_t people;       // with answers at both levels
    struct stat_ttest t; // of the people's differences, two-sided against 0; NaN as in ttest.h
    double holm;         // adjusted for the pairs of levels of this factor
};

// What is tested. Zero is the default.
struct choices_desc {
    double conf;                       // of intervals and null regions, in (0, 1); 0 means 0.95
    double p0;                         // the preference under the null hypothesis, in (0, 1); 0 means 0.5
    enum stat_alternative alternative; // two-sided by default
};

struct choices {
    double conf, p0;
    enum stat_alternative alternative;
    size_t cell_count;
    struct choice_cell *cells; // by block, then levels: numbers falling, words rising
    size_t contrast_count;
    struct choice_contrast *contrasts;
    int64_t answers, equal; // in all cells; of them "equal"
    int64_t chosen_first, chosen_a;
    int64_t first_known;         // answers for an option of which it is known what was shown first
    struct stat_moments toggles; // over all such answers
    double reaction_median_s;
    // Left out, by the first reason that holds:
    int64_t not_done, excluded, no_test_slot, other_kinds;
    bool one_each, several; // any cell with answers of that kind
    size_t tested;          // cells with a p: what Holm's p is adjusted for
};

// False with a sentence. No answer at all is not an error here: cell_count is 0.
bool choices_load(struct choices *out, struct sample *sample, double conf, char *error, size_t error_size);
// The same against another preference, or one-sided.
bool choices_load_for(struct choices *out, struct sample *sample, const struct choices_desc *desc, char *error,
                      size_t error_size);
void choices_free(struct choices *choices);

// Fills what a cell's counts say; choices_load() does.
void choice_cell_test(struct choice_cell *cell, const struct choices_desc *desc);
bool choices_contrast(
    struct choices *choices); // fills the contrasts of sorted cells; false where memory ran out
const char *choice_method_word(enum choice_method method); // "binomial", "sign-flip", "t"; "" for none

#endif
