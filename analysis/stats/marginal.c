#include "analysis/stats/marginal.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

enum {
    FINE = 2000, // points of a smooth density between nodes
    PARTS = 10   // of a cell of a grid
};

void stat_gauss_legendre(size_t count, double x[], double w[])
{
    double n = (double)count;
    for (size_t i = 0; i < count; i++) {
        double z = cos(3.14159265358979323846 * ((double)i + 0.75) / (n + 0.5)), slope = 1;
        for (int round = 0; round < 100; round++) {
            double p = 1, before = 0;
            for (size_t j = 1; j <= count; j++) {
                double m = (double)j, next = ((2 * m - 1) * z * p - (m - 1) * before) / m;
                before = p;
                p = next;
            }
            slope = n * (z * p - before) / (z * z - 1);
            double step = p / slope;
            z -= step;
            if (fabs(step) < 1e-15)
                break;
        }
        x[i] = (1 - z) / 2;
        w[i] = 1 / ((1 - z * z) * slope * slope);
    }
}

double stat_grid_at(double low, double high, size_t points, size_t i)
{
    return points < 2 ? low : low + (high - low) * (double)i / (double)(points - 1);
}

// The density between its points, by the cubic through the four nearest: straight lines would give the tails
// too much, as a density is hollow there.
static double refined(const double *density, size_t points, size_t i, double along)
{
    if (points < 4)
        return density[i] + (along > 0 ? along * (density[i + 1] - density[i]) : 0);
    size_t first = i == 0 ? 0 : i + 3 > points ? points - 4 : i - 1;
    double t = (double)(i - first) + along;
    const double *y = density + first;
    double value = -y[0] * (t - 1) * (t - 2) * (t - 3) / 6 + y[1] * t * (t - 2) * (t - 3) / 2 -
                   y[2] * t * (t - 1) * (t - 3) / 2 + y[3] * t * (t - 1) * (t - 2) / 6;
    return fmax(0, value);
}

// Where the mass of the density's straight lines reaches `share` of `total`.
static double quantile(const double *density, double low, double high, size_t points, double total,
                       double share)
{
    double h = (high - low) / (double)(points - 1), left = share * total;
    for (size_t i = 0; i + 1 < points; i++) {
        double a = density[i], b = density[i + 1], mass = h * (a + b) / 2;
        if (left > mass) {
            left -= mass;
            continue;
        }
        // a t + (b - a) t^2 / 2 = left / h, in the form that holds for equal ends too
        double root = sqrt(fmax(0, a * a + 2 * (b - a) * left / h));
        return stat_grid_at(low, high, points, i) + (a + root > 0 ? h * (2 * left / h) / (a + root) : 0);
    }
    return high;
}

static void set_quantiles(struct stat_marginal *m, const double *density, double low, double high,
                          size_t points, double conf)
{
    double h = (high - low) / (double)(points - 1), total = 0;
    for (size_t i = 1; i < points; i++)
        total += h * (density[i - 1] + density[i]) / 2;
    m->median = quantile(density, low, high, points, total, 0.5);
    m->credible.low = quantile(density, low, high, points, total, (1 - conf) / 2);
    m->credible.high = quantile(density, low, high, points, total, (1 + conf) / 2);
}

struct stat_marginal stat_grid_marginal(const double *density, double low, double high, size_t points,
                                        double conf, bool exponential)
{
    const double none = (double)NAN;
    struct stat_marginal m = {none, none, none, {none, none}};
    double mass = 0, mean = 0, square = 0;
    if (points < 2)
        return m;
    for (size_t i = 0; i < points; i++) {
        double x = stat_grid_at(low, high, points, i);
        mass += density[i];
        mean += density[i] * (exponential ? exp(x) : x);
    }
    size_t fine = (points - 1) * PARTS + 1;
    double *between = malloc(fine * sizeof *between);
    if (!(mass > 0) || !isfinite(mass) || !between) {
        free(between);
        return m;
    }
    m.mean = mean / mass;
    for (size_t i = 0; i < points; i++) {
        double x = stat_grid_at(low, high, points, i), off = (exponential ? exp(x) : x) - m.mean;
        square += density[i] * off * off;
    }
    m.sd = sqrt(square / mass);
    for (size_t i = 0; i < fine; i++)
        between[i] = refined(density, points, i / PARTS, (double)(i % PARTS) / PARTS);
    set_quantiles(&m, between, low, high, fine, conf);
    free(between);
    if (exponential) {
        m.median = exp(m.median);
        m.credible = (struct stat_interval){exp(m.credible.low), exp(m.credible.high)};
    }
    return m;
}

// Lagrange's cubic through the four nodes around `at`. Where values fall so steeply that it swings away from
// the straight line between its neighbours by more than 2, the nodes lie four standard deviations apart or more
// and the line is all that is known: a swing would put mass where there is none.
static double between(const double *x, const double *y, size_t count, double at)
{
    size_t first = 0, right = 1, points = count < 4 ? count : 4;
    while (first + points < count && x[first + points / 2] < at)
        first++;
    while (right + 1 < count && x[right] < at)
        right++;
    double sum = 0;
    for (size_t i = first; i < first + points; i++) {
        double part = y[i];
        for (size_t j = first; j < first + points; j++)
            part *= j == i ? 1 : (at - x[j]) / (x[i] - x[j]);
        sum += part;
    }
    double line = y[right - 1] + (y[right] - y[right - 1]) * (at - x[right - 1]) / (x[right] - x[right - 1]);
    return fabs(sum - line) <= 2 ? sum : line;
}

struct stat_marginal stat_node_marginal(const double *mass, const double *prior, const double *x, size_t count,
                                        double end, double conf)
{
    if (count == 1)
        return (struct stat_marginal){x[0], 0, x[0], {x[0], x[0]}};
    double y[64], density[FINE + 1], total = 0, mean = 0, square = 0, top = -(double)INFINITY;
    for (size_t i = 0; i < count; i++) {
        y[i] = log(fmax(mass[i], DBL_MIN) / prior[i]);
        top = fmax(top, y[i]);
        total += mass[i];
        mean += mass[i] * x[i];
    }
    for (size_t i = 0; i <= FINE; i++) {
        double at = end * (double)i / FINE;
        density[i] = exp(between(x, y, count, at) - top) * pow(1 - at, 9);
    }
    struct stat_marginal m = stat_grid_marginal(density, 0, end, FINE + 1, conf, false);
    m.mean = mean / total;
    for (size_t i = 0; i < count; i++)
        square += mass[i] * (x[i] - m.mean) * (x[i] - m.mean);
    m.sd = sqrt(square / total);
    return m;
}
