// Answers of three kinds.
#include "analysis/report/choice_three.h"
#include "analysis/report/html.h"
#include "analysis/report/sections.h"

#include <inttypes.h>
#include <math.h>

static void three_row(const struct report *r, const struct choice_cell *cell)
{
    FILE *out = r->out;
    struct choice_three x;
    char p[24], words[256];
    if (!choice_three_of(&r->choices, cell, &x))
        return;
    html_p_value(p, x.p_value);
    report_cell_words(cell, words);
    fputs("<tr>", out);
    html_cell(out, "th scope=\"row\" class=\"word\"", "%s", words);
    html_cell(out, "td", "%zu", x.people);
    html_cell(out, "td", "%" PRId64, x.test);
    html_cell(out, "td", "%" PRId64, x.equal);
    html_cell(out, "td", "%" PRId64, x.reference);
    html_cell(out, "td", "%.1f\u00a0%%", 100 * x.negative);
    if (isnan(x.negative_ci.low))
        html_cell(out, "td", "\u2013");
    else
        html_cell(out, "td", "%.1f to %.1f\u00a0%%", 100 * x.negative_ci.low, 100 * x.negative_ci.high);
    html_cell(out, "td", "%+.2f", x.net);
    if (isnan(x.net_ci.low))
        html_cell(out, "td", "\u2013");
    else
        html_cell(out, "td", "%+.2f to %+.2f", x.net_ci.low, x.net_ci.high);
    html_cell(out, "td", "%s", p);
    fputs("</tr>\n", out);
}

void report_choice_three(const struct report *r)
{
    const struct choices *c = &r->choices;
    bool any = false;
    report_figure(
        r, &r->three_figure,
        "Net preference per cell: the mean over people of answers for the test option minus those for the "
        "reference, over all answers, with its t interval; \u201cequal\u201d counts 0. Negative: the "
        "reference was preferred (as in Stengel et al. 2016, Figure 7). An arrow marks an interval that goes "
        "on "
        "beyond \u22121 or 1, as a t interval of few people may; the table has it whole.");
    for (size_t i = 0; i < c->cell_count; i++) {
        if (!choice_three_applies(c, &c->cells[i]))
            continue;
        if (!any)
            fprintf(
                r->out,
                "<div class=\"table\" tabindex=\"0\" role=\"region\" aria-label=\"Answers of three kinds\">"
                "<table class=\"wrap\">\n<caption>Answers of three kinds, as in Stengel et al. 2016, Figure 7: "
                "negative are "
                "those for the reference</caption>\n<thead><tr><th scope=\"col\" class=\"word\">cell</th><th "
                "scope=\"col\">people</th><th scope=\"col\">test better</th><th scope=\"col\">equal</th><th "
                "scope=\"col\">reference better</th><th scope=\"col\">negative</th><th "
                "scope=\"col\">%g&nbsp;%% interval</th><th scope=\"col\">net preference</th><th "
                "scope=\"col\">%g&nbsp;%% interval</th><th scope=\"col\">p</th></tr></thead>\n<tbody>\n",
                100 * c->conf, 100 * c->conf);
        any = true;
        three_row(r, &c->cells[i]);
    }
    if (any)
        fputs("</tbody></table></div>\n<p>Means over people, each counting the same. The net preference is "
              "test minus "
              "reference over all answers, from \u22121 (always the reference) to 1, with its t interval; p is "
              "the "
              "exact two-sided sign-flip test over people, in which \u201cequal\u201d counts 0. A large p does "
              "not "
              "show that the options are equal.</p>\n",
              r->out);
}
