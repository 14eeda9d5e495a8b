// The posterior of psychometric_bayes.h summed over a grid: marginals of threshold and width at even points, of
// guess, lapse and eta at their nodes.
#ifndef ANALYSIS_STATS_PSYCHOMETRIC_GRID_H
#define ANALYSIS_STATS_PSYCHOMETRIC_GRID_H

#include "analysis/stats/psychometric_problem.h"

#include <stdbool.h>
#include <stddef.h>

enum {
    STAT_GRID_NODES = 12,    // at most, of guess or lapse
    STAT_GRID_ETA_NODES = 16 // at most; the nodes of eta are 4, 8, 12 or 16
};

struct stat_grid {
    size_t points, guesses, lapses, etas;
    double at_low, at_high, width_low, width_high; // of ln width, whose posterior is less skewed
    double guess[STAT_GRID_NODES], lapse[STAT_GRID_NODES], eta[STAT_GRID_ETA_NODES]; // nodes, ascending
    double w_guess[STAT_GRID_NODES], w_lapse[STAT_GRID_NODES],
        w_eta[STAT_GRID_ETA_NODES]; // prior times the node's weight
    double *at, *width;             // borrowed; marginals, `points` each
    double *yes;                    // borrowed; room for one number a level
    double m_guess[STAT_GRID_NODES], m_lapse[STAT_GRID_NODES],
        m_eta[STAT_GRID_ETA_NODES]; // marginals at the nodes, weight included
};

// Fills the marginals, relative to exp(top). sparse: from what every fourth threshold and width say, pairs of
// guess and lapse, and ends of eta, that hold next to nothing are not evaluated at the others: together at
// most 1.2e-5 of the mass, which is laid out over the nodes as at the former.
void stat_grid_sum(struct stat_problem *problem, struct stat_grid *grid, double top, bool sparse);

#endif
