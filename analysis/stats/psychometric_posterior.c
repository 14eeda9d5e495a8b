// A product over the answers, made for several etas at once, is nearly all the work of psychometric_bayes.c.
#include "analysis/stats/psychometric_posterior.h"

#include <math.h>

static const double pi = 3.14159265358979323846, ln_2 = 0.69314718055994530942;

double stat_axis_at(const struct stat_axis *a, size_t i)
{
    return a->points < 2 ? a->low : a->low + (a->high - a->low) * (double)i / (double)(a->points - 1);
}

void stat_posterior_axes(const struct stat_problem *p, struct stat_axis axes[STAT_GRID_AXES])
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

double stat_axis_value(const struct stat_axis *a, double root)
{
    return a->end > 0 ? a->end * root * root * root : a->fixed;
}

// Beta(1, 10) of the value, 3 root^2 for the cube.
static double prior_root(const struct stat_axis *a, double root)
{
    return a->end > 0 ? root * root * pow(1 - stat_axis_value(a, root), 9) : 1;
}

double stat_posterior_prior(const struct stat_problem *p, const struct stat_axis axes[STAT_GRID_AXES],
                            int which, double coordinate)
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
void stat_posterior_products(const struct stat_problem *p, double guess, double lapse, const double *inverse_nu,
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
        products(p, guess, lapse, inverse_nu, product, twos, STAT_POSTERIOR_LANES);
    }
}

double stat_posterior_ln_divisor(const struct stat_problem *p, double inverse_nu)
{
    double sum = 0;
    for (size_t i = 0; i < p->count; i++)
        for (int j = 0; j < (int)p->n[i]; j++)
            sum += log1p(j * inverse_nu);
    return sum;
}

double stat_posterior_inverse_nu(double eta)
{
    return eta * eta / (1 - eta * eta);
}

void stat_posterior_set_tails(struct stat_problem *p, double at, double width)
{
    double span = stat_family_quantile(p->desc.family, 0.95) - stat_family_quantile(p->desc.family, 0.05);
    double slope = (p->desc.falling ? -span : span) / width;
    for (size_t i = 0; i < p->count; i++) {
        struct stat_tails t = stat_family_tails(p->desc.family, slope * (p->u[i] - at));
        p->lower[i] = t.lower;
        p->upper[i] = t.upper;
    }
}

double stat_posterior_ln_density(struct stat_problem *p, const struct stat_axis axes[STAT_GRID_AXES],
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
        inverse_nu[i] = stat_posterior_inverse_nu(stat_axis_value(&axes[STAT_GRID_ETA], point[STAT_GRID_ETA]));
    stat_posterior_set_tails(p, point[STAT_GRID_AT], exp(point[STAT_GRID_WIDTH]));
    stat_posterior_products(p, stat_axis_value(&axes[STAT_GRID_GUESS], point[STAT_GRID_GUESS]),
                            stat_axis_value(&axes[STAT_GRID_LAPSE], point[STAT_GRID_LAPSE]), inverse_nu,
                            product, twos, 4);
    return log(prior) + log(product[0]) + twos[0] * ln_2 - stat_posterior_ln_divisor(p, inverse_nu[0]);
}
