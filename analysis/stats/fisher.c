// Fisher's exact test of a 2 x 2 table.
//   Fisher, R. A. (1935), Journal of the Royal Statistical Society 98, 39-82. Two-sided: all tables no more
//   probable than this one, with a relative tolerance of 1e-7, as fisher.test of R. Odds ratio and interval by
//   the noncentral hypergeometric distribution: Cornfield, J. (1956), Proc. Third Berkeley Symposium 4,
//   135-148. Roots are bisected in the logarithm of the odds ratio to a double's digits; R stops its search at
//   1e-4 of the odds ratio.
#include "analysis/stats/fisher.h"

#include "analysis/stats/binomial_private.h"

#include <Rmath.h>
#include <math.h>
#include <stdlib.h>

enum { BISECTIONS = 100, WIDEST = 1024 }; // more than a double has bits; exp(1024) is infinite

// a goes from low to high; log_weight[a - low] is ln P(a) at an odds ratio of 1.
struct hypergeometric {
    int64_t low, high, a;
    double *log_weight; // owned
};

static bool weigh(const int64_t counts[4], struct hypergeometric *h)
{
    int64_t row = counts[0] + counts[1], other = counts[2] + counts[3], column = counts[0] + counts[2];
    h->low = column > other ? column - other : 0;
    h->high = column < row ? column : row;
    h->a = counts[0];
    h->log_weight = malloc((size_t)(h->high - h->low + 1) * sizeof *h->log_weight);
    if (!h->log_weight)
        return false;
    for (int64_t a = h->low; a <= h->high; a++)
        h->log_weight[a - h->low] = dhyper((double)a, (double)row, (double)other, (double)column, true);
    return true;
}

// The sum over a from `from` to `to` of its probability at odds ratio exp(log_odds), in units of exp(most);
// times a above the least where `weighted`. Powers are taken from the observed a on, near which the sums lie,
// to keep their digits.
static double sum(const struct hypergeometric *h, int64_t from, int64_t to, double log_odds, double most,
                  bool weighted)
{
    double total = 0;
    for (int64_t a = from; a <= to; a++)
        total += exp(h->log_weight[a - h->low] + (double)(a - h->a) * log_odds - most) *
                 (weighted ? (double)(a - h->low) : 1);
    return total;
}

static double most_of(const struct hypergeometric *h, double log_odds)
{
    double most = -(double)INFINITY;
    for (int64_t a = h->low; a <= h->high; a++) {
        double value = h->log_weight[a - h->low] + (double)(a - h->a) * log_odds;
        most = value > most ? value : most;
    }
    return most;
}

enum quantity { UPPER_TAIL, LOWER_TAIL, MEAN }; // P(A >= a), P(A <= a), E(A) less the least a

// Whether the odds ratio is too small for the quantity to be `target`. The lower tail falls as it grows.
static bool too_small(const struct hypergeometric *h, enum quantity quantity, double target, double log_odds)
{
    double most = most_of(h, log_odds), all = sum(h, h->low, h->high, log_odds, most, false);
    switch (quantity) {
    case UPPER_TAIL:
        return sum(h, h->a, h->high, log_odds, most, false) < target * all;
    case LOWER_TAIL:
        return sum(h, h->low, h->a, log_odds, most, false) > target * all;
    case MEAN:
        break;
    }
    return sum(h, h->low, h->high, log_odds, most, true) < target * all;
}

static double odds_at(const struct hypergeometric *h, enum quantity quantity, double target)
{
    double low = -1, high = 1;
    while (low > -WIDEST && !too_small(h, quantity, target, low))
        low *= 2;
    while (high < WIDEST && too_small(h, quantity, target, high))
        high *= 2;
    for (int i = 0; i < BISECTIONS; i++) {
        double middle = low + (high - low) / 2;
        if (middle <= low || middle >= high)
            break;
        if (too_small(h, quantity, target, middle))
            low = middle;
        else
            high = middle;
    }
    return exp(high);
}

static double p_of(const struct hypergeometric *h, enum stat_alternative alternative)
{
    double p = 0, limit = h->log_weight[h->a - h->low] + log1p(1e-7);
    for (int64_t a = h->low; a <= h->high; a++) {
        double w = h->log_weight[a - h->low];
        if (alternative == STAT_TWO_SIDED ? w <= limit : alternative == STAT_LESS ? a <= h->a : a >= h->a)
            p += exp(w);
    }
    return p < 1 ? p : 1;
}

static double odds_ratio(const struct hypergeometric *h)
{
    if (h->a == h->low || h->a == h->high)
        return h->a == h->low ? 0 : (double)INFINITY;
    return odds_at(h, MEAN, (double)(h->a - h->low));
}

static struct stat_interval odds_interval(const struct hypergeometric *h, double conf,
                                          enum stat_alternative alternative)
{
    double tail = alternative == STAT_TWO_SIDED ? (1 - conf) / 2 : 1 - conf;
    struct stat_interval ci = {0, (double)INFINITY};
    if (alternative != STAT_LESS && h->a > h->low)
        ci.low = odds_at(h, UPPER_TAIL, tail);
    if (alternative != STAT_GREATER && h->a < h->high)
        ci.high = odds_at(h, LOWER_TAIL, tail);
    return ci;
}

struct stat_fisher stat_fisher_2x2(const int64_t counts[4], double conf, enum stat_alternative alternative)
{
    const double nan = (double)NAN;
    struct stat_fisher out = {nan, nan, {nan, nan}};
    int64_t all = 0;
    for (int i = 0; i < 4; i++) {
        if (counts[i] < 0 || counts[i] > STAT_FISHER_MAX_N)
            return out;
        all += counts[i];
    }
    struct hypergeometric h;
    if (all == 0 || all > STAT_FISHER_MAX_N || !binomial_conf_ok(conf) || !weigh(counts, &h))
        return out;
    out.p_value = p_of(&h, alternative);
    out.ci = (struct stat_interval){0, (double)INFINITY};
    if (h.low < h.high) {
        out.odds_ratio = odds_ratio(&h);
        out.ci = odds_interval(&h, conf, alternative);
    }
    free(h.log_weight);
    return out;
}
