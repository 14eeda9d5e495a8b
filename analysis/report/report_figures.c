// The figures that a report has: drawn for both widths, written as files of their own, freed.
#include "analysis/report/figures.h"
#include "analysis/report/sections.h"

#include <stdlib.h>
#include <string.h>

static bool draw_choices(struct report *r, char *error, size_t error_size)
{
    for (int narrow = 0; r->choices.cell_count && narrow < 2; narrow++) {
        struct figure_text text = {
            narrow ? "choices-n" : "choices-w", "Percent of choices for the test option",
            "Bars per cell over the region of the null hypothesis; the table below has every "
            "number.",
            narrow ? "narrow" : "wide"};
        struct figure_desc desc = {narrow, &text};
        char **svg = narrow ? &r->choices_figure.narrow : &r->choices_figure.wide;
        if (!figure_choices(&r->choices, &desc, svg, error, error_size))
            return false;
    }
    return true;
}

static bool draw_three(struct report *r, char *error, size_t error_size)
{
    for (int narrow = 0; figure_three_rows(&r->choices) && narrow < 2; narrow++) {
        struct figure_text text = {
            narrow ? "three-n" : "three-w", "Net preference per cell",
            "A dot and an interval per cell, negative where the reference was preferred; "
            "the table below has every number.",
            narrow ? "narrow" : "wide"};
        struct figure_desc desc = {narrow, &text};
        char **svg = narrow ? &r->three_figure.narrow : &r->three_figure.wide;
        if (!figure_three(&r->choices, &desc, svg, error, error_size))
            return false;
    }
    return true;
}

static bool draw_ratings(struct report *r, char *error, size_t error_size)
{
    for (size_t i = 0; i < r->ratings.question_count && i < REPORT_QUESTIONS; i++)
        for (int narrow = 0; r->ratings.questions[i].group_count && narrow < 2; narrow++) {
            char id[32];
            snprintf(id, sizeof id, "ratings-%zu-%c", i, narrow ? 'n' : 'w');
            struct figure_text text = {
                id, "First and second rating of each person",
                "One line per person, in one panel per order, with means; the table below has "
                "the tests.",
                narrow ? "narrow" : "wide"};
            struct figure_desc desc = {narrow, &text};
            char **svg = narrow ? &r->ratings_figures[i].narrow : &r->ratings_figures[i].wide;
            if (!figure_ratings(r->sample, &r->ratings.questions[i], &desc, svg, error, error_size))
                return false;
        }
    return true;
}

static bool draw_factorial(struct report *r, size_t i, bool narrow, char *error, size_t error_size)
{
    const struct factorial *f = &r->ratings.factorials.items[i];
    struct figure_pair *means = &r->factorial_figures[i], *answers = &r->likert_figures[i];
    char id[32], other[32];
    snprintf(id, sizeof id, "factorial-%zu-%c", i, narrow ? 'n' : 'w');
    snprintf(other, sizeof other, "likert-%zu-%c", i, narrow ? 'n' : 'w');
    struct figure_text mean_text = {id, "Mean ratings per level of each factor",
                                    "A dot and an interval per level; the tables below have every number.",
                                    narrow ? "narrow" : "wide"},
                       answer_text = {
                           other, "Answers per level of each factor",
                           "A bar per level, from the lowest answer on the left to the highest; shares "
                           "below and above the middle stand at its ends.",
                           narrow ? "narrow" : "wide"};
    if (!figure_factorial(f, &(struct figure_desc){narrow, &mean_text}, narrow ? &means->narrow : &means->wide,
                          error, error_size))
        return false;
    return !figure_likert_possible(f) ||
           figure_likert(f, &(struct figure_desc){narrow, &answer_text},
                         narrow ? &answers->narrow : &answers->wide, error, error_size);
}

static bool draw_factorials(struct report *r, char *error, size_t error_size)
{
    const struct factorial_list *list = &r->ratings.factorials;
    for (size_t i = 0; i < list->count && i < REPORT_QUESTIONS; i++)
        for (int narrow = 0; !list->items[i].refusal[0] && narrow < 2; narrow++)
            if (!draw_factorial(r, i, narrow, error, error_size))
                return false;
    return true;
}

static bool draw_frames(struct report *r, char *error, size_t error_size)
{
    for (int narrow = 0; figure_frames_rows(&r->frames) && narrow < 2; narrow++) {
        struct figure_text text = {narrow ? "frames-n" : "frames-w", "Frame times per option",
                                   "Median, 95th and 99th percentile; the table below has every number.",
                                   narrow ? "narrow" : "wide"};
        struct figure_desc desc = {narrow, &text};
        char **svg = narrow ? &r->frames_figure.narrow : &r->frames_figure.wide;
        if (!figure_frames(r->sample, &r->frames, &desc, svg, error, error_size))
            return false;
    }
    return true;
}

