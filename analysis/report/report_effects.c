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

static bool is_dull(const struct report *r, const struct effect *e)
{
    return e->people > 1 && e->flip.uneven > 0 && e->exact && e->flip.least_p > 1 - r->conf;
}

// Tests that these few people could not make clear, and whom checks leave out.
static void effect_notes(const struct report *r)
{
    size_t dull = 0, partial = 0;
    bool any = false;
    for (int i = 0; i < EFFECT_CHECKS; i++) {
        const struct effect *e = &r->effects.checks[i];
        any = any || is_dull(r, e) || (e->people && e->left_out);
    }
    if (!any)
        return;
    fputs("<p class=\"note\">", r->out);
    for (int i = 0; i < EFFECT_CHECKS; i++) {
        const struct effect *e = &r->effects.checks[i];
        if (is_dull(r, e)) {
            if (dull++ == 0)
                html_printf(r->out, "Cannot reach %.4g, with the smallest possible p: ", 1 - r->conf);
            html_printf(r->out, "%s%s (%.3g)", dull > 1 ? "; " : "", effect_words((enum effect_check)i),
                        e->flip.least_p);
        }
    }
    fputs(dull ? ". " : "", r->out);
    for (int i = 0; i < EFFECT_CHECKS; i++) {
        const struct effect *e = &r->effects.checks[i];
        if (e->people && e->left_out)
            html_printf(r->out, "%s%s (%zu)", partial++ ? "; " : "People without a value, left out: ",
                        effect_words((enum effect_check)i), e->left_out);
    }
    fputs(partial ? ".</p>\n" : "</p>\n", r->out);
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
        "pooled answers: by the sign-flip test, for more than %d people by Student\u2019s t. ",
        STAT_FLIP_VALUES);
    if (r->effects.tested == 0)
        fputs("These data permit none of the tests. ", out);
    else
        html_printf(out,
                    "p (Holm) is adjusted for the family of the %zu %s. A large p does not show that there is "
                    "no effect. ",
                    r->effects.tested, r->effects.tested == 1 ? "check that has a p" : "checks that have a p");
    fputs("Shares of sides and of orders are balanced within each person over trials in which the test option "
          "had that side or place and trials in which it had not, then averaged over people: they are not the "
          "counts of all answers in section \u201cToggles before answering\u201d. ",
          out);
    fputs("What was on screen last or longest may be so because it was preferred.", out);
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
