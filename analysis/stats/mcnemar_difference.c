// The difference of two shares of the same people, by the melded interval of Fay, M. P. & Lumbard, K. (2021),
// Statistics in Medicine 40, 1147-1159. The difference is D (2 T - 1) with D the share of people whose answers
// differ and T the share of b among them. Either has a confidence distribution (Clopper and Pearson's limits at
// every level), and the lower limit is the alpha / 2 quantile of that product: T from Beta(b, c + 1); D, m = b
// + c, from Beta(m + 1, n - m) where the limit is negative and from Beta(m, n - m + 1) where it is positive, so
// that it is the lower one. The upper limit is the lower one with b and c exchanged. Its sign is T's alone, and
// T's is the exact test: interval and p never contradict each other.
//
// Chosen after counting all tables of 10, 20 and 40 people (tests/reference/mcnemar_difference.R; least
// coverage of 95 % intervals over a grid of true shares; tables whose interval leaves 0 out although the exact
// p is 0.05 or more, at n = 20 and of how many):
//     Student's t        0       0       0        16 of  231; passes 1 in 22 tables
//     Tango 1998         0.914   0.912   0.922    14 of  231
//     Newcombe 1998, 10  0.860   0.900   0.891   136 of 1771
//     this one           0.969   0.959   0.962     0 of  231
// The price is width: 1.16 times that of Tango's on the average of that grid at 20 people, 1.13 at 40. That its
// coverage is never less than stated is the authors' conjecture, which they checked by such counts too.
#include "analysis/stats/mcnemar.h"

#include "analysis/stats/binomial_private.h"
#include "analysis/stats/panel.h"

#include <Rmath.h>
#include <math.h>

enum { REACH = 9, CUTS = 2 * REACH + 1, STEPS = 100 }; // beyond 9 normal SDs lie 1e-19 of a distribution

struct beta {
    double a, b;
};

struct product {
    struct beta t, d;
    double t_cut[CUTS], d_cut[CUTS]; // quantiles one normal SD apart
    double x;
};

static double quantile(struct beta of, double p)
{
    if (of.b == 0) // all of n differ: their share may be 1
        return 1;
    return qbeta(p, of.a, of.b, true, false);
}

static void cut(struct beta of, double out[CUTS])
{
    for (int z = -REACH; z <= REACH; z++)
        out[z + REACH] = qbeta(pnorm(-fabs((double)z), 0, 1, true, false), of.a, of.b, z <= 0, false);
}

// P(T <= what puts the product at x), times the density of D.
static double integrand(double d, const void *user)
{
    const struct product *p = user;
    return dbeta(d, p->d.a, p->d.b, false) * pbeta((1 + p->x / d) / 2, p->t.a, p->t.b, true, false);
}

static int put_in_order(double *breaks, int count, double value)
{
    int at = count;
    for (; at > 0 && breaks[at - 1] > value; at--)
        breaks[at] = breaks[at - 1];
    breaks[at] = value;
    return count + 1;
}

// P(D (2 T - 1) <= x). The integrand changes on two scales, D's and T's as seen from D: panels between break
// points on both have nothing sharp within.
static double reached(struct product *p, double x)
{
    p->x = x;
    if (p->d.b == 0)
        return pbeta((1 + x) / 2, p->t.a, p->t.b, true, false);
    double low = fmax(fabs(x), p->d_cut[0]), high = p->d_cut[CUTS - 1], breaks[2 * CUTS + 1];
    if (low >= high)
        return x < 0 ? 0 : 1;
    int count = put_in_order(breaks, 0, low);
    for (int i = 0; i < CUTS; i++) {
        double seen = x / (2 * p->t_cut[i] - 1);
        if (p->d_cut[i] > low)
            count = put_in_order(breaks, count, p->d_cut[i]);
        if (seen > low && seen < high)
            count = put_in_order(breaks, count, seen);
    }
    double sum = x > 0 ? pbeta(x, p->d.a, p->d.b, true, false) : 0; // D below x: whatever T is
    for (int i = 0; i + 1 < count; i++)
        sum += stat_panel(integrand, p, breaks[i], breaks[i + 1]);
    return sum;
}

// Regula falsi after Illinois within low and high, where `reached` crosses `tail`.
static double solve(struct product *p, double tail, double low, double high)
{
    double at_low = reached(p, low) - tail, at_high = reached(p, high) - tail;
    if (at_low >= 0 || at_high <= 0) // by rounding: the bracket ends where the limit is
        return at_low >= 0 ? low : high;
    for (int i = 0, side = 0; i < STEPS && high - low > 1e-15 * fmax(fabs(low), fabs(high)); i++) {
        double middle = (low * at_high - high * at_low) / (at_high - at_low);
        double value = reached(p, middle) - tail;
        if (value == 0 || !(middle > low && middle < high))
            return middle;
        if (value < 0) {
            low = middle, at_low = value;
            at_high /= side == -1 ? 2 : 1;
            side = -1;
        } else {
            high = middle, at_high = value;
            at_low /= side == 1 ? 2 : 1;
            side = 1;
        }
    }
    return low + (high - low) / 2;
}

// The bracket: the product is below `low` only where T or D is in half of the tail each, and below `high` where
// T is in twice the tail and D in the half that makes it so.
static double lower_limit(int64_t b, int64_t c, int64_t n, double tail)
{
    double differ = (double)(b + c), agree = (double)(n - b - c);
    struct product p = {.t = {(double)b, (double)c + 1}};
    if (b == 0) // T is 0
        return -quantile((struct beta){differ + 1, agree}, 1 - tail);
    bool negative = pbeta(0.5, p.t.a, p.t.b, true, false) >= tail;
    p.d = negative ? (struct beta){differ + 1, agree} : (struct beta){differ, agree + 1};
    cut(p.t, p.t_cut);
    if (p.d.b > 0)
        cut(p.d, p.d_cut);
    double low = quantile(p.d, negative ? 1 - tail / 2 : tail / 2) * (2 * quantile(p.t, tail / 2) - 1);
    double high = quantile(p.d, 0.5) * (2 * quantile(p.t, 2 * tail) - 1);
    return negative ? solve(&p, tail, low, fmin(high, 0)) : solve(&p, tail, fmax(low, 0), high);
}

struct stat_interval stat_mcnemar_difference(int64_t b, int64_t c, int64_t n, double conf)
{
    if (b < 0 || c < 0 || n < 1 || n > STAT_BINOMIAL_MAX_N || b > n || c > n - b || !binomial_conf_ok(conf))
        return (struct stat_interval){(double)NAN, (double)NAN};
    double tail = (1 - conf) / 2;
    return (struct stat_interval){lower_limit(b, c, n, tail), -lower_limit(c, b, n, tail)};
}
