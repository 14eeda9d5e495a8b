// Both options of a trial, rated after the choice.
#include "analysis/report/html.h"
#include "analysis/report/sections.h"

#include <math.h>

static void cell_heading(const struct report *r, const struct rating_option_cell *c)
{
    char words[384];
    rating_option_words(r->sample, c, words);
    fprintf(r->out, "<tr%s>", c->p_holm <= 1 - r->conf ? " class=\"outside\"" : "");
    html_cell(r->out, "th scope=\"row\" class=\"word\"", "%s", words);
}

static void test_row(const struct report *r, const struct rating_option_cell *c)
{
    FILE *out = r->out;
    char p[24], holm[24];
    html_p_value(p, c->difference.p_value);
    html_p_value(holm, c->p_holm);
    cell_heading(r, c);
    html_cell(out, "td", "%zu", c->n);
    report_mean_sd(out, &c->test_of);
    report_mean_sd(out, &c->reference_of);
    html_cell(out, "td", "%+.2f", c->difference.estimate);
    if (isnan(c->difference.p_value)) {
        html_cell(out, "td colspan=\"4\" class=\"word\"",
                  c->n < 2 ? "too few for a test" : "all differences are equal: no t-test");
    } else {
        html_cell(out, "td", "%.2f to %.2f", c->difference.ci_low, c->difference.ci_high);
        html_cell(out, "td", "t(%.0f) = %.3f", c->difference.df, c->difference.t);
        html_cell(out, "td", "%s", p);
        html_cell(out, "td", "%s", holm);
    }
    fputs("</tr>\n", out);
}

static void rank_row(const struct report *r, const struct rating_option_cell *c)
{
    FILE *out = r->out;
    char p[24];
    html_p_value(p, c->rank.p_value);
    cell_heading(r, c);
    html_cell(out, "td", "%zu", c->rank.n);
    html_cell(out, "td", "%s%s", p, c->rank.exact ? "" : " (normal)");
    html_cell(out, "td", "%+.2f", c->rank.estimate);
    report_rank_interval(out, &c->rank);
    if (isnan(c->effect.d)) {
        html_cell(out, "td colspan=\"2\" class=\"word\"", "no spread");
    } else {
        html_cell(out, "td", "%.2f", c->effect.d);
        html_cell(out, "td", "%.2f to %.2f", c->effect.ci_low, c->effect.ci_high);
    }
    fputs("</tr>\n", out);
}

// Cells from `from` up to `to` compare the same two options.
static void tables(const struct report *r, const struct rating_options *q, size_t from, size_t to)
{
    FILE *out = r->out;
    const struct rating_option_cell *first = &q->cells[from];
    fputs("<p>", out);
    html_printf(out, "Test: %s. Reference: %s.", report_label(r, first->test),
                report_label(r, first->reference));
    fprintf(out,
            "</p>\n<div class=\"table\" tabindex=\"0\" role=\"region\" aria-label=\"Ratings of both options\">"
            "<table class=\"wrap\">\n<caption>Test less reference, paired within people; M "
            "(SD)</caption>\n<thead><tr>"
            "<th scope=\"col\" class=\"word\">cell</th><th scope=\"col\">n</th><th scope=\"col\">test</th>"
            "<th scope=\"col\">reference</th><th scope=\"col\">difference</th><th scope=\"col\">%g&nbsp;%% "
            "interval</th><th scope=\"col\">t</th><th scope=\"col\">p</th><th scope=\"col\">p Holm</th></tr>"
            "</thead>\n<tbody>\n",
            100 * r->conf);
    for (size_t i = from; i < to; i++)
        test_row(r, &q->cells[i]);
    fprintf(
        out,
        "</tbody></table></div>\n<div class=\"table\" tabindex=\"0\" role=\"region\" aria-label=\"Ratings of "
        "both options by ranks\"><table>\n<caption>The same differences by Wilcoxon\u2019s signed ranks, and "
        "their size</caption>\n<thead><tr><th scope=\"col\" class=\"word\">cell</th><th "
        "scope=\"col\">not&nbsp;0</th>"
        "<th scope=\"col\">p</th><th scope=\"col\">Hodges\u2013Lehmann</th><th scope=\"col\">%g&nbsp;%% "
        "interval</th><th scope=\"col\">d<sub>z</sub></th><th scope=\"col\">%g&nbsp;%% interval</th></tr>"
        "</thead>\n<tbody>\n",
        100 * r->conf, 100 * r->conf);
    for (size_t i = from; i < to; i++)
        rank_row(r, &q->cells[i]);
    fputs("</tbody></table></div>\n", out);
}

void report_rating_options(const struct report *r, const struct rating_options *q)
{
    FILE *out = r->out;
    fputs("<h3>", out);
    html_printf(out, "Question \u201c%s\u201d, %g to %g, of both options of a trial", q->question, q->scale_min,
                q->scale_max);
    fputs("</h3>\n", out);
    if (q->cell_count == 0) {
        fputs("<p>No trial has ratings of both options.</p>\n", out);
        return;
    }
    for (size_t from = 0, to; from < q->cell_count; from = to) {
        for (to = from + 1; to < q->cell_count && q->cells[to].test == q->cells[from].test &&
                            q->cells[to].reference == q->cells[from].reference;)
            to++;
        tables(r, q, from, to);
    }
    fputs("<p>The signed-rank test drops differences of 0; the Hodges\u2013Lehmann estimate and its interval "
          "keep them. "
          "p Holm: the t-test\u2019s p adjusted over all cells of this question; shaded where it is at most ",
          out);
    html_printf(out, "%.4g.", 1 - r->conf);
    fputs("</p>\n", out);
}
