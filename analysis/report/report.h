// One HTML file that tells a study's results: no script, nothing loaded from elsewhere, readable on a phone and
// on paper. Simulated data is branded in the title, at the top of the page and on every printed page.
#ifndef ANALYSIS_REPORT_REPORT_H
#define ANALYSIS_REPORT_REPORT_H

#include "analysis/report/figure_file.h"
#include "analysis/report/sample.h"

// Writes FILE whole or not at all. What a study lacks (no choice, no rating, no frame) is said in its section.
// False with a sentence, also where gnuplot is missing.
bool report_write(struct sample *sample, double conf, const char *path, char *error, size_t error_size);
// The same, and then every figure as files of their own in files->folder, unless `files` is NULL; with the
// section of speed against error where `bench`, a file of fovbench --csv, is not NULL.
bool report_write_with_figures(struct sample *sample, double conf, const char *path, const char *bench,
                               struct figure_files *files, char *error, size_t error_size);

#endif
