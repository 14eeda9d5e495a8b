// Equivalence of a binomial probability with p0.
//   Two one-sided tests: Schuirmann, D. J. (1987), J. Pharmacokinetics and Biopharmaceutics 15, 657-680. Both
//   are exact binomial tests at the margin's ends. The interval that belongs to them leaves out alpha on either
//   side, so its confidence is 1 - 2 alpha.
#include "analysis/stats/equivalence.h"

#include <math.h>
#include <stdbool.h>

struct stat_equivalence stat_binomial_equivalence(int64_t k, int64_t n, double p0, double margin, double alpha)
{
    double low = p0 - margin, high = p0 + margin, nan = (double)NAN;
    struct stat_equivalence out = {nan, nan, nan, {nan, nan}};
    if (!(margin > 0 && low >= 0 && high <= 1 && alpha > 0 && alpha < 0.5))
        return out;
    out.p_low = stat_binomial_p(k, n, low, STAT_GREATER);
    out.p_high = stat_binomial_p(k, n, high, STAT_LESS);
    out.p_value = out.p_low > out.p_high ? out.p_low : out.p_high;
    out.ci.low = stat_clopper_pearson(k, n, 1 - alpha, STAT_GREATER).low;
    out.ci.high = stat_clopper_pearson(k, n, 1 - alpha, STAT_LESS).high;
    return out;
}

enum stat_verdict stat_verdict(double p_difference, double p_equivalence, double alpha)
{
    bool different = p_difference <= alpha, within = p_equivalence <= alpha;
    if (within)
        return different ? STAT_DIFFERENT_WITHIN : STAT_WITHIN;
    return different ? STAT_DIFFERENT : STAT_UNDECIDED;
}
