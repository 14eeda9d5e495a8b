// Thresholds of staircases and of constant levels: for each person what the staircase itself arrived at, and a
// psychometric function fitted to all of the person's answers; across people a mean with its t interval.
//
// A cell is one combination of block and factor levels. Counted are main trials that are done and not excluded.
//   staircase  The estimate that the study stored with the last step: of up-down methods the mean of the last
//              even number of reversals (studies/engine/staircase.h), of QUEST+ the posterior mean. It has seen
//              every step, excluded ones too. Of several sittings the mean.
//   fit        Maximum likelihood over the person's steps (analysis/stats/psychometric_fit.h), guess fixed at
//              one half, lapse between 0 and 0.06 (Wichmann & Hill 2001, p. 1296).
//   bayes      The same by Bayes' rule with overdispersion (analysis/stats/psychometric_bayes.h).
//
// Constant levels are toggle and sequential trials whose factor has numbers for levels: at least 3 for a
// question with a right answer (fitted as above), at least 5 for a preference, whose function is that of the
// answers for the test option, both asymptotes free between 0 and 1/2 from their ends. The cell then has the
// other factors' levels. Which way the function goes is the sign of the answers' covariance with the level, all
// people together.
//
// People are the unit: their answers are never pooled, but where several people answered and nobody twice at a
// level. Then a cell of constant levels has one function for all, its answers at one level from different
// people. Means are over those who have an estimate; how many have none is counted, and whoever prints a mean
// must print that too. Answers on a scale, and blocks that take "equal", have the staircase's own estimate
// only. Which way the function goes is what staircases did after a wrong answer (they make it easier) or,
// without any, after right ones, unless the options say it.
#ifndef ANALYSIS_REPORT_THRESHOLDS_H
#define ANALYSIS_REPORT_THRESHOLDS_H

#include "analysis/report/sample.h"
#include "analysis/stats/moments.h"
#include "analysis/stats/psychometric_bayes.h"
#include "analysis/stats/psychometric_fit.h"
#include "analysis/stats/ttest.h"

enum threshold_source { THRESHOLD_STAIRCASES, THRESHOLD_LEVELS };
enum threshold_larger { THRESHOLD_AS_SHOWN, THRESHOLD_EASIER, THRESHOLD_HARDER };

struct threshold_options {
    double conf; // 0 means 0.95
    enum stat_family family;
    bool logarithmic;
    enum threshold_larger larger;
    size_t replicates; // of the bootstrap; 0: none
    uint64_t seed;     // of the bootstrap
    bool bayes;        // also by Bayes' rule
};

struct threshold_person {
    size_t person;              // index into the sample; SAMPLE_NONE: all people of a cell
    size_t step_count;          // done and not excluded
    struct stat_answers *steps; // one answer each; k 1: right, or for the test option
    int64_t reversals;
    size_t staircases, estimates; // sittings; those with an estimate
    double estimate;              // mean of those; NaN for none
    struct stat_fit fit;
    struct stat_fit_bootstrap bootstrap;
    struct stat_bayes bayes;
};

// Over the people who have a value.
struct threshold_mean {
    struct stat_moments of;
    double median;
    struct stat_ttest t; // its interval; NaN for fewer than two people
};

struct threshold_cell {
    enum threshold_source source;
    bool preference;             // of constant levels
    size_t pooled;               // people who share one function; 0: each has their own
    const char *block, *factors; // factors: the JSON text
    const char *label;           // its levels as the file has them; "all" for none
    const char *words;           // the same for people
    const char *parameter;       // what the levels are of; "level" where nothing tells
    bool quest, graded, falling;
    bool undirected; // nothing tells which way the function goes: no fit by Bayes' rule, which would need it
    size_t steps;    // of all people, used
    size_t person_count;
    struct threshold_person *people; // in the sample's order
    struct threshold_mean by_staircase, by_fit, by_bayes;
    size_t prior_bound; // people whose credible interval ends where only the prior does
};

struct thresholds {
    struct threshold_options options;
    size_t cell_count;
    struct threshold_cell *cells;           // staircases first, by block and factors
    int64_t steps;                          // used
    int64_t not_finite, not_done, excluded; // left out, by the first reason that holds
};

// False with a sentence. No staircase at all is not an error: cell_count is 0.
bool thresholds_load(struct thresholds *out, struct sample *sample, const struct threshold_options *options,
                     char *error, size_t error_size);
void thresholds_free(struct thresholds *thresholds);

// Moments, median and t interval of values, NaN among them left out.
struct threshold_mean threshold_mean_of(const double *values, size_t count, double conf);

// The levels of a factors text but the one of the factor `without` (NULL: none), joined by commas, as the file
// has them or for people; "all" for none. Owned by the sample; NULL where memory ran out.
const char *threshold_label(struct sample *sample, const char *factors, const char *without, bool words);

#endif
