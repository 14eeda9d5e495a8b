// Answers of three kinds, "first better", "equal", "second better", as Stengel et al. 2016, section 6.2 and
// Figure 7, report them: negative are those that preferred the reference, whatever was first.
//
// Each person counts the same: the net preference of a person is (test - reference) / all of the person's
// answers, from -1 (always the reference) to 1, and its mean over people has Student's t interval. The test is
// the exact sign flip of test minus reference, in which "equal" is a zero that keeps no sign; for one answer
// each it is the binomial test of those who saw a difference. That many answered "equal", or a large p, does
// not show equality by itself.
#ifndef ANALYSIS_REPORT_CHOICE_THREE_H
#define ANALYSIS_REPORT_CHOICE_THREE_H

#include "analysis/report/choices.h"

struct choice_three {
    int64_t test, equal, reference; // answers
    size_t people;
    double negative;                  // mean over people of the share of answers for the reference
    struct stat_interval negative_ci; // Clopper and Pearson's of one answer each, else t
    double net;                       // mean over people
    struct stat_interval net_ci;      // t; NaN for one person, or where all are the same
    double p_value, least_p;          // sign flip; NaN where nobody saw a difference
};

// Whether the cell's question permits "equal", as far as its block's answers show.
bool choice_three_applies(const struct choices *choices, const struct choice_cell *cell);
// False where memory ran out.
bool choice_three_of(const struct choices *choices, const struct choice_cell *cell, struct choice_three *out);

#endif
