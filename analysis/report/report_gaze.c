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

static void rate(FILE *out, const struct gaze_record *record)
{
    char words[GAZE_REASON_SIZE];
    gaze_rate_words(record, words);
    html_cell(out, "td", "%s", words[0] ? words : "\u2013");
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
        rate(out, &records[i]);
        number(out, "%.2f", q->samples ? 100 * (double)q->invalid / (double)q->samples : (double)NAN);
        number(out, "%.2f", 100 * records[i].missing / gaze_due(&records[i]));
        number(out, "%.2f", accuracy ? accuracy->error.mean : (double)NAN);
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

// A cell over all the columns that one reason keeps empty.
static void no_estimate(FILE *out, int columns, const char *why)
{
    fprintf(out, "<td colspan=\"%d\" class=\"word\">", columns);
    html_printf(out, "not estimable: %s", why);
    fputs("</td>", out);
}

static void sequence_row(FILE *out, const struct gaze_record *person)
{
    char vmax[GAZE_REASON_SIZE], c[GAZE_REASON_SIZE], power[GAZE_REASON_SIZE];
    const struct stat_main_sequence *m = &person->main_sequence;
    bool level = !gaze_sequence_problem(person, GAZE_VMAX, vmax);
    bool shape = !gaze_sequence_problem(person, GAZE_C, c);
    bool straight = !gaze_sequence_problem(person, GAZE_POWER, power);
    bool same = !shape && strcmp(c, power) == 0;
    if (level)
        html_cell(out, "td", "%.0f [%.0f, %.0f]", m->vmax.value, m->vmax.low, m->vmax.high);
    if (level && shape)
        html_cell(out, "td", "%.2f [%.2f, %.2f]", m->c.value, m->c.low, m->c.high);
    else
        no_estimate(out, (level ? 1 : 2) + (same ? 2 : 0), c);
    if (straight) {
        html_cell(out, "td", "%.1f [%.1f, %.1f]", m->k.value, m->k.low, m->k.high);
        html_cell(out, "td", "%.3f [%.3f, %.3f]", m->b.value, m->b.low, m->b.high);
    } else if (!same) {
        no_estimate(out, 2, power);
    }
}

static void sequence_table(const struct report *r)
{
    static const char *const headings[] = {
        "<participant", "<eye", "saccades", "V<sub>max</sub>, \u00b0/s", "c, \u00b0", "k, \u00b0/s", "b", NULL};
    FILE *out = r->out;
    char words[GAZE_WORDS_SIZE];
    table_head(out, "Main sequence", headings);
    for (size_t i = 0; i < r->gaze.person_count; i++) {
        const struct gaze_record *person = &r->gaze.people[i];
        who(r, person);
        html_cell(out, "td", "%zu of %" PRId64, person->main_sequence.n, person->quality.saccade_ms.n);
        sequence_row(out, person);
        fputs("</tr>\n", out);
    }
    table_foot(out);
    gaze_sequence_words(&r->gaze, words);
    fputs("<p>", out);
    html_printf(out, "%s", words);
    fputs("</p>\n", out);
}

static void targets_table(const struct report *r)
{
    static const char *const headings[] = {
        "<participant",     "<eye", "<target", "samples", "M (SD)", "median", "samples outside",
        "target not known", NULL};
    const struct gaze_over *over = &r->gaze_over;
    FILE *out = r->out;
    int64_t flat = gaze_flat_samples(&r->gaze);
    if (over->target_count == 0 && flat == 0)
        fputs("<p>No trial that counts had a fixation target: accuracy and distance to it are not "
              "estimable.</p>\n",
              out);
    if (flat)
        fprintf(
            out,
            "<p class=\"note\">Samples of one eye that cannot be compared with the target, since the file (of "
            "an older version) does not tell how far away it was: %" PRId64
            ". Accuracy and distance are not estimable by them.</p>\n",
            flat);
    if (over->target_count == 0)
        return;
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

void report_gaze(const struct report *r)
{
    const struct gaze_report *g = &r->gaze;
    report_heading(r, "Gaze");
    if (g->record_count + g->latency_count + g->check_count == 0) {
        fputs("<p class=\"note\">No gaze was recorded in any trial.</p>\n", r->out);
        report_gaze_limits(r);
        return;
    }
    report_gaze_methods(r);
    report_gaze_limits(r);
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
