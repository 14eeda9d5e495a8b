// p-values adjusted for the number of tests, in the order they come in.
//
// NaN stays NaN and is not counted as a test; a p outside [0, 1] counts as NaN. `out` has room for n and is
// not `p`.
#ifndef ANALYSIS_STATS_MULTIPLE_H
#define ANALYSIS_STATS_MULTIPLE_H

#include <stddef.h>

// Step-down: controls the chance of any false rejection whatever the tests have in common.
void stat_adjust_holm(const double *p, size_t n, double *out);

#endif
