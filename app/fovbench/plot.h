// The figure of a run: error over time, one row of panels per scene, size and gaze, the Pareto front marked.
#ifndef APP_FOVBENCH_PLOT_H
#define APP_FOVBENCH_PLOT_H

#include "app/fovbench/row.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

// `rows` are groups of mode_count. False: no memory.
bool plot_write(FILE *out, const struct row *rows, size_t group_count, size_t mode_count);

#endif
