#include "analysis/stats/marginal.h"

#include <math.h>

enum { MOST = 64, PARTS = 16 }; // parts of a cell

static double coordinate(const struct stat_even *e, double place)
{
    return e->low + (e->high - e->low) * place / (double)(e->points - 1);
}

static double value_of(const struct stat_even *e, double x)
{
    return e->scale == STAT_SCALE_LN ? exp(x) : e->scale == STAT_SCALE_CUBE_ROOT ? e->end * x * x * x : x;
}

// Lagrange's cubic through the four points from `first`, at `t` from there.
static double cubic(const double *y, double t)
{
    return -y[0] * (t - 1) * (t - 2) * (t - 3) / 6 + y[1] * t * (t - 2) * (t - 3) / 2 -
           y[2] * t * (t - 1) * (t - 3) / 2 + y[3] * t * (t - 1) * (t - 2) / 6;
}

// ln of mass over prior where there is mass.
struct likelihood {
    double ln[MOST];
    size_t from, to; // points with mass, none between them without
};

// Beyond the points with mass, in a cell in which the prior falls to 0, the likelihood goes on as before.
static double density_at(const struct stat_even *e, const struct likelihood *l, double place)
{
    size_t first = (size_t)place > l->from ? (size_t)place - 1 : l->from;
    if (place < (double)l->from - 1 || place > (double)l->to)
        return 0;
    first = first + 4 > l->to ? l->to - 4 : first;
    return exp(cubic(l->ln + first, place - (double)first)) * e->prior(e->user, coordinate(e, place));
}

static void set_quantiles(struct stat_marginal *m, const struct stat_even *e, const double *density,
                          size_t count, double conf)
{
    const double shares[3] = {0.5, (1 - conf) / 2, (1 + conf) / 2};
    double *out[3] = {&m->median, &m->credible.low, &m->credible.high}, total = 0;
    for (size_t i = 0; i + 1 < count; i++)
        total += (density[i] + density[i + 1]) / 2;
    for (int k = 0; k < 3; k++) {
        double left = shares[k] * total, along = 0;
        size_t i = 0;
        while (i + 2 < count && left > (density[i] + density[i + 1]) / 2) {
            left -= (density[i] + density[i + 1]) / 2;
            i++;
        }
        // a t + (b - a) t^2 / 2 = left, in the form that holds for equal ends too
        double a = density[i], b = density[i + 1], root = sqrt(fmax(0, a * a + 2 * (b - a) * left));
        along = a + root > 0 ? 2 * left / (a + root) : 0;
        *out[k] = value_of(e, coordinate(e, ((double)i + fmin(along, 1)) / PARTS));
    }
}

struct stat_marginal stat_even_marginal(const struct stat_even *e, double conf)
{
    const double none = (double)NAN;
    struct stat_marginal m = {none, none, none, {none, none}};
    struct likelihood l = {.from = e->points};
    double mass = 0, mean = 0, square = 0;
    if (e->points < 4 || e->points > MOST)
        return m;
    for (size_t i = 0; i < e->points; i++) {
        double x = coordinate(e, (double)i);
        mass += e->mass[i];
        mean += e->mass[i] * value_of(e, x);
        if (!(e->mass[i] > 0))
            continue;
        bool end = i == 0 || i + 1 == e->points;
        l.ln[i] = log((end ? 2 : 1) * e->mass[i] / e->prior(e->user, x));
        l.from = l.from == e->points ? i : l.from;
        l.to = i + 1;
    }
    if (!(mass > 0) || !isfinite(mass) || l.to - l.from < 4)
        return m;
    m.mean = mean / mass;
    for (size_t i = 0; i < e->points; i++) {
        double off = value_of(e, coordinate(e, (double)i)) - m.mean;
        square += e->mass[i] * off * off;
        if (i > l.from && i < l.to && !(e->mass[i] > 0))
            return (struct stat_marginal){none, none, none, {none, none}};
    }
    m.sd = sqrt(square / mass);
    double density[(MOST - 1) * PARTS + 1];
    size_t count = (e->points - 1) * PARTS + 1;
    for (size_t i = 0; i < count; i++)
        density[i] = density_at(e, &l, (double)i / PARTS);
    set_quantiles(&m, e, density, count, conf);
    return m;
}
