// What lies outside of chance, in a sentence at the head of the report.
#include "analysis/report/html.h"
#include "analysis/report/sections.h"

#include <inttypes.h>

int report_direction(const struct choice_cell *cell)
{
    if (!report_outside(cell))
        return 0;
    if (!cell->several)
        return 2 * cell->chosen > cell->n ? 1 : -1;
    int people = (cell->flip.statistic > 0) - (cell->flip.statistic < 0),
        share = (cell->estimate > 0.5) - (cell->estimate < 0.5);
    return people == share ? people : 0;
}

static void list_outside(const struct report *r, bool right, int where)
{
    bool first = true;
    for (size_t i = 0; i < r->choices.cell_count; i++) {
        const struct choice_cell *cell = &r->choices.cells[i];
        if (cell->right != right || report_direction(cell) != where)
            continue;
        char words[256];
        report_cell_words(cell, words);
        html_printf(r->out, "%s%s (%" PRId64 " of %" PRId64 ")", first ? "" : "; ", words, cell->chosen,
                    cell->n);
        first = false;
    }
}

// What lies outside, after its subject; `no`: "does not lie outside".
static void summary_test(const struct report *r, bool no, bool plural)
{
    if (r->choices.several)
        html_printf(r->out, "%s p %s %.4g", plural ? "have" : "has", no ? ">" : "\u2264", 1 - r->conf);
    else
        html_printf(r->out, "%s outside the %g\u00a0%% region of the null hypothesis",
                    no       ? "does not lie"
                    : plural ? "lie"
                             : "lies",
                    100 * r->conf);
}

void report_summary(const struct report *r)
{
    int64_t cells = 0, outside = 0, holm = 0, of[2][3] = {{0}};
    for (size_t i = 0; i < r->choices.cell_count; i++) {
        const struct choice_cell *cell = &r->choices.cells[i];
        cells += cell->n > 0;
        outside += report_outside(cell);
        of[cell->right][report_direction(cell) + 1]++;
        holm += cell->holm <= 1 - r->conf;
    }
    if (cells == 0)
        return;
    fputs("<p class=\"lead\">", r->out);
    if (cells == 1)
        fputs("The one cell ", r->out);
    else if (outside == 0)
        html_printf(r->out, "None of the %" PRId64 " cells ", cells);
    else
        html_printf(r->out, "Of %" PRId64 " cells, %" PRId64 " ", cells, outside);
    summary_test(r, cells == 1 && outside == 0, cells > 1 && outside > 1);
    static const struct {
        bool right;
        int where;
        const char *words;
    } lists[] = {{false, -1, "; the reference was preferred for "},
                 {false, 1, "; the test option was preferred for "},
                 {true, 1, "; answers were right more often than by guessing for "},
                 {true, -1, "; answers were wrong more often than by guessing for "}};
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++)
        if (of[lists[i].right][lists[i].where + 1]) {
            fputs(lists[i].words, r->out);
            list_outside(r, lists[i].right, lists[i].where);
        }
    fputs(". ", r->out);
    if (cells > outside)
        html_printf(r->out, "%s no clear preference, which does not show that the options look the same. ",
                    cells == 1             ? "It shows"
                    : outside == 0         ? "They show"
                    : cells - outside == 1 ? "The other cell shows"
                                           : "The other cells show");
    if (outside && cells > 1) {
        fputs("With Holm\u2019s correction for the number of cells, ", r->out);
        if (holm == 0)
            fputs("none remains.", r->out);
        else if (outside == 1)
            fputs("it remains.", r->out);
        else
            html_printf(r->out, "%" PRId64 " of them %s.", holm, holm == 1 ? "remains" : "remain");
    }
    fputs("</p>\n", r->out);
}
