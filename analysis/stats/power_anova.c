// The noncentral F is a Poisson mixture of beta distributions: Johnson, Kotz & Balakrishnan (1995), "Continuous
// Univariate Distributions" 2, section 30.2. Summed outwards from the mixture's mode, where the weights are
// largest, so that none underflows first; all terms are positive. Noncentrality people * cells * f^2: Cohen, J.
// (1988), Statistical power analysis, 2nd ed., section 8.2, with the effect's own error (effect by people) as
// the residual.
#include "analysis/stats/power_anova.h"

#include "analysis/stats/power.h"

#include <Rmath.h>
#include <math.h>
#include <stdbool.h>

static const double most_ncp = 1e6;
static const double negligible = 1e-20; // of a weight; some 20 SD of the mixture, 2e4 terms at most, lie within

double stat_noncentral_f_upper(double f, double df, double df_error, double ncp)
{
    if (!(f >= 0 && isfinite(f)) || !(df >= 1 && df <= 1e9) || !(df_error >= 1 && df_error <= 1e9) ||
        !(ncp >= 0 && ncp <= most_ncp))
        return (double)NAN;
    double x = df * f / (df * f + df_error), mode = floor(ncp / 2), sum = 0;
    for (int down = 0; down < 2; down++)
        for (double j = down ? mode - 1 : mode; j >= 0; j += down ? -1 : 1) {
            double weight = dpois(j, ncp / 2, false);
            if (weight < negligible)
                break;
            sum += weight * pbeta(x, df / 2 + j, df_error / 2, false, false);
        }
    return fmin(1, sum);
}

double stat_anova_within_power(int64_t people, int64_t cells, int64_t df, double f, double alpha)
{
    if (people < 2 || people > STAT_POWER_MAX_N || df < 1 || df >= cells || !(f >= 0) ||
        !(alpha > 0 && alpha < 1))
        return (double)NAN;
    double effect = (double)df, error = effect * (double)(people - 1);
    return stat_noncentral_f_upper(qf(alpha, effect, error, false, false), effect, error,
                                   (double)people * (double)cells * f * f);
}
