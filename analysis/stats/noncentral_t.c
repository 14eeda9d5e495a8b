// T = (Z + ncp) / S with a normal Z and S = sqrt(chi squared / df): P(T <= t) is the mean of Phi(t S - ncp)
// over S (Johnson, Kotz & Balakrishnan 1995, "Continuous Univariate Distributions" 2, section 31.4). The
// integrand changes on two scales, that of S and, about S = ncp / t, that of 1 / t; Gauss-Legendre panels
// between break points on both leave nothing sharp within one panel.
#include "analysis/stats/noncentral_t.h"

#include "analysis/stats/panel.h"

#include <Rmath.h>
#include <math.h>
#include <stdbool.h>

enum { PANELS = 12, STEPS = 200 };

struct problem {
    double t, df, ncp;
};

static double integrand(double s, const void *user)
{
    const struct problem *p = user;
    return pnorm(p->t * s - p->ncp, 0, 1, true, false) * 2 * p->df * s * dchisq(p->df * s * s, p->df, false);
}

static double segment(double low, double high, const struct problem *problem)
{
    double sum = 0, step = (high - low) / PANELS;
    for (int panel = 0; panel < PANELS; panel++)
        sum += stat_panel(integrand, problem, low + panel * step, low + (panel + 1) * step);
    return sum;
}

double stat_noncentral_t_lower(double t, double df, double ncp)
{
    if (!isfinite(t) || !isfinite(ncp) || !(df >= 1 && df <= 1e9))
        return (double)NAN;
    const double rest = 1e-18, reach = 9; // of S and of Z; what lies beyond adds less than 1e-17
    double low = sqrt(qchisq(rest, df, true, false) / df), high = sqrt(qchisq(rest, df, false, false) / df);
    double breaks[] = {low, low, low, low, high};
    for (int i = 0; i < 3 && t != 0; i++)
        breaks[i + 1] = fmin(high, fmax(low, ncp / t + (i - 1) * reach / fabs(t)));
    double sum = 0;
    for (int i = 0; i < 4; i++)
        if (breaks[i + 1] > breaks[i])
            sum += segment(breaks[i], breaks[i + 1], &(struct problem){t, df, ncp});
    return fmin(1, sum);
}

// The probability falls as the noncentrality grows: regula falsi after Illinois within a bracket.
double stat_noncentral_t_limit(double t, double df, double p)
{
    if (!isfinite(t) || !(df >= 1 && df <= 1e9) || !(p >= 1e-10 && p <= 0.5))
        return (double)NAN;
    double step = 1 + fabs(t) / sqrt(2 * df), low = t, high = t, at_low, at_high, middle = t;
    while ((at_low = stat_noncentral_t_lower(t, df, low) - p) < 0)
        low -= step *= 2;
    while ((at_high = stat_noncentral_t_lower(t, df, high) - p) > 0)
        high += step *= 2;
    for (int i = 0, side = 0; i < STEPS && high - low > 1e-14 * fmax(fabs(low), fabs(high)); i++) {
        middle = at_low - at_high > 0 ? (low * -at_high + high * at_low) / (at_low - at_high) : low;
        double value = stat_noncentral_t_lower(t, df, middle) - p;
        if (value == 0 || !(middle > low && middle < high))
            return middle;
        if (value > 0) {
            low = middle, at_low = value;
            at_high /= side == 1 ? 2 : 1;
            side = 1;
        } else {
            high = middle, at_high = value;
            at_low /= side == -1 ? 2 : 1;
            side = -1;
        }
    }
    return middle;
}
