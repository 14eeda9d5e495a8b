// Gaze: the tracker's quality, fixations and saccades, distance to targets, age of the gaze in frames.
#include "analysis/report/html.h"
#include "analysis/report/sections.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

static void table_head(FILE *out, const char *caption, const char *const *headings)
{
    fprintf(
        out,
        "<div class=\"table\" tabindex=\"0\" role=\"region\" aria-label=\"%s\"><table>\n<caption>%s</caption>\n"
        "<thead><tr>",
        caption, caption);
    for (; *headings; headings++) {
        bool word = **headings == '<';
        fprintf(out, "<th scope=\"col\"%s>%s</th>", word ? " class=\"word\"" : "", *headings + word);
    }
    fputs("</tr></thead>\n<tbody>\n", out);
}

static void table_foot(FILE *out)
{
    fputs("</tbody></table></div>\n", out);
}

static void number(FILE *out, const char *format, double value)
{
    char text[48];
    snprintf(text, sizeof text, format, value);
    html_cell(out, "td", "%s", isnan(value) ? "\u2013" : text);
}

static void three(FILE *out, double x, double y, double both)
{
    if (isnan(both))
        html_cell(out, "td", "\u2013");
    else
        html_cell(out, "td", "%.3f, %.3f, %.3f", x, y, both);
}

static void who(const struct report *r, const struct gaze_record *record)
{
    fputs("<tr>", r->out);
    html_cell(r->out, "th scope=\"row\" class=\"word\"", "%s", r->sample->people[record->person].code);
    if (record->session != SAMPLE_NONE)
        html_cell(r->out, "td", "%" PRId64, r->sample->sessions[record->session].id);
    html_cell(r->out, "td class=\"word\"", "%s", gaze_eye_words(record->eye));
}

static void quality_table(const struct report *r, const struct gaze_record *records, size_t count)
{
    static const char *const headings[] = {"<participant",
                                           "session",
                                           "<eye",
                                           "samples",
                                           "Hz",
                                           "not valid, %",
                                           "missing, %",
                                           "accuracy, \u00b0",
                                           "offset x, y, \u00b0",
                                           NULL};
    static const char *const people[] = {
        "<participant",        "<eye", "samples", "Hz", "not valid, %", "missing, %", "accuracy, \u00b0",
        "offset x, y, \u00b0", NULL};
    FILE *out = r->out;
    bool of_sessions = records == r->gaze.records;
    table_head(out, of_sessions ? "Gaze per session: data loss and accuracy" : "Gaze: data loss and accuracy",
               of_sessions ? headings : people);
    for (size_t i = 0; i < count; i++) {
        const struct gaze_quality *q = &records[i].quality;
        const struct gaze_target *accuracy = gaze_accuracy(&records[i]);
        who(r, &records[i]);
        html_cell(out, "td", "%" PRId64, q->samples);
        number(out, "%.1f", records[i].rate_hz);
        number(out, "%.2f", q->samples ? 100 * (double)q->invalid / (double)q->samples : (double)NAN);
        number(out, "%.2f", 100 * records[i].missing / gaze_due(&records[i]));
        number(out, "%.2f", accuracy ? accuracy->distance.mean : (double)NAN);
        if (accuracy)
            html_cell(out, "td", "%+.2f, %+.2f", accuracy->offset.mean_x, accuracy->offset.mean_y);
        else
            html_cell(out, "td", "\u2013");
        fputs("</tr>\n", out);
    }
    table_foot(out);
}

