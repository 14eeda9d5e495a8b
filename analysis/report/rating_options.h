// Both options of a trial, rated after the choice: test less reference, per cell, paired within people.
//
// A person's ratings in one cell are averaged, so that a person counts once however often a cell was asked.
#ifndef ANALYSIS_REPORT_RATING_OPTIONS_H
#define ANALYSIS_REPORT_RATING_OPTIONS_H

#include "analysis/report/sample.h"
#include "analysis/stats/effect.h"
#include "analysis/stats/moments.h"
#include "analysis/stats/ttest.h"
#include "analysis/stats/wilcoxon.h"

struct rating_option_cell {
    const char *block, *factors; // the factors' JSON text
    size_t test, reference;      // conditions
    int64_t trials;
    size_t n; // people
    size_t *person;
    double *count, *test_value, *reference_value; // per person; sums until rating_options_finish()
    struct stat_moments test_of, reference_of;
    struct stat_ttest difference; // test less reference; NaN where all differences are equal or n < 2
    struct stat_wilcoxon rank;
    struct stat_effect effect, average; // d_z and d_av
    double p_holm;                      // of the t-test, over the cells of the question
    bool name_block;                    // other cells of the question are of other blocks
};

struct rating_options {
    const char *question;
    double scale_min, scale_max;
    size_t cell_count;
    struct rating_option_cell *cells;
};

// The first of two ratings of a trial while the second is waited for. All zero at first.
struct rating_options_open {
    int64_t trial_id; // 0: none
    size_t question;  // index
    char subject;
    size_t condition;
    double value;
};

struct rating_options_list {
    size_t count;
    struct rating_options *items;
    int64_t used, unpaired; // ratings
};

// Takes the next rating with subject 't' or 'r'. False where memory ran out.
bool rating_options_add(struct rating_options_list *list, struct sample *sample,
                        struct rating_options_open *open, const struct store_rating_row *row, size_t person,
                        size_t condition);
// After the last rating of a file.
void rating_options_close(struct rating_options_list *list, struct rating_options_open *open);
// False where memory ran out.
bool rating_options_finish(struct rating_options_list *list, double conf, bool pratt);
// "pairs: epsilon 0.2", for a reader; the block where there are several, or no factor.
void rating_option_words(const struct sample *sample, const struct rating_option_cell *cell, char out[384]);
void rating_options_free(struct rating_options_list *list);

#endif
