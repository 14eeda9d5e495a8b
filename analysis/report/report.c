#include "analysis/report/report.h"

#include "analysis/report/figures.h"
#include "analysis/report/html.h"
#include "analysis/report/sections.h"
#include "report_css.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

const char *report_label(const struct report *r, size_t condition)
{
    return condition == SAMPLE_NONE ? "gray or text" : r->sample->conditions[condition].words;
}

bool report_outside(const struct choice_cell *cell)
{
    return cell->clear;
}

void report_figure(const struct report *r, const struct figure_pair *figure, const char *caption)
{
    if (figure->wide && figure->narrow)
        fprintf(r->out, "<figure>\n%s%s<figcaption>%s</figcaption>\n</figure>\n", figure->wide, figure->narrow,
                caption);
}

void report_heading(const struct report *r, const char *heading)
{
    fprintf(r->out, "<h2>%s</h2>\n<p class=\"source\">Data %.16s, fovstats " FOVSTUDY_VERSION "</p>\n", heading,
            r->sample->data_hash);
}

static const char *title_of(const struct report *r)
{
    return r->sample->sessions[0].protocol_name;
}

static void write_head(const struct report *r)
{
    FILE *out = r->out;
    bool simulated = r->sample->simulated;
    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
          "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
          "<link rel=\"icon\" href=\"data:,\">\n<title>",
          out);
    html_printf(out, "%s%s: study report", simulated ? "SIMULATED DATA \u2013 " : "", title_of(r));
    fputs("</title>\n<style>\n", out);
    fwrite(report_css, 1, sizeof report_css, out);
    fprintf(out, "</style>\n</head>\n<body%s>\n", simulated ? " class=\"branded\"" : "");
    if (simulated)
        fputs("<div class=\"brand\" role=\"note\">SIMULATED DATA: no person took part</div>\n", out);
    fputs("<main>\n<header>\n<h1>", out);
    html_printf(out, "%s%s: study report", simulated ? "SIMULATED DATA \u2013 " : "", title_of(r));
    fputs("</h1>\n", out);
    if (r->sample->sessions[0].title[0]) {
        fputs("<p>", out);
        html_printf(out, "%s", r->sample->sessions[0].title);
        fputs("</p>\n", out);
    }
    fprintf(out,
            "<p class=\"source\">Data SHA-256 <code>%s</code>, fovstats " FOVSTUDY_VERSION "</p>\n</header>\n",
            r->sample->data_hash);
}

// The hash in a section's head says nothing of these.
static void not_hashed(const struct report *r, const char *rows)
{
    fprintf(r->out, "<p class=\"source\">The data hash does not cover the rows of %s.</p>\n", rows);
}

static bool write_page(const struct report *r, char *error, size_t error_size)
{
    write_head(r);
    report_summary(r);
    report_sample(r);
    report_methods(r);
    report_planned(r);
    report_choices(r);
    report_toggles(r);
    report_ratings(r);
    report_thresholds(r);
    report_effects(r);
    report_checks(r);
    report_frames(r);
    not_hashed(r, "frames");
    report_gaze(r);
    not_hashed(r, "gaze and frames");
    report_bench(r);
    if (!report_quality(r, error, error_size))
        return false;
    report_definitions(r);
    fprintf(r->out, "<footer>Made by fovstats " FOVSTUDY_VERSION " from data with SHA-256 <code>%s</code>",
            r->sample->data_hash);
    fputs(", which covers sessions, trials, answers and exclusions, not the logs of frames and "
          "gaze.</footer>\n</main>\n</body>\n</html>\n",
          r->out);
    return true;
}

// --- figures ---

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

// --- the file ---

static bool write_to(struct report *r, const char *path, const char *temporary, char *error, size_t error_size)
{
    r->out = fopen(temporary, "w");
    if (!r->out) {
        snprintf(error, error_size, "%s: cannot be written: %s", path, strerror(errno));
        return false;
    }
    bool ok = write_page(r, error, error_size);
    bool written = fflush(r->out) == 0 && !ferror(r->out) && fsync(fileno(r->out)) == 0;
    int reason = errno;
    written = fclose(r->out) == 0 && written;
    if (ok && written && rename(temporary, path) == 0)
        return true;
    if (ok)
        snprintf(error, error_size, "%s: cannot be written: %s", path, strerror(written ? errno : reason));
    unlink(temporary);
    return false;
}

static bool load_tests(struct report_tests *out, struct report *r, enum sample_rules rules, char *error,
                       size_t error_size)
{
    sample_apply(r->sample, rules);
    bool ok = choices_load(&out->choices, r->sample, r->conf, error, error_size) &&
              ratings_load(&out->ratings, r->sample, r->conf, false, error, error_size) &&
              thresholds_load(&out->thresholds, r->sample, &(struct threshold_options){.conf = r->conf}, error,
                              error_size) &&
              jod_load(&out->jod, r->sample, r->conf, 0, JOD_SEED, error, error_size);
    sample_apply(r->sample, SAMPLE_RULES);
    return ok;
}

