#include "analysis/stats/psychometric_bayes.h"

#include "analysis/stats/marginal.h"
#include "analysis/stats/psychometric_problem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    POINTS = 41,      // of threshold and of width
    LOOK_POINTS = 33, // while looking for the posterior's mass
    NODES = 12,       // of guess or lapse
    BOTH_NODES = 8,   // of each where both are free
    ETA_NODES = 16,   // of eta, whose posterior may be narrow
    LOOK_NODES = 4
};

// How far below its maximum a marginal's density still counts as mass: e^-16 is 1e-7.
static const double mass_ln = 16;
static const double pi = 3.14159265358979323846;

struct grid {
    size_t points, guesses, lapses, etas;
    double at_low, at_high, width_low, width_high;
    double guess[NODES], lapse[NODES], eta[ETA_NODES];       // nodes
    double inverse_nu[ETA_NODES];                            // of each eta
    double w_guess[NODES], w_lapse[NODES], w_eta[ETA_NODES]; // prior times the node's weight
    double *at, *width;                                      // marginals, `points` each
    double *yes;                                             // P of each level
    double m_guess[NODES], m_lapse[NODES], m_eta[ETA_NODES]; // marginals at the nodes, weight included
};

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

static double prior_at(const struct stat_problem *p, double u)
{
    double beyond = fmax(p->u[0] - u, u - p->u[p->count - 1]) / p->range;
    return beyond <= 0 ? 1 : beyond >= 0.5 ? 0 : 0.5 + 0.5 * cos(2 * pi * beyond);
}

static double prior_width(const struct stat_problem *p, double width)
{
    double rise = width / p->gap - 1, fall = (width / p->range - 1) / 2;
    return (rise <= 0   ? 0
            : rise >= 1 ? 1
                        : 0.5 - 0.5 * cos(pi * rise)) *
           (fall <= 0   ? 1
            : fall >= 1 ? 0
                        : 0.5 + 0.5 * cos(pi * fall));
}

// A weight below e^-45 of the likelihood's maximum is left out: together all of a grid's, fewer than 41 x 41 x
// 64 x 16 = 1.8e6, with priors and nodes' weights of the order of 1, are below 1e-13 of it.
static const double negligible_ln = -45;

// Takes the logarithm of products before they leave the doubles. Eight more factors, each below 20000 x 100
// (answers times 1 / nu), cannot.
static inline void keep_in_range(double *product, double *sum, size_t count)
{
    double low = product[0], high = product[0];
    for (size_t k = 1; k < count; k++) {
        low = product[k] < low ? product[k] : low;
        high = product[k] > high ? product[k] : high;
    }
    if (low >= 1e-150 && high <= 1e150)
        return;
    for (size_t k = 0; k < count; k++) {
        sum[k] += log(product[k]);
        product[k] = 1;
    }
}

// ln of the beta-binomial without its coefficient, over all levels: a product of (nu P + j) and the like over
// the answers, divided through by nu so that eta = 0 would be the binomial. All nodes of eta side by side,
// which the processor multiplies several at a time: that is nearly all the work there is.
static inline void log_beta_binomials(const struct stat_problem *p, const double *yes, const double *inverse_nu,
                                      double *sum, size_t count)
{
    double product[ETA_NODES];
    int since = 0;
    for (size_t k = 0; k < count; k++) {
        sum[k] = 0;
        product[k] = 1;
    }
    for (size_t i = 0; i < p->count; i++) {
        int right = (int)p->k[i], n = (int)p->n[i];
        for (int j = 0; j < n; j++) {
            double base = j < right ? yes[i] : 1 - yes[i], steps = j < right ? j : j - right;
            for (size_t k = 0; k < count; k++)
                product[k] *= base + steps * inverse_nu[k];
            if (++since % 8 == 0)
                keep_in_range(product, sum, count);
        }
    }
    for (size_t k = 0; k < count; k++)
        sum[k] += log(product[k]);
}

static double log_divisor(const struct stat_problem *p, double inverse_nu)
{
    double sum = 0;
    for (size_t i = 0; i < p->count; i++)
        for (int j = 0; j < (int)p->n[i]; j++)
            sum += log1p(j * inverse_nu);
    return sum;
}

// Adds one threshold and width: sums over the nodes. Weights are relative to exp(`top`).
static void add_point(const struct stat_problem *p, struct grid *g, size_t a, size_t b, const double *divisor,
                      double prior, double top)
{
    double *yes = g->yes;
    for (size_t i = 0; i < g->guesses; i++)
        for (size_t j = 0; j < g->lapses; j++) {
            for (size_t l = 0; l < p->count; l++)
                yes[l] = g->guess[i] * p->upper[l] + (1 - g->lapse[j]) * p->lower[l];
            double ln[ETA_NODES];
            if (g->etas == ETA_NODES) // two copies, each with a count that the compiler knows
                log_beta_binomials(p, yes, g->inverse_nu, ln, ETA_NODES);
            else
                log_beta_binomials(p, yes, g->inverse_nu, ln, LOOK_NODES);
            for (size_t k = 0; k < g->etas; k++) {
                double below = ln[k] - divisor[k] - top;
                if (!(below > negligible_ln))
                    continue;
                double weight = prior * g->w_guess[i] * g->w_lapse[j] * g->w_eta[k] * exp(below);
                g->at[a] += weight;
                g->width[b] += weight;
                g->m_guess[i] += weight;
                g->m_lapse[j] += weight;
                g->m_eta[k] += weight;
            }
        }
}

