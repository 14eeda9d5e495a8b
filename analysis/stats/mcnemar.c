// McNemar, Q. (1947), Psychometrika 12, 153-157; the correction is Edwards' (1948, Psychometrika 13, 185-187),
// not applied where b = c, as mcnemar.test of R. Exact: the binomial test of b in b + c against one half; its
// interval p goes to the odds ratio by p / (1 - p). Mid-p: Fagerland, M. W., Lydersen, S. & Laake, P. (2013),
// BMC Medical Research Methodology 13, 91; at one half it is the two-sided mid-p of binomial.h.
#include "analysis/stats/mcnemar.h"

#include "analysis/stats/binomial_private.h"

#include <Rmath.h>
#include <math.h>

static double odds(double p)
{
    return p < 1 ? p / (1 - p) : (double)INFINITY;
}

static double chi_squared_p(double x)
{
    return pchisq(x, 1, false, false);
}

struct stat_mcnemar stat_mcnemar_test(int64_t b, int64_t c, double conf)
{
    const double nan = (double)NAN;
    struct stat_mcnemar out = {nan, nan, nan, nan, nan, nan, nan, {nan, nan}};
    if (b < 0 || c < 0 || b > STAT_BINOMIAL_MAX_N || c > STAT_BINOMIAL_MAX_N - b || !binomial_conf_ok(conf))
        return out;
    if (b + c == 0) {
        out.p_exact = out.p_mid = 1;
        return out;
    }
    double apart = fabs((double)b - (double)c), n = (double)(b + c), corrected = apart > 0 ? apart - 1 : 0;
    out.p_exact = stat_binomial_p(b, b + c, 0.5, STAT_TWO_SIDED);
    out.p_mid = stat_binomial_mid_p(b, b + c, 0.5, STAT_TWO_SIDED);
    out.chi_squared = apart * apart / n;
    out.p_value = chi_squared_p(out.chi_squared);
    out.chi_squared_corrected = corrected * corrected / n;
    out.p_corrected = chi_squared_p(out.chi_squared_corrected);
    struct stat_interval share = stat_clopper_pearson(b, b + c, conf, STAT_TWO_SIDED);
    out.odds_ratio = c > 0 ? (double)b / (double)c : (double)INFINITY;
    out.ci = (struct stat_interval){odds(share.low), odds(share.high)};
    return out;
}
