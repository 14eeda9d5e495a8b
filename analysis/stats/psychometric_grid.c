// A sum over the posterior is nearly all the work of psychometric_bayes.c. Most of it would go to asymptotes
// that the answers rule out at a threshold and width, so that every fourth of these is summed first, then every
// second, then all: a pair of asymptotes is evaluated only where it held something at a neighbour.
#include "analysis/stats/psychometric_grid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LANES = 16, COARSEST = 4, CLASSES = 1 << STAT_GRID_AXES };

static const double pi = 3.14159265358979323846, ln_2 = 0.69314718055994530942;

// A pair whose neighbours all hold less than this of the heaviest pair so far is left out. Neighbours are up to
// two posterior standard deviations away while every second point is summed; in a bell it then holds at most
// 1e-6 of the heaviest, and all that is left out together some 1e-4 of the mass.
static const double negligible = 1e-7;

double stat_axis_at(const struct stat_axis *a, size_t i)
{
    return a->points < 2 ? a->low : a->low + (a->high - a->low) * (double)i / (double)(a->points - 1);
}

void stat_grid_axes(const struct stat_problem *p, struct stat_axis axes[STAT_GRID_AXES])
{
    const struct stat_fit_desc *d = &p->desc;
    bool guess = d->guess_low < d->guess_high, lapse = d->lapse_low < d->lapse_high;
    axes[STAT_GRID_AT] =
        (struct stat_axis){.low = p->u[0] - p->range / 2, .high = p->u[p->count - 1] + p->range / 2};
    axes[STAT_GRID_WIDTH] = (struct stat_axis){.low = log(p->gap), .high = log(3 * p->range)};
    axes[STAT_GRID_GUESS] = guess ? (struct stat_axis){.high = 1, .end = 0.5}
                                  : (struct stat_axis){.points = 1, .fixed = d->guess_low};
    axes[STAT_GRID_LAPSE] = lapse ? (struct stat_axis){.high = 1, .end = 0.5}
                                  : (struct stat_axis){.points = 1, .fixed = d->lapse_low};
    axes[STAT_GRID_ETA] = (struct stat_axis){.high = 1, .end = 1};
}

// --- priors, as densities over the coordinates ---

static double prior_at(const struct stat_problem *p, double u)
{
    double beyond = fmax(p->u[0] - u, u - p->u[p->count - 1]) / p->range;
    return beyond <= 0 ? 1 : beyond >= 0.5 ? 0 : 0.5 + 0.5 * cos(2 * pi * beyond);
}

static double prior_width(const struct stat_problem *p, double width)
{
    double rise = width / p->gap - 1, fall = (width / p->range - 1) / 2;
    return width *
           (rise <= 0   ? 0
            : rise >= 1 ? 1
                        : 0.5 - 0.5 * cos(pi * rise)) *
           (fall <= 0   ? 1
            : fall >= 1 ? 0
                        : 0.5 + 0.5 * cos(pi * fall));
}

static double value_at(const struct stat_axis *a, double root)
{
    return a->end > 0 ? a->end * root * root * root : a->fixed;
}

// Beta(1, 10) of the value, 3 root^2 for the cube.
static double prior_root(const struct stat_axis *a, double root)
{
    return a->end > 0 ? root * root * pow(1 - value_at(a, root), 9) : 1;
}

double stat_grid_prior(const struct stat_problem *p, const struct stat_axis axes[STAT_GRID_AXES], int which,
                       double coordinate)
{
    return which == STAT_GRID_AT      ? prior_at(p, coordinate)
           : which == STAT_GRID_WIDTH ? prior_width(p, exp(coordinate))
                                      : prior_root(&axes[which], coordinate);
}

