// t-tests. Student (1908), Biometrika 6, 1-25; unequal variances: Welch, B. L. (1947), Biometrika 34, 28-35,
// with the degrees of freedom of Satterthwaite, F. E. (1946), Biometrics Bulletin 2, 110-114. Data count as
// constant where the standard error is under ten rounding errors of the mean, as t.test of R has it. What is
// tested is a difference, and is taken before any mean is rounded, so that 1e9 in all values changes nothing.
#include "analysis/stats/ttest.h"

#include "analysis/stats/moments.h"

#include <Rmath.h>
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

static const struct stat_ttest none = {(double)NAN, (double)NAN, (double)NAN, (double)NAN,
                                       (double)NAN, (double)NAN, (double)NAN};

// `distance` is the estimate less its mean under the null hypothesis.
static struct stat_ttest finish(double estimate, double distance, double std_error, double df, double scale,
                                const struct stat_ttest_options *options)
{
    const struct stat_ttest_options defaults = {0};
    const struct stat_ttest_options *o = options ? options : &defaults;
    double conf = o->conf == 0 ? 0.95 : o->conf; // exactly 0 is "not set"
    struct stat_ttest test = none;
    test.estimate = estimate;
    if (!(conf > 0 && conf < 1) || !isfinite(o->mean) || !(std_error > 10 * DBL_EPSILON * scale) || !(df > 0))
        return test;
    test.std_error = std_error;
    test.t = distance / std_error;
    test.df = df;
    if (o->alternative == STAT_TWO_SIDED) {
        double reach = qt((1 - conf) / 2, df, false, false) * std_error;
        test.p_value = 2 * pt(-fabs(test.t), df, true, false);
        test.ci_low = estimate - reach;
        test.ci_high = estimate + reach;
        return test;
    }
    double reach = qt(1 - conf, df, false, false) * std_error;
    test.p_value = pt(test.t, df, o->alternative == STAT_LESS, false);
    test.ci_low = o->alternative == STAT_LESS ? -(double)INFINITY : estimate - reach;
    test.ci_high = o->alternative == STAT_LESS ? estimate + reach : (double)INFINITY;
    return test;
}

struct stat_ttest stat_ttest_one_sample(const double *x, size_t n, const struct stat_ttest_options *options)
{
    struct stat_moments m = stat_moments(x, n);
    double distance = options ? stat_moments_about(x, n, options->mean).mean : m.mean;
    return finish(m.mean, distance, m.std_error, (double)n - 1, fabs(m.mean), options);
}

struct stat_ttest stat_ttest_paired(const double *x, const double *y, size_t n,
                                    const struct stat_ttest_options *options)
{
    double *difference = n ? malloc(n * sizeof *difference) : NULL;
    if (!difference)
        return none;
    for (size_t i = 0; i < n; i++)
        difference[i] = x[i] - y[i];
    struct stat_ttest test = stat_ttest_one_sample(difference, n, options);
    free(difference);
    return test;
}

struct stat_ttest stat_ttest_welch(const double *x, size_t n_x, const double *y, size_t n_y,
                                   const struct stat_ttest_options *options)
{
    double origin = n_x && n_y ? x[0] : 0;
    struct stat_moments a = stat_moments_about(x, n_x, origin), b = stat_moments_about(y, n_y, origin);
    double va = a.std_error * a.std_error, vb = b.std_error * b.std_error;
    double df = (va + vb) * (va + vb) / (va * va / ((double)n_x - 1) + vb * vb / ((double)n_y - 1));
    double estimate = a.mean - b.mean, scale = fmax(fabs(a.mean + origin), fabs(b.mean + origin));
    return finish(estimate, options ? estimate - options->mean : estimate, sqrt(va + vb), df, scale, options);
}
