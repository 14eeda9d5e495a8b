// T = (Z + ncp) / S with a normal Z and S = sqrt(chi squared / df): P(T <= t) is the mean of Phi(t S - ncp)
// over S (Johnson, Kotz & Balakrishnan 1995, "Continuous Univariate Distributions" 2, section 31.4). The
// integrand changes on two scales, that of S and, about S = ncp / t, that of 1 / t; Gauss-Legendre panels
// between break points on both leave nothing sharp within one panel.
#include "analysis/stats/noncentral_t.h"

#include <Rmath.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>

enum { PANELS = 12, STEPS = 200 };

// 16 points: Abramowitz & Stegun (1964), table 25.4.
static const double node[] = {0.095012509837637440185, 0.281603550779258913230, 0.458016777657227386342,
                              0.617876244402643748447, 0.755404408355003033895, 0.865631202387831743880,
                              0.944575023073232576078, 0.989400934991649932596};
static const double weight[] = {0.189450610455068496285, 0.182603415044923588867, 0.169156519395002538189,
                                0.149595988816576732081, 0.124628971255533872052, 0.095158511682492784810,
                                0.062253523938647892863, 0.027152459411754094852};

static double integrand(double s, double t, double df, double ncp)
{
    return pnorm(t * s - ncp, 0, 1, true, false) * 2 * df * s * dchisq(df * s * s, df, false);
}

static double segment(double low, double high, double t, double df, double ncp)
{
    double sum = 0, half = (high - low) / (2 * PANELS);
    for (int panel = 0; panel < PANELS; panel++) {
        double centre = low + (2 * panel + 1) * half;
        for (size_t i = 0; i < sizeof node / sizeof node[0]; i++)
            sum += weight[i] * half *
                   (integrand(centre - half * node[i], t, df, ncp) +
                    integrand(centre + half * node[i], t, df, ncp));
    }
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
            sum += segment(breaks[i], breaks[i + 1], t, df, ncp);
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
