// Effects on choices that are no preference, as a table.
#include "analysis/report/effects.h"

#include "analysis/report/html.h"
#include "analysis/report/sections.h"

#include <math.h>

static void number_cell(FILE *out, double value, int digits)
{
    if (isnan(value))
        html_cell(out, "td", "\u2013");
    else
        html_cell(out, "td", "%.*f", digits, value);
}

static void effect_row(const struct report *r, enum effect_check check)
{
    const struct effect *e = &r->effects.checks[check];
    FILE *out = r->out;
    char p[24], holm[24];
    html_p_value(p, e->p_value);
    html_p_value(holm, e->holm);
    fputs("<tr>", out);
    html_cell(out, "th scope=\"row\" class=\"word\"", "%s", effect_words(check));
    html_cell(out, "td", "%zu", e->people);
    if (e->people == 0) {
        html_cell(out, "td class=\"word\" colspan=\"6\"", "not estimable: %s", effect_null(check));
        fputs("</tr>\n", out);
        return;
    }
    html_cell(out, "td", "%.1f\u00a0%s", effect_shown(check, e->estimate), effect_unit(check));
    if (isnan(e->t.ci_low))
        html_cell(out, "td", "\u2013");
    else
        html_cell(out, "td", "%.1f to %.1f", effect_shown(check, e->t.ci_low),
                  effect_shown(check, e->t.ci_high));
    number_cell(out, e->d, 2);
    html_cell(out, "td class=\"word\"", "%s",
              e->people == 1        ? "one person only"
              : e->flip.uneven == 0 ? "no: all are 0"
              : e->exact            ? "sign-flip"
                                    : "t");
    html_cell(out, "td", "%s", isnan(e->p_value) ? "\u2013" : p);
    html_cell(out, "td", "%s", isnan(e->holm) ? "\u2013" : holm);
    fputs("</tr>\n", out);
}

// Tests that these few people could not make clear, and whom a check leaves out.
static void effect_notes(const struct report *r)
{
    for (int i = 0; i < EFFECT_CHECKS; i++) {
        const struct effect *e = &r->effects.checks[i];
        const char *words = effect_words((enum effect_check)i);
        bool dull = e->people > 1 && e->flip.uneven > 0 && e->exact && e->flip.least_p > 1 - r->conf,
             partial = e->people && e->left_out;
        if (!dull && !partial)
            continue;
        fputs("<p class=\"note\">", r->out);
        html_printf(r->out, "\u201c%s\u201d: ", words);
        if (dull)
            html_printf(r->out, "cannot reach %.4g, for the smallest p of these people\u2019s values is %.3g. ",
                        1 - r->conf, e->flip.least_p);
        if (partial)
            html_printf(r->out, "%zu %s no such value.", e->left_out,
                        e->left_out == 1 ? "person has" : "people have");
        fputs("</p>\n", r->out);
    }
}

void report_effects(const struct report *r)
{
    FILE *out = r->out;
    if (r->effects.choices == 0)
        return;
    report_heading(r, "Effects on choices that are no preference");
    fputs("<p>", out);
    html_printf(
        out,
        "Each person gives one value per check, which a preference does not move; people are tested, never "
        "pooled answers: by the exact sign-flip test, for more than %d people by Student\u2019s t. p (Holm) "
        "is adjusted for the family of these %zu checks. A large p does not show that there is no effect. "
        "What was on screen last or longest may be so because it was preferred.",
        STAT_FLIP_VALUES, r->effects.tested);
    fputs(
        "</p>\n<div class=\"table\" tabindex=\"0\" role=\"region\" aria-label=\"Effects on choices that are no "
        "preference\"><table class=\"wrap\">\n<caption>",
        out);
    html_printf(out, "Means over people with %g\u00a0%% t intervals; d: mean over SD", 100 * r->conf);
    fputs("</caption>\n<thead><tr><th scope=\"col\" class=\"word\">effect</th><th scope=\"col\">people</th><th "
          "scope=\"col\">mean</th><th scope=\"col\">interval</th><th scope=\"col\">d</th><th scope=\"col\" "
          "class=\"word\">tested by</th><th scope=\"col\">p</th><th scope=\"col\">p "
          "(Holm)</th></tr></thead>\n<tbody>\n",
          out);
    for (int i = 0; i < EFFECT_CHECKS; i++)
        effect_row(r, (enum effect_check)i);
    fputs("</tbody></table></div>\n", out);
    effect_notes(r);
}
