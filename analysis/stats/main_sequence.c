#include "analysis/stats/main_sequence.h"

#include <Rmath.h>
#include <math.h>
#include <stdbool.h>

// For a given c the best vmax is a ratio of sums, so the search is over ln c alone: a grid, since the sum of
// squares may have several minima, then golden sections. c is looked for from a hundredth of the smallest to
// three times the largest amplitude: a saccade of a third of c has reached 28 % of vmax, and what a curve that
// straight ends at is guesswork.
enum { GRID = 64, SECTIONS = 48 };
#define ABOVE_LARGEST 3.0
#define BELOW_SMALLEST 0.01

struct data {
    const double *a, *v;
    size_t n, used;
    double smallest, largest;
};

static bool usable(const struct data *d, size_t i)
{
    return d->a[i] > 0 && d->v[i] > 0 && isfinite(d->a[i]) && isfinite(d->v[i]);
}

static double best_vmax(const struct data *d, double c, double *out_squares)
{
    double fv = 0, ff = 0, vv = 0;
    for (size_t i = 0; i < d->n; i++)
        if (usable(d, i)) {
            double f = -expm1(-d->a[i] / c);
            fv += f * d->v[i];
            ff += f * f;
            vv += d->v[i] * d->v[i];
        }
    *out_squares = vv - fv * fv / ff;
    return fv / ff;
}

static double squares_at(const struct data *d, double log_c)
{
    double squares;
    best_vmax(d, exp(log_c), &squares);
    return squares;
}

// ln c of the least squares; NaN where it lies at an end of what is searched.
static double search(const struct data *d)
{
    double low = log(d->smallest * BELOW_SMALLEST), high = log(d->largest * ABOVE_LARGEST);
    double step = (high - low) / GRID, least = INFINITY;
    int best = 0;
    for (int i = 0; i <= GRID; i++) {
        double squares = squares_at(d, low + step * i);
        if (squares < least) {
            least = squares;
            best = i;
        }
    }
    if (best == 0 || best == GRID)
        return NAN;
    const double golden = (sqrt(5) - 1) / 2;
    double from = low + step * (best - 1), to = low + step * (best + 1);
    double x = to - golden * (to - from), y = from + golden * (to - from);
    double at_x = squares_at(d, x), at_y = squares_at(d, y);
    for (int i = 0; i < SECTIONS; i++)
        if (at_x < at_y) {
            to = y;
            y = x;
            at_y = at_x;
            x = to - golden * (to - from);
            at_x = squares_at(d, x);
        } else {
            from = x;
            x = y;
            at_x = at_y;
            y = from + golden * (to - from);
            at_y = squares_at(d, y);
        }
    return (from + to) / 2;
}

static struct stat_estimate estimate(double value, double std_error, double t)
{
    return (struct stat_estimate){value, std_error, value - t * std_error, value + t * std_error};
}

// Golden sections stop at the square root of the arithmetic's precision; Gauss-Newton steps end the search, and
// give the covariance s^2 (J'J)^-1.
static bool exponential(const struct data *d, double log_c, double t, struct stat_main_sequence *out)
{
    double c = exp(log_c), ignored, vmax = best_vmax(d, c, &ignored), determinant = 0, squares = 0;
    double ff = 0, fg = 0, gg = 0;
    for (int step = 0; step < 8; step++) {
        double fr = 0, gr = 0;
        ff = fg = gg = squares = 0;
        for (size_t i = 0; i < d->n; i++)
            if (usable(d, i)) {
                double rest = exp(-d->a[i] / c), f = -expm1(-d->a[i] / c);
                double g = -vmax * rest * d->a[i] / (c * c), r = d->v[i] - vmax * f;
                ff += f * f;
                fg += f * g;
                gg += g * g;
                fr += f * r;
                gr += g * r;
                squares += r * r;
            }
        determinant = ff * gg - fg * fg;
        if (!(determinant > 1e-12 * ff * gg))
            return false;
        if (step < 7) {
            vmax += (gg * fr - fg * gr) / determinant;
            c += (ff * gr - fg * fr) / determinant;
        }
    }
    double variance = squares / (double)(d->used - 2);
    if (!(c > 0) || !isfinite(c) || !isfinite(vmax))
        return false;
    out->residual_sd = sqrt(variance);
    out->vmax = estimate(vmax, sqrt(variance * gg / determinant), t);
    out->c = estimate(c, sqrt(variance * ff / determinant), t);
    return true;
}

static bool power(const struct data *d, double t, struct stat_main_sequence *out)
{
    double n = 0, x_mean = 0, y_mean = 0, xx = 0, xy = 0, yy = 0;
    for (size_t i = 0; i < d->n; i++)
        if (usable(d, i)) {
            double x = log(d->a[i]), y = log(d->v[i]), dx = x - x_mean, dy = y - y_mean;
            n++;
            x_mean += dx / n;
            y_mean += dy / n;
            xx += dx * (x - x_mean);
            xy += dx * (y - y_mean);
            yy += dy * (y - y_mean);
        }
    if (!(xx > 1e-12 * n))
        return false;
    double b = xy / xx, variance = fmax(yy - b * xy, 0) / (n - 2);
    double log_k = y_mean - b * x_mean, error = sqrt(variance * (1 / n + x_mean * x_mean / xx));
    out->b = estimate(b, sqrt(variance / xx), t);
    out->k = (struct stat_estimate){exp(log_k), error, exp(log_k - t * error), exp(log_k + t * error)};
    return true;
}

struct stat_main_sequence stat_main_sequence(const double *amplitude_deg, const double *peak_deg_s, size_t n,
                                             double conf)
{
    const struct stat_estimate none = {NAN, NAN, NAN, NAN};
    struct stat_main_sequence out = {.vmax = none, .c = none, .residual_sd = NAN, .k = none, .b = none};
    struct data d = {amplitude_deg, peak_deg_s, n, 0, INFINITY, 0};
    for (size_t i = 0; i < n; i++)
        if (usable(&d, i)) {
            d.used++;
            d.smallest = fmin(d.smallest, amplitude_deg[i]);
            d.largest = fmax(d.largest, amplitude_deg[i]);
        }
    out.n = d.used;
    out.problem = out.power_problem = "fewer than 10 complete saccades";
    if (d.used < STAT_MAIN_SEQUENCE_LEAST || !(conf > 0 && conf < 1))
        return out;
    double t = qt(0.5 + conf / 2, (double)d.used - 2, true, false);
    out.power_problem = power(&d, t, &out) ? NULL : "all amplitudes are the same";
    out.problem = "peak velocity does not level off within the amplitudes seen";
    double log_c = search(&d);
    if (!isnan(log_c) && exponential(&d, log_c, t, &out))
        out.problem = NULL;
    return out;
}
