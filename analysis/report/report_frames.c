#include "analysis/report/html.h"
#include "analysis/report/sections.h"

#include <inttypes.h>
#include <math.h>

static void times_cells(FILE *out, const struct frame_times *t)
{
    const double values[] = {t->median, t->p95, t->p99};
    for (int i = 0; i < 3; i++) {
        if (t->count)
            html_cell(out, "td", "%.2f", values[i]);
        else
            html_cell(out, "td", "\u2013");
    }
}

static void group_row(const struct report *r, const struct frame_group *g)
{
    FILE *out = r->out;
    fputs("<tr>", out);
    html_cell(out, "th scope=\"row\" class=\"word\"", "%s", g->phase);
    html_cell(out, "td class=\"word\"", "%s", report_label(r, g->condition));
    html_cell(out, "td", "%" PRId64, g->frames);
    if (g->late_known == g->frames)
        html_cell(out, "td", "%" PRId64, g->late);
    else if (g->late_known)
        html_cell(out, "td", "%" PRId64 " of %" PRId64, g->late, g->late_known);
    else
        html_cell(out, "td", "\u2013");
    times_cells(out, &g->gpu);
    times_cells(out, &g->cpu);
    if (g->interval.count)
        html_cell(out, "td", "%.2f", g->interval.median);
    else
        html_cell(out, "td", "\u2013");
    if (isnan(g->shaded_px_mean))
        html_cell(out, "td", "\u2013");
    else
        html_cell(out, "td", "%.0f", g->shaded_px_mean);
    fputs("</tr>\n", out);
}

// `known`: for whom the value is known, of the row's people: a display may not tell its rate, a time may be 0.
static void pair_cell(FILE *out, size_t known, size_t people, const double value[3], const char *unit)
{
    char of[64] = "";
    if (known < people)
        snprintf(of, sizeof of, ", known of %zu", known);
    if (isnan(value[0]))
        html_cell(out, "td", "\u2013");
    else if (isnan(value[1]))
        html_cell(out, "td", "%.2f%s%s", value[0], unit, of);
    else
        html_cell(out, "td", "%.2f%s (%.2f to %.2f)%s", value[0], unit, value[1], value[2], of);
}

static void pair_row(const struct report *r, const struct frames_pair *p)
{
    const struct frames_mean *d = &p->difference_ms, *q = &p->log_ratio, *late = &p->late;
    FILE *out = r->out;
    fputs("<tr>", out);
    html_cell(out, "th scope=\"row\" class=\"word\"", "%s", report_label(r, p->test));
    html_cell(out, "td class=\"word\"", "%s", report_label(r, p->reference));
    html_cell(out, "td class=\"word\"", "%s", p->measure == FRAMES_GPU ? "GPU" : "CPU");
    html_cell(out, "td", "%zu", p->trials);
    html_cell(out, "td", "%zu", p->people);
    pair_cell(out, d->people, p->people, (double[]){d->mean, d->t.ci_low, d->t.ci_high}, "\u00a0ms");
    pair_cell(out, q->people, p->people, (double[]){exp(q->mean), exp(q->t.ci_low), exp(q->t.ci_high)}, "");
    pair_cell(out, late->people, p->people,
              (double[]){100 * late->mean, 100 * late->t.ci_low, 100 * late->t.ci_high}, "\u00a0%");
    fputs("</tr>\n", out);
}

static void pairs_table(const struct report *r)
{
    const struct frames_pairs *pairs = &r->frames_pairs;
    FILE *out = r->out;
    if (pairs->count == 0)
        return;
    fputs("<div class=\"table\" tabindex=\"0\" role=\"region\" aria-label=\"Frames of both options\"><table "
          "class=\"wrap\">\n<caption>",
          out);
    html_printf(
        out,
        "Test option less reference within trials: medians of full frames, their ratio, and percent of them "
        "late. Each trial counts once, a person\u2019s trials are averaged; in brackets %g\u00a0%% t "
        "intervals over people, none for one person%s",
        100 * r->conf, pairs->simulated_clock ? ". Late frames are the simulated clock\u2019s" : "");
    fputs("</caption>\n<thead><tr><th scope=\"col\" class=\"word\">test option</th><th scope=\"col\" "
          "class=\"word\">reference</th><th scope=\"col\" class=\"word\">time</th><th "
          "scope=\"col\">trials</th><th "
          "scope=\"col\">people</th><th scope=\"col\">difference</th><th scope=\"col\">ratio</th><th "
          "scope=\"col\">late</th></tr></thead>\n<tbody>\n",
          out);
    for (size_t i = 0; i < pairs->count; i++)
        pair_row(r, &pairs->pairs[i]);
    fputs("</tbody></table></div>\n", out);
}

void report_frames(const struct report *r)
{
    const struct frames *f = &r->frames;
    FILE *out = r->out;
    report_heading(r, "Frame times");
    if (f->group_count == 0) {
        fputs("<p class=\"note\">No frame was recorded.</p>\n", out);
        return;
    }
    fputs("<p>", out);
    html_printf(out, "%" PRId64 " frames", f->frames);
    if (f->late_known)
        html_printf(out, ", %" PRId64 " of them late (%.2f\u00a0%%%s)", f->late,
                    100 * (double)f->late / (double)f->late_known,
                    f->late_known < f->frames ? " of those known" : "");
    if (f->late_known < f->frames)
        html_printf(out,
                    ". Of %" PRId64 " it is not known whether they were late: the display told no refresh rate",
                    f->frames - f->late_known);
    fputc('.', out);
    if (f->simulated_clock)
        fputs(" The clock was simulated: intervals and late frames are that clock\u2019s and say nothing of "
              "the machine.",
              out);
    fputs("</p>\n", out);
    char caption[512];
    snprintf(
        caption, sizeof caption,
        "Time per stimulus frame on the GPU (on the CPU where no GPU time is known): dot and number, median; "
        "dark line to the 95th, pale line to the 99th percentile. Over all frames of an option, whatever the "
        "scene: options that were shown in different scenes are not compared by it%s",
        r->frames_pairs.count ? ", but by the last table of this section, within trials." : ".");
    report_figure(r, &r->frames_figure, caption);
    fputs("<div class=\"table\" tabindex=\"0\" role=\"region\" aria-label=\"Frame "
          "times\"><table>\n<caption>Times in milliseconds; "
          "percentiles as R\u2019s quantile() has them (type 7)</caption>\n<thead><tr><th scope=\"col\" "
          "class=\"word\">phase</th><th "
          "scope=\"col\" "
          "class=\"word\">option</th><th scope=\"col\">frames</th><th scope=\"col\">late</th><th "
          "scope=\"col\">GPU "
          "median</th><th scope=\"col\">p95</th><th scope=\"col\">p99</th><th scope=\"col\">CPU median</th>"
          "<th scope=\"col\">p95</th><th scope=\"col\">p99</th><th scope=\"col\">interval median</th>"
          "<th scope=\"col\">pixels shaded, mean</th></tr></thead>\n<tbody>\n",
          out);
    for (size_t i = 0; i < f->group_count; i++)
        group_row(r, &f->groups[i]);
    fputs("</tbody></table></div>\n", out);
    pairs_table(r);
}
