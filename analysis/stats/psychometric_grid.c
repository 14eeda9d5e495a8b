// A sum over the posterior is nearly all the work of psychometric_bayes.c. Most of it would go to asymptotes
// and overdispersions that the answers rule out, so that these are found first on a sixteenth of the thresholds
// and widths.
#include "analysis/stats/psychometric_grid.h"

#include "analysis/stats/marginal.h"

#include <math.h>
#include <string.h>

enum { PAIRS = STAT_GRID_NODES * STAT_GRID_NODES, STRIDE = 4 };

static const double pi = 3.14159265358979323846, ln_2 = 0.69314718055994530942;

// The share of the mass that pairs of asymptotes may hold together to be left out, and the same of either end
// of eta. Every fourth point both ways is 1.1 posterior standard deviations from the next where
// psychometric_bayes.c lays its 37 points over 10 of them, at which distance sums over a smooth density are
// good to 1e-6 of themselves (Poisson's summation: 2 e^(-2 pi^2 / 1.1^2)).
static const double pair_share = 1e-5, eta_share = 1e-6;

struct sums {
    const struct stat_problem *problem;
    struct stat_grid *grid;
    double inverse_nu[STAT_GRID_ETA_NODES];
    double part[STAT_GRID_ETA_NODES]; // of a weight, what depends on eta alone, times 2^part_twos
    int part_twos[STAT_GRID_ETA_NODES];
    bool left_out[PAIRS];                               // guess * lapses + lapse
    size_t eta_from, eta_to;                            // nodes that are evaluated: 4, 8, 12 or 16 of them
    double mass, pair[PAIRS], eta[STAT_GRID_ETA_NODES]; // so far
};

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

// Moves products by powers of two, which is exact, before they leave the doubles. Four more factors, each
// below 20000 x 100 (answers times 1 / nu) and above 1e-17 (1 - P where P is not 1), cannot.
static inline void keep_in_range(double *product, int *twos, size_t count)
{
    double low = product[0], high = product[0];
    for (size_t k = 1; k < count; k++) {
        low = product[k] < low ? product[k] : low;
        high = product[k] > high ? product[k] : high;
    }
    if (low >= 1e-150 && high <= 1e150)
        return;
    for (size_t k = 0; k < count; k++) {
        int by = 0;
        product[k] = frexp(product[k], &by);
        twos[k] += by;
    }
}

// The beta-binomial without its coefficient, over all levels: a product of (nu P + j) and the like over the
// answers, divided through by nu so that eta = 0 would be the binomial; 2^twos times `product`. All nodes of
// eta side by side, which the processor multiplies several at a time: that is nearly all the work there is.
static inline void products(const struct stat_problem *p, const double *yes, const double *inverse_nu,
                            double *product, int *twos, size_t count)
{
    int since = 0;
    for (size_t k = 0; k < count; k++) {
        product[k] = 1;
        twos[k] = 0;
    }
    for (size_t i = 0; i < p->count; i++) {
        // The first answer of either kind does not depend on nu.
        int right = (int)p->k[i], wrong = (int)p->n[i] - right;
        double no = 1 - yes[i], first = (right ? yes[i] : 1) * (wrong ? no : 1);
        for (size_t k = 0; k < count; k++)
            product[k] *= first;
        for (int j = 1; j < right + wrong; j++) {
            double base = j < right ? yes[i] : no, steps = j < right ? j : j - right;
            if (j == right)
                continue;
            for (size_t k = 0; k < count; k++)
                product[k] *= base + steps * inverse_nu[k];
            if (++since % 4 == 0)
                keep_in_range(product, twos, count);
        }
        if (++since % 4 == 0)
            keep_in_range(product, twos, count);
    }
}

static double log_divisor(const struct stat_problem *p, double inverse_nu)
{
    double sum = 0;
    for (size_t i = 0; i < p->count; i++)
        for (int j = 0; j < (int)p->n[i]; j++)
            sum += log1p(j * inverse_nu);
    return sum;
}

// The compiler knows the count of each copy.
static void beta_binomials(const struct sums *s, double *product, int *twos)
{
    const double *inverse_nu = s->inverse_nu + s->eta_from, *yes = s->grid->yes;
    switch (s->eta_to - s->eta_from) {
    case 4:
        products(s->problem, yes, inverse_nu, product, twos, 4);
        break;
    case 8:
        products(s->problem, yes, inverse_nu, product, twos, 8);
        break;
    case 12:
        products(s->problem, yes, inverse_nu, product, twos, 12);
        break;
    default:
        products(s->problem, yes, inverse_nu, product, twos, 16);
    }
}

