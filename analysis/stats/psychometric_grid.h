// The posterior of psychometric_bayes.h at a point, and its sum over a grid: marginals at even points of five
// coordinates in which posteriors are smooth and near enough to Gauss's bell that even points are best:
// threshold on the axis, ln width, and the cube roots of guess, lapse and eta over their largest values, near
// 0 of which posteriors crowd (the cube root of an exponential variable is near normal: Wilson & Hilferty 1931,
// PNAS 17, 684-688).
#ifndef ANALYSIS_STATS_PSYCHOMETRIC_GRID_H
#define ANALYSIS_STATS_PSYCHOMETRIC_GRID_H

#include "analysis/stats/psychometric_problem.h"

#include <stdbool.h>
#include <stddef.h>

enum { STAT_GRID_AT, STAT_GRID_WIDTH, STAT_GRID_GUESS, STAT_GRID_LAPSE, STAT_GRID_ETA, STAT_GRID_AXES };
enum { STAT_GRID_MOST = 64 }; // points along one axis

struct stat_axis {
    double low, high; // of the coordinate; equal where points is 1
    size_t points;    // threshold, width: 4 m + 1; eta: 4 m
    double end;       // guess, lapse, eta: the largest value; 0 for a fixed one
    double fixed;     // its value then
};

struct stat_grid {
    struct stat_axis axis[STAT_GRID_AXES];
    double marginal[STAT_GRID_AXES][STAT_GRID_MOST]; // masses
    // The largest share of the mass by which sums over every second point, along some axes at once, differ.
    // Sums over smooth densities are off by about its square (stat_grid_sum).
    double rough;
    bool rough_along[STAT_GRID_AXES]; // the axes of all shares above stat_grid_enough
};

static const double stat_grid_enough = 0.05; // 0.05^2 is half of the half percent that is promised

// Axes over all that the priors allow, without points.
void stat_grid_axes(const struct stat_problem *problem, struct stat_axis axes[STAT_GRID_AXES]);
double stat_axis_at(const struct stat_axis *axis, size_t i); // the coordinate of a point

// The prior's density over one coordinate, but for a factor.
double stat_grid_prior(const struct stat_problem *problem, const struct stat_axis axes[STAT_GRID_AXES],
                       int which, double coordinate);

// ln of the posterior's density over the coordinates, but for a constant; -INFINITY outside the axes' widest.
double stat_grid_ln_density(struct stat_problem *problem, const struct stat_axis axes[STAT_GRID_AXES],
                            const double point[STAT_GRID_AXES]);

// Fills the marginals, relative to exp(top). False where memory ran out.
bool stat_grid_sum(struct stat_problem *problem, struct stat_grid *grid, double top);

#endif
