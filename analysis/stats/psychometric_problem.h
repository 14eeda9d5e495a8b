// A fit's data, ready to be asked for its likelihood. Shared by psychometric_*.c only.
#ifndef ANALYSIS_STATS_PSYCHOMETRIC_PROBLEM_H
#define ANALYSIS_STATS_PSYCHOMETRIC_PROBLEM_H

#include "analysis/stats/psychometric_fit.h"

struct stat_problem {
    struct stat_fit_desc desc;
    bool logarithmic;
    size_t count;           // distinct levels
    double *u, *k, *n;      // levels on the axis, ascending
    double *lower, *upper;  // F and 1 - F of the function last asked for
    double total;           // answers
    double range, gap;      // of levels; the smallest distance of two
    double at_low, at_high; // thresholds searched, on the axis
    double ln_slope_low, ln_slope_high;
    double *block; // owned
};

// A function on the axis with its likelihood.
struct stat_point {
    double at, ln_slope, guess, lapse;
    double log_likelihood;
};

// False for bad input or memory; the problem is then empty. One level only is no failure: range 0.
bool stat_problem_init(struct stat_problem *out, const struct stat_answers *answers, size_t count,
                       const struct stat_fit_desc *desc);
void stat_problem_finish(struct stat_problem *problem);

// The best asymptotes for a threshold and slope, and what likelihood they have.
struct stat_point stat_problem_point(struct stat_problem *problem, double at, double ln_slope);
// The same for F as it stands in `lower` and `upper`; fills in guess, lapse and log_likelihood.
void stat_problem_asymptotes(const struct stat_problem *problem, struct stat_point *point);
// The most that a step, and a constant, can reach. out_step: the levels around the step.
double stat_problem_step(struct stat_problem *problem, size_t out_step[2]);
double stat_problem_constant(const struct stat_problem *problem);
double stat_problem_saturated(const struct stat_problem *problem);

struct stat_search {
    int fine;                       // cells of the grid along the slope, and of the even thresholds; at most 40
    bool thorough;                  // lay thresholds by the levels too, and follow long ridges
    int starts;                     // best peaks of the grid that the simplex goes on from; at most 12
    const struct stat_point *start; // one more, or NULL
};

// The maximum over everything: a grid, and the simplex from its best peaks. -INFINITY where memory ran out.
struct stat_point stat_problem_maximum(struct stat_problem *problem, const struct stat_search *search);
// The maximum with the threshold (or the log of the slope) held.
double stat_problem_profile(struct stat_problem *problem, bool slope, double value);

double stat_problem_level(const struct stat_problem *problem, double u); // from the axis

#endif
