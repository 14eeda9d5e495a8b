#include "analysis/report/html.h"
#include "analysis/report/sections.h"

#include <inttypes.h>
#include <math.h>

static void group_row(const struct report *r, const struct rating_group *g)
{
    FILE *out = r->out;
    char p[24];
    html_p_value(p, g->change.p_value);
    fputs("<tr>", out);
    html_cell(out, "th scope=\"row\" class=\"word\"", "%s", report_label(r, g->first_condition));
    html_cell(out, "td class=\"word\"", "%s", report_label(r, g->second_condition));
    html_cell(out, "td", "%zu", g->n);
    html_cell(out, "td", "%.2f (%.2f)", g->first_of.mean, g->first_of.sd);
    html_cell(out, "td", "%.2f (%.2f)", g->second_of.mean, g->second_of.sd);
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

static void first_sentence(const struct report *r, const struct rating_question *q)
{
    const struct stat_ttest *w = &q->first_between;
    char p[24];
    html_p_value(p, w->p_value);
    fputs("<p>", r->out);
    if (!q->compared)
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
                    "= %.3f, p %s%s.",
                    report_label(r, q->groups[0].first_condition),
                    report_label(r, q->groups[1].first_condition), w->estimate, 100 * r->conf, w->ci_low,
                    w->ci_high, w->df, w->t, p[0] == '<' ? "" : "= ", p);
    if (q->unpaired)
        html_printf(r->out, " %" PRId64 " %s without two ratings of different options left out.", q->unpaired,
                    q->unpaired == 1 ? "session is" : "sessions are");
    fputs("</p>\n", r->out);
}

void report_ratings(const struct report *r)
{
    fputs("<h2>Ratings</h2>\n", r->out);
    if (r->ratings.question_count == 0)
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
        first_sentence(r, q);
    }
}
