#include "analysis/report/report.h"

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
         report_draw(&r, error, error_size) && write_to(&r, path, temporary, error, error_size) &&
         (!files || report_write_figures(&r, files, error, error_size));
    report_free_figures(&r);
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
