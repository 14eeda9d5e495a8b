#include "analysis/report/choice_equivalence.h"

#include "analysis/stats/multiple.h"
#include "analysis/stats/people_equivalence.h"

#include <math.h>
#include <stdlib.h>

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

struct choice_equality *choice_equalities(const struct choices *c, double margin, bool right)
{
    struct choice_equality *out = calloc(c->cell_count + 1, sizeof *out);
    double *p = calloc(c->cell_count + 1, sizeof *p);
    if (!out || !p) {
        free(out);
        free(p);
        return NULL;
    }
    for (size_t i = 0; i < c->cell_count; i++) {
        bool part = right || !c->cells[i].right;
        out[i].test = part ? choice_equivalence(c, &c->cells[i], margin)
                           : stat_people_equivalence(NULL, 0, c->p0, margin, 1 - c->conf);
        p[i] = out[i].test.p_value;
    }
    stat_adjust_holm(p, c->cell_count, p);
    for (size_t i = 0; i < c->cell_count; i++)
        out[i].holm = p[i];
    free(p);
    return out;
}

const char *choice_equivalence_words(const struct choice_cell *cell, const struct choice_equality *equality,
                                     double alpha)
{
    static const char *const verdicts[] = {[STAT_UNDECIDED] = "neither is shown",
                                           [STAT_DIFFERENT] = "a difference is shown",
                                           [STAT_WITHIN] = "equality within the margin is shown",
                                           [STAT_DIFFERENT_WITHIN] = "a difference within the margin is shown"};
    return isnan(equality->holm) ? "not estimable" : verdicts[stat_verdict(cell->holm, equality->holm, alpha)];
}

const char *choice_equivalence_method(const struct choice_cell *cell)
{
    return cell->n == 0 ? "" : cell->several ? "t of people's shares" : "exact binomial";
}