static void sum_grid(struct stat_problem *p, struct grid *g, double top)
{
    double divisor[ETA_NODES],
        span = stat_family_quantile(p->desc.family, 0.95) - stat_family_quantile(p->desc.family, 0.05);
    for (size_t k = 0; k < g->etas; k++)
        g->inverse_nu[k] = g->eta[k] * g->eta[k] / (1 - g->eta[k] * g->eta[k]);
    for (size_t k = 0; k < g->etas; k++)
        divisor[k] = log_divisor(p, g->inverse_nu[k]);
    memset(g->at, 0, g->points * sizeof *g->at);
    memset(g->width, 0, g->points * sizeof *g->width);
    memset(g->m_guess, 0, sizeof g->m_guess);
    memset(g->m_lapse, 0, sizeof g->m_lapse);
    memset(g->m_eta, 0, sizeof g->m_eta);
    for (size_t b = 0; b < g->points; b++) {
        double width = stat_grid_at(g->width_low, g->width_high, g->points, b);
        double slope = (p->desc.falling ? -span : span) / width;
        for (size_t a = 0; a < g->points; a++) {
            double at = stat_grid_at(g->at_low, g->at_high, g->points, a);
            double prior = prior_at(p, at) * prior_width(p, width);
            if (!(prior > 0))
                continue;
            for (size_t i = 0; i < p->count; i++) {
                struct stat_tails t = stat_family_tails(p->desc.family, slope * (p->u[i] - at));
                p->lower[i] = t.lower;
                p->upper[i] = t.upper;
            }
            add_point(p, g, a, b, divisor, prior, top);
        }
    }
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

static void set_nodes(const struct stat_fit_desc *d, struct grid *g, bool look)
{
    bool both = d->guess_low < d->guess_high && d->lapse_low < d->lapse_high;
    size_t asymptotes = !look ? (both ? BOTH_NODES : NODES) : LOOK_NODES;
    g->guesses = nodes(d->guess_low, d->guess_high, 0.5, asymptotes, g->guess, g->w_guess);
    g->lapses = nodes(d->lapse_low, d->lapse_high, 0.5, asymptotes, g->lapse, g->w_lapse);
    g->etas = nodes(0, 1, 1, look ? LOOK_NODES : ETA_NODES, g->eta, g->w_eta);
}

static struct stat_bayes finish(const struct stat_problem *p, struct grid *g)
{
    struct stat_bayes b;
    const struct stat_fit_desc *d = &p->desc;
    double conf = d->conf;
    b.threshold = stat_grid_marginal(g->at, g->at_low, g->at_high, g->points, conf, p->logarithmic);
    b.width = stat_grid_marginal(g->width, g->width_low, g->width_high, g->points, conf, false);
    b.guess = stat_node_marginal(g->m_guess, g->w_guess, g->guess, g->guesses, 0.5, conf);
    b.lapse = stat_node_marginal(g->m_lapse, g->w_lapse, g->lapse, g->lapses, 0.5, conf);
    b.eta = stat_node_marginal(g->m_eta, g->w_eta, g->eta, g->etas, 1, conf);
    b.prior_bound = b.threshold.credible.low < stat_problem_level(p, p->u[0]) ||
                    b.threshold.credible.high > stat_problem_level(p, p->u[p->count - 1]);
    return b;
}

static void compute(struct stat_problem *p, struct grid *g)
{
    // Near enough to the likelihood's maximum that no weight leaves the doubles.
    double top = stat_problem_maximum(p, LOOK_NODES * 4, NULL).log_likelihood;
    g->at_low = p->u[0] - p->range / 2;
    g->at_high = p->u[p->count - 1] + p->range / 2;
    g->width_low = p->gap;
    g->width_high = 3 * p->range;
    set_nodes(&p->desc, g, true);
    g->points = LOOK_POINTS;
    for (int i = 0; i < 2; i++) {
        sum_grid(p, g, top);
        narrow(g->at, g->points, &g->at_low, &g->at_high);
        narrow(g->width, g->points, &g->width_low, &g->width_high);
    }
    set_nodes(&p->desc, g, false);
    g->points = POINTS;
    sum_grid(p, g, top);
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
    struct grid g = {.at = malloc(POINTS * sizeof(double)),
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
