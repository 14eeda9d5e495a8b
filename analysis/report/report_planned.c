// What was planned before the first participant, each with its result. What cannot be computed says why, so
// that a planned test is never silently missing.
#include "analysis/report/html.h"
#include "analysis/report/sections.h"

#include <math.h>
#include <string.h>

// "paired_t rating order" as "paired t of rating, per order".
static void write_plan(FILE *out, const struct plan *plan)
{
    for (const char *c = plan->method; *c; c++)
        html_printf(out, "%c", *c == '_' ? ' ' : *c);
    html_printf(out, " of %s", plan->of);
    if (strcmp(plan->per, "-") != 0)
        html_printf(out, ", per %s", plan->per);
    if (!isnan(plan->margin))
        html_printf(out, ", margin %.4g\u00a0%%", 100 * plan->margin);
}

// Thresholds and adjusted values may be of any size; ratings, toggles and seconds are not.
static void number(const struct planned_row *row, const struct plan *plan, double value, char out[32])
{
    bool any_size = plan_is(plan, NULL, "threshold", NULL) || plan_is(plan, NULL, "adjusted", NULL);
    if (row->share)
        snprintf(out, 32, "%.1f", 100 * value);
    else
        snprintf(out, 32, any_size ? "%.4g" : "%.2f", value);
}

static void estimate_cells(FILE *out, const struct planned_row *row, const struct plan *plan, double conf)
{
    char estimate[32], low[32], high[32];
    const char *unit = !row->share ? row->unit : row->difference ? "points" : "%";
    number(row, plan, row->estimate, estimate);
    number(row, plan, row->low, low);
    number(row, plan, row->high, high);
    if (isnan(row->estimate))
        html_cell(out, "td", "\u2013");
    else if (row->effect_size)
        html_cell(out, "td", "\u03b7\u00b2\u209a %.3f", row->estimate);
    else
        html_cell(out, "td", "%s%s%s", estimate, unit[0] ? "\u00a0" : "", unit);
    if (isnan(row->low))
        html_cell(out, "td", "\u2013");
    else if (row->conf != conf)
        html_cell(out, "td", "%s to %s (%.4g\u00a0%%)", low, high, 100 * row->conf);
    else
        html_cell(out, "td", "%s to %s", low, high);
}

static void p_cell(FILE *out, double value)
{
    char p[24];
    html_p_value(p, value);
    html_cell(out, "td", "%s", isnan(value) ? "\u2013" : p);
}

static void planned_row(const struct report *r, const struct planned_row *row)
{
    FILE *out = r->out;
    fputs("<tr>", out);
    html_cell(out, "th scope=\"row\" class=\"word\"", "%s", row->words[0] ? row->words : "all");
    if (row->people == 0) {
        html_cell(out, "td colspan=\"6\" class=\"word\"", "%s",
                  row->note[0] ? row->note : "not estimable: nobody has a value");
        fputs("</tr>\n", out);
        return;
    }
    html_cell(out, "td", "%zu", row->people);
    estimate_cells(out, row, &r->plans.items[row->plan], r->conf);
    html_cell(out, "td class=\"word\"", "%s%s%s", row->test, row->test[0] && row->note[0] ? "; " : "",
              row->note);
    p_cell(out, row->p_value);
    p_cell(out, row->holm);
    fputs("</tr>\n", out);
}

static void partial_note(const struct report *r)
{
    size_t most = 0;
    for (size_t i = 0; i < r->planned.row_count; i++)
        most = r->planned.rows[i].partial > most ? r->planned.rows[i].partial : most;
    if (most)
        html_printf(
            r->out,
            " In some rows people (up to %zu) lack cells that others have; their value is over those that "
            "they have, nothing is filled.",
            most);
}

static void planned_table(const struct report *r)
{
    FILE *out = r->out;
    fprintf(out,
            "<div class=\"table\" tabindex=\"0\" role=\"region\" aria-label=\"Planned analyses\"><table "
            "class=\"wrap\">\n<caption>What the protocol planned, and its results</caption>\n<thead><tr><th "
            "scope=\"col\" class=\"word\">planned</th><th scope=\"col\">people</th><th "
            "scope=\"col\">estimate</th><th scope=\"col\">%g&nbsp;%% interval</th><th scope=\"col\" "
            "class=\"word\">test</th><th scope=\"col\">p</th><th scope=\"col\">p "
            "(Holm)</th></tr></thead>\n",
            100 * r->conf);
    for (size_t plan = 0; plan < r->plans.count; plan++) {
        fputs("<tbody>\n<tr><th scope=\"rowgroup\" colspan=\"7\" class=\"word\">", out);
        write_plan(out, &r->plans.items[plan]);
        fputs("</th></tr>\n", out);
        for (size_t i = 0; i < r->planned.row_count; i++)
            if (r->planned.rows[i].plan == plan)
                planned_row(r, &r->planned.rows[i]);
        fputs("</tbody>\n", out);
    }
    fputs("</table></div>\n", out);
}

