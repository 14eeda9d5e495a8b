// What choices were tested by, and the cells in which a person answered several times.
#include "analysis/report/html.h"
#include "analysis/report/sections.h"

#include <inttypes.h>
#include <math.h>

static void methods_one_each(const struct report *r)
{
    html_printf(
        r->out,
        "%s compared with an even split by the exact two-sided binomial test (method of small p-values), with "
        "Clopper\u2013Pearson intervals; the null region of a cell is the range of counts with p > %.4g for "
        "that cell\u2019s own n. Each person gave at most one answer per cell, so the answers within a cell "
        "are "
        "independent, however people differ; overdispersion is not estimable there. ",
        r->choices.several ? "Choices in cells with one answer per person were" : "Choices were", 1 - r->conf);
}

static void methods_several(const struct report *r)
{
    bool fitted = false;
    for (size_t i = 0; i < r->choices.cell_count; i++) {
        const struct choice_cell *cell = &r->choices.cells[i];
        fitted = fitted || (cell->several && (cell->mixed.state == STAT_MIXED_FITTED ||
                                              cell->mixed.state == STAT_MIXED_SD_ZERO));
    }
    html_printf(
        r->out,
        "%s the people, not the answers, were taken as independent: the sum over people of answers for the "
        "test "
        "option beyond half of their answers was compared with all ways to flip the people\u2019s signs (exact "
        "two-sided sign-flip test). The share is the mean of the people\u2019s shares, with its t interval; "
        "test "
        "and interval can differ at the edge. ",
        r->choices.one_each ? "In cells with several answers of a person"
                            : "As people answered several times per cell,");
    if (fitted)
        fputs("A logistic mixed model with a random intercept per person (maximum likelihood, adaptive "
              "quadrature, intercept referred to t with N \u2212 1 degrees of freedom) stands beside it. ",
              r->out);
}

void report_choices_methods(const struct report *r)
{
    if (r->choices.one_each || !r->choices.several)
        methods_one_each(r);
    if (r->choices.several)
        methods_several(r);
    if (r->choices.tested > 1)
        html_printf(
            r->out,
            "Each cell was tested by itself; Holm\u2019s p is adjusted for the %zu cells that were tested. ",
            r->choices.tested);
}

static void share_interval(FILE *out, double share, struct stat_interval ci)
{
    if (isnan(share))
        html_cell(out, "td", "\u2013");
    else if (isnan(ci.low))
        html_cell(out, "td", "%.1f\u00a0%%", 100 * share);
    else
        html_cell(out, "td", "%.1f\u00a0%% [%.1f, %.1f]", 100 * share, 100 * ci.low, 100 * ci.high);
}

static void number_cell(FILE *out, int digits, double value)
{
    if (isnan(value))
        html_cell(out, "td", "\u2013");
    else
        html_cell(out, "td", "%.*f", digits, value);
}

static void tests_row(const struct report *r, const struct choice_cell *cell)
{
    FILE *out = r->out;
    char words[256], flip[24], t[24], pooled[24];
    struct stat_people people = stat_people_sum(cell->counts, cell->people);
    report_cell_words(cell, words);
    html_p_value(flip, cell->flip.p_value);
    html_p_value(t, cell->t.p_value);
    html_p_value(pooled, cell->binomial.p_value);
    fputs("<tr>", out);
    html_cell(out, "th scope=\"row\" class=\"word\"", "%s", words);
    html_cell(out, "td", "%zu", people.people);
    if (people.least_n == people.most_n)
        html_cell(out, "td", "%" PRId64, people.least_n);
    else
        html_cell(out, "td", "%" PRId64 " to %" PRId64, people.least_n, people.most_n);
    html_cell(out, "td", "%s", flip);
    html_cell(out, "td", "%.2g", cell->flip.least_p);
    html_cell(out, "td", "%s", t);
    number_cell(out, 2, cell->overdispersion);
    share_interval(out, cell->binomial.estimate, cell->binomial.ci);
    html_cell(out, "td", "%s", pooled);
    fputs("</tr>\n", out);
}

static void tests_table(const struct report *r)
{
    FILE *out = r->out;
    fputs("<h3>Several answers per person</h3>\n<div class=\"table\" tabindex=\"0\" role=\"region\" "
          "aria-label=\"Several answers per person\"><table>\n<caption>Tests of people, and all answers pooled "
          "as the "
          "papers have it</caption>\n<thead><tr><th scope=\"col\" class=\"word\">cell</th><th "
          "scope=\"col\">people</th>"
          "<th scope=\"col\">answers each</th><th scope=\"col\">"
          "sign-flip p</th><th scope=\"col\">smallest attainable p</th><th scope=\"col\">t-test p</th><th "
          "scope=\"col\">overdispersion</th><th scope=\"col\">pooled share</th><th scope=\"col\">pooled "
          "p</th></tr>"
          "</thead>\n<tbody>\n",
          out);
    for (size_t i = 0; i < r->choices.cell_count; i++)
        if (r->choices.cells[i].several)
            tests_row(r, &r->choices.cells[i]);
    fputs("</tbody></table></div>\n", out);
}

