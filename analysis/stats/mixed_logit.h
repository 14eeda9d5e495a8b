// Logistic mixed model of choices: each person has a preference of their own, normal on the logit scale.
//
//   P(test option) of person i = logistic(intercept + sd b_i), b_i standard normal
//
// Maximum likelihood by adaptive quadrature. The intercept belongs to a person in the middle
// (conditional); the mean preference over people (population) is nearer to one half, and is what shares
// estimate. The test of the intercept refers to t with N - 1 degrees of freedom, N people: a normal
// distribution rejects too often with few. Counts are those of people.h. NaN where `state` says that a number
// does not exist.
#ifndef ANALYSIS_STATS_MIXED_LOGIT_H
#define ANALYSIS_STATS_MIXED_LOGIT_H

#include "analysis/stats/binomial.h"
#include "analysis/stats/people.h"

enum stat_mixed_state {
    STAT_MIXED_FITTED,
    STAT_MIXED_SD_ZERO,  // fitted; people do not differ beyond chance, so the model is the pooled one
    STAT_MIXED_ONE_EACH, // one answer each: how people differ cannot be seen
    STAT_MIXED_ALL_SAME, // complete separation: all answers are the same, the intercept has no bound
    STAT_MIXED_SPLIT,    // nobody ever changed their mind: the SD has no bound
    STAT_MIXED_TOO_FEW,  // fewer than two people
    STAT_MIXED_BAD       // counts or options out of range, no memory, no convergence
};

struct stat_mixed_options {
    double p0;   // conditional preference under the null hypothesis; 0 means 0.5
    double conf; // 0 means 0.95
    enum stat_alternative alternative;
};

struct stat_mixed_logit {
    enum stat_mixed_state state;
    size_t people;
    double intercept, std_error, sd; // logits
    double log_likelihood;           // of the single answers, without binomial coefficients
    double t, df, p_value;
    struct stat_interval intercept_ci;
    double conditional; // logistic of the intercept
    struct stat_interval conditional_ci;
    double population; // mean over people
    struct stat_interval population_ci;
};

// `options` may be NULL: all defaults.
struct stat_mixed_logit stat_mixed_logit(const struct stat_person *people, size_t count,
                                         const struct stat_mixed_options *options);

const char *stat_mixed_words(enum stat_mixed_state state); // a sentence without a full stop; "" where fitted

#endif