static void family(const struct report *r)
{
    size_t tests = r->planned.tested, equality = planned_equality(&r->planned);
    if (tests)
        html_printf(r->out, "p (Holm) is adjusted for the %zu %s of this table, the planned family", tests,
                    tests == 1 ? "test" : "tests");
    if (equality)
        html_printf(
            r->out,
            "; %zu of them %s of equality by two one-sided tests, with the interval that belongs to "
            "them. No difference and one beyond the margin cannot both be true, so that the two tests of "
            "a preference count once (Shaffer 1986). Equality, and a difference beside it, count as "
            "shown where p (Holm) is at most %.4g",
            equality, equality == 1 ? "is" : "are", 1 - r->conf);
    fputs(tests ? ". " : "", r->out);
}

// Where the protocol planned to join cells, and there was something to join.
static void joined_methods(const struct report *r)
{
    static const char *const joining[] = {"scene", "factor", "study"};
    size_t count = 0;
    for (size_t i = 0; i < sizeof joining / sizeof joining[0]; i++) {
        bool used = false;
        for (size_t k = 0; k < r->planned.row_count; k++)
            used = used || (r->planned.rows[k].people > 0 &&
                            plan_is(&r->plans.items[r->planned.rows[k].plan], NULL, NULL, joining[i]));
        if (used)
            html_printf(r->out, "%s per %s", count++ ? " and" : "Planned analyses", joining[i]);
    }
    if (count)
        fputs(" join cells: each person\u2019s answers in them are taken together first, so that people are "
              "what is counted. ",
              r->out);
}

// By which tests equality was tested.
static const char *equality_tests(const struct report *r)
{
    bool exact = false, t = false;
    for (size_t i = 0; i < r->planned.row_count; i++) {
        const struct planned_row *row = &r->planned.rows[i];
        bool tested = !isnan(row->margin) && !isnan(row->p_value);
        exact = exact || (tested && strstr(row->test, "binomial"));
        t = t || (tested && !strstr(row->test, "binomial"));
    }
    return !t       ? "exact binomial tests"
           : !exact ? "t-tests of the people\u2019s shares"
                    : "tests: exact binomial ones of one answer each, t-tests of the people\u2019s shares else";
}

void report_planned_methods(const struct report *r)
{
    joined_methods(r);
    size_t tests = r->planned.tested, equality = planned_equality(&r->planned);
    if (tests == 1)
        fputs("One test was planned. ", r->out);
    else if (tests)
        html_printf(r->out, "The %zu planned tests are one family, with Holm\u2019s adjustment. ", tests);
    if (equality)
        html_printf(
            r->out,
            "Equality of preferences within the protocol\u2019s margin was tested by two one-sided %s. "
            "%s in the family, where the two tests of a preference count once, as their hypotheses "
            "exclude each other (Shaffer 1986); equality is claimed only where Holm\u2019s p is at most "
            "%.4g. ",
            equality_tests(r), equality == 1 ? "That test is" : "These tests are", 1 - r->conf);
}

void report_planned(const struct report *r)
{
    FILE *out = r->out;
    report_heading(r, "Planned analyses");
    if (r->plans.count == 0) {
        fprintf(out, "<p>None: %s.</p>\n", plans_none(r->sample));
        return;
    }
    planned_table(r);
    fputs("<p>A person\u2019s answers in a cell are averaged, then the cells of a row, so that each person "
          "counts "
          "the same; shares of choices are tested as in section \u201cChoices\u201d, joined over cells only "
          "where the protocol planned it. Levels are compared in what is otherwise the same, by paired tests "
          "and analyses of variance where the factor "
          "lies within people (at least half of them were to see several of its levels, as their trials were "
          "planned), by unpaired tests where it lies between them; who does not fit is left out and said. ",
          out);
    family(r);
    fputs("A large p does not show that there is no difference. Everything else in this report was not "
          "planned.",
          out);
    partial_note(r);
    fputs("</p>\n", out);
}