static void tests_notes(const struct report *r)
{
    for (size_t i = 0; i < r->choices.cell_count; i++) {
        const struct choice_cell *cell = &r->choices.cells[i];
        char words[256];
        report_cell_words(cell, words);
        if (cell->method == CHOICE_SIGN_FLIP && cell->flip.least_p > 1 - r->conf) {
            fputs("<p class=\"note\">", r->out);
            html_printf(r->out,
                        "%s: %zu of %zu people did not choose both equally often; with so many the sign-flip p "
                        "is never below "
                        "%.2g and cannot reach %.2g.",
                        words, cell->flip.uneven, cell->flip.people, cell->flip.least_p, 1 - r->conf);
            fputs("</p>\n", r->out);
        }
        if (cell->several && (cell->ci.low < 0 || cell->ci.high > 1)) {
            fputs("<p class=\"note\">", r->out);
            html_printf(r->out,
                        "%s: the t interval reaches beyond 0 or 100\u00a0%%; so near the end, t fits badly.",
                        words);
            fputs("</p>\n", r->out);
        }
    }
    fputs("<p>The sign-flip statistic sums, over people, the answers for the test option less half of the "
          "person\u2019s "
          "answers, so that whoever answered more weighs more; shares and their t count each person the "
          "same.</p>\n",
          r->out);
    fputs("<p class=\"note\"><strong>Pooled:</strong> the binomial test of all answers takes the answers of "
          "one person "
          "as independent. Overdispersion is Pearson\u2019s chi-squared of the people\u2019s counts over its "
          "degrees of "
          "freedom: 1 where answers are independent, more where people differ. Where it exceeds 1 the pooled p "
          "is too "
          "small and the pooled interval too narrow.</p>\n",
          r->out);
}

static void model_row(const struct report *r, const struct choice_cell *cell)
{
    FILE *out = r->out;
    const struct stat_mixed_logit *m = &cell->mixed;
    char words[256], p[24];
    report_cell_words(cell, words);
    html_p_value(p, m->p_value);
    fputs("<tr>", out);
    html_cell(out, "th scope=\"row\" class=\"word\"", "%s", words);
    number_cell(out, 3, m->intercept);
    number_cell(out, 3, m->std_error);
    number_cell(out, 3, m->sd);
    share_interval(out, m->conditional, m->conditional_ci);
    share_interval(out, m->population, m->population_ci);
    if (isnan(m->t))
        html_cell(out, "td", "\u2013");
    else
        html_cell(out, "td", "t(%.0f) = %.3f", m->df, m->t);
    html_cell(out, "td", "%s", p);
    html_cell(out, "td class=\"word\"", "%s", stat_mixed_words(m->state));
    fputs("</tr>\n", out);
}

static void models_table(const struct report *r)
{
    FILE *out = r->out;
    fputs("<div class=\"table\" tabindex=\"0\" role=\"region\" aria-label=\"Mixed models\"><table "
          "class=\"wrap\">\n"
          "<caption>Logistic mixed model per cell</caption>\n"
          "<thead><tr><th scope=\"col\" class=\"word\">cell</th><th scope=\"col\">intercept</th><th "
          "scope=\"col\">SE"
          "</th><th scope=\"col\">SD between people</th><th scope=\"col\">of a person in the middle</th><th "
          "scope=\"col\">over people</th><th scope=\"col\">test</th><th scope=\"col\">p</th><th scope=\"col\" "
          "class=\"word\">note</th></tr></thead>\n<tbody>\n",
          out);
    for (size_t i = 0; i < r->choices.cell_count; i++)
        if (r->choices.cells[i].several)
            model_row(r, &r->choices.cells[i]);
    fputs("</tbody></table></div>\n<p>Intercept, its standard error and the SD between people are logits. A "
          "person in the "
          "middle has the intercept\u2019s preference (conditional); over people stands their mean preference "
          "(marginal), which is what shares estimate.</p>\n",
          out);
}

static void contrast_row(FILE *out, const struct choice_contrast *x)
{
    char p[24], holm[24];
    html_p_value(p, x->t.p_value);
    html_p_value(holm, x->holm);
    fputs("<tr>", out);
    html_cell(out, "th scope=\"row\" class=\"word\"", "%s: %s \u2212 %s", x->factor, x->a, x->b);
    html_cell(out, "td", "%zu", x->people);
    if (isnan(x->t.t)) {
        for (int i = 0; i < 3; i++)
            html_cell(out, "td", "\u2013");
    } else {
        html_cell(out, "td", "%+.1f", 100 * x->t.estimate);
        html_cell(out, "td", "%.1f to %.1f", 100 * x->t.ci_low, 100 * x->t.ci_high);
        html_cell(out, "td", "t(%.0f) = %.3f", x->t.df, x->t.t);
    }
    html_cell(out, "td", "%s", p);
    html_cell(out, "td", "%s", holm);
    fputs("</tr>\n", out);
}

static void contrasts_table(const struct report *r)
{
    FILE *out = r->out;
    if (r->choices.contrast_count == 0)
        return;
    fprintf(out,
            "<div class=\"table\" tabindex=\"0\" role=\"region\" aria-label=\"Levels compared within "
            "people\"><table>\n"
            "<caption>Levels compared within people: t-test of each person\u2019s difference of shares, in "
            "cells that "
            "are otherwise the same</caption>\n<thead><tr><th scope=\"col\" class=\"word\">levels</th><th "
            "scope=\"col\">people</th><th scope=\"col\">difference, points</th><th scope=\"col\">%g&nbsp;%% "
            "interval</th><th "
            "scope=\"col\">test</th><th scope=\"col\">p</th><th scope=\"col\">p "
            "(Holm)</th></tr></thead>\n<tbody>\n",
            100 * r->conf);
    for (size_t i = 0; i < r->choices.contrast_count; i++)
        contrast_row(out, &r->choices.contrasts[i]);
    fputs("</tbody></table></div>\n<p>All pairs of levels are compared so once somebody answered several times "
          "at "
          "one of them. Holm\u2019s p is over the pairs of a factor\u2019s levels.</p>\n",
          out);
}

void report_people(const struct report *r)
{
    if (!r->choices.several)
        return;
    tests_table(r);
    tests_notes(r);
    models_table(r);
    contrasts_table(r);
}
