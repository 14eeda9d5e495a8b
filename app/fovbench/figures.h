// `fovbench figures`: figures like the paper's (Franke et al. 2021, section 8.4) from fovbench's CSV files.
#ifndef APP_FOVBENCH_FIGURES_H
#define APP_FOVBENCH_FIGURES_H

#include "app/fovbench/csv.h"

#include <stdbool.h>
#include <stdio.h>

int command_figures(int argc, char **argv); // the exit status

// Each writes one sheet of panels from a table of its kind; false where the table has nothing to show, with a
// sentence that says what is missing. Nothing is written then.
bool figure_epsilon(FILE *out, const struct csv_table *table, char *why, size_t why_size);    // Figure 6
bool figure_resolution(FILE *out, const struct csv_table *table, char *why, size_t why_size); // Figure 10
bool figure_triangles(FILE *out, const struct csv_table *table, char *why, size_t why_size);  // Figure 12
bool figure_shaded(FILE *out, const struct csv_table *table, char *why, size_t why_size);     // Figure 13
bool figure_moving(FILE *out, const struct csv_table *table, char *why, size_t why_size);     // Figure 14

#endif