// --- likelihood ---

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
// answers, divided through by nu so that eta = 0 would be the binomial; 2^twos times `product`. Several etas
// side by side, which the processor multiplies at a time: that is nearly all the work there is.
static inline void products(const struct stat_problem *p, double guess, double lapse, const double *inverse_nu,
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
        double yes = guess * p->upper[i] + (1 - lapse) * p->lower[i],
               no = lapse * p->lower[i] + (1 - guess) * p->upper[i],
               first = (right ? yes : 1) * (wrong ? no : 1);
        for (size_t k = 0; k < count; k++)
            product[k] *= first;
        for (int j = 1; j < right + wrong; j++) {
            double base = j < right ? yes : no, steps = j < right ? j : j - right;
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

// The compiler knows the count of each copy.
static void beta_binomials(const struct stat_problem *p, double guess, double lapse, const double *inverse_nu,
                           double *product, int *twos, size_t count)
{
    switch (count) {
    case 4:
        products(p, guess, lapse, inverse_nu, product, twos, 4);
        break;
    case 8:
        products(p, guess, lapse, inverse_nu, product, twos, 8);
        break;
    case 12:
        products(p, guess, lapse, inverse_nu, product, twos, 12);
        break;
    default:
        products(p, guess, lapse, inverse_nu, product, twos, LANES);
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

static double inverse_nu_of(double eta)
{
    return eta * eta / (1 - eta * eta);
}

static void set_tails(struct stat_problem *p, double at, double width)
{
    double span = stat_family_quantile(p->desc.family, 0.95) - stat_family_quantile(p->desc.family, 0.05);
    double slope = (p->desc.falling ? -span : span) / width;
    for (size_t i = 0; i < p->count; i++) {
        struct stat_tails t = stat_family_tails(p->desc.family, slope * (p->u[i] - at));
        p->lower[i] = t.lower;
        p->upper[i] = t.upper;
    }
}

double stat_grid_ln_density(struct stat_problem *p, const struct stat_axis axes[STAT_GRID_AXES],
                            const double point[STAT_GRID_AXES])
{
    double prior = prior_at(p, point[STAT_GRID_AT]) * prior_width(p, exp(point[STAT_GRID_WIDTH]));
    for (int i = STAT_GRID_GUESS; i <= STAT_GRID_ETA; i++)
        prior *= axes[i].end > 0 && !(point[i] > 0 && point[i] < 1) ? 0 : prior_root(&axes[i], point[i]);
    if (!(prior > 0))
        return -(double)INFINITY;
    double inverse_nu[4], product[4];
    int twos[4];
    for (int i = 0; i < 4; i++)
        inverse_nu[i] = inverse_nu_of(value_at(&axes[STAT_GRID_ETA], point[STAT_GRID_ETA]));
    set_tails(p, point[STAT_GRID_AT], exp(point[STAT_GRID_WIDTH]));
    beta_binomials(p, value_at(&axes[STAT_GRID_GUESS], point[STAT_GRID_GUESS]),
                   value_at(&axes[STAT_GRID_LAPSE], point[STAT_GRID_LAPSE]), inverse_nu, product, twos, 4);
    return log(prior) + log(product[0]) + twos[0] * ln_2 - log_divisor(p, inverse_nu[0]);
}

// --- the sum ---

struct sums {
    struct stat_problem *problem;
    struct stat_grid *grid;
    size_t pairs;
    double inverse_nu[STAT_GRID_MOST];
    double part[STAT_GRID_MOST]; // of a weight, what depends on eta alone, times 2^part_twos
    int part_twos[STAT_GRID_MOST];
    double *mass;            // owned; by width, threshold, guess, lapse
    double heaviest;         // of those
    double classes[CLASSES]; // mass by which of a point's five places are odd
};

// Adds one pair of asymptotes at a threshold and width.
static void add_pair(struct sums *s, size_t a, size_t b, size_t i, size_t j, double prior)
{
    struct stat_grid *g = s->grid;
    const struct stat_axis *axes = g->axis;
    double guess = stat_axis_at(&axes[STAT_GRID_GUESS], i), lapse = stat_axis_at(&axes[STAT_GRID_LAPSE], j);
    size_t etas = axes[STAT_GRID_ETA].points, odd = (a & 1) | (b & 1) << 1 | (i & 1) << 2 | (j & 1) << 3;
    double sum[2] = {0};
    prior *= prior_root(&axes[STAT_GRID_GUESS], guess) * prior_root(&axes[STAT_GRID_LAPSE], lapse);
    for (size_t from = 0; prior > 0 && from < etas; from += LANES) {
        double product[LANES];
        int twos[LANES];
        size_t count = etas - from < LANES ? etas - from : LANES;
        beta_binomials(s->problem, value_at(&axes[STAT_GRID_GUESS], guess),
                       value_at(&axes[STAT_GRID_LAPSE], lapse), s->inverse_nu + from, product, twos, count);
        for (size_t k = 0; k < count; k++) {
            size_t node = from + k;
            double weight = ldexp(prior * product[k] * s->part[node], twos[k] + s->part_twos[node]);
            g->marginal[STAT_GRID_ETA][node] += weight;
            sum[node & 1] += weight;
        }
    }
    double both = sum[0] + sum[1];
    s->mass[(b * axes[STAT_GRID_AT].points + a) * s->pairs + i * axes[STAT_GRID_LAPSE].points + j] = both;
    s->heaviest = fmax(s->heaviest, both);
    s->classes[odd] += sum[0];
    s->classes[odd | 1 << STAT_GRID_ETA] += sum[1];
    g->marginal[STAT_GRID_AT][a] += both;
    g->marginal[STAT_GRID_WIDTH][b] += both;
    g->marginal[STAT_GRID_GUESS][i] += both;
    g->marginal[STAT_GRID_LAPSE][j] += both;
}

// Whether a pair held something at the nearest points that are `twice` apart.
static bool held(const struct sums *s, size_t a, size_t b, size_t pair, size_t twice)
{
    size_t across = s->grid->axis[STAT_GRID_AT].points;
    for (size_t y = b - b % twice; y <= b + (b % twice ? twice / 2 : 0); y += twice)
        for (size_t x = a - a % twice; x <= a + (a % twice ? twice / 2 : 0); x += twice)
            if (s->mass[(y * across + x) * s->pairs + pair] > negligible * s->heaviest)
                return true;
    return false;
}

// A threshold and width: all pairs on the coarsest points, else those that are likely to hold something.
static void add_point(struct sums *s, size_t a, size_t b, size_t stride)
{
    const struct stat_axis *axes = s->grid->axis;
    double at = stat_axis_at(&axes[STAT_GRID_AT], a), width = exp(stat_axis_at(&axes[STAT_GRID_WIDTH], b));
    double prior = prior_at(s->problem, at) * prior_width(s->problem, width);
    if (!(prior > 0))
        return;
    set_tails(s->problem, at, width);
    for (size_t i = 0; i < axes[STAT_GRID_GUESS].points; i++)
        for (size_t j = 0; j < axes[STAT_GRID_LAPSE].points; j++)
            if (stride == COARSEST || held(s, a, b, i * axes[STAT_GRID_LAPSE].points + j, 2 * stride))
                add_pair(s, a, b, i, j, prior);
}

// Poisson's summation formula: a sum over even points is the integral plus the density's Fourier transform at
// the points of the lattice that is dual to theirs; a sum over points with alternating signs is the transform
// half way to one of these, where that of a bell is the fourth root, and that of an exponential's cut-off tail
// the square root, of what it is there. All 31 alternations are combinations of the classes' masses.
static void set_rough(const struct sums *s)
{
    struct stat_grid *g = s->grid;
    double total = 0;
    for (int i = 0; i < CLASSES; i++)
        total += s->classes[i];
    for (int along = 1; along < CLASSES; along++) {
        double sum = 0;
        bool fixed = false;
        for (int axis = 0; axis < STAT_GRID_AXES; axis++)
            fixed = fixed || ((along >> axis & 1) && g->axis[axis].points == 1);
        for (int i = 0; i < CLASSES; i++) {
            bool minus = false;
            for (int both = along & i; both; both &= both - 1)
                minus = !minus;
            sum += minus ? -s->classes[i] : s->classes[i];
        }
        double share = fixed ? 0 : total > 0 ? fabs(sum) / total : 1;
        g->rough = fmax(g->rough, share);
        for (int axis = 0; axis < STAT_GRID_AXES; axis++)
            g->rough_along[axis] |= share > stat_grid_enough && (along >> axis & 1);
    }
}

bool stat_grid_sum(struct stat_problem *p, struct stat_grid *g, double top)
{
    size_t across = g->axis[STAT_GRID_AT].points, down = g->axis[STAT_GRID_WIDTH].points;
    struct sums s = {
        .problem = p, .grid = g, .pairs = g->axis[STAT_GRID_GUESS].points * g->axis[STAT_GRID_LAPSE].points};
    s.mass = calloc(across * down * s.pairs, sizeof *s.mass);
    if (!s.mass)
        return false;
    const struct stat_axis *eta = &g->axis[STAT_GRID_ETA];
    for (size_t k = 0; k < eta->points; k++) {
        double root = stat_axis_at(eta, k), at_1 = root < 1 ? root : 0; // its prior is 0 there
        s.inverse_nu[k] = inverse_nu_of(value_at(eta, at_1));
        double twos = (-log_divisor(p, s.inverse_nu[k]) - top) / ln_2;
        s.part_twos[k] = (int)floor(twos);
        s.part[k] = prior_root(eta, root) * exp2(twos - floor(twos));
    }
    memset(g->marginal, 0, sizeof g->marginal);
    memset(g->rough_along, 0, sizeof g->rough_along);
    g->rough = 0;
    for (size_t stride = COARSEST; stride > 0; stride /= 2)
        for (size_t b = 0; b < down; b += stride)
            for (size_t a = 0; a < across; a += stride)
                if (stride == COARSEST || a % (2 * stride) || b % (2 * stride))
                    add_point(&s, a, b, stride);
    set_rough(&s);
    free(s.mass);
    return true;
}