static void precision_table(const struct report *r, const struct gaze_record *records, size_t count)
{
    static const char *const headings[] = {
        "<participant",          "session",         "<eye", "RMS-S2S h, v, both, \u00b0",
        "SD h, v, both, \u00b0", "BCEA, deg\u00b2", NULL};
    static const char *const people[] = {
        "<participant", "<eye", "RMS-S2S h, v, both, \u00b0", "SD h, v, both, \u00b0", "BCEA, deg\u00b2", NULL};
    FILE *out = r->out;
    bool of_sessions = records == r->gaze.records;
    table_head(out, of_sessions ? "Precision per session" : "Precision", of_sessions ? headings : people);
    for (size_t i = 0; i < count; i++) {
        const struct gaze_quality *q = &records[i].quality;
        who(r, &records[i]);
        three(out, gaze_quality_rms_x(q), gaze_quality_rms_y(q), gaze_quality_rms(q));
        three(out, gaze_spread_sd_x(&q->within), gaze_spread_sd_y(&q->within), gaze_spread_sd(&q->within));
        number(out, "%.3f", gaze_spread_bcea(&q->within, r->gaze.options.bcea_share));
        fputs("</tr>\n", out);
    }
    table_foot(out);
}

static void events_table(const struct report *r)
{
    static const char *const headings[] = {"<participant",
                                           "<eye",
                                           "fixations",
                                           "duration M (SD), ms",
                                           "saccades",
                                           "amplitude M (SD), \u00b0",
                                           "duration M, ms",
                                           "peak M, \u00b0/s",
                                           NULL};
    FILE *out = r->out;
    table_head(out, "Fixations and saccades", headings);
    for (size_t i = 0; i < r->gaze.person_count; i++) {
        const struct gaze_quality *q = &r->gaze.people[i].quality;
        who(r, &r->gaze.people[i]);
        html_cell(out, "td", "%" PRId64 " (%" PRId64 " cut)", q->fixation_ms.n + q->fixations_cut,
                  q->fixations_cut);
        if (q->fixation_ms.n > 1)
            html_cell(out, "td", "%.0f (%.0f)", q->fixation_ms.mean, gaze_running_sd(&q->fixation_ms));
        else
            html_cell(out, "td", "\u2013");
        html_cell(out, "td", "%" PRId64 " (%" PRId64 " cut)", q->saccade_ms.n + q->saccades_cut,
                  q->saccades_cut);
        if (q->saccade_ms.n > 1)
            html_cell(out, "td", "%.2f (%.2f)", q->amplitude_deg.mean, gaze_running_sd(&q->amplitude_deg));
        else
            html_cell(out, "td", "\u2013");
        number(out, "%.1f", gaze_running_mean(&q->saccade_ms));
        number(out, "%.0f", gaze_running_mean(&q->peak_deg_s));
        fputs("</tr>\n", out);
    }
    table_foot(out);
}

static void sequence_table(const struct report *r)
{
    static const char *const headings[] = {
        "<participant", "<eye", "saccades", "V<sub>max</sub>, \u00b0/s", "c, \u00b0", "k, \u00b0/s", "b", NULL};
    FILE *out = r->out;
    table_head(out, "Main sequence", headings);
    for (size_t i = 0; i < r->gaze.person_count; i++) {
        const struct stat_main_sequence *m = &r->gaze.people[i].main_sequence;
        who(r, &r->gaze.people[i]);
        html_cell(out, "td", "%zu", m->n);
        if (m->problem) {
            html_cell(out, "td colspan=\"2\" class=\"word\"", "not estimable: %s", m->problem);
        } else {
            html_cell(out, "td", "%.0f [%.0f, %.0f]", m->vmax.value, m->vmax.low, m->vmax.high);
            html_cell(out, "td", "%.2f [%.2f, %.2f]", m->c.value, m->c.low, m->c.high);
        }
        if (m->power_problem) {
            html_cell(out, "td colspan=\"2\" class=\"word\"", "not estimable: %s", m->power_problem);
        } else {
            html_cell(out, "td", "%.1f [%.1f, %.1f]", m->k.value, m->k.low, m->k.high);
            html_cell(out, "td", "%.3f [%.3f, %.3f]", m->b.value, m->b.low, m->b.high);
        }
        fputs("</tr>\n", out);
    }
    table_foot(out);
}

