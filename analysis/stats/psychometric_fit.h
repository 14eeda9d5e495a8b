// A psychometric function fitted by maximum likelihood, with profile-likelihood intervals.
//
// Answers are binomial at each level and independent. Asymptotes are fixed where their bounds are equal, and
// else free between them: fix guess at 1 / m only for questions with a right answer among m; leave both free
// for preferences. For each threshold and slope the asymptotes have a concave likelihood, which is solved
// exactly; threshold and slope are searched on a grid that has every level in it, from whose peaks Nelder and
// Mead's simplex goes on (1965, The Computer Journal 7, 308-313). No start is drawn at random: the same data
// give the same fit.
//
// Searched are thresholds from one range of levels below the lowest to one above the highest (on the axis), and
// slopes from 0.1 over that range to 10 over the smallest distance of two levels.
// The interval of a parameter is where the likelihood, maximised over all others, is within
// qchisq(conf, 1) / 2 of its maximum (Venzon & Moolgavkar 1988, Applied Statistics 37, 87-94).
//
// "Not estimable" is an answer, with its reason: a fit without status STAT_FIT_OK has no threshold.
#ifndef ANALYSIS_STATS_PSYCHOMETRIC_FIT_H
#define ANALYSIS_STATS_PSYCHOMETRIC_FIT_H

#include "analysis/stats/binomial.h"
#include "analysis/stats/psychometric.h"

#include <stddef.h>
#include <stdint.h>

enum { STAT_FIT_LEVELS = 2000 }; // distinct ones; more are bad input

struct stat_answers {
    double level;
    int64_t k, n; // 0 <= k <= n
};

struct stat_fit_desc {
    enum stat_family family;
    bool logarithmic, falling;
    double guess_low, guess_high; // 0..1, equal: fixed
    double lapse_low, lapse_high; // the same; the highest two sum to at most 1
    double conf;                  // 0 means 0.95
};

enum stat_fit_status {
    STAT_FIT_OK,
    STAT_FIT_BAD_INPUT,
    STAT_FIT_NO_ANSWERS,
    STAT_FIT_NOT_POSITIVE, // a level that a logarithmic axis does not have
    STAT_FIT_ONE_LEVEL,
    STAT_FIT_ALL_NO,    // 0 of n everywhere
    STAT_FIT_ALL_YES,   // n of n everywhere
    STAT_FIT_NO_EFFECT, // a constant explains the answers as well
    STAT_FIT_STEP,      // a step explains them as well: no slope, and no threshold but between two levels
    STAT_FIT_OUTSIDE,   // the best threshold is at the end of the search
    STAT_FIT_OPEN       // the threshold's profile does not close within the search
};
const char *stat_fit_reason(enum stat_fit_status status); // in words: "all answers are alike"; "" for OK

struct stat_fit {
    enum stat_fit_status status;
    // The best function; NaN in its numbers unless the status is OK or OPEN. OPEN: the maximum, for drawing
    // only.
    struct stat_psychometric function;
    struct stat_interval threshold, slope; // slope.low 0 or slope.high infinite: open within the search
    double log_likelihood;                 // without binomial coefficients, which no parameter changes
    double deviance;                       // against a probability of its own for each level
    struct stat_interval step;             // STAT_FIT_STEP: the levels between which it lies; else NaN
    int64_t n;
    size_t levels; // distinct ones
};

// Levels in any order; equal ones (to 1e-9 of the range) are joined, those with n = 0 left out.
struct stat_fit stat_psychometric_fit(const struct stat_answers *answers, size_t count,
                                      const struct stat_fit_desc *desc);

struct stat_fit_bootstrap {
    size_t replicates, failed;      // failed: without a threshold; left out of the interval
    size_t below, above;            // whose threshold lies beyond the search: at minus infinity, at infinity
    double deviance_p;              // share of replicates that fit no better, counting the data themselves
    struct stat_interval threshold; // an infinite end is open
    // The interval misses its estimate, or more than 1 in 20 replicates failed. It is not clipped.
    bool unreliable;
};

// Parametric bootstrap at the levels that were shown, as if the answers had not chosen them: Efron & Tibshirani
// 1993, chapters 6 and 13, percentile interval; goodness of fit as Wichmann & Hill 2001, p. 1302. Replicates
// whose best function is a step have its threshold in the middle between the two levels; those that one of the
// asymptotes explains have it at infinity. NaN where the fit is not OK or memory ran out.
struct stat_fit_bootstrap stat_psychometric_bootstrap(const struct stat_answers *answers, size_t count,
                                                      const struct stat_fit_desc *desc,
                                                      const struct stat_fit *fit, size_t replicates,
                                                      uint64_t seed);

#endif
