// Two one-sided t-tests: Schuirmann, D. J. (1987), J. Pharmacokinetics and Biopharmaceutics 15, 657-680. The
// sign-flip test has no counterpart here: counts are symmetric about one half only, not about a margin's end.
#include "analysis/stats/people_equivalence.h"

#include <math.h>

struct stat_equivalence stat_people_equivalence(const struct stat_person *people, size_t count, double p0,
                                                double margin, double alpha)
{
    const double nan = (double)NAN, low = p0 - margin, high = p0 + margin;
    struct stat_equivalence out = {nan, nan, nan, {nan, nan}};
    if (!(margin > 0 && low >= 0 && high <= 1 && alpha > 0 && alpha < 0.5))
        return out;
    struct stat_ttest above = stat_people_t(people, count,
                                            &(struct stat_ttest_options){low, 1 - alpha, STAT_GREATER}),
                      below = stat_people_t(people, count,
                                            &(struct stat_ttest_options){high, 1 - alpha, STAT_LESS});
    if (isnan(above.p_value) || isnan(below.p_value))
        return out;
    out.p_low = above.p_value;
    out.p_high = below.p_value;
    out.p_value = fmax(out.p_low, out.p_high);
    out.ci = (struct stat_interval){above.ci_low, below.ci_high};
    return out;
}