static void targets_table(const struct report *r)
{
    static const char *const headings[] = {
        "<participant",     "<eye", "<target", "samples", "M (SD)", "median", "samples outside",
        "target not known", NULL};
    const struct gaze_over *over = &r->gaze_over;
    FILE *out = r->out;
    if (over->target_count == 0) {
        fputs("<p>No trial that counts had a fixation target: accuracy and distance to it are not "
              "estimable.</p>\n",
              out);
        return;
    }
    table_head(out, "Distance of the gaze to the fixation target, degrees", headings);
    for (size_t i = 0; i < r->gaze.person_count; i++)
        for (size_t j = 0; j < r->gaze.people[i].target_count; j++) {
            const struct gaze_target *t = &r->gaze.people[i].targets[j];
            who(r, &r->gaze.people[i]);
            html_cell(out, "td class=\"word\"", "%s", t->fixation);
            html_cell(out, "td", "%" PRId64, t->samples);
            if (t->samples > 1)
                html_cell(out, "td", "%.2f (%.2f)", t->distance.mean, gaze_running_sd(&t->distance));
            else
                html_cell(out, "td", "\u2013");
            number(out, "%.2f", gaze_bins_quantile(&t->distances, 0.5));
            html_cell(out, "td", "%" PRId64, t->outside);
            html_cell(out, "td", "%" PRId64, t->unknown);
            fputs("</tr>\n", out);
        }
    table_foot(out);
    for (size_t i = 0; i < over->target_count; i++) {
        const struct gaze_over_target *t = &over->targets[i];
        fputs("<p>", out);
        html_printf(out,
                    "Target \u201c%s\u201d: all samples M = %.2f\u00b0, SD = %.2f\u00b0, median %.2f\u00b0",
                    t->fixation, gaze_running_mean(&t->samples), gaze_running_sd(&t->samples), t->median);
        if (isnan(t->t.ci_low))
            html_printf(out, "; over people not estimable (n = %zu).", t->people.n);
        else
            html_printf(out, "; over %zu people M = %.2f\u00b0 [%.2f, %.2f], SD = %.2f\u00b0.", t->people.n,
                        t->people.mean, t->t.ci_low, t->t.ci_high, t->people.sd);
        fputs("</p>\n", out);
    }
}

static void latencies_table(const struct report *r)
{
    static const char *const headings[] = {
        "<participant",    "session", "frames", "age median, p95, p99", "to light median, p95, p99",
        "light estimated", NULL};
    FILE *out = r->out;
    if (r->gaze.latency_count == 0)
        return;
    table_head(out, "Age of the gaze in stimulus frames that followed it, ms", headings);
    for (size_t i = 0; i < r->gaze.latency_count; i++) {
        const struct gaze_latency *l = &r->gaze.latencies[i];
        const struct gaze_bins *bins[] = {&l->age, &l->to_light};
        fputs("<tr>", out);
        html_cell(out, "th scope=\"row\" class=\"word\"", "%s",
                  r->sample->people[r->sample->sessions[l->session].person].code);
        html_cell(out, "td", "%" PRId64, r->sample->sessions[l->session].id);
        html_cell(out, "td", "%" PRId64, l->frames);
        for (int j = 0; j < 2; j++)
            if (bins[j]->n)
                html_cell(out, "td", "%.1f, %.1f, %.1f", gaze_bins_quantile(bins[j], 0.5),
                          gaze_bins_quantile(bins[j], 0.95), gaze_bins_quantile(bins[j], 0.99));
            else
                html_cell(out, "td", "\u2013");
        html_cell(out, "td", "%" PRId64, l->estimated);
        fputs("</tr>\n", out);
    }
    table_foot(out);
}

