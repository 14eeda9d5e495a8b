// The posterior of psychometric_bayes.h at a point of five coordinates in which posteriors are smooth and near
// enough to Gauss's bell that even points are best to sum over: threshold on the axis, ln width, and the cube
// roots of guess, lapse and eta over their largest values, near 0 of which posteriors crowd (the cube root of
// an exponential variable is near normal: Wilson & Hilferty 1931, PNAS 17, 684-688).
#ifndef ANALYSIS_STATS_PSYCHOMETRIC_POSTERIOR_H
#define ANALYSIS_STATS_PSYCHOMETRIC_POSTERIOR_H

#include "analysis/stats/psychometric_problem.h"

#include <stdbool.h>
#include <stddef.h>

enum { STAT_GRID_AT, STAT_GRID_WIDTH, STAT_GRID_GUESS, STAT_GRID_LAPSE, STAT_GRID_ETA, STAT_GRID_AXES };

struct stat_axis {
    double low, high; // of the coordinate; equal where points is 1
    size_t points;    // threshold, width: 4 m + 1; eta: 4 m
    double end;       // guess, lapse, eta: the largest value; 0 for a fixed one
    double fixed;     // its value then
};

// Axes over all that the priors allow, without points.
void stat_posterior_axes(const struct stat_problem *problem, struct stat_axis axes[STAT_GRID_AXES]);
double stat_axis_at(const struct stat_axis *axis, size_t i); // the coordinate of a point

// The prior's density over one coordinate, but for a factor.
double stat_posterior_prior(const struct stat_problem *problem, const struct stat_axis axes[STAT_GRID_AXES],
                            int which, double coordinate);

// ln of the posterior's density over the coordinates, but for a constant; -INFINITY outside the axes' widest.
double stat_posterior_ln_density(struct stat_problem *problem, const struct stat_axis axes[STAT_GRID_AXES],
                                 const double point[STAT_GRID_AXES]);

// --- its parts, for a sum over many points ---

enum { STAT_POSTERIOR_LANES = 16 };

double stat_axis_value(const struct stat_axis *axis, double coordinate); // guess, lapse or eta
double stat_posterior_inverse_nu(double eta);
// Fills the problem's `lower` and `upper`.
void stat_posterior_set_tails(struct stat_problem *problem, double at, double width);
// 2^twos[i] times product[i] is the likelihood for inverse_nu[i], but for the binomial coefficients and for a
// divisor that depends on nu alone. count: 4, 8, 12 or STAT_POSTERIOR_LANES.
void stat_posterior_products(const struct stat_problem *problem, double guess, double lapse,
                             const double *inverse_nu, double *product, int *twos, size_t count);
double stat_posterior_ln_divisor(const struct stat_problem *problem, double inverse_nu);

#endif
