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

// A pair stands below its set, which says where.
static void levels_cell(FILE *out, const struct choice_factor_test *x)
{
    fputs("<th scope=\"row\" class=\"word\">", out);
    if (x->pair)
        fputs("\u2003", out);
    else
        html_printf(out, "%s%s%s: ", x->name_block ? x->block : "", x->name_block ? ", " : "", x->factor);
    for (size_t i = 0; i < x->levels; i++)
        html_printf(out, "%s%s", i == 0 ? "" : x->levels == 2 ? " \u2212 " : ", ", x->level[i]);
    if (x->where[0] && !x->pair) {
        fputs("<br>at ", out);
        html_text(out, x->where);
    }
    fputs("</th>", out);
}

static void factor_row(FILE *out, const struct choice_factor_test *x)
{
    char p[24], holm[24];
    html_p_value(p, x->p_value);
    html_p_value(holm, x->holm);
    fputs("<tr>", out);
    levels_cell(out, x);
    html_cell(out, "td", "%zu", x->people);
    html_cell(out, "td class=\"word\"", "%s", choice_factor_word(x->method));
    if (x->none[0]) {
        html_cell(out, "td class=\"word\" colspan=\"6\"", "no test: %s", x->none);
    } else {
        html_cell(out, "td", "%s", p);
        html_cell(out, "td", "%s", holm);
        interval_cell(out, x->difference, x->ci, 100);
        interval_cell(out, x->odds_ratio, x->odds_ci, 1);
    }
    fputs("</tr>\n", out);
}

static void left_out(const struct report *r)
{
    bool any = false;
    for (size_t i = 0; i < r->factors.count; i++) {
        const struct choice_factor_test *x = &r->factors.tests[i];
        char words[CHOICE_FACTOR_WORDS], note[CHOICE_FACTOR_NOTE];
        choice_factor_words(x, words);
        choice_factor_note(x, note);
        if (!note[0] || x->pair)
            continue;
        fputs(any ? "<li>" : "<ul>\n<li>", r->out);
        html_printf(r->out, "%s: %s.", words, note);
        fputs("</li>\n", r->out);
        any = true;
    }
    fputs(any ? "</ul>\n" : "", r->out);
}

static void notes(const struct report *r)
{
    fprintf(r->out,
            "<p>A factor lies within people where at least half of them were to answer at several "
            "of the levels, as their trials were planned, else between people. Between people: "
            "Fisher\u2019s exact test where each answered once, else whole people are exchanged "
            "between levels. Within people, each having answered once at every level: "
            "McNemar\u2019s exact test, Cochran\u2019s Q by permutation within people. The "
            "interval of a difference within people is Fay and Lumbard\u2019s (2021), which leaves "
            "0 out exactly where McNemar\u2019s p is below %.4g; between people it is "
            "Newcombe\u2019s where each answered once and Welch\u2019s else, and near its limit "
            "the exact p may say otherwise. Intervals of odds ratios are exact. Holm\u2019s p is "
            "over the factors, and of pairs of levels over the pairs of their factor. A large p "
            "does not show that levels are equal.",
            1 - r->conf);
    double error = 0;
    for (size_t i = 0; i < r->factors.count; i++)
        error = fmax(error, r->factors.tests[i].p_error);
    if (error > 0)
        fprintf(r->out,
                " Where people are too many to list every arrangement, p is from random ones, with a standard "
                "error of at most %.2g.",
                error);
    fputs("</p>\n", r->out);
    left_out(r);
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
