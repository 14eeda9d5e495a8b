// The parts of the report, each in its file. Shared by report*.c only.
#ifndef ANALYSIS_REPORT_SECTIONS_H
#define ANALYSIS_REPORT_SECTIONS_H

#include "analysis/report/adjusted.h"
#include "analysis/report/audit.h"
#include "analysis/report/bench.h"
#include "analysis/report/checks.h"
#include "analysis/report/choice_factors.h"
#include "analysis/report/choices.h"
#include "analysis/report/effects.h"
#include "analysis/report/figure_file.h"
#include "analysis/report/frames.h"
#include "analysis/report/frames_pairs.h"
#include "analysis/report/gaze_over.h"
#include "analysis/report/jod.h"
#include "analysis/report/planned.h"
#include "analysis/report/plans.h"
#include "analysis/report/ratings.h"
#include "analysis/report/sample.h"
#include "analysis/report/thresholds.h"

#include <stdio.h>

enum { REPORT_QUESTIONS = 8 };  // ratings drawn; further questions are in the tables only
enum { REPORT_STAIRCASES = 8 }; // cells drawn; further ones are in the tables only
enum { REPORT_ADJUSTED = 8 };   // the same of adjusted values, of the first parameter

struct figure_pair {
    char *wide, *narrow; // NULL where there is nothing to draw
};

// The tests under other exclusions than those that hold.
struct report_tests {
    struct choices choices;
    struct ratings ratings;
    struct thresholds thresholds; // without Bayes' rule
    struct jod jod;               // without intervals
};

struct report {
    FILE *out;
    struct sample *sample;
    double conf;
    struct plans plans;
    struct planned planned;
    struct choices choices;
    struct choice_factors factors;
    struct ratings ratings;
    struct frames frames;
    struct frames_pairs frames_pairs;
    struct gaze_report gaze;
    struct gaze_over gaze_over;
    struct checks checks;
    struct effects effects;
    struct audit audit;
    struct thresholds thresholds;
    struct adjusted adjusted;
    struct jod jod;
    struct report_tests all, stricter; // without any exclusion; with those of the set 'stricter' too
    struct figure_pair choices_figure, three_figure, frames_figure, ratings_figures[REPORT_QUESTIONS],
        factorial_figures[REPORT_QUESTIONS], likert_figures[REPORT_QUESTIONS];
    struct bench bench; // without rows where no file was given
    struct figure_pair bench_figures[BENCH_FIGURES];
    struct figure_pair threshold_figures[REPORT_STAIRCASES], adjusted_figure;
};

void report_summary(const struct report *r);
void report_sample(const struct report *r);
void report_methods(const struct report *r);
void report_planned(const struct report *r);             // what the protocol planned, with its results
void report_choices_methods(const struct report *r);     // sentences
void report_planned_methods(const struct report *r);     // sentences
void report_equivalence_methods(const struct report *r); // sentences, after those on what was planned
void report_scale_methods(const struct report *r);       // sentences
void report_choices(const struct report *r);
void report_equivalence(const struct report *r);    // by the protocol's margin
void report_choice_three(const struct report *r);   // where "equal" was an answer
void report_choice_factors(const struct report *r); // levels compared, but for several answers within people
void report_people(const struct report *r);         // cells with several answers per person
// 1: the test option, or right answers; -1: the other; 0: neither, or people and their mean share disagree.
int report_direction(const struct choice_cell *cell);
void report_cell_words(const struct choice_cell *cell, char out[256]);
void report_toggles(const struct report *r);
void report_ratings(const struct report *r);
// A cell: M (SD), without an SD where there is none.
void report_mean_sd(FILE *out, const struct stat_moments *of);
// A cell; one that reaches to infinity says that n is too small for its confidence.
void report_rank_interval(FILE *out, const struct stat_wilcoxon *rank);
// Parts of the ratings; figures may be NULL.
void report_rating_options(const struct report *r, const struct rating_options *q);
void report_factorial(const struct report *r, const struct factorial *f, const struct figure_pair *means,
                      const struct figure_pair *answers);
void report_thresholds(const struct report *r); // staircases, adjusted values, preferences on one scale
bool report_load_frames(struct report *r, char *error, size_t error_size);
void report_frames(const struct report *r);
void report_effects(const struct report *r); // on choices, that are no preference
void report_gaze(const struct report *r);
void report_gaze_methods(const struct report *r); // of report_gaze()
void report_gaze_limits(const struct report *r);
void report_checks(const struct report *r);         // null and catch trials
void report_what_if(const struct report *r);        // the same tests under other exclusions
void report_what_if_scales(const struct report *r); // its rows of thresholds and JOD
void report_what_if_notes(const struct report *r);  // what stands below it
bool report_quality(const struct report *r, char *error, size_t error_size);
void report_bench(const struct report *r);
bool report_draw_bench(struct report *r, char *error, size_t error_size);
// Every figure, for both widths; report_free_figures() frees them, also after false.
bool report_draw(struct report *r, char *error, size_t error_size);
void report_free_figures(struct report *r);
// As files, numbered in the report's order from 1.
bool report_write_figures(const struct report *r, struct figure_files *files, char *error, size_t error_size);
void report_audit(const struct report *r); // every frame accounted for
void report_definitions(const struct report *r);

// Both widths of a figure and its caption, which is HTML.
void report_figure(const struct report *r, const struct figure_pair *figure, const char *caption);
// The heading of a section, which is HTML, with where its numbers come from.
void report_heading(const struct report *r, const char *heading);
const char *report_label(const struct report *r, size_t condition);
bool report_outside(
    const struct choice_cell *cell); // p <= 1 - conf; of a binomial test, outside the null region

#endif
