// Lines of fovbench's CSV files as figures need them: groups that share columns, parameters, names of modes.
#ifndef APP_FOVBENCH_FIGURE_DATA_H
#define APP_FOVBENCH_FIGURE_DATA_H

#include "app/fovbench/csv.h"

#include <stdbool.h>
#include <stddef.h>

enum { FIGURE_GROUPS = 64, FIGURE_SERIES = 24, FIGURE_TEXT = 256 };

// Names of columns; NULL ends them. A column that the file lacks makes no difference.
bool figure_same(const struct csv_table *table, size_t a, size_t b, const char *const *columns);
// The first row of each combination of values, at most FIGURE_GROUPS.
size_t figure_groups(const struct csv_table *table, const char *const *columns, size_t out_rows[FIGURE_GROUPS]);

const char *figure_cell(const struct csv_table *table, size_t row, const char *column);
double figure_number(const struct csv_table *table, size_t row, const char *column);
double figure_parameter(const struct csv_table *table, size_t row, const char *name); // NaN for none

// The mode with those parameters in which lines of that mode in the file differ: "time_warped epsilon=0.1".
void figure_mode_name(const struct csv_table *table, size_t row, char out[FIGURE_TEXT]);
// "town, 640x720, gaze centre".
void figure_place_name(const struct csv_table *table, size_t row, char out[FIGURE_TEXT]);

extern const char *const figure_place[]; // device, scene, size, gaze and settings
extern const char *const figure_mode[];  // mode and parameters

#endif
