#include "analysis/tools/choices_equivalence.h"

#include "analysis/report/choice_equivalence.h"
#include "analysis/tools/choices_people.h"

#include <stdlib.h>

bool choices_equivalence_print(const struct choices *c, double margin)
{
    char ci[32];
    const double alpha = 1 - c->conf;
    snprintf(ci, sizeof ci, "%g %% CI", 100 * (1 - 2 * alpha));
    const char *const headings[] = {
        "<block", "<cell", "<two one-sided tests", "p above", "p below", "p", "Holm p", ci, "<verdict", NULL};
    struct table t;
    struct choice_equality *equalities = choice_equalities(c, margin, true);
    if (!equalities)
        return false;
    table_init(&t, headings);
    for (size_t i = 0; i < c->cell_count; i++) {
        const struct choice_cell *cell = &c->cells[i];
        const struct stat_equivalence *e = &equalities[i].test;
        table_cell(&t, "%s", cell->block);
        table_cell(&t, "%s", cell->label);
        table_cell(&t, "%s", choice_equivalence_method(cell));
        choices_p_cell(&t, e->p_low);
        choices_p_cell(&t, e->p_high);
        choices_p_cell(&t, e->p_value);
        choices_p_cell(&t, equalities[i].holm);
        choices_range_cell(&t, e->ci);
        table_cell(&t, "%s", choice_equivalence_words(cell, &equalities[i], alpha));
    }
    printf("\nEquivalence: is the preference within %.4g to %.4g?\n", c->p0 - margin, c->p0 + margin);
    bool ok = table_print(&t, stdout);
    table_finish(&t);
    free(equalities);
    puts("p above, below: of the lower and of the upper end of the margin; p: the larger; Holm p: adjusted for "
         "the cells with a p.\nThe verdict is by Holm's p, of the difference too.");
    return ok;
}

bool choices_equivalence_json(struct json *json, const struct choices *c, double margin)
{
    struct choice_equality *equalities = choice_equalities(c, margin, true);
    if (!equalities)
        return false;
    json_open(json, "equivalence", '[');
    for (size_t i = 0; i < c->cell_count; i++) {
        const struct choice_cell *cell = &c->cells[i];
        const struct stat_equivalence *e = &equalities[i].test;
        json_open(json, NULL, '{');
        json_text(json, "block", cell->block);
        json_text(json, "cell", cell->label);
        json_number(json, "margin", margin);
        json_text(json, "method", choice_equivalence_method(cell));
        json_number(json, "p_low", e->p_low);
        json_number(json, "p_high", e->p_high);
        json_number(json, "p_value", e->p_value);
        json_number(json, "p_holm", equalities[i].holm);
        json_number(json, "ci_low", e->ci.low);
        json_number(json, "ci_high", e->ci.high);
        json_text(json, "shown", choice_equivalence_words(cell, &equalities[i], 1 - c->conf));
        json_close(json, '}');
    }
    json_close(json, ']');
    free(equalities);
    return true;
}
