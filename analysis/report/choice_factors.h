// Whether choices differ between the levels of a factor, where each person gave one answer, or the factor lies
// between people.
//
// Cells that are the same but for one factor's level are a set. Whether it lies between or within people
// follows from the design (choice_design.h), the test from how often people answered:
//   between people, one answer each:              Fisher's exact test, Pearson's chi-squared beside it
//   between people, several answers:              people are exchanged between levels (exchange.h)
//   within people, one answer each, two levels:   McNemar's exact test, his chi-squared beside it
//   within people, one answer each, more levels:  Cochran's Q by permutation, chi-squared beside it
// Sets within people in which somebody answered several times at a level are compared by choices.h (contrasts).
// Left out and counted are, between people, those with answers at several levels (of the whole set, also from
// its pairs), within people those without an answer at every level compared; nothing is filled. More than two
// levels are followed by all pairs of them. Does not: join sets, or a person's cells.
#ifndef ANALYSIS_REPORT_CHOICE_FACTORS_H
#define ANALYSIS_REPORT_CHOICE_FACTORS_H

#include "analysis/report/choice_design.h"

enum { CHOICE_FACTOR_LEVELS = 16 }; // as a protocol permits, and exchange.h

enum choice_factor_method { FACTOR_FISHER, FACTOR_EXCHANGE, FACTOR_MCNEMAR, FACTOR_COCHRAN };

struct choice_factor_test {
    const char *block, *factor;
    bool name_block; // other tests are of other blocks
    char where[256]; // the other factors' levels; "" for none
    enum choice_factor_method method;
    struct choice_design design; // of the whole set
    bool pair;                   // of two of more levels; belongs to the test before it that is none
    size_t levels, people, left_out;
    const char *level[CHOICE_FACTOR_LEVELS]; // their names, as many as levels
    // NaN where `none` says why. All answers the same: 1 by Fisher's and McNemar's test, NaN by the others,
    // whose statistic then does not exist.
    double p_value;
    char none[192];          // why there is no p-value; "" where there is one
    double p_error;          // of p_value, where arrangements were drawn at random; else 0
    double holm;             // over all sets; of a pair, over the pairs of its set
    double statistic, df;    // chi-squared beside it; of people exchanged, what was compared, df NaN
    double p_asymptotic;     // by chi-squared; NaN for people exchanged
    double share_a, share_b; // of two levels: means over people; NaN else
    double difference;       // share_a - share_b
    // Of the difference. Within people the one that agrees with McNemar's exact p (mcnemar.h). Between people
    // Newcombe's of one answer each, Welch's t of several: methods of their own, which can differ from the
    // exact p where that is near 1 - conf; Welch's may reach beyond -1 and 1.
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
enum { CHOICE_FACTOR_WORDS = 1200, CHOICE_FACTOR_NOTE = 320 };
// What a test compares, for a sentence: "a 3, 2 and 1, at epsilon 0.2".
void choice_factor_words(const struct choice_factor_test *test, char out[CHOICE_FACTOR_WORDS]);
// Who was left out and why, and where people were planned differently what was made of it; "" for nothing.
void choice_factor_note(const struct choice_factor_test *test, char out[CHOICE_FACTOR_NOTE]);

#endif