// The bootstrap is left to fovstats thresholds: it would take most of a report's time.
static bool load_thresholds(struct report *r, char *error, size_t error_size)
{
    const struct threshold_options options = {.conf = r->conf, .bayes = true};
    return thresholds_load(&r->thresholds, r->sample, &options, error, error_size) &&
           adjusted_load(&r->adjusted, r->sample, r->conf, error, error_size) &&
           jod_load(&r->jod, r->sample, r->conf, JOD_REPLICATES, JOD_SEED, error, error_size);
}

static bool load_planned(struct report *r, char *error, size_t error_size)
{
    const struct planned_sources sources = {&r->ratings, &r->thresholds, &r->adjusted};
    return planned_load(&r->planned, r->sample, &r->plans, &sources, r->conf, error, error_size);
}

static bool load(struct report *r, char *error, size_t error_size)
{
    if (!choices_load(&r->choices, r->sample, r->conf, error, error_size))
        return false;
    if (!plans_load(&r->plans, r->sample) || !choice_factors_load(&r->factors, &r->choices)) {
        snprintf(error, error_size, "not enough memory");
        return false;
    }
    return ratings_load(&r->ratings, r->sample, r->conf, false, error, error_size) &&
           checks_load(&r->checks, r->sample, r->conf, error, error_size) &&
           effects_load(&r->effects, r->sample, r->conf, error, error_size) &&
           report_load_frames(r, error, error_size) && load_thresholds(r, error, error_size) &&
           load_planned(r, error, error_size) &&
           (r->sample->exclusion_count == 0 ||
            (load_tests(&r->all, r, SAMPLE_ALL_DATA, error, error_size) &&
             load_tests(&r->stricter, r, SAMPLE_STRICTER, error, error_size)));
}

static void free_tests(struct report_tests *tests)
{
    choices_free(&tests->choices);
    thresholds_free(&tests->thresholds);
    jod_free(&tests->jod);
    ratings_free(&tests->ratings);
}

static void free_figures(struct report *r)
{
    free(r->choices_figure.wide);
    free(r->choices_figure.narrow);
    free(r->three_figure.wide);
    free(r->three_figure.narrow);
    free(r->frames_figure.wide);
    free(r->frames_figure.narrow);
    free(r->adjusted_figure.wide);
    free(r->adjusted_figure.narrow);
    for (int i = 0; i < BENCH_SCENES; i++) {
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
static bool write_figures(const struct report *r, struct figure_files *files, char *error, size_t error_size)
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
               {"speed_error", r->bench_figures, BENCH_SCENES},
               {"frame_times", &r->frames_figure, 0}};
    bool ok = figure_files_begin(files, error, error_size);
    for (size_t i = 0; ok && i < sizeof all / sizeof all[0]; i++)
        for (size_t j = 0; ok && j < (all[i].count ? all[i].count : 1); j++)
            ok = write_pair(files, &all[i].pairs[j], all[i].name, all[i].count ? j + 1 : 0, error, error_size);
    return ok;
}

bool report_write(struct sample *sample, double conf, const char *path, char *error, size_t error_size)
{
    return report_write_with_figures(sample, conf, path, NULL, NULL, error, error_size);
}

bool report_write_with_figures(struct sample *sample, double conf, const char *path, const char *bench,
                               struct figure_files *files, char *error, size_t error_size)
{
    struct report r = {.sample = sample, .conf = conf};
    size_t size = strlen(path) + 32;
    char *temporary = malloc(size);
    bool ok = temporary != NULL;
    if (ok)
        snprintf(temporary, size, "%s.part-%ld", path, (long)getpid());
    else
        snprintf(error, error_size, "not enough memory");
    ok = ok && (!bench || bench_load(&r.bench, bench, error, error_size)) && load(&r, error, error_size) &&
         report_draw_bench(&r, error, error_size) && draw_choices(&r, error, error_size) &&
         draw_three(&r, error, error_size) && draw_ratings(&r, error, error_size) &&
         draw_factorials(&r, error, error_size) && draw_frames(&r, error, error_size) &&
         draw_thresholds(&r, error, error_size) && draw_adjusted(&r, error, error_size) &&
         write_to(&r, path, temporary, error, error_size) &&
         (!files || write_figures(&r, files, error, error_size));
    free_figures(&r);
    choice_factors_free(&r.factors);
    choices_free(&r.choices);
    plans_free(&r.plans);
    planned_free(&r.planned);
    ratings_free(&r.ratings);
    frames_free(&r.frames);
    frames_pairs_free(&r.frames_pairs);
    gaze_free(&r.gaze);
    checks_free(&r.checks);
    audit_free(&r.audit);
    thresholds_free(&r.thresholds);
    adjusted_free(&r.adjusted);
    bench_free(&r.bench);
    jod_free(&r.jod);
    free_tests(&r.all);
    free_tests(&r.stricter);
    free(temporary);
    return ok;
}
