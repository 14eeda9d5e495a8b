#include "analysis/report/choice_equivalence.h"

#include "analysis/stats/people_equivalence.h"

#include <math.h>

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

const char *choice_equivalence_words(double p_difference, const struct stat_equivalence *e, double alpha)
{
    static const char *const verdicts[] = {[STAT_UNDECIDED] = "neither is shown",
                                           [STAT_DIFFERENT] = "a difference is shown",
                                           [STAT_WITHIN] = "equality within the margin is shown",
                                           [STAT_DIFFERENT_WITHIN] = "a difference within the margin is shown"};
    return isnan(e->p_value) ? "not estimable" : verdicts[stat_verdict(p_difference, e->p_value, alpha)];
}

const char *choice_equivalence_method(const struct choice_cell *cell)
{
    return cell->n == 0 ? "" : cell->several ? "t of people's shares" : "exact binomial";
}
