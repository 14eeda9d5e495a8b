// The report's figures. Each is drawn for two widths, so that its letters stay readable on a wide and on a
// narrow page; the page shows one of them.
#ifndef ANALYSIS_REPORT_FIGURES_H
#define ANALYSIS_REPORT_FIGURES_H

#include "analysis/report/adjusted.h"
#include "analysis/report/bench.h"
#include "analysis/report/choices.h"
#include "analysis/report/figure.h"
#include "analysis/report/frames.h"
#include "analysis/report/ratings.h"
#include "analysis/report/thresholds.h"

enum { FIGURE_WIDE_PX = 860, FIGURE_NARROW_PX = 360 };

struct figure_desc {
    bool narrow;
    const struct figure_text *text;
};

// All return false with a sentence; *out_svg is freed by the caller.

// Franke 2021, Figure 7: bars of the percent of choices for the test option, in groups of the first factor's
// levels, over each cell's null region for its own n. The region is drawn half an answer wider than its
// outermost counts, so that a bar ends clearly inside or outside. Where somebody answered more than once in a
// cell, its interval is drawn instead.
bool figure_choices(const struct choices *choices, const struct figure_desc *desc, char **out_svg, char *error,
                    size_t error_size);
// "choices for the test option", "right answers", or both: what the bars are percentages of.
const char *figure_choices_what(const struct choices *choices);
// Whether the bars bear numbers, those of the table's rows: words are missing, or do not fit.
bool figure_choices_numbered(const struct choices *choices);

// Stengel 2016, Figure 7: net preferences of cells with three kinds of answers, with their intervals.
bool figure_three(const struct choices *choices, const struct figure_desc *desc, char **out_svg, char *error,
                  size_t error_size);
size_t figure_three_rows(const struct choices *choices); // 0 where there is nothing to draw

// Each person's two ratings as a line, in two panels by what came first, with the means.
bool figure_ratings(const struct sample *sample, const struct rating_question *question,
                    const struct figure_desc *desc, char **out_svg, char *error, size_t error_size);

// Means of every factor's levels with their intervals within people, on the whole scale.
bool figure_factorial(const struct factorial *factorial, const struct figure_desc *desc, char **out_svg,
                      char *error, size_t error_size);

// Diverging bars of what was answered at every factor's levels (Weier 2016, Figures 6 and 7). Only for scales
// of 2 to 11 points, and answers on them.
bool figure_likert(const struct factorial *factorial, const struct figure_desc *desc, char **out_svg,
                   char *error, size_t error_size);
bool figure_likert_possible(const struct factorial *factorial);

// Median, 95th and 99th percentile of the stimulus frames' GPU time (CPU time where no GPU time is known).
bool figure_frames(const struct sample *sample, const struct frames *frames, const struct figure_desc *desc,
                   char **out_svg, char *error, size_t error_size);

// Shares of right answers by level, each person's fitted function, and the staircases' thresholds with their
// mean. Of a cell with at least one step.
bool figure_thresholds(const struct threshold_cell *cell, const struct figure_desc *desc, char **out_svg,
                       char *error, size_t error_size);

// Each person's adjusted value and the mean with its interval, cell by cell of one parameter.
bool figure_adjusted(const struct adjusted_cell *const *cells, size_t count, const struct figure_desc *desc,
                     char **out_svg, char *error, size_t error_size);

// Speed against error of a group's rows, the Pareto front in blue. Of a group with rows that are drawn.
bool figure_bench(const struct bench *bench, size_t group, const struct figure_desc *desc, char **out_svg,
                  char *error, size_t error_size);

// How many groups figure_frames() would draw: 0 where there is nothing to draw.
size_t figure_frames_rows(const struct frames *frames);

#endif
