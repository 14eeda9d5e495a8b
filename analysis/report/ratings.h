// Ratings, by how they were asked: before and after in two orders (here), both options of a trial
// (rating_options.h), over crossed factors (factorial.h).
//
// Before and after: two ratings per person, the comparison of Franke 2021, section 8.2.
//
// Of each question, the two ratings of different conditions that a rate block and its complement ask make a
// pair. People are grouped by which condition came first; several sittings of a person in one order are
// averaged. First ratings are compared between the two groups by Welch's t-test (what people say before they
// have learned to see a difference); second minus first is tested within each group by a paired t-test. The two
// groups are never pooled: their differences have opposite meanings and would cancel.
//
// The order is that in which a person saw the options. A flagged trial comes again after all others: where it
// was the first one, its option was seen before the other, and what counts was rated after both had been seen,
// also where the second one was flagged and comes again after it (late_first.h). Such a pair has no first
// rating, belongs to neither order and is left out (`late_first`); a second trial that alone comes again
// changes no order.
#ifndef ANALYSIS_REPORT_RATINGS_H
#define ANALYSIS_REPORT_RATINGS_H

#include "analysis/report/factorial.h"
#include "analysis/report/rating_options.h"
#include "analysis/report/sample.h"
#include "analysis/stats/effect.h"
#include "analysis/stats/moments.h"
#include "analysis/stats/ttest.h"
#include "analysis/stats/wilcoxon.h"

struct rating_group {
    size_t first_condition, second_condition;
    size_t n;               // people
    double *first, *second; // of each, the mean over sittings
    double *change_of;      // of each, second minus first, equal where their sums are
    size_t *person;
    double *sittings;
    struct stat_moments first_of, second_of;
    struct stat_ttest change;           // second minus first, paired; NaN where all changes are equal or n < 2
    struct stat_wilcoxon rank;          // of the same changes
    struct stat_effect effect, average; // d_z and d_av of the same
};

struct rating_question {
    const char *question;
    double scale_min, scale_max;
    size_t group_count;
    struct rating_group *groups;
    bool overlap;  // somebody is in both of two groups
    bool compared; // exactly two groups, nobody in both: `first_between` is group 0 minus group 1
    struct stat_ttest first_between;
    struct stat_effect between_effect; // in the pooled SD
    int64_t unpaired;                  // sessions with a rating and no pair
    int64_t late_first; // sessions whose rating planned as the first was given after both were seen
};

struct ratings {
    double conf;
    size_t question_count;
    struct rating_question *questions;
    int64_t used; // ratings in pairs
    struct rating_options_list options;
    struct factorial_list factorials;
    // Ratings left out; `not_finite` are NaN or infinite, which no program of ours writes.
    int64_t not_done, other_kinds, excluded, no_condition, more, not_finite;
};

// `pratt`: signed-rank tests rank zeros before they drop them.
bool ratings_load(struct ratings *out, struct sample *sample, double conf, bool pratt, char *error,
                  size_t error_size);
void ratings_free(struct ratings *ratings);
bool ratings_any(const struct ratings *ratings); // whether there is anything to show

#endif
