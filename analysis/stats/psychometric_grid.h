// The posterior of psychometric_posterior.h summed over a grid: marginals at even points.
#ifndef ANALYSIS_STATS_PSYCHOMETRIC_GRID_H
#define ANALYSIS_STATS_PSYCHOMETRIC_GRID_H

#include "analysis/stats/psychometric_posterior.h"

enum { STAT_GRID_MOST = 64 }; // points along one axis

struct stat_grid {
    struct stat_axis axis[STAT_GRID_AXES];
    double marginal[STAT_GRID_AXES][STAT_GRID_MOST]; // masses
    // The largest share of the mass by which sums over every second point, along some axes at once, differ.
    // Sums over smooth densities are off by about its square (stat_grid_sum).
    double rough;
    bool rough_along[STAT_GRID_AXES]; // the axes of all shares above stat_grid_enough
};

static const double stat_grid_enough = 0.05; // 0.05^2 is half of the half percent that is promised

// Fills the marginals, relative to exp(top). False where memory ran out.
bool stat_grid_sum(struct stat_problem *problem, struct stat_grid *grid, double top);

#endif
