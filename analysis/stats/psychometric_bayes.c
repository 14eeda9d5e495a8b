#include "analysis/stats/psychometric_bayes.h"

#include "analysis/stats/marginal.h"
#include "analysis/stats/psychometric_mass.h"
#include "analysis/stats/psychometric_problem.h"

#include <math.h>
#include <stdlib.h>

enum { REFINEMENTS = 4 };

struct prior {
    const struct stat_problem *problem;
    const struct stat_grid *grid;
    int axis;
};

static double prior(const void *user, double coordinate)
{
    const struct prior *p = user;
    return stat_posterior_prior(p->problem, p->grid->axis, p->axis, coordinate);
}

static struct stat_marginal marginal(const struct stat_problem *p, const struct stat_grid *g, int axis,
                                     enum stat_scale scale)
{
    const struct stat_axis *a = &g->axis[axis];
    if (a->points == 1)
        return (struct stat_marginal){a->fixed, 0, a->fixed, {a->fixed, a->fixed}};
    return stat_even_marginal(&(struct stat_even){.mass = g->marginal[axis],
                                                  .low = a->low,
                                                  .high = a->high,
                                                  .points = a->points,
                                                  .scale = scale,
                                                  .end = a->end,
                                                  .prior = prior,
                                                  .user = &(struct prior){p, g, axis}},
                              p->desc.conf);
}

static struct stat_bayes finish(const struct stat_problem *p, const struct stat_grid *g)
{
    struct stat_bayes b;
    b.threshold = marginal(p, g, STAT_GRID_AT, p->logarithmic ? STAT_SCALE_LN : STAT_SCALE_PLAIN);
    b.width = marginal(p, g, STAT_GRID_WIDTH, STAT_SCALE_LN);
    b.guess = marginal(p, g, STAT_GRID_GUESS, STAT_SCALE_CUBE_ROOT);
    b.lapse = marginal(p, g, STAT_GRID_LAPSE, STAT_SCALE_CUBE_ROOT);
    b.eta = marginal(p, g, STAT_GRID_ETA, STAT_SCALE_CUBE_ROOT);
    b.prior_bound = b.threshold.credible.low < stat_problem_level(p, p->u[0]) ||
                    b.threshold.credible.high > stat_problem_level(p, p->u[p->count - 1]);
    b.rough = g->rough > stat_grid_enough;
    return b;
}

// Sums, and again with more points along the axes whose sums over every second point differ, until they do not.
static bool compute(struct stat_problem *p, struct stat_grid *g)
{
    double top;
    if (!stat_mass_find(p, g, &top))
        return false;
    for (int i = 0; i <= REFINEMENTS; i++) {
        if (!stat_grid_sum(p, g, top))
            return false;
        bool finer = false;
        for (int axis = 0; g->rough > stat_grid_enough && axis < STAT_GRID_AXES; axis++) {
            struct stat_axis *a = &g->axis[axis];
            size_t points = a->points;
            if (g->rough_along[axis])
                a->points = stat_mass_points(a, axis, (a->high - a->low) / (1.3 * (double)points));
            finer = finer || a->points > points;
        }
        if (!finer || i == REFINEMENTS)
            break;
    }
    return true;
}

struct stat_bayes stat_psychometric_bayes(const struct stat_answers *answers, size_t count,
                                          const struct stat_fit_desc *desc)
{
    const double none = (double)NAN;
    const struct stat_marginal unknown = {none, none, none, {none, none}};
    struct stat_bayes b = {unknown, unknown, unknown, unknown, unknown, false, false};
    struct stat_problem p;
    if (!stat_problem_init(&p, answers, count, desc))
        return b;
    struct stat_grid *g = calloc(1, sizeof *g);
    if (g && p.count > 1 && p.range > 0 && p.total <= STAT_BAYES_MOST && compute(&p, g))
        b = finish(&p, g);
    free(g);
    stat_problem_finish(&p);
    return b;
}
