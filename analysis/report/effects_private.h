// Shared by effects.c and effects_values.c only.
#ifndef ANALYSIS_REPORT_EFFECTS_PRIVATE_H
#define ANALYSIS_REPORT_EFFECTS_PRIVATE_H

#include "analysis/report/effects.h"

struct effect_answer {
    size_t person, place; // place: in the order of all answers
    size_t session;
    bool test, a;            // chosen: the test option; slot a
    int test_a, first, last; // whether the test option was in slot a, shown first, shown last; -1: not known
    bool after_equal;        // the answer before was no choice
    double toggles;          // NaN: nothing to switch
    double test_view;        // the test option's share of viewing time; NaN: not known
};

// A person's value for a check, from all of the person's answers in their order; NaN where there is none.
double effect_value(enum effect_check check, const struct effect_answer *answers, size_t count);

#endif
