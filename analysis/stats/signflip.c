// Sign-flip (one-sample permutation) test: Fisher, R. A. (1935), The Design of Experiments, section 21. Its
// null distribution by convolution instead of by listing the signs: Pagano, M. & Tritchler, D. (1983), J. Am.
// Stat. Assoc. 78, 435-440. With w = |2k - n|, whole numbers, the sum of all signed w is 2 s - S, where s sums
// the w of positive sign and S all; the probability of each s is built person by person. Halving is exact in a
// double and only positive numbers are added, so that p is good to people times 1.1e-16, relative, down to
// about 1e-300.
#include "analysis/stats/signflip.h"

#include "analysis/stats/coins.h"

#include <math.h>
#include <stdlib.h>

enum { MOST_SUM = 10000000 }; // 80 MB

static int64_t weight(const struct stat_person *p)
{
    int64_t off = 2 * p->k - p->n;
    return off < 0 ? -off : off;
}

static int64_t common_divisor(int64_t a, int64_t b)
{
    while (b) {
        int64_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

// P(s >= from) of the sums of weights, each with its sign by a fair coin. NaN: no memory.
static double upper_tail(const struct stat_person *people, size_t count, int64_t unit, int64_t total,
                         int64_t from)
{
    double *chance = malloc(((size_t)total + 1) * sizeof *chance), p = 0;
    uint64_t *weights = malloc(count * sizeof *weights);
    if (chance && weights) {
        for (size_t i = 0; i < count; i++)
            weights[i] = (uint64_t)(weight(&people[i]) / unit);
        stat_coin_sums(weights, count, chance, (uint64_t)total);
        for (int64_t s = total; s >= from && s >= 0; s--) // the smallest first
            p += chance[s];
    } else {
        p = (double)NAN;
    }
    free(weights);
    free(chance);
    return p;
}

struct stat_signflip stat_signflip(const struct stat_person *people, size_t count,
                                   enum stat_alternative alternative)
{
    struct stat_people sum = stat_people_sum(people, count);
    struct stat_signflip test = {
        .people = sum.people, .statistic = (double)NAN, .p_value = (double)NAN, .least_p = (double)NAN};
    if (!sum.ok || sum.people == 0)
        return test;
    int64_t unit = 0, total = 0;
    for (size_t i = 0; i < count; i++) {
        unit = common_divisor(weight(&people[i]), unit);
        total += weight(&people[i]);
        test.uneven += weight(&people[i]) > 0;
    }
    test.statistic = (double)(2 * sum.k - sum.n) / 2;
    int sides = alternative == STAT_TWO_SIDED ? 2 : 1;
    test.least_p = fmin(1, sides * ldexp(1, -(int)fmin((double)test.uneven, 2000)));
    if (test.uneven == 0) {
        test.p_value = 1;
        return test;
    }
    total /= unit;
    int64_t seen = (2 * sum.k - sum.n) / unit;
    if (alternative == STAT_LESS || (alternative == STAT_TWO_SIDED && seen < 0))
        seen = -seen;
    if (total > MOST_SUM || (double)total * (double)test.uneven > STAT_SIGNFLIP_MAX_STEPS)
        return test;
    // 2 s - S >= seen; both have the parity of S
    double tail = upper_tail(people, count, unit, total, (total + seen) / 2);
    test.p_value = isnan(tail) ? tail : fmin(1, sides * tail);
    return test;
}
