// Bayes factor of a binomial probability, H1: Beta(a, b) against H0: p0.
//   The ratio of prior to posterior density at p0: Dickey, J. M. (1971), Annals of Mathematical Statistics 42,
//   204-223; Wagenmakers, E.-J. et al. (2010), Cognitive Psychology 60, 158-189. Beta densities keep their
//   digits for n = 1e9 (dbeta of libRmath by saddle point), where differences of ln B(k + a, n - k + b) and n
//   ln p0 lose all of them.
#include "analysis/stats/bayes_factor.h"

#include "analysis/stats/binomial_private.h"

#include <Rmath.h>
#include <math.h>

static bool prior_ok(double shape)
{
    return shape > 0 && shape <= 1e9;
}

double stat_binomial_log_bf10(int64_t k, int64_t n, double p0, double a, double b)
{
    if (!binomial_counts_ok(k, n) || !binomial_probability_ok(p0) || !prior_ok(a) || !prior_ok(b))
        return (double)NAN;
    double x = (double)k, y = (double)(n - k);
    if (p0 == 0 || p0 == 1) // densities have their poles there; under H0 the data is certain or impossible
        return k == (p0 == 0 ? 0 : n) ? lbeta(x + a, y + b) - lbeta(a, b) : (double)INFINITY;
    return dbeta(p0, a, b, true) - dbeta(p0, x + a, y + b, true);
}
