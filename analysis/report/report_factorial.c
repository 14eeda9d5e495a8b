// Ratings over crossed factors: analysis of variance, means, pairs of levels.
#include "analysis/report/html.h"
#include "analysis/report/sections.h"

#include <inttypes.h>
#include <math.h>

static void number(FILE *out, const char *format, double value)
{
    if (isnan(value))
        html_cell(out, "td", "\u2013");
    else
        html_cell(out, "td", format, value);
}

static void p_cell(FILE *out, double p)
{
    char text[24];
    html_p_value(text, p);
    html_cell(out, "td", "%s", isnan(p) ? "\u2013" : text);
}

static void open_table(FILE *out, const char *caption, const char *css, const char *const *headings,
                       size_t words)
{
    fprintf(out,
            "<div class=\"table\" tabindex=\"0\" role=\"region\" aria-label=\"%s\"><table%s>\n<caption>%s"
            "</caption>\n<thead><tr>",
            caption, css, caption);
    for (size_t i = 0; headings[i]; i++)
        fprintf(out, "<th scope=\"col\"%s>%s</th>", i < words ? " class=\"word\"" : "", headings[i]);
    fputs("</tr></thead>\n<tbody>\n", out);
}

static void close_table(FILE *out)
{
    fputs("</tbody></table></div>\n", out);
}

static void effect_row(const struct report *r, const struct factorial *f, const struct stat_anova_effect *e)
{
    FILE *out = r->out;
    char name[256];
    factorial_effect_name(f, e->factors, " \u00d7 ", name);
    fprintf(out, "<tr%s>", e->p_gg <= 1 - r->conf ? " class=\"outside\"" : "");
    html_cell(out, "th scope=\"row\" class=\"word\"", "%s", name);
    html_cell(out, "td", "%.0f, %.0f", e->df, e->df_error);
    number(out, "%.3f", e->f);
    p_cell(out, e->p_value);
    number(out, "%.3f", e->epsilon_gg);
    p_cell(out, e->p_gg);
    number(out, "%.3f", e->epsilon_hf);
    p_cell(out, e->p_hf);
    number(out, "%.3f", e->eta2_partial);
    number(out, "%.3f", e->eta2_generalised);
    fputs("</tr>\n", out);
}

static void effects_table(const struct report *r, const struct factorial *f)
{
    static const char *const headings[] = {"effect",
                                           "df",
                                           "F",
                                           "p",
                                           "\u03b5 GG",
                                           "p GG",
                                           "\u03b5 HF",
                                           "p HF",
                                           "partial \u03b7\u00b2",
                                           "generalised \u03b7\u00b2",
                                           NULL};
    open_table(r->out, "Analysis of variance within participants", " class=\"wrap\"", headings, 1);
    for (size_t i = 0; i < f->anova.effect_count; i++)
        effect_row(r, f, &f->anova.effects[i]);
    close_table(r->out);
    fputs("<p>GG and HF: Greenhouse\u2013Geisser\u2019s and Huynh\u2013Feldt\u2019s \u03b5, and p with both "
          "degrees "
          "of freedom times \u03b5; effects of one degree of freedom need none. Shaded: p GG is at most ",
          r->out);
    html_printf(r->out, "%.4g. A dash: no spread to test against.", 1 - r->conf);
    fputs("</p>\n", r->out);
}

static void means_table(const struct report *r, const struct factorial *f)
{
    char interval[64];
    snprintf(interval, sizeof interval, "%g&nbsp;%% within people", 100 * r->conf);
    const char *const headings[] = {"factor", "level", "M", interval, NULL};
    open_table(r->out, "Means of the factors\u2019 levels", "", headings, 2);
    for (size_t j = 0; j < f->factor_count; j++)
        for (size_t k = 0; k < f->factors[j].level_count; k++) {
            const struct factorial_factor *factor = &f->factors[j];
            double half = factor->half_width[k];
            fputs("<tr>", r->out);
            html_cell(r->out, "th scope=\"row\" class=\"word\"", "%s", k ? "" : factor->name);
            html_cell(r->out, "td class=\"word\"", "%s", factor->levels[k]);
            number(r->out, "%.2f", factor->mean[k]);
            if (isnan(f->anova.effects[j].p_gg))
                html_cell(r->out, "td", "no spread");
            else
                html_cell(r->out, "td", "%.2f to %.2f", factor->mean[k] - half, factor->mean[k] + half);
            fputs("</tr>\n", r->out);
        }
    close_table(r->out);
}

