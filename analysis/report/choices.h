// How often the test option was chosen, cell by cell.
//
// A cell is one combination of block, factor levels and the two options compared. Counted are answers to trials
// of the kinds toggle and sequential that are done and not excluded. Test and reference are told apart through
// the store's test slot, whatever the sides were. The test is the exact binomial one against 0.5, two-sided. It
// takes answers as independent: true where a cell holds one answer per person. Where it holds more, the cell
// says `pooled`, and whoever prints it must too. Answers "equal" are counted apart and are not part of n.
#ifndef ANALYSIS_REPORT_CHOICES_H
#define ANALYSIS_REPORT_CHOICES_H

#include "analysis/report/sample.h"
#include "analysis/stats/binomial.h"
#include "analysis/stats/moments.h"

enum { CHOICE_LEVELS = 6 };

struct choice_level {
    const char *factor, *value;
    double number; // NaN for a word
};

struct choice_cell {
    const char *block, *factors; // factors: the JSON text
    size_t test, reference;      // conditions
    struct choice_level levels[CHOICE_LEVELS];
    size_t level_count;
    const char *label; // its levels, or its options where there are none
    int64_t n, chosen; // without "equal"; for the test option
    int64_t equal;
    int64_t persons;
    bool pooled;                  // more answers than persons
    struct stat_binomial test_of; // NaN where n is 0
    struct stat_moments toggles;
    double reaction_median_s; // NaN where none was stored
    // Working arrays, one entry per answer:
    size_t answers;
    size_t *person;
    double *toggle, *reaction_s;
    size_t reactions;
};

struct choices {
    double conf;
    size_t cell_count;
    struct choice_cell *cells; // by block, then levels: numbers falling, words rising
    int64_t answers;           // in all cells, "equal" too
    int64_t chosen_first, chosen_a;
    struct stat_moments toggles; // over all answers
    double reaction_median_s;
    // Left out, by the first reason that holds:
    int64_t not_done, excluded, no_test_slot, other_kinds;
    bool pooled; // any cell
};

// False with a sentence. No answer at all is not an error here: cell_count is 0.
bool choices_load(struct choices *out, struct sample *sample, double conf, char *error, size_t error_size);
void choices_free(struct choices *choices);

#endif
