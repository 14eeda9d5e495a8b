// Where the posterior of psychometric_posterior.h has its mass.
#ifndef ANALYSIS_STATS_PSYCHOMETRIC_MASS_H
#define ANALYSIS_STATS_PSYCHOMETRIC_MASS_H

#include "analysis/stats/psychometric_grid.h"

// Sets ends and points of the grid's axes so that every marginal has its mass between them and the points are
// near enough to each other for a density that falls off along each axis as it does around its mode. out_top:
// ln of the density at the mode. Leaves the marginals of a coarse sum in the grid. False where memory ran out
// or no point has a density.
bool stat_mass_find(struct stat_problem *problem, struct stat_grid *grid, double *out_top);

// Points for a spacing of `step` between the axis' ends, as many as fit an axis of that kind.
size_t stat_mass_points(const struct stat_axis *axis, int which, double step);

#endif
