// Permutation tests: p of random arrangements is (reached + 1) / (draws + 1), since the data is one of them:
// Phipson, B. & Smyth, G. K. (2010), Statistical Applications in Genetics and Molecular Biology 9, article 39.
// Random bits: SplitMix64 (draw.h) over a counter.
#include "analysis/stats/permutation.h"

#include "analysis/stats/draw.h"

#include <math.h>

struct stat_permuting stat_permuting_defaults(struct stat_permuting how)
{
    const int64_t usual = 100000;
    how.exact_most = how.exact_most == 0 ? usual : how.exact_most;
    how.draws = how.draws == 0 ? usual : how.draws;
    return how;
}

bool stat_permutation_reaches(double statistic, double data)
{
    return statistic >= data - 1e-9 * fabs(data);
}

struct stat_permutation stat_permutation_done(double statistic, int64_t reached, int64_t arrangements,
                                              bool exact)
{
    struct stat_permutation out = {.statistic = statistic, .arrangements = arrangements, .exact = exact};
    double of = (double)arrangements + (exact ? 0 : 1);
    out.p_value = ((double)reached + (exact ? 0 : 1)) / of;
    out.standard_error = exact ? 0 : sqrt(out.p_value * (1 - out.p_value) / of);
    return out;
}

struct stat_permutation stat_permutation_none(void)
{
    const double nan = (double)NAN;
    return (struct stat_permutation){nan, nan, nan, 0, false};
}

uint32_t stat_permutation_below(uint64_t seed, uint64_t counter, uint32_t n)
{
    uint64_t z = stat_mix(seed * 0xD1B54A32D192ED03u + counter * 0x9E3779B97F4A7C15u);
    return (uint32_t)((z >> 32) * n >> 32);
}