static bool draw_thresholds(struct report *r, char *error, size_t error_size)
{
    for (size_t i = 0; i < r->thresholds.cell_count && i < REPORT_STAIRCASES; i++)
        for (int narrow = 0; narrow < 2; narrow++) {
            char id[32];
            snprintf(id, sizeof id, "threshold-%zu-%c", i, narrow ? 'n' : 'w');
            struct figure_text text = {
                id, "Right answers by level, and thresholds",
                "Shares of right answers, fitted functions and each person's threshold; the "
                "tables have the numbers.",
                narrow ? "narrow" : "wide"};
            struct figure_desc desc = {narrow, &text};
            char **svg = narrow ? &r->threshold_figures[i].narrow : &r->threshold_figures[i].wide;
            if (r->thresholds.cells[i].steps &&
                !r->thresholds.cells[i].graded && // a scale has no right answers
                !figure_thresholds(&r->thresholds.cells[i], &desc, svg, error, error_size))
                return false;
        }
    return true;
}

static bool draw_adjusted(struct report *r, char *error, size_t error_size)
{
    const struct adjusted_cell *cells[REPORT_ADJUSTED];
    size_t count = 0;
    for (size_t i = 0; i < r->adjusted.cell_count && count < REPORT_ADJUSTED; i++)
        if (strcmp(r->adjusted.cells[i].parameter, r->adjusted.cells[0].parameter) == 0)
            cells[count++] = &r->adjusted.cells[i];
    for (int narrow = 0; count && narrow < 2; narrow++) {
        struct figure_text text = {
            narrow ? "adjusted-n" : "adjusted-w", "Adjusted values",
            "Each person's mean and the mean over people; the table below has every number.",
            narrow ? "narrow" : "wide"};
        struct figure_desc desc = {narrow, &text};
        char **svg = narrow ? &r->adjusted_figure.narrow : &r->adjusted_figure.wide;
        if (!figure_adjusted(cells, count, &desc, svg, error, error_size))
            return false;
    }
    return true;
}

bool report_draw(struct report *r, char *error, size_t error_size)
{
    return report_draw_bench(r, error, error_size) && draw_choices(r, error, error_size) &&
           draw_three(r, error, error_size) && draw_ratings(r, error, error_size) &&
           draw_factorials(r, error, error_size) && draw_frames(r, error, error_size) &&
           draw_thresholds(r, error, error_size) && draw_adjusted(r, error, error_size);
}

void report_free_figures(struct report *r)
{
    free(r->choices_figure.wide);
    free(r->choices_figure.narrow);
    free(r->three_figure.wide);
    free(r->three_figure.narrow);
    free(r->frames_figure.wide);
    free(r->frames_figure.narrow);
    free(r->adjusted_figure.wide);
    free(r->adjusted_figure.narrow);
    for (int i = 0; i < BENCH_FIGURES; i++) {
        free(r->bench_figures[i].wide);
        free(r->bench_figures[i].narrow);
    }
    for (int i = 0; i < REPORT_STAIRCASES; i++) {
        free(r->threshold_figures[i].wide);
        free(r->threshold_figures[i].narrow);
    }
    for (int i = 0; i < REPORT_QUESTIONS; i++) {
        free(r->ratings_figures[i].wide);
        free(r->ratings_figures[i].narrow);
        free(r->factorial_figures[i].wide);
        free(r->factorial_figures[i].narrow);
        free(r->likert_figures[i].wide);
        free(r->likert_figures[i].narrow);
    }
}

static bool write_pair(struct figure_files *files, const struct figure_pair *pair, const char *name,
                       size_t number, char *error, size_t error_size)
{
    char wide[64], narrow[80];
    if (number)
        snprintf(wide, sizeof wide, "%s_%zu", name, number);
    else
        snprintf(wide, sizeof wide, "%s", name);
    snprintf(narrow, sizeof narrow, "%s_narrow", wide);
    return figure_files_write(files, wide, pair->wide, error, error_size) &&
           figure_files_write(files, narrow, pair->narrow, error, error_size);
}

// Numbers are those of the report's order, from 1.
bool report_write_figures(const struct report *r, struct figure_files *files, char *error, size_t error_size)
{
    const struct {
        const char *name;
        const struct figure_pair *pairs;
        size_t count; // 0: one, without a number
    } all[] = {{"choices", &r->choices_figure, 0},
               {"net_preference", &r->three_figure, 0},
               {"ratings_before_after", r->ratings_figures, REPORT_QUESTIONS},
               {"ratings_means", r->factorial_figures, REPORT_QUESTIONS},
               {"ratings_answers", r->likert_figures, REPORT_QUESTIONS},
               {"thresholds", r->threshold_figures, REPORT_STAIRCASES},
               {"adjusted", &r->adjusted_figure, 0},
               {"speed_error", r->bench_figures, BENCH_FIGURES},
               {"frame_times", &r->frames_figure, 0}};
    bool ok = figure_files_begin(files, error, error_size);
    for (size_t i = 0; ok && i < sizeof all / sizeof all[0]; i++)
        for (size_t j = 0; ok && j < (all[i].count ? all[i].count : 1); j++)
            ok = write_pair(files, &all[i].pairs[j], all[i].name, all[i].count ? j + 1 : 0, error, error_size);
    return ok;
}
