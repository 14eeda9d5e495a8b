// The Pareto front of two costs: the points that no other point beats.
#ifndef APP_FOVBENCH_PARETO_H
#define APP_FOVBENCH_PARETO_H

#include <stdbool.h>
#include <stddef.h>

// Marks the points for which no other is at most as large in both costs and smaller in one. Equal points stand
// or fall together; a point with a cost that is not a number is never on the front. False: no memory.
bool pareto_front(const double *first, const double *second, size_t count, bool *out_on_front);

#endif