static void limits(const struct report *r)
{
    const struct gaze_report *g = &r->gaze;
    FILE *out = r->out;
    size_t named = 0, failed = 0;
    struct gaze_running accuracy = {.n = 0};
    double worst = 0;
    for (size_t i = 0; i < g->check_count; i++) {
        failed += !g->checks[i].passed;
        if (isnan(g->checks[i].accuracy_deg))
            continue;
        gaze_running_add(&accuracy, g->checks[i].accuracy_deg);
        worst = fmax(worst, g->checks[i].accuracy_deg);
    }
    if (g->check_count)
        fprintf(out, "<p>Independent checks of the tracker at %zu point%s, %zu of them not passed.",
                g->check_count, g->check_count == 1 ? "" : "s", failed);
    if (accuracy.n)
        fprintf(out, " Mean distance from the points: %.2f\u00b0, at worst %.2f\u00b0.", accuracy.mean, worst);
    fputs(g->check_count ? "</p>\n" : "", out);
    for (size_t i = 0; i < g->silent_count; i++) {
        fputs("<p class=\"note\">", out);
        html_printf(out, "Session %" PRId64 " had a tracker and no sample in any trial.",
                    r->sample->sessions[g->silent[i]].id);
        fputs("</p>\n", out);
    }
    for (size_t i = 0; i < r->sample->exclusion_count; i++) {
        const struct sample_exclusion *e = &r->sample->exclusions[i];
        if (strncmp(e->rule, "gaze_", 5) != 0)
            continue;
        fputs(named++ ? "" : "<p>The protocol\u2019s limits for the gaze were exceeded:</p>\n<ul>\n", out);
        fputs("<li>", out);
        html_printf(out, "%s, trial %" PRId64 ", %s (%s): %s", e->code, e->trial_id, e->rule, e->rule_set,
                    e->reason);
        fputs("</li>\n", out);
    }
    fputs(named ? "</ul>\n" : "", out);
}

static void methods(const struct report *r)
{
    const struct gaze_options *o = &r->gaze.options;
    FILE *out = r->out;
    fputs("<p>", out);
    html_printf(
        out,
        "Degrees of visual angle in the head\u2019s frame, right and up positive; samples of the last attempt "
        "of each trial. Not valid: of the samples that came; missing: of those due at the measured rate. "
        "Accuracy: mean distance from a target at rest. RMS from sample to sample, SD and BCEA (square "
        "degrees, P = %g, Crossland & Rubin 2002) within fixations. Saccades are faster than %g\u00b0/s over "
        "%g ms (I-VT, Salvucci & Goldberg 2000; Olsen 2012), fixations last %g ms or more; gaps over %g ms "
        "break them, and what touches one is cut: counted, not measured. ",
        o->bcea_share, o->rules.velocity_deg_s, o->rules.window_ms, o->rules.min_fixation_ms, o->gap_ms);
    fputs("Main sequence, of peak velocity V and amplitude A: V = V<sub>max</sub> (1 \u2212 e<sup>\u2212A / "
          "c</sup>) and "
          "V\u00a0=\u00a0k\u00a0A<sup>b</sup>. ",
          out);
    html_printf(
        out,
        "Distance to the target as Weier et al. 2016, section 4.2.2: samples within %g\u00b0 left and right "
        "and "
        "%g\u00b0 up and down. Age: from a sample\u2019s arrival to the start of work on the frame, and to "
        "light.",
        o->region_x_deg, o->region_y_deg);
    fputs("</p>\n", out);
}

void report_gaze(const struct report *r)
{
    const struct gaze_report *g = &r->gaze;
    report_heading(r, "Gaze");
    if (g->record_count + g->latency_count + g->check_count == 0) {
        fputs("<p class=\"note\">No gaze was recorded in any trial.</p>\n", r->out);
        limits(r);
        return;
    }
    methods(r);
    limits(r);
    if (g->record_count) {
        quality_table(r, g->people, g->person_count);
        precision_table(r, g->people, g->person_count);
        if (g->record_count != g->person_count) {
            quality_table(r, g->records, g->record_count);
            precision_table(r, g->records, g->record_count);
        }
        events_table(r);
        sequence_table(r);
        targets_table(r);
    }
    latencies_table(r);
}
