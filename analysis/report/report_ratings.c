#include "analysis/report/html.h"
#include "analysis/report/sections.h"

#include <inttypes.h>
#include <math.h>

void report_mean_sd(FILE *out, const struct stat_moments *of)
{
    if (isnan(of->sd))
        html_cell(out, "td", "%.2f", of->mean);
    else
        html_cell(out, "td", "%.2f (%.2f)", of->mean, of->sd);
}

static void group_row(const struct report *r, const struct rating_group *g)
{
    FILE *out = r->out;
    char p[24];
    html_p_value(p, g->change.p_value);
    fputs("<tr>", out);
    html_cell(out, "th scope=\"row\" class=\"word\"", "%s", report_label(r, g->first_condition));
    html_cell(out, "td class=\"word\"", "%s", report_label(r, g->second_condition));
    html_cell(out, "td", "%zu", g->n);
    report_mean_sd(out, &g->first_of);
    report_mean_sd(out, &g->second_of);
    html_cell(out, "td", "%+.2f", g->change.estimate);
    if (isnan(g->change.p_value)) {
        html_cell(out, "td colspan=\"3\" class=\"word\"",
                  g->n < 2 ? "too few for a test" : "all changes are equal: no t-test");
    } else {
        html_cell(out, "td", "%.2f to %.2f", g->change.ci_low, g->change.ci_high);
        html_cell(out, "td", "t(%.0f) = %.3f", g->change.df, g->change.t);
        html_cell(out, "td", "%s", p);
    }
    fputs("</tr>\n", out);
}

static void question_table(const struct report *r, const struct rating_question *q)
{
    FILE *out = r->out;
    fputs("<div class=\"table\" tabindex=\"0\" role=\"region\" aria-label=\"Ratings per "
          "order\"><table class=\"wrap\">\n<caption>Second minus first "
          "rating within each order, paired t-test; M (SD)</caption>\n<thead><tr><th scope=\"col\" "
          "class=\"word\">first</th>"
          "<th scope=\"col\" class=\"word\">second</th><th scope=\"col\">n</th><th scope=\"col\">first</th><th "
          "scope=\"col\">"
          "second</th><th scope=\"col\">change</th>",
          out);
    fprintf(out,
            "<th scope=\"col\">%g&nbsp;%% interval</th><th scope=\"col\">t</th><th "
            "scope=\"col\">p</th></tr></thead>\n",
            100 * r->conf);
    fputs("<tbody>\n", out);
    for (size_t i = 0; i < q->group_count; i++)
        group_row(r, &q->groups[i]);
    fputs("</tbody></table></div>\n", out);
}

void report_rank_interval(FILE *out, const struct stat_wilcoxon *w)
{
    if (isfinite(w->ci_low) && isfinite(w->ci_high))
        html_cell(out, "td", "%.2f to %.2f", w->ci_low, w->ci_high);
    else
        html_cell(out, "td", "n too small");
}

static void ranks_table(const struct report *r, const struct rating_question *q)
{
    FILE *out = r->out;
    fprintf(
        out,
        "<div class=\"table\" tabindex=\"0\" role=\"region\" aria-label=\"Changes by ranks and their "
        "size\"><table class=\"wrap\">\n<caption>The same changes by Wilcoxon\u2019s signed ranks, and their "
        "size</caption>\n<thead><tr><th scope=\"col\" class=\"word\">first</th><th "
        "scope=\"col\">not&nbsp;0</th>"
        "<th scope=\"col\">V</th><th scope=\"col\">p</th><th scope=\"col\">Hodges\u2013Lehmann</th>"
        "<th scope=\"col\">%g&nbsp;%% interval</th><th scope=\"col\">d<sub>z</sub></th><th scope=\"col\">"
        "%g&nbsp;%% interval</th><th scope=\"col\">Hedges\u2019 g</th></tr></thead>\n<tbody>\n",
        100 * r->conf, 100 * r->conf);
    for (size_t i = 0; i < q->group_count; i++) {
        const struct rating_group *g = &q->groups[i];
        char p[24];
        html_p_value(p, g->rank.p_value);
        fputs("<tr>", out);
        html_cell(out, "th scope=\"row\" class=\"word\"", "%s", report_label(r, g->first_condition));
        html_cell(out, "td", "%zu", g->rank.n);
        html_cell(out, "td", "%g", g->rank.statistic);
        html_cell(out, "td", "%s%s", p, g->rank.exact ? "" : " (normal)");
        html_cell(out, "td", "%+.2f", g->rank.estimate);
        report_rank_interval(out, &g->rank);
        if (isnan(g->effect.d)) {
            html_cell(out, "td colspan=\"3\" class=\"word\"", "no spread");
        } else {
            html_cell(out, "td", "%.2f", g->effect.d);
            html_cell(out, "td", "%.2f to %.2f", g->effect.ci_low, g->effect.ci_high);
            html_cell(out, "td", isnan(g->effect.g) ? "\u2013" : "%.2f", g->effect.g);
        }
        fputs("</tr>\n", out);
    }
    fputs("</tbody></table></div>\n<p>The signed-rank test drops changes of 0 and is exact with ties unless it "
          "says "
          "\u201cnormal\u201d; the Hodges\u2013Lehmann estimate and its interval keep them, so the interval "
          "may reach "
          "0 where p is small.</p>\n",
          out);
}