// Adds one threshold and width: sums over the nodes. Weights are relative to exp(top).
static void add_point(struct sums *s, size_t a, size_t b, double prior)
{
    const struct stat_problem *p = s->problem;
    struct stat_grid *g = s->grid;
    for (size_t i = 0; i < g->guesses; i++)
        for (size_t j = 0; j < g->lapses; j++) {
            size_t pair = i * g->lapses + j;
            double product[STAT_GRID_ETA_NODES], sum = 0, nodes = prior * g->w_guess[i] * g->w_lapse[j];
            int twos[STAT_GRID_ETA_NODES];
            if (s->left_out[pair])
                continue;
            for (size_t l = 0; l < p->count; l++)
                g->yes[l] = g->guess[i] * p->upper[l] + (1 - g->lapse[j]) * p->lower[l];
            beta_binomials(s, product, twos);
            for (size_t k = 0; k < s->eta_to - s->eta_from; k++) {
                size_t node = s->eta_from + k;
                double weight = ldexp(nodes * product[k] * s->part[node], twos[k] + s->part_twos[node]);
                s->eta[node] += weight;
                sum += weight;
            }
            g->at[a] += sum;
            g->width[b] += sum;
            s->pair[pair] += sum;
            s->mass += sum;
        }
}

static bool every_fourth(size_t a, size_t b)
{
    return a % STRIDE == 0 && b % STRIDE == 0;
}

// Over every fourth point both ways, or over all others.
static void add_points(struct stat_problem *p, struct sums *s, bool fourth)
{
    struct stat_grid *g = s->grid;
    double span = stat_family_quantile(p->desc.family, 0.95) - stat_family_quantile(p->desc.family, 0.05);
    for (size_t b = 0; b < g->points; b++) {
        double width = exp(stat_grid_at(g->width_low, g->width_high, g->points, b));
        double slope = (p->desc.falling ? -span : span) / width;
        for (size_t a = 0; a < g->points; a++) {
            double at = stat_grid_at(g->at_low, g->at_high, g->points, a);
            double prior = every_fourth(a, b) == fourth ? prior_at(p, at) * prior_width(p, width) * width : 0;
            if (!(prior > 0))
                continue;
            for (size_t i = 0; i < p->count; i++) {
                struct stat_tails t = stat_family_tails(p->desc.family, slope * (p->u[i] - at));
                p->lower[i] = t.lower;
                p->upper[i] = t.upper;
            }
            add_point(s, a, b, prior);
        }
    }
}

// The pairs that hold least.
static void leave_pairs_out(struct sums *s)
{
    size_t pairs = s->grid->guesses * s->grid->lapses;
    for (double left = 0;;) {
        size_t least = pairs;
        for (size_t i = 0; i < pairs; i++)
            if (!s->left_out[i] && (least == pairs || s->pair[i] < s->pair[least]))
                least = i;
        if (least == pairs || (left += s->pair[least]) > pair_share * s->mass)
            return;
        s->left_out[least] = true;
    }
}

// The ends of eta, so that 4, 8, 12 or 16 nodes stay.
static void leave_ends_out(struct sums *s)
{
    const struct stat_grid *g = s->grid;
    double low = 0, high = 0;
    size_t from = 0, to = g->etas;
    while (from < to && (low += s->eta[from]) < eta_share * s->mass)
        from++;
    while (to > from && (high += s->eta[to - 1]) < eta_share * s->mass)
        to--;
    to = from + (to - from + 3) / 4 * 4;
    s->eta_from = to > g->etas ? from - (to - g->etas) : from;
    s->eta_to = to > g->etas ? g->etas : to;
}

// `first` is what every fourth point held. What was not evaluated elsewhere is there in the same proportion, so
// that no node has a hole in its marginal.
static void set_nodes_marginals(const struct sums *s, const struct sums *first)
{
    struct stat_grid *g = s->grid;
    double others = first->mass > 0 ? (s->mass - first->mass) / first->mass : 0;
    for (size_t i = 0; i < g->guesses; i++)
        for (size_t j = 0; j < g->lapses; j++) {
            size_t pair = i * g->lapses + j;
            double mass = s->pair[pair] + (s->left_out[pair] ? others * first->pair[pair] : 0);
            g->m_guess[i] += mass;
            g->m_lapse[j] += mass;
        }
    for (size_t k = 0; k < g->etas; k++) {
        bool out = k < s->eta_from || k >= s->eta_to;
        g->m_eta[k] = s->eta[k] + (out ? others * first->eta[k] : 0);
    }
}

void stat_grid_sum(struct stat_problem *p, struct stat_grid *g, double top, bool sparse)
{
    struct sums s = {.problem = p, .grid = g, .eta_to = g->etas};
    for (size_t k = 0; k < g->etas; k++) {
        s.inverse_nu[k] = g->eta[k] * g->eta[k] / (1 - g->eta[k] * g->eta[k]);
        double twos = (-log_divisor(p, s.inverse_nu[k]) - top) / ln_2;
        s.part_twos[k] = (int)floor(twos);
        s.part[k] = g->w_eta[k] * exp2(twos - floor(twos));
    }
    memset(g->at, 0, g->points * sizeof *g->at);
    memset(g->width, 0, g->points * sizeof *g->width);
    memset(g->m_guess, 0, sizeof g->m_guess);
    memset(g->m_lapse, 0, sizeof g->m_lapse);
    add_points(p, &s, true);
    struct sums first = s;
    if (sparse && s.mass > 0) {
        leave_pairs_out(&s);
        leave_ends_out(&s);
    }
    add_points(p, &s, false);
    set_nodes_marginals(&s, &first);
}
