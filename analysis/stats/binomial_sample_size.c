// Exact sample sizes of the binomial test.
//   Power does not rise evenly with n, so no search by halves finds where it stays: every n is looked at below
//   a bound beyond which no n can fall short, the last that does fall short first. The bound: with d = k/n - p0
//   > 0 the two-sided p-value is at most C exp(-2 n d^2) (Hoeffding, W. 1963, J. American Statistical
//   Association 58, 13-30, for k's own tail); C is 2 at p0 = 1/2. Elsewhere the far tail, whose most probable
//   count j is no more probable than k, is at most sqrt(8 n x (1 - x)) P(j) with x = j/n (Ash, R. B. 1965,
//   Information theory, lemma 4.7.1), so that C is 1 + sqrt(2 n) with the tie's tolerance. So k rejects from n
//   (p0 + d(n)) on, d(n) = sqrt(ln(C/alpha) / (2 n)), and at p the test accepts with at most exp(-2 n (|p - p0|
//   - d(n) - 1/n)^2), 1/n for k being whole. sqrt(n) times that bracket rises with n wherever it is positive.
//   Sides are alike.
#include "analysis/stats/binomial_sample_size.h"

#include "analysis/stats/binomial.h"
#include "analysis/stats/power.h"

#include <Rmath.h>
#include <math.h>
#include <stdbool.h>

struct plan {
    double p0, p, alpha, power;
};

static bool surely_enough(const struct plan *plan, int64_t n)
{
    double size = (double)n, c = plan->p0 == 0.5 ? 2 : 1 + sqrt(2 * size) * (1 + 2e-7);
    double left = fabs(plan->p - plan->p0) - sqrt(log(c / plan->alpha) / (2 * size)) - 1 / size;
    return left > 0 && -2 * size * left * left <= log1p(-plan->power);
}

// The least n that is surely enough, and every larger one with it; 0 beyond the maximum.
static int64_t bound(const struct plan *plan)
{
    int64_t low = 1, high = STAT_POWER_MAX_N;
    if (!surely_enough(plan, high))
        return 0;
    while (low < high) {
        int64_t middle = low + (high - low) / 2;
        if (surely_enough(plan, middle))
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

static bool accepts(const struct plan *plan, int64_t k, int64_t n)
{
    return k >= 0 && k <= n && stat_binomial_p(k, n, plan->p0, STAT_TWO_SIDED) > plan->alpha;
}

// Moves the accepted counts of a neighbouring n to those of n: they move by a step or two. p rises up to the
// mode and falls from there, so the accepted counts are one run, and the mode is among them.
static void follow(const struct plan *plan, struct stat_region *region, int64_t n)
{
    int64_t mode = (int64_t)floor((double)(n + 1) * plan->p0);
    mode = mode > n ? n : mode;
    region->low = region->low < mode ? region->low : mode;
    region->high = region->high > n ? n : region->high < mode ? mode : region->high;
    while (region->low < mode && !accepts(plan, region->low, n))
        region->low++;
    while (accepts(plan, region->low - 1, n))
        region->low--;
    while (region->high > mode && !accepts(plan, region->high, n))
        region->high--;
    while (accepts(plan, region->high + 1, n))
        region->high++;
}

static bool reaches(const struct plan *plan, struct stat_region *region, int64_t n)
{
    follow(plan, region, n);
    double power = pbinom((double)region->low - 1, (double)n, plan->p, true, false) +
                   pbinom((double)region->high, (double)n, plan->p, false, false);
    return power >= plan->power;
}

struct stat_sample_size stat_binomial_sample_size(double p0, double p, double alpha, double power)
{
    struct plan plan = {p0, p, alpha, power};
    struct stat_sample_size out = {0, 0};
    bool ok = p0 >= 0 && p0 <= 1 && p >= 0 && p <= 1 && alpha > 0 && alpha < 1 && 1 - alpha < 1 && power > 0 &&
              power < 1;
    int64_t most = ok ? bound(&plan) : 0;
    if (most == 0)
        return out;
    struct stat_region region = {0, 1};
    for (out.first = 1; out.first < most && !reaches(&plan, &region, out.first);)
        out.first++;
    region = stat_null_region(most, p0, 1 - alpha, STAT_TWO_SIDED);
    for (out.stays = most; out.stays > 1 && reaches(&plan, &region, out.stays - 1);)
        out.stays--;
    return out;
}
