// Signed ranks: Wilcoxon, F. (1945), Biometrics Bulletin 1, 80-83; zeros ranked and then dropped: Pratt, J. W.
// (1959), J. American Statistical Association 54, 655-667. Given the ranks, each sign is a fair coin, so V is a
// sum of independent terms; its distribution is their convolution, on doubled mid-ranks, which are whole
// numbers. All terms are positive: n = 500 costs 500 roundings of the last digit, and 2^-500 is no underflow.
// Estimate: Hodges, J. L. & Lehmann, E. L. (1963), Annals of Mathematical Statistics 34, 598-611. Interval:
// order statistics of the averages by the distribution without ties, which covers at least as often with ties:
// Noether, G. E. (1967), J. American Statistical Association 62, 184-188.
#include "analysis/stats/wilcoxon.h"

#include "analysis/stats/coins.h"
#include "analysis/stats/quantile.h"

#include <Rmath.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

static const struct stat_wilcoxon none = {.statistic = (double)NAN,
                                          .p_value = (double)NAN,
                                          .estimate = (double)NAN,
                                          .ci_low = (double)NAN,
                                          .ci_high = (double)NAN};

static int by_size(const void *a, const void *b)
{
    double x = fabs(*(const double *)a), y = fabs(*(const double *)b);
    return (x > y) - (x < y);
}

// Doubled mid-ranks of those that are not zero, and twice V. Sorts `d` by size.
static size_t rank(double *d, size_t n, bool pratt, uint64_t *out_ranks, uint64_t *out_v)
{
    qsort(d, n, sizeof d[0], by_size);
    size_t zeros = 0, count = 0;
    while (zeros < n && d[zeros] == 0)
        zeros++;
    size_t below = pratt ? 0 : zeros;
    *out_v = 0;
    for (size_t i = zeros, end; i < n; i = end) {
        for (end = i + 1; end < n && fabs(d[end]) == fabs(d[i]);)
            end++;
        for (size_t j = i; j < end; j++) {
            out_ranks[count] = (i + 1 - below) + (end - below);
            *out_v += d[j] > 0 ? out_ranks[count] : 0;
            count++;
        }
    }
    return count;
}

// P(sum = 0) to P(sum = v) of ranks with fair signs; freed by the caller. NULL: no memory.
static double *distribution(const uint64_t *ranks, size_t n, uint64_t v)
{
    double *chance = malloc((v + 1) * sizeof *chance);
    if (chance)
        stat_coin_sums(ranks, n, chance, v);
    return chance;
}

// P(sum <= v). NaN: no memory.
static double lower_tail(const uint64_t *ranks, size_t n, uint64_t v)
{
    double *chance = distribution(ranks, n, v), sum = 0;
    if (!chance)
        return (double)NAN;
    for (uint64_t s = 0; s <= v; s++)
        sum += chance[s];
    free(chance);
    return fmin(1, sum);
}

// Both tails, each with V itself. V is symmetric about half of the total.
static void exact_tails(const uint64_t *ranks, size_t n, uint64_t v, double *less, double *greater)
{
    uint64_t total = 0;
    for (size_t i = 0; i < n; i++)
        total += ranks[i];
    *less = lower_tail(ranks, n, v);
    *greater = lower_tail(ranks, n, total - v);
}

// Wilcoxon's normal approximation. The sum of squared mid-ranks holds the correction for ties.
static void normal_tails(const uint64_t *ranks, size_t n, uint64_t v, double *less, double *greater)
{
    double mean = 0, variance = 0;
    for (size_t i = 0; i < n; i++) {
        double rank = (double)ranks[i] / 2;
        mean += rank / 2;
        variance += rank * rank / 4;
    }
    double off = (double)v / 2 - mean, sd = sqrt(variance);
    *less = pnorm((off + 0.5) / sd, 0, 1, true, false);
    *greater = pnorm((off - 0.5) / sd, 0, 1, false, false);
}

