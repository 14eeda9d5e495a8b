#include "analysis/stats/psychometric_bayes.h"

#include "analysis/stats/marginal.h"
#include "analysis/stats/psychometric_grid.h"
#include "analysis/stats/psychometric_problem.h"

#include <math.h>
#include <stdlib.h>

enum {
    POINTS = 37,      // of threshold and of width
    LOOK_POINTS = 33, // while looking for the posterior's mass
    NODES = STAT_GRID_NODES,
    BOTH_NODES = 8, // of each where both are free
    LOOK_NODES = 4
};

// How far below its maximum a marginal's density still counts as mass: e^-12 is 6e-6.
static const double mass_ln = 12;

// Beta(1, 10) up to an end, by Gauss-Legendre; or one node.
static size_t nodes(double low, double high, double end, size_t count, double x[], double w[])
{
    if (low == high) {
        x[0] = low;
        w[0] = 1;
        return 1;
    }
    stat_gauss_legendre(count, x, w);
    for (size_t i = 0; i < count; i++) {
        x[i] *= end;
        w[i] *= end * 10 * pow(1 - x[i], 9);
    }
    return count;
}

// The part of a marginal that holds mass, a cell wider on both sides.
static void narrow(const double *marginal, size_t points, double *low, double *high)
{
    double most = 0, from = *low, to = *high;
    for (size_t i = 0; i < points; i++)
        most = fmax(most, marginal[i]);
    size_t first = points, last = 0;
    for (size_t i = 0; i < points; i++)
        if (marginal[i] > most * exp(-mass_ln)) {
            first = first == points ? i : first;
            last = i;
        }
    if (first == points)
        return;
    *low = stat_grid_at(from, to, points, first ? first - 1 : 0);
    *high = stat_grid_at(from, to, points, last + 1 < points ? last + 1 : last);
}

static void set_nodes(const struct stat_fit_desc *d, struct stat_grid *g, bool look)
{
    bool both = d->guess_low < d->guess_high && d->lapse_low < d->lapse_high;
    size_t asymptotes = !look ? (both ? BOTH_NODES : NODES) : LOOK_NODES;
    g->guesses = nodes(d->guess_low, d->guess_high, 0.5, asymptotes, g->guess, g->w_guess);
    g->lapses = nodes(d->lapse_low, d->lapse_high, 0.5, asymptotes, g->lapse, g->w_lapse);
    g->etas = nodes(0, 1, 1, look ? LOOK_NODES : STAT_GRID_ETA_NODES, g->eta, g->w_eta);
}

static struct stat_bayes finish(const struct stat_problem *p, struct stat_grid *g)
{
    struct stat_bayes b;
    const struct stat_fit_desc *d = &p->desc;
    double conf = d->conf;
    b.threshold = stat_grid_marginal(g->at, g->at_low, g->at_high, g->points, conf, p->logarithmic);
    b.width = stat_grid_marginal(g->width, g->width_low, g->width_high, g->points, conf, true);
    b.guess = stat_node_marginal(g->m_guess, g->w_guess, g->guess, g->guesses, 0.5, conf);
    b.lapse = stat_node_marginal(g->m_lapse, g->w_lapse, g->lapse, g->lapses, 0.5, conf);
    b.eta = stat_node_marginal(g->m_eta, g->w_eta, g->eta, g->etas, 1, conf);
    b.prior_bound = b.threshold.credible.low < stat_problem_level(p, p->u[0]) ||
                    b.threshold.credible.high > stat_problem_level(p, p->u[p->count - 1]);
    return b;
}

static void compute(struct stat_problem *p, struct stat_grid *g)
{
    // Near enough to the likelihood's maximum that no weight leaves the doubles.
    double top = stat_problem_maximum(p, LOOK_NODES * 4, NULL).log_likelihood;
    g->at_low = p->u[0] - p->range / 2;
    g->at_high = p->u[p->count - 1] + p->range / 2;
    g->width_low = log(p->gap);
    g->width_high = log(3 * p->range);
    set_nodes(&p->desc, g, true);
    g->points = LOOK_POINTS;
    for (int i = 0; i < 2; i++) {
        stat_grid_sum(p, g, top, false);
        narrow(g->at, g->points, &g->at_low, &g->at_high);
        narrow(g->width, g->points, &g->width_low, &g->width_high);
    }
    set_nodes(&p->desc, g, false);
    g->points = POINTS;
    stat_grid_sum(p, g, top, true);
}

struct stat_bayes stat_psychometric_bayes(const struct stat_answers *answers, size_t count,
                                          const struct stat_fit_desc *desc)
{
    const double none = (double)NAN;
    const struct stat_marginal unknown = {none, none, none, {none, none}};
    struct stat_bayes b = {unknown, unknown, unknown, unknown, unknown, false};
    struct stat_problem p;
    if (!stat_problem_init(&p, answers, count, desc))
        return b;
    struct stat_grid g = {.at = malloc(POINTS * sizeof(double)),
                          .width = malloc(POINTS * sizeof(double)),
                          .yes = malloc(p.count * sizeof(double))};
    if (g.at && g.width && g.yes && p.count > 1 && p.range > 0 && p.total <= STAT_BAYES_MOST) {
        compute(&p, &g);
        b = finish(&p, &g);
    }
    free(g.yes);
    free(g.at);
    free(g.width);
    stat_problem_finish(&p);
    return b;
}