static void pair_row(FILE *out, const struct factorial_factor *factor, const struct factorial_pair *p)
{
    fputs("<tr>", out);
    html_cell(out, "th scope=\"row\" class=\"word\"", "%s \u2212 %s", factor->levels[p->a],
              factor->levels[p->b]);
    number(out, "%+.2f", p->test.estimate);
    if (isnan(p->test.p_value)) {
        html_cell(out, "td colspan=\"6\" class=\"word\"", "all differences are equal: no t-test");
    } else {
        html_cell(out, "td", "%.2f to %.2f", p->test.ci_low, p->test.ci_high);
        html_cell(out, "td", "t(%.0f) = %.3f", p->test.df, p->test.t);
        p_cell(out, p->test.p_value);
        p_cell(out, p->p_holm);
        number(out, "%.2f", p->effect.d);
        html_cell(out, "td", "%.2f to %.2f", p->effect.ci_low, p->effect.ci_high);
    }
    fputs("</tr>\n", out);
}

static void pairs_words(const struct report *r, const struct factorial *f, bool any)
{
    char names[256];
    size_t untested = factorial_untested(f, names);
    fputs("<p>", r->out);
    if (any)
        fputs("p Holm: adjusted over the pairs of that factor. ", r->out);
    if (untested)
        html_printf(
            r->out,
            "%s cannot be tested: everybody\u2019s ratings differ by the same between levels, so that there "
            "is nothing to hold an effect against, however large it is; see the means. ",
            names);
    if (any)
        fputs("Levels of factors that show no effect are not compared.", r->out);
    else if (untested < f->factor_count)
        fprintf(r->out,
                "No %sfactor by itself shows an effect, so %s levels are not compared; that does not show that "
                "they are alike.",
                untested ? "other " : "", untested ? "their" : "its");
    fputs("</p>\n", r->out);
}

static void pairs_tables(const struct report *r, const struct factorial *f)
{
    char ci[32];
    snprintf(ci, sizeof ci, "%g&nbsp;%% interval", 100 * r->conf);
    const char *const headings[] = {"levels", "difference", ci, "t", "p", "p Holm", "d<sub>z</sub>", ci, NULL};
    bool any = false;
    for (size_t j = 0; j < f->factor_count; j++) {
        const struct factorial_factor *factor = &f->factors[j];
        if (factor->pair_count == 0)
            continue;
        any = true;
        fputs("<p>", r->out);
        html_printf(r->out, "Levels of %s, over all other factors:", factor->name);
        fputs("</p>\n", r->out);
        open_table(r->out, "Pairs of levels, paired t-tests", "", headings, 1);
        for (size_t i = 0; i < factor->pair_count; i++)
            pair_row(r->out, factor, &factor->pairs[i]);
        close_table(r->out);
    }
    pairs_words(r, f, any);
}

static void left_out(const struct report *r, const struct factorial *f)
{
    if (f->dropped[0]) {
        fputs("<p>", r->out);
        html_printf(r->out, "Left out, factors: %s.", f->dropped);
        fputs("</p>\n", r->out);
    }
    if (f->left_count == 0)
        return;
    fputs("<p class=\"note\">", r->out);
    html_printf(r->out, "Left out, as missing ratings are never filled in: ");
    for (size_t i = 0, alike = 1; i < f->left_count; i++, alike++) { // who lack as many one after another
        html_printf(r->out, "%s%s", i ? ", " : "", r->sample->people[f->left[i].person].code);
        if (i + 1 < f->left_count && f->left[i + 1].missing == f->left[i].missing)
            continue;
        html_printf(r->out, " (no rating in %zu of %zu cells%s)", f->left[i].missing, f->cells,
                    alike > 1 ? " each" : "");
        alike = 0;
    }
    fputs(".</p>\n", r->out);
}

void report_factorial(const struct report *r, const struct factorial *f, const struct figure_pair *means,
                      const struct figure_pair *answers)
{
    fputs("<h3>", r->out);
    html_printf(r->out, "Question \u201c%s\u201d, %g to %g, block \u201c%s\u201d", f->question, f->scale_min,
                f->scale_max, f->block);
    fputs("</h3>\n", r->out);
    left_out(r, f);
    fputs("<p>", r->out);
    if (f->refusal[0]) {
        char words[512];
        factorial_refusal(f, words);
        html_printf(r->out, "%s", words);
    } else if (f->least == f->most)
        html_printf(r->out, "%zu participants with %zu rating%s in each of %zu cells.", f->people, f->least,
                    f->least == 1 ? "" : "s", f->cells);
    else
        html_printf(r->out, "%zu participants with %zu to %zu ratings in each of %zu cells, averaged.",
                    f->people, f->least, f->most, f->cells);
    fputs("</p>\n", r->out);
    if (f->refusal[0])
        return;
    if (answers)
        report_figure(
            r, answers,
            "Shares of all answers per level, over all other factors. Orange: below the middle of the scale, "
            "the darker the lower; blue: above it, the darker the higher; gray: the middle, half on either "
            "side. Numbers: the shares below and above.");
    if (means)
        report_figure(
            r, means,
            "Mean ratings per level, over all other factors, on the whole scale. Lines: intervals within "
            "people (Cousineau\u2013Morey), which compare the levels of one factor and do not say where a "
            "mean lies; an arrow marks one that goes on beyond the scale.");
    effects_table(r, f);
    means_table(r, f);
    pairs_tables(r, f);
}
