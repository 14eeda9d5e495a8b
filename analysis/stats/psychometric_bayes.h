// A psychometric function by Bayes' rule on a grid, for answers that may vary more than independent ones would.
//
// Source: Schuett, Harmeling, Macke & Wichmann 2016 (psychometric.h). The k of n answers at a level are
// beta-binomial: the probability itself varies, as Beta(nu P, nu (1 - P)) with nu = 1 / eta^2 - 1; eta is 0 for
// independent answers and near 1 where a level is answered always alike within a sitting.
//
// Priors, after theirs, on the axis, with R the range of levels and d the smallest distance of two:
//     threshold       even over the levels, falling to 0 as a raised cosine R / 2 beyond them
//     width           of F from 0.05 to 0.95: rising as a raised cosine from d to 2 d, even, falling from R to
//                     3 R (the product of both where 2 d > R)
//     guess, lapse    Beta(1, 10) up to 1/2 where free; else the desc's
//     eta             Beta(1, 10), on eta itself
// Differences: reported are means and medians of the marginals, where their program prefers the joint mode;
// the grid (psychometric_grid.h) is laid where the posterior has its mass (psychometric_mass.h) and made finer
// until sums over every second of its points say that it is fine enough. Whether a lapse is free or fixed is
// the desc's word, its bounds else do not matter here.
#ifndef ANALYSIS_STATS_PSYCHOMETRIC_BAYES_H
#define ANALYSIS_STATS_PSYCHOMETRIC_BAYES_H

#include "analysis/stats/psychometric_fit.h"

enum { STAT_BAYES_MOST = 20000 }; // answers; the work grows with them

struct stat_marginal {
    double mean, sd, median;
    struct stat_interval credible; // equal tails
};

struct stat_bayes {
    // On a logarithmic axis threshold is in the level's unit (its mean and sd are those of the level itself,
    // median and interval are the axis' own), width in ln of it.
    struct stat_marginal threshold, width;
    struct stat_marginal guess, lapse; // fixed: mean as given, sd 0
    struct stat_marginal eta;
    // An end of the threshold's interval lies beyond the levels that were shown: how far is the prior's word.
    bool prior_bound;
    // The grid could not be made fine enough: the numbers may be off by more than half a percent of the
    // interval.
    bool rough;
};

// NaN for bad input, fewer than two levels, more answers than STAT_BAYES_MOST, or no memory. Data of one answer
// kind only are fine here: the posterior then says how far away the threshold may be.
struct stat_bayes stat_psychometric_bayes(const struct stat_answers *answers, size_t count,
                                          const struct stat_fit_desc *desc);

#endif
