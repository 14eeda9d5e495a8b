// Whether choices differ between the levels of a factor, where each person gave one answer, or saw one level.
//
// Cells that are the same but for one factor's level are a set. The test follows the data:
//   nobody answered at two levels, one answer each:      Fisher's exact test, Pearson's chi-squared beside it
//   nobody answered at two levels, several answers:      people are exchanged between levels (exchange.h)
//   people answered once at every level, two levels:     McNemar's exact test, his chi-squared beside it
//   people answered once at every level, more levels:    Cochran's Q by permutation, chi-squared beside it
// Sets in which people answered several times at several levels are compared by choices.h (contrasts). People
// without an answer at every level of a set within people are left out and counted; nothing is filled. More
// than two levels are followed by all pairs of them. Does not: join sets, or a person's cells.
#ifndef ANALYSIS_REPORT_CHOICE_FACTORS_H
#define ANALYSIS_REPORT_CHOICE_FACTORS_H

#include "analysis/report/choices.h"

enum choice_factor_method { FACTOR_FISHER, FACTOR_EXCHANGE, FACTOR_MCNEMAR, FACTOR_COCHRAN };

struct choice_factor_test {
    const char *block, *factor;
    char where[256]; // the other factors' levels; "" for none
    enum choice_factor_method method;
    bool pair; // of two of more levels; belongs to the test before it that is none
    size_t levels, people, left_out;
    const char *a, *b;       // the two levels; NULL where there are more
    double p_value;          // NaN where all answers are the same, or nobody is left
    double p_error;          // of p_value, where arrangements were drawn at random; else 0
    double holm;             // over all sets; of a pair, over the pairs of its set
    double statistic, df;    // chi-squared beside it; of people exchanged, what was compared, df NaN
    double p_asymptotic;     // by chi-squared; NaN for people exchanged
    double share_a, share_b; // of two levels: means over people; NaN else
    double difference;       // share_a - share_b
    // Of the difference. Between people of one answer Newcombe's, of several Welch's t; within people t.
    struct stat_interval ci;
    double odds_ratio;            // of a over b, by Fisher's or McNemar's test; NaN else
    struct stat_interval odds_ci; // exact
};

struct choice_factors {
    double conf;
    size_t count;
    struct choice_factor_test *tests;
};

// False where memory ran out; of loaded choices.
bool choice_factors_load(struct choice_factors *out, const struct choices *choices);
void choice_factors_free(struct choice_factors *factors);
const char *choice_factor_word(enum choice_factor_method method); // "Fisher", "exchange of people", ...

#endif
