// Levels of factors of one answer each, and between people.
#include "analysis/report/html.h"
#include "analysis/report/sections.h"

#include <math.h>

static void interval_cell(FILE *out, double value, struct stat_interval ci, double scale)
{
    if (isnan(value)) {
        html_cell(out, "td", "\u2013");
        html_cell(out, "td", "\u2013");
        return;
    }
    if (isinf(value))
        html_cell(out, "td", "infinite");
    else
        html_cell(out, "td", "%.*f", scale > 1 ? 1 : 2, scale * value);
    if (isnan(ci.low))
        html_cell(out, "td", "\u2013");
    else if (isinf(ci.high))
        html_cell(out, "td", "above %.2f", ci.low);
    else
        html_cell(out, "td", "%.*f to %.*f", scale > 1 ? 1 : 2, scale * ci.low, scale > 1 ? 1 : 2,
                  scale * ci.high);
}

static void factor_row(FILE *out, const struct choice_factor_test *x)
{
    char p[24], holm[24];
    html_p_value(p, x->p_value);
    html_p_value(holm, x->holm);
    fputs("<tr>", out);
    if (x->a)
        html_cell(out, "th scope=\"row\" class=\"word\"", "%s%s: %s \u2212 %s%s%s", x->pair ? "\u2003" : "",
                  x->factor, x->a, x->b, x->where[0] ? ", at " : "", x->where);
    else
        html_cell(out, "th scope=\"row\" class=\"word\"", "%s, %zu levels%s%s", x->factor, x->levels,
                  x->where[0] ? ", at " : "", x->where);
    html_cell(out, "td", "%zu", x->people);
    html_cell(out, "td class=\"word\"", "%s", choice_factor_word(x->method));
    html_cell(out, "td", "%s", p);
    html_cell(out, "td", "%s", holm);
    interval_cell(out, x->difference, x->ci, 100);
    interval_cell(out, x->odds_ratio, x->odds_ci, 1);
    fputs("</tr>\n", out);
}

static void notes(const struct report *r)
{
    fputs(
        "<p>Fisher: exact, nobody saw two levels and each person answered once. Exchange of people: whole "
        "people are exchanged between levels, since they answered several times. McNemar (exact) and "
        "Cochran\u2019s Q (permutation within people): each person answered once at every level. Intervals of "
        "differences are Newcombe\u2019s between people of one answer, Welch\u2019s of several, and t within "
        "people; of odds ratios they are exact. Holm\u2019s p is over the factors, and of pairs of levels over "
        "the pairs of their factor. A large p does not show that levels are equal.",
        r->out);
    double error = 0;
    for (size_t i = 0; i < r->factors.count; i++) {
        const struct choice_factor_test *x = &r->factors.tests[i];
        error = fmax(error, x->p_error);
        if (x->left_out && !x->pair)
            html_printf(r->out, " %s: %zu people without an answer at every level are left out.", x->factor,
                        x->left_out);
    }
    if (error > 0)
        fprintf(r->out,
                " Where people are too many to list every arrangement, p is from random ones, with a standard "
                "error of at most %.2g.",
                error);
    fputs("</p>\n", r->out);
}

void report_choice_factors(const struct report *r)
{
    if (r->factors.count == 0)
        return;
    fprintf(r->out,
            "<div class=\"table\" tabindex=\"0\" role=\"region\" aria-label=\"Levels of factors\"><table>\n"
            "<caption>Levels of factors, in cells that are otherwise the same</caption>\n<thead><tr><th "
            "scope=\"col\" class=\"word\">levels</th><th scope=\"col\">people</th><th scope=\"col\" "
            "class=\"word\">test</th><th scope=\"col\">p</th><th scope=\"col\">p (Holm)</th><th "
            "scope=\"col\">difference, points</th><th scope=\"col\">%g&nbsp;%% interval</th><th "
            "scope=\"col\">odds ratio</th><th scope=\"col\">%g&nbsp;%% interval</th></tr></thead>\n<tbody>\n",
            100 * r->conf, 100 * r->conf);
    for (size_t i = 0; i < r->factors.count; i++)
        factor_row(r->out, &r->factors.tests[i]);
    fputs("</tbody></table></div>\n", r->out);
    notes(r);
}
