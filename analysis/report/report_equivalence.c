// Whether the options count as equal in a cell, by the margin that the protocol fixed.
#include "analysis/report/choice_equivalence.h"
#include "analysis/report/html.h"
#include "analysis/report/sections.h"

#include <math.h>
#include <stdlib.h>

static void p_cell(FILE *out, double value)
{
    char p[24];
    html_p_value(p, value);
    html_cell(out, "td", "%s", isnan(value) ? "\u2013" : p);
}

static void equivalence_row(const struct report *r, const struct choice_cell *cell,
                            const struct choice_equality *equality)
{
    FILE *out = r->out;
    char words[256];
    const struct stat_equivalence *e = &equality->test;
    report_cell_words(cell, words);
    fputs("<tr>", out);
    html_cell(out, "th scope=\"row\" class=\"word\"", "%s", words);
    html_cell(out, "td", "%zu", stat_people_sum(cell->counts, cell->people).people);
    html_cell(out, "td class=\"word\"", "%s", choice_equivalence_method(cell));
    if (isnan(e->ci.low))
        html_cell(out, "td", "\u2013");
    else
        html_cell(out, "td", "%.1f to %.1f\u00a0%%", 100 * e->ci.low, 100 * e->ci.high);
    p_cell(out, e->p_low);
    p_cell(out, e->p_high);
    p_cell(out, e->p_value);
    p_cell(out, equality->holm);
    p_cell(out, equality->difference);
    html_cell(out, "td class=\"word\"", "%s%s", choice_equivalence_words(equality, 1 - r->conf),
              equality->planned ? " (planned)" : "");
    fputs("</tr>\n", out);
}

// Whether the table has rows of that family.
static bool has_family(const struct report *r, const struct choice_equality *equalities, bool planned)
{
    for (size_t i = 0; i < r->choices.cell_count; i++)
        if (!r->choices.cells[i].right && equalities[i].planned == planned)
            return true;
    return false;
}

static void families(const struct report *r, const struct choice_equality *equalities)
{
    if (has_family(r, equalities, true))
        fputs("\u201cPlanned\u201d: equality of this cell was planned, and both p (Holm) are those of the "
              "planned "
              "analyses, adjusted for all that was planned. ",
              r->out);
    if (has_family(r, equalities, false))
        fputs("Where a result is not marked as planned, equality of the cell was not; both p (Holm) are "
              "adjusted over "
              "the tests of a difference and of equality of all such cells together, where the two of a cell "
              "count once, as their hypotheses exclude each other (Shaffer 1986). ",
              r->out);
}

static void equivalence_table(const struct report *r, double margin, const struct choice_equality *equalities)
{
    FILE *out = r->out;
    fprintf(out,
            "<div class=\"table\" tabindex=\"0\" role=\"region\" aria-label=\"Equivalence\"><table "
            "class=\"wrap\">\n<caption>Equivalence: is the share of choices within %.4g to %.4g&nbsp;%%, the "
            "protocol\u2019s margin?</caption>\n<thead><tr><th scope=\"col\" class=\"word\">cell</th><th "
            "scope=\"col\">people</th><th scope=\"col\" class=\"word\">two one-sided tests</th><th "
            "scope=\"col\">%.4g&nbsp;%% interval</th><th scope=\"col\">p above</th><th scope=\"col\">p "
            "below</th><th scope=\"col\">p</th><th scope=\"col\">p (Holm)</th><th scope=\"col\">p of "
            "a difference (Holm)</th><th scope=\"col\" "
            "class=\"word\">result</th></tr></thead>\n<tbody>\n",
            50 - 100 * margin, 50 + 100 * margin, 100 * (1 - 2 * (1 - r->conf)));
    for (size_t i = 0; i < r->choices.cell_count; i++)
        if (!r->choices.cells[i].right)
            equivalence_row(r, &r->choices.cells[i], &equalities[i]);
    fprintf(out, "</tbody></table></div>\n<p>%s",
            r->choices.equal ? "Of answers for one of the options; \u201cequal\u201d is none. " : "");
    fputs("p above and below: that the share lies above the lower and below the upper end of the margin; p is "
          "the larger of both. Results are by both p (Holm). ",
          out);
    families(r, equalities);
    fputs("Only a small p shows equality, and equality within this margin alone; a large p in the table before "
          "does not.</p>\n",
          out);
}

static void equivalence(const struct report *r, double margin)
{
    struct choice_equality *equalities = choice_equalities(&r->choices, &r->planned, margin, false);
    if (equalities)
        equivalence_table(r, margin, equalities);
    else
        fputs("<p class=\"note\">Equivalence is not tested here: not enough memory.</p>\n", r->out);
    free(equalities);
}

void report_equivalence(const struct report *r)
{
    bool differ;
    double margin = plans_margin(&r->plans, &differ);
    if (differ)
        fputs("<p class=\"note\">Equivalence is not tested here: the sessions\u2019 protocols plan different "
              "margins; <code>fovstats choices --margin M</code> tests one.</p>\n",
              r->out);
    else if (!isnan(margin) && r->conf > 0.5)
        equivalence(r, margin);
    else if (!isnan(margin))
        fputs("<p class=\"note\">Equivalence within the protocol\u2019s margin is tested at a confidence above "
              "0.5 only.</p>\n",
              r->out);
}

void report_equivalence_methods(const struct report *r)
{
    bool differ;
    double margin = plans_margin(&r->plans, &differ);
    struct choice_equality *equalities =
        isnan(margin) || !(r->conf > 0.5) ? NULL : choice_equalities(&r->choices, &r->planned, margin, false);
    if (equalities && has_family(r, equalities, false))
        fputs(
            "Equality of single cells that was not planned was tested in the same way, in a family of its own "
            "with the tests of a difference of these cells. ",
            r->out);
    free(equalities);
}
