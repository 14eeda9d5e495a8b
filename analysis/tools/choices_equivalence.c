#include "analysis/tools/choices_equivalence.h"

#include "analysis/report/choice_equivalence.h"
#include "analysis/tools/choices_people.h"

#include <math.h>
#include <stdlib.h>

// What the protocol fixed.
static void take_planned(struct choices_margin *out, const struct plans *plans, const struct choices *c)
{
    bool differ;
    double margin = plans_margin(plans, &differ);
    if (differ) {
        out->note = "The sessions' protocols plan different margins of equivalence; --margin tests one.";
    } else if (!isnan(margin) && c->p0 == 0.5 && c->conf > 0.5) {
        out->value = margin;
        out->note = "The margin is the protocol's.";
    } else if (!isnan(margin)) {
        out->note = "The protocol's margin of equivalence is about one half and for a --conf above 0.5; "
                    "it is not used here.";
    }
}

static bool is_planned(const struct plans *plans, double margin)
{
    for (size_t i = 0; i < plans->count; i++)
        if (plan_is(&plans->items[i], "binomial", "choice", NULL) && plans->items[i].margin == margin)
            return true;
    return false;
}

bool choices_margin_load(struct choices_margin *out, double typed, struct sample *sample,
                         const struct choices *c, char *error, size_t error_size)
{
    struct plans plans;
    *out = (struct choices_margin){.value = typed};
    if (!plans_load(&plans, sample)) {
        snprintf(error, error_size, "not enough memory");
        return false;
    }
    if (isnan(typed))
        take_planned(out, &plans, c);
    bool planned = c->p0 == 0.5 && is_planned(&plans, out->value);
    plans_free(&plans);
    return !planned || planned_results_load(&out->results, sample, c->conf, error, error_size);
}

void choices_margin_free(struct choices_margin *margin)
{
    planned_results_free(&margin->results);
}

static void print_families(const struct choices *c, const struct choice_equality *equalities)
{
    bool planned = false, cells = false;
    for (size_t i = 0; i < c->cell_count; i++) {
        planned = planned || equalities[i].planned;
        cells = cells || !equalities[i].planned;
    }
    puts("p above, below: of the lower and of the upper end of the margin; p: the larger. The verdict is by "
         "Holm's "
         "p, of\nequality and of a difference.");
    if (planned)
        puts("Family planned: both are those of the planned analyses (fovstats planned), adjusted for all that "
             "was "
             "planned.");
    if (cells)
        printf(
            "Family cells: both are adjusted over the tests of a difference and of equality of all such cells "
            "together%s.\n",
            c->alternative == STAT_TWO_SIDED ? ",\nwhere the two of a cell count once, as their hypotheses "
                                               "exclude each other (Shaffer 1986)"
                                             : "");
}

static void row(struct table *t, const struct choices *c, const struct choice_cell *cell,
                const struct choice_equality *equality)
{
    const struct stat_equivalence *e = &equality->test;
    table_cell(t, "%s", cell->block);
    table_cell(t, "%s", cell->label);
    table_cell(t, "%s", choice_equivalence_method(cell));
    choices_p_cell(t, e->p_low);
    choices_p_cell(t, e->p_high);
    choices_p_cell(t, e->p_value);
    choices_range_cell(t, e->ci);
    choices_p_cell(t, equality->holm);
    choices_p_cell(t, equality->difference);
    table_cell(t, "%s", equality->planned ? "planned" : "cells");
    table_cell(t, "%s", choice_equivalence_words(equality, 1 - c->conf));
}

bool choices_equivalence_print(const struct choices *c, const struct choices_margin *margin)
{
    char ci[32];
    snprintf(ci, sizeof ci, "%g %% CI", 100 * (1 - 2 * (1 - c->conf)));
    const char *const headings[] = {"<block", "<cell",  "<two one-sided tests", "p above", "p below",  "p",
                                    ci,       "Holm p", "of a difference",      "<family", "<verdict", NULL};
    struct table t;
    bool ok = true;
    if (!isnan(margin->value)) {
        struct choice_equality *equalities =
            choice_equalities(c, &margin->results.planned, margin->value, true);
        if (!equalities)
            return false;
        table_init(&t, headings);
        for (size_t i = 0; i < c->cell_count; i++)
            row(&t, c, &c->cells[i], &equalities[i]);
        printf("\nEquivalence: is the preference within %.4g to %.4g?\n", c->p0 - margin->value,
               c->p0 + margin->value);
        ok = table_print(&t, stdout);
        table_finish(&t);
        print_families(c, equalities);
        free(equalities);
    }
    if (margin->note)
        puts(margin->note);
    return ok;
}

bool choices_equivalence_json(struct json *json, const struct choices *c, const struct choices_margin *margin)
{
    if (isnan(margin->value))
        return true;
    struct choice_equality *equalities = choice_equalities(c, &margin->results.planned, margin->value, true);
    if (!equalities)
        return false;
    json_open(json, "equivalence", '[');
    for (size_t i = 0; i < c->cell_count; i++) {
        const struct choice_cell *cell = &c->cells[i];
        const struct stat_equivalence *e = &equalities[i].test;
        json_open(json, NULL, '{');
        json_text(json, "block", cell->block);
        json_text(json, "cell", cell->label);
        json_number(json, "margin", margin->value);
        json_text(json, "method", choice_equivalence_method(cell));
        json_number(json, "p_low", e->p_low);
        json_number(json, "p_high", e->p_high);
        json_number(json, "p_value", e->p_value);
        json_number(json, "p_holm", equalities[i].holm);
        json_number(json, "p_holm_of_difference", equalities[i].difference);
        json_text(json, "family", equalities[i].planned ? "planned" : "cells");
        json_number(json, "ci_low", e->ci.low);
        json_number(json, "ci_high", e->ci.high);
        json_text(json, "shown", choice_equivalence_words(&equalities[i], 1 - c->conf));
        json_close(json, '}');
    }
    json_close(json, ']');
    free(equalities);
    return true;
}