static void first_sentence(const struct report *r, const struct rating_question *q)
{
    const struct stat_ttest *w = &q->first_between;
    char p[24];
    html_p_value(p, w->p_value);
    fputs("<p>", r->out);
    if (q->overlap)
        fputs("First ratings are not compared: somebody rated in both orders.", r->out);
    else if (!q->compared)
        html_printf(r->out, "First ratings are not compared: that needs two order groups, there %s %zu.",
                    q->group_count == 1 ? "is" : "are", q->group_count);
    else if (isnan(w->p_value))
        html_printf(
            r->out,
            "First ratings differ by %.2f; there are too few, or all are equal, so that no t-test is possible.",
            w->estimate);
    else
        html_printf(r->out,
                    "First ratings, %s minus %s: %+.2f, %g\u00a0%% interval %.2f to %.2f, Welch\u2019s t(%.2f) "
                    "= %.3f, p %s%s; d = %.2f (%.2f to %.2f).",
                    report_label(r, q->groups[0].first_condition),
                    report_label(r, q->groups[1].first_condition), w->estimate, 100 * r->conf, w->ci_low,
                    w->ci_high, w->df, w->t, p[0] == '<' ? "" : "= ", p, q->between_effect.d,
                    q->between_effect.ci_low, q->between_effect.ci_high);
    if (q->unpaired)
        html_printf(r->out, " %" PRId64 " %s left out.", q->unpaired,
                    q->unpaired == 1 ? "session without two ratings of different options is"
                                     : "sessions without two ratings of different options are");
    if (q->late_first)
        html_printf(
            r->out,
            " %" PRId64 " %s left out, here and where orders are compared as planned: the rating planned "
            "as the first was given when both options had been seen (a flagged trial comes again at the "
            "end), so that there is no first rating.",
            q->late_first, q->late_first == 1 ? "session is" : "sessions are");
    fputs("</p>\n", r->out);
}

void report_ratings(const struct report *r)
{
    report_heading(r, "Ratings");
    if (!ratings_any(&r->ratings))
        fputs("<p class=\"note\">No rating of an option was recorded that counts.</p>\n", r->out);
    for (size_t i = 0; i < r->ratings.question_count; i++) {
        const struct rating_question *q = &r->ratings.questions[i];
        fputs("<h3>", r->out);
        html_printf(r->out, "Question \u201c%s\u201d, %g to %g", q->question, q->scale_min, q->scale_max);
        fputs("</h3>\n", r->out);
        if (i < REPORT_QUESTIONS)
            report_figure(
                r, &r->ratings_figures[i],
                "One thin line per person from the first to the second rating, slightly set off so that equal "
                "ratings do not hide each other. Large dots and the number beside them: means. One panel for "
                "each order in which the two options were rated.");
        if (q->group_count)
            question_table(r, q);
        if (q->group_count)
            ranks_table(r, q);
        first_sentence(r, q);
    }
    for (size_t i = 0; i < r->ratings.options.count; i++)
        report_rating_options(r, &r->ratings.options.items[i]);
    for (size_t i = 0; i < r->ratings.factorials.count; i++)
        report_factorial(r, &r->ratings.factorials.items[i],
                         i < REPORT_QUESTIONS ? &r->factorial_figures[i] : NULL,
                         i < REPORT_QUESTIONS ? &r->likert_figures[i] : NULL);
}
