// Cohen, J. (1988), "Statistical Power Analysis for the Behavioral Sciences", 2nd ed., chapter 2; d_z and d_av
// as Lakens, D. (2013), Frontiers in Psychology 4, 863, eqs. 7 and 10. Correction: Hedges, L. V. (1981), J.
// Educational Statistics 6, 107-128, eq. 6e, by gamma functions and not by its approximation. Intervals: the
// noncentralities that t confines, Steiger, J. H. & Fouladi, R. T. (1997), in "What If There Were No
// Significance Tests?", 221-257; of d_av: Algina, J. & Keselman, H. J. (2003), Educational and Psychological
// Measurement 63, 537-553, who put the interval of the paired t in the unit of the single measures' SD.
#include "analysis/stats/effect.h"

#include "analysis/stats/moments.h"
#include "analysis/stats/noncentral_t.h"
#include "analysis/stats/ttest.h"

#include <Rmath.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>

static const struct stat_effect none = {(double)NAN, (double)NAN, (double)NAN, (double)NAN, (double)NAN};

double stat_hedges_factor(double df)
{
    // gamma(df / 2) / (sqrt(df / 2) gamma((df - 1) / 2)), whose parts overflow; their ratio is a beta function
    return df >= 2 ? sqrt(2 * M_PI / df) / exp(lbeta((df - 1) / 2, 0.5)) : (double)NAN;
}

// d = t x unit, and so are the limits.
static struct stat_effect finish(double t, double df, double unit, double conf)
{
    if (!isfinite(t) || !isfinite(unit) || !(conf > 0 && conf < 1))
        return none;
    double p = (1 - conf) / 2, d = t * unit;
    return (struct stat_effect){d, d * stat_hedges_factor(df), df, -stat_noncentral_t_limit(-t, df, p) * unit,
                                stat_noncentral_t_limit(t, df, p) * unit};
}

struct stat_effect stat_effect_one_sample(const double *x, size_t n, double mean0, double conf)
{
    struct stat_ttest t = stat_ttest_one_sample(x, n, &(struct stat_ttest_options){.mean = mean0});
    return finish(t.t, t.df, 1 / sqrt((double)n), conf);
}

struct stat_effect stat_effect_paired(const double *x, const double *y, size_t n, double conf)
{
    struct stat_ttest t = stat_ttest_paired(x, y, n, NULL);
    return finish(t.t, t.df, 1 / sqrt((double)n), conf);
}

struct stat_effect stat_effect_average(const double *x, const double *y, size_t n, double conf)
{
    struct stat_ttest t = stat_ttest_paired(x, y, n, NULL);
    double average = (stat_moments(x, n).sd + stat_moments(y, n).sd) / 2;
    double unit = t.std_error / average; // NaN where there is no test
    return finish(t.t, t.df, unit, conf);
}

struct stat_effect stat_effect_two_samples(const double *x, size_t n_x, const double *y, size_t n_y,
                                           double conf)
{
    if (n_x < 2 || n_y < 2)
        return none;
    struct stat_moments a = stat_moments_about(x, n_x, x[0]), b = stat_moments_about(y, n_y, x[0]);
    double df = (double)n_x + (double)n_y - 2, scale = fmax(fabs(a.mean + x[0]), fabs(b.mean + x[0]));
    double pooled = sqrt((a.sd * a.sd * ((double)n_x - 1) + b.sd * b.sd * ((double)n_y - 1)) / df);
    double unit = sqrt(1 / (double)n_x + 1 / (double)n_y);
    if (!(pooled * unit > 10 * DBL_EPSILON * scale)) // as the t-tests say it: constant
        return none;
    return finish((a.mean - b.mean) / (pooled * unit), df, unit, conf);
}