// The largest c with P(V < c) <= tail without ties: the interval reaches from the c-th average to the c-th
// last. 0: there is none.
static uint64_t interval_rank(size_t n, double tail)
{
    uint64_t all = (uint64_t)n * (n + 1) / 2, c = 0;
    if (n > STAT_WILCOXON_EXACT) {
        double count = (double)n, mean = count * (count + 1) / 4;
        double place = mean + 0.5 + qnorm(tail, 0, 1, true, false) * sqrt(mean * (2 * count + 1) / 6);
        return place >= 1 ? (uint64_t)fmin(place, (double)all) : 0;
    }
    uint64_t ranks[STAT_WILCOXON_EXACT];
    for (size_t i = 0; i < n; i++)
        ranks[i] = i + 1;
    double *chance = distribution(ranks, n, all), below = 0;
    while (chance && c < all && (below += chance[c]) <= tail)
        c++;
    free(chance);
    return c;
}

// How many averages (x[i] + x[j]) / 2 with i <= j are at most `most`; x ascending, so what goes with x[i]
// shrinks as i grows.
static uint64_t averages_up_to(const double *x, size_t n, double most)
{
    uint64_t count = 0;
    size_t end = n;
    for (size_t i = 0; i < n; i++) {
        while (end > i && x[i] / 2 + x[end - 1] / 2 > most)
            end--;
        if (end <= i)
            break;
        count += end - i;
    }
    return count;
}

// The k-th smallest average, from 1: the least double with k averages up to it. Needs no room for all of them.
static double average_at(const double *x, size_t n, uint64_t k)
{
    double low = x[0], high = x[n - 1];
    if (averages_up_to(x, n, low) >= k)
        return low;
    for (;;) { // low has too few, high enough
        double middle = low / 2 + high / 2;
        if (!(middle > low && middle < high))
            return high;
        if (averages_up_to(x, n, middle) >= k)
            high = middle;
        else
            low = middle;
    }
}

static void estimate(const double *d, size_t n, double mean, double tail, enum stat_alternative alternative,
                     struct stat_wilcoxon *out)
{
    uint64_t all = (uint64_t)n * (n + 1) / 2, c = interval_rank(n, tail);
    out->estimate = mean + (average_at(d, n, (all + 1) / 2) / 2 + average_at(d, n, all / 2 + 1) / 2);
    out->ci_low = c && alternative != STAT_LESS ? mean + average_at(d, n, c) : -(double)INFINITY;
    out->ci_high = c && alternative != STAT_GREATER ? mean + average_at(d, n, all + 1 - c) : (double)INFINITY;
}

// `d` are the values less the mean under the null hypothesis; sorted here.
static struct stat_wilcoxon test(double *d, size_t n, const struct stat_wilcoxon_options *o, uint64_t *ranks)
{
    struct stat_wilcoxon out = none;
    double conf = o->conf == 0 ? 0.95 : o->conf, less, greater; // exactly 0 is "not set"
    if (!(conf > 0 && conf < 1) || !isfinite(o->mean))
        return none;
    for (size_t i = 0; i < n; i++)
        if (!isfinite(d[i]))
            return none;
    uint64_t v;
    out.n = rank(d, n, o->pratt, ranks, &v);
    out.zeros = n - out.n;
    out.statistic = (double)v / 2;
    out.exact = out.n <= STAT_WILCOXON_EXACT;
    if (out.n) {
        (out.exact ? exact_tails : normal_tails)(ranks, out.n, v, &less, &greater);
        out.p_value = o->alternative == STAT_LESS      ? less
                      : o->alternative == STAT_GREATER ? greater
                                                       : fmin(1, 2 * fmin(less, greater));
    }
    stat_sort(d, n);
    estimate(d, n, o->mean, (1 - conf) / (o->alternative == STAT_TWO_SIDED ? 2 : 1), o->alternative, &out);
    return out;
}

struct stat_wilcoxon stat_wilcoxon_paired(const double *x, const double *y, size_t n,
                                          const struct stat_wilcoxon_options *options)
{
    const struct stat_wilcoxon_options defaults = {0};
    const struct stat_wilcoxon_options *o = options ? options : &defaults;
    struct stat_wilcoxon out = none;
    double *d = n ? malloc(n * sizeof *d) : NULL;
    uint64_t *ranks = n ? malloc(n * sizeof *ranks) : NULL;
    if (d && ranks) {
        for (size_t i = 0; i < n; i++)
            d[i] = (y ? x[i] - y[i] : x[i]) - o->mean;
        out = test(d, n, o, ranks);
    }
    free(d);
    free(ranks);
    return out;
}

struct stat_wilcoxon stat_wilcoxon(const double *x, size_t n, const struct stat_wilcoxon_options *options)
{
    return stat_wilcoxon_paired(x, NULL, n, options);
}
