// Tails of the binomial distribution at any depth, and the counts that are no more probable than a limit.
//   Tails are pbinom of libRmath down to 1e-280. Deeper they are P(k) times 1 + r(1) + r(1) r(2) + ..., r being
//   the ratios of neighbouring probabilities, which only fall outwards: terms are positive, and z standard
//   deviations out some 40 sd / z of them are enough (2e4 for n = 1e9). The logarithm of P(k) is dbinom's
//   (Loader, C. 2000, Fast and accurate computation of binomial probabilities).
//
//   Edges: P(j) is log-concave, so Newton's step on ln P lands beyond the edge and comes back; a bracket and
//   bisection catch what is too flat for it. Three densities on average, where bisection alone takes log2(n).
#include "analysis/stats/binomial_private.h"

#include <Rmath.h>
#include <math.h>

enum { NEWTON_STEPS = 8 }; // then bisection: flat around the mode

bool binomial_counts_ok(int64_t k, int64_t n)
{
    return n >= 1 && n <= STAT_BINOMIAL_MAX_N && k >= 0 && k <= n;
}

bool binomial_probability_ok(double p0)
{
    return p0 >= 0 && p0 <= 1;
}

// 1 - conf must still differ from 1, else no k has p > 1 - conf.
bool binomial_conf_ok(double conf)
{
    return conf > 0 && conf < 1 && 1 - conf < 1;
}

double binomial_lower(int64_t k, int64_t n, double p0)
{
    return pbinom((double)k, (double)n, p0, true, false);
}

double binomial_upper(int64_t k, int64_t n, double p0)
{
    return pbinom((double)k - 1, (double)n, p0, false, false);
}

// The sum of P(j) from k outwards over P(k), where P falls: `inside` of the outcomes counted by k are left to
// change, `outside` have changed, and odds are those of the change. Upwards k successes may become more.
static double outward_sum(double inside, double outside, double odds)
{
    double sum = 1, term = 1;
    while (inside > 0 && term > sum * 1e-18) {
        term *= inside / (outside + 1) * odds;
        sum += term;
        inside--;
        outside++;
    }
    return sum;
}

double binomial_log_lower(int64_t k, int64_t n, double p0)
{
    double p = binomial_lower(k, n, p0), size = (double)n, x = (double)k;
    if (p > BINOMIAL_SHALLOW || k < 0)
        return p > 0.5 ? log1p(-binomial_upper(k + 1, n, p0)) : log(p);
    return dbinom(x, size, p0, true) + log(outward_sum(x, size - x, (1 - p0) / p0));
}

double binomial_log_upper(int64_t k, int64_t n, double p0)
{
    double p = binomial_upper(k, n, p0), size = (double)n, x = (double)k;
    if (p > BINOMIAL_SHALLOW || k > n)
        return p > 0.5 ? log1p(-binomial_lower(k - 1, n, p0)) : log(p);
    return dbinom(x, size, p0, true) + log(outward_sum(size - x, x, p0 / (1 - p0)));
}

double binomial_outside(struct binomial_tails tails, int64_t n, double p0)
{
    if (tails.low + 1 >= tails.high)
        return 1;
    bool mirrored = p0 == 0.5 && tails.high == n - tails.low; // then one tail is the other
    double low = binomial_lower(tails.low, n, p0),
           p = low + (mirrored ? low : binomial_upper(tails.high, n, p0));
    return p < 1 ? p : 1;
}

double binomial_log_outside(struct binomial_tails tails, int64_t n, double p0)
{
    double p = binomial_outside(tails, n, p0);
    if (p > BINOMIAL_SHALLOW)
        return log(p);
    double low = binomial_log_lower(tails.low, n, p0), high = binomial_log_upper(tails.high, n, p0);
    return isinf(low) ? high : isinf(high) ? low : logspace_add(low, high);
}

// j at `out` steps from `base`, upwards or downwards.
struct side {
    int64_t base, steps; // out is 0 to steps
    double size, p0;
    bool up;
};

static double count_at(const struct side *side, int64_t out)
{
    return (double)(side->up ? side->base + out : side->base - out);
}

// ln P(j) - ln P(one further out) > 0 away from the mode.
static double fall(const struct side *side, double j)
{
    double odds = side->p0 / (1 - side->p0);
    return side->up ? log((j + 1) / ((side->size - j) * odds)) : log((side->size - j + 1) * odds / j);
}

// The least `out` with ln P <= log_limit; steps + 1 where there is none.
static int64_t edge(const struct side *side, double log_limit, double near)
{
    int64_t low = 0, high = side->steps + 1; // the answer is one of these or between
    double probe = floor(near);
    for (int i = 0; low < high; i++) {
        int64_t out = low + (high - low) / 2;
        if (i < NEWTON_STEPS && probe <= (double)low)
            out = low;
        else if (i < NEWTON_STEPS)
            out = probe >= (double)(high - 1) ? high - 1 : (int64_t)probe;
        double j = count_at(side, out), above = dbinom(j, side->size, side->p0, true) - log_limit;
        if (above <= 0)
            high = out;
        else
            low = out + 1;
        double slope = fall(side, j);
        probe = slope > 0 ? (double)out + ceil(above / slope) : (double)(low + (high - low) / 2);
    }
    return low;
}

int64_t binomial_low_edge(int64_t n, double p0, double log_limit, double near)
{
    struct side side = {.size = (double)n, .p0 = p0, .up = false};
    side.base = side.steps = (int64_t)floor((double)n * p0); // P does not fall from 0 to there
    return side.base - edge(&side, log_limit, near);
}

int64_t binomial_high_edge(int64_t n, double p0, double log_limit, double near)
{
    struct side side = {.size = (double)n, .p0 = p0, .up = true};
    side.base = (int64_t)ceil((double)n * p0); // P does not rise from there to n
    side.steps = n - side.base;
    return side.base + edge(&side, log_limit, near);
}
