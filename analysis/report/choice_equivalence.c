#include "analysis/report/choice_equivalence.h"

#include "analysis/stats/multiple.h"
#include "analysis/stats/people_equivalence.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct stat_equivalence choice_equivalence(const struct choices *c, const struct choice_cell *cell,
                                           double margin)
{
    const double alpha = 1 - c->conf;
    if (cell->several)
        return stat_people_equivalence(cell->counts, cell->people, c->p0, margin, alpha);
    if (cell->n == 0)
        return stat_people_equivalence(NULL, 0, c->p0, margin, alpha);
    return stat_binomial_equivalence(cell->chosen, cell->n, c->p0, margin, alpha);
}

static bool is_cell(const struct planned_row *row, const struct choice_cell *cell)
{
    return row->block && row->option == cell->test && row->reference == cell->reference && !cell->right &&
           strcmp(row->block, cell->block) == 0 && strcmp(row->factors, cell->factors) == 0;
}

// The row of equality follows the one that tests a difference. Plans are about one half.
static void take_planned(struct choice_equality *out, const struct choices *c, const struct choice_cell *cell,
                         const struct planned *planned, double margin)
{
    for (size_t i = 1; planned && c->p0 == 0.5 && i < planned->row_count && !out->planned; i++) {
        const struct planned_row *row = &planned->rows[i];
        if (row->margin != margin || !is_cell(row, cell))
            continue;
        out->planned = true;
        out->difference = planned->rows[i - 1].holm;
        out->holm = row->holm;
    }
}

// Of cells that were not planned. A one-sided "no difference" may be true with a difference beyond the margin.
static bool adjust(const struct choices *c, struct choice_equality *equalities, bool right)
{
    const size_t count = 2 * c->cell_count;
    double *p = calloc(count + 1, sizeof *p);
    size_t *set = calloc(count + 1, sizeof *set);
    bool ok = p && set;
    for (size_t i = 0; ok && i < count; i++) {
        const struct choice_cell *cell = &c->cells[i / 2];
        const struct choice_equality *e = &equalities[i / 2];
        bool part = !e->planned && (right || !cell->right);
        p[i] = !part ? (double)NAN : i % 2 ? e->test.p_value : cell->p_value;
        set[i] = c->alternative == STAT_TWO_SIDED ? i / 2 : i;
    }
    if (ok)
        stat_adjust_exclusive(p, set, count, p);
    for (size_t i = 0; ok && i < count; i += 2)
        if (!equalities[i / 2].planned) {
            equalities[i / 2].difference = p[i];
            equalities[i / 2].holm = p[i + 1];
        }
    free(p);
    free(set);
    return ok;
}

struct choice_equality *choice_equalities(const struct choices *c, const struct planned *planned, double margin,
                                          bool right)
{
    struct choice_equality *out = calloc(c->cell_count + 1, sizeof *out);
    for (size_t i = 0; out && i < c->cell_count; i++) {
        bool part = right || !c->cells[i].right;
        out[i].test = part ? choice_equivalence(c, &c->cells[i], margin)
                           : stat_people_equivalence(NULL, 0, c->p0, margin, 1 - c->conf);
        take_planned(&out[i], c, &c->cells[i], planned, margin);
    }
    if (out && !adjust(c, out, right)) {
        free(out);
        return NULL;
    }
    return out;
}

const char *choice_equivalence_words(const struct choice_equality *equality, double alpha)
{
    static const char *const verdicts[] = {[STAT_UNDECIDED] = "neither is shown",
                                           [STAT_DIFFERENT] = "a difference is shown",
                                           [STAT_WITHIN] = "equality within the margin is shown",
                                           [STAT_DIFFERENT_WITHIN] = "a difference within the margin is shown"};
    return isnan(equality->holm) ? "not estimable"
                                 : verdicts[stat_verdict(equality->difference, equality->holm, alpha)];
}

const char *choice_equivalence_method(const struct choice_cell *cell)
{
    return cell->n == 0 ? "" : cell->several ? "t of people's shares" : "exact binomial";
}
