// Data in order, and the exact solution for the asymptotes. With F fixed, P = guess (1 - F) + (1 - lapse) F is
// linear in both, so the log-likelihood is concave in them: one root search, or one within another.
#include "analysis/stats/psychometric_problem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ROUNDS = 60 };

static int by_level(const void *x, const void *y)
{
    const struct stat_answers *a = x, *b = y;
    return (a->level > b->level) - (a->level < b->level);
}

static bool desc_ok(const struct stat_fit_desc *d)
{
    return d->family < STAT_FAMILIES && d->guess_low >= 0 && d->guess_low <= d->guess_high &&
           d->lapse_low >= 0 && d->lapse_low <= d->lapse_high && d->guess_high + d->lapse_high <= 1 &&
           d->guess_low + d->lapse_low < 1 && d->conf >= 0 && d->conf < 1;
}

static bool answers_ok(const struct stat_answers *answers, size_t count, bool logarithmic)
{
    for (size_t i = 0; i < count; i++)
        if (!isfinite(answers[i].level) || answers[i].n < 0 || answers[i].k < 0 ||
            answers[i].k > answers[i].n || answers[i].n > STAT_BINOMIAL_MAX_N ||
            (logarithmic && answers[i].n > 0 && !(answers[i].level > 0)))
            return false;
    return true;
}

// Adds sorted answers, joining levels that differ by rounding only.
static void join(struct stat_problem *p, const struct stat_answers *sorted, size_t count, double equal)
{
    for (size_t i = 0; i < count; i++) {
        double u = p->logarithmic ? log(sorted[i].level) : sorted[i].level;
        if (p->count == 0 || u - p->u[p->count - 1] > equal) {
            p->u[p->count] = u;
            p->k[p->count] = p->n[p->count] = 0;
            p->count++;
        }
        p->k[p->count - 1] += (double)sorted[i].k;
        p->n[p->count - 1] += (double)sorted[i].n;
    }
}

static void set_search(struct stat_problem *p)
{
    p->range = p->u[p->count - 1] - p->u[0];
    p->gap = p->range;
    for (size_t i = 1; i < p->count; i++)
        p->gap = fmin(p->gap, p->u[i] - p->u[i - 1]);
    p->at_low = p->u[0] - p->range;
    p->at_high = p->u[p->count - 1] + p->range;
    p->ln_slope_low = log(0.1 / p->range);
    p->ln_slope_high = log(10 / p->gap);
}

bool stat_problem_init(struct stat_problem *p, const struct stat_answers *answers, size_t count,
                       const struct stat_fit_desc *desc)
{
    *p = (struct stat_problem){.desc = *desc,
                               .logarithmic = desc->logarithmic || stat_family_logarithmic(desc->family)};
    if (p->desc.conf == 0) // exactly 0 is "not set"
        p->desc.conf = 0.95;
    if (count == 0 || !desc_ok(desc) || !answers_ok(answers, count, p->logarithmic))
        return false;
    struct stat_answers *sorted = malloc(count * sizeof *sorted);
    p->block = malloc(5 * count * sizeof *p->block);
    size_t used = 0;
    for (size_t i = 0; sorted && i < count; i++)
        if (answers[i].n > 0)
            sorted[used++] = answers[i];
    if (sorted && p->block && used > 0) {
        qsort(sorted, used, sizeof *sorted, by_level);
        double first = sorted[0].level, last = sorted[used - 1].level;
        double range = p->logarithmic ? log(last) - log(first) : last - first;
        p->u = p->block;
        p->k = p->block + count;
        p->n = p->block + 2 * count;
        p->lower = p->block + 3 * count;
        p->upper = p->block + 4 * count;
        join(p, sorted, used, 1e-9 * range);
        for (size_t i = 0; i < p->count; i++)
            p->total += p->n[i];
        set_search(p);
    }
    free(sorted);
    if (p->count > 0 && p->count <= STAT_FIT_LEVELS && isfinite(p->range))
        return true;
    stat_problem_finish(p);
    return false;
}

void stat_problem_finish(struct stat_problem *p)
{
    free(p->block);
    *p = (struct stat_problem){0};
}

double stat_problem_level(const struct stat_problem *p, double u)
{
    return p->logarithmic ? exp(u) : u;
}

// --- likelihood ---

static double log_part(double count, double p)
{
    return count > 0 ? count * log(p) : 0;
}

static double log_likelihood(const struct stat_problem *p, double guess, double lapse)
{
    double sum = 0;
    for (size_t i = 0; i < p->count; i++) {
        double yes = guess * p->upper[i] + (1 - lapse) * p->lower[i],
               no = lapse * p->lower[i] + (1 - guess) * p->upper[i];
        sum += log_part(p->k[i], yes) + log_part(p->n[i] - p->k[i], no);
    }
    return sum;
}

// Derivative of the log-likelihood by guess or by lapse; falls with it.
static double derivative(const struct stat_problem *p, double guess, double lapse, bool of_lapse)
{
    double sum = 0;
    for (size_t i = 0; i < p->count; i++) {
        double yes = guess * p->upper[i] + (1 - lapse) * p->lower[i],
               no = lapse * p->lower[i] + (1 - guess) * p->upper[i];
        double by = of_lapse ? -p->lower[i] : p->upper[i];
        if (by == 0)
            continue;
        sum += by * ((p->k[i] > 0 ? p->k[i] / yes : 0) - (p->n[i] > p->k[i] ? (p->n[i] - p->k[i]) / no : 0));
    }
    return sum;
}

// Where a falling function of one variable crosses 0 between low and high, or the end it does not reach. Regula
// falsi that halves the stale end (Illinois; Dowell & Jarratt 1971, BIT 11, 168-174).
struct falling {
    const struct stat_problem *problem;
    double guess; // where lapse is solved for
    double lapse; // set by the search within
};

static double solve(struct falling *f, bool lapse, double low, double high);

static double value(struct falling *f, bool lapse, double x)
{
    const struct stat_fit_desc *d = &f->problem->desc;
    if (lapse)
        return derivative(f->problem, f->guess, x, true);
    f->guess = x;
    f->lapse = solve(f, true, d->lapse_low, d->lapse_high);
    return derivative(f->problem, x, f->lapse, false);
}

static double solve(struct falling *f, bool lapse, double low, double high)
{
    if (low == high)
        return low;
    double a = low, b = high, at_a = value(f, lapse, a), at_b;
    if (!(at_a > 0))
        return a;
    at_b = value(f, lapse, b);
    if (!(at_b < 0))
        return b;
    double x = a, enough = 1e-10 * f->problem->total;
    int side = 0;
    for (int i = 0; i < ROUNDS && b - a > 1e-14; i++) {
        double secant = a + (b - a) * (at_a / (at_a - at_b));
        x = isfinite(at_a) && isfinite(at_b) && i % 8 != 7 && secant > a && secant < b ? secant : (a + b) / 2;
        double at_x = value(f, lapse, x);
        if (fabs(at_x) < enough)
            break;
        if (at_x > 0) {
            a = x;
            at_a = at_x;
            at_b = side > 0 ? at_b / 2 : at_b;
            side = 1;
        } else {
            b = x;
            at_b = at_x;
            at_a = side < 0 ? at_a / 2 : at_a;
            side = -1;
        }
    }
    return x;
}

void stat_problem_asymptotes(const struct stat_problem *p, struct stat_point *point)
{
    const struct stat_fit_desc *d = &p->desc;
    struct falling f = {.problem = p, .guess = d->guess_low, .lapse = d->lapse_low};
    point->guess = solve(&f, false, d->guess_low, d->guess_high);
    f.guess = point->guess;
    point->lapse = solve(&f, true, d->lapse_low, d->lapse_high);
    point->log_likelihood = log_likelihood(p, point->guess, point->lapse);
}

struct stat_point stat_problem_point(struct stat_problem *p, double at, double ln_slope)
{
    struct stat_point point = {.at = at, .ln_slope = ln_slope};
    double slope = p->desc.falling ? -exp(ln_slope) : exp(ln_slope);
    for (size_t i = 0; i < p->count; i++) {
        struct stat_tails t = stat_family_tails(p->desc.family, slope * (p->u[i] - at));
        p->lower[i] = t.lower;
        p->upper[i] = t.upper;
    }
    stat_problem_asymptotes(p, &point);
    return point;
}

// --- limits ---

static double try_step(struct stat_problem *p, size_t first, size_t own, double *inner)
{
    for (size_t i = 0; i < p->count; i++) {
        p->lower[i] = (i >= first) != p->desc.falling;
        p->upper[i] = 1 - p->lower[i];
    }
    double k = 0, n = 0;
    if (own < p->count) { // a level right at the step has a probability of its own
        k = p->k[own];
        n = p->n[own];
        p->k[own] = p->n[own] = 0;
    }
    struct stat_point point = {0};
    stat_problem_asymptotes(p, &point);
    double share = n > 0 ? k / n : 0.5;
    if (own < p->count) {
        p->k[own] = k;
        p->n[own] = n;
        point.log_likelihood += log_part(k, share) + log_part(n - k, 1 - share);
    }
    *inner = n > 0 && (share < point.guess || share > 1 - point.lapse) ? (double)NAN : 0;
    return point.log_likelihood;
}

double stat_problem_step(struct stat_problem *p, size_t out_step[2])
{
    double best = -(double)INFINITY, inner;
    out_step[0] = out_step[1] = 0;
    for (size_t i = 0; i < p->count; i++) {
        double at = try_step(p, i, i, &inner);
        if (!isnan(inner) && at > best) {
            best = at;
            out_step[0] = i ? i - 1 : 0;
            out_step[1] = i + 1 < p->count ? i + 1 : i;
        }
        double between = i ? try_step(p, i, p->count, &inner) : best;
        if (i && between >= best) {
            best = between;
            out_step[0] = i - 1;
            out_step[1] = i;
        }
    }
    return best;
}

double stat_problem_constant(const struct stat_problem *p)
{
    double k = 0, n = 0;
    for (size_t i = 0; i < p->count; i++) {
        k += p->k[i];
        n += p->n[i];
    }
    double share = fmin(fmax(k / n, p->desc.guess_low), 1 - p->desc.lapse_low);
    return log_part(k, share) + log_part(n - k, 1 - share);
}

double stat_problem_saturated(const struct stat_problem *p)
{
    double sum = 0;
    for (size_t i = 0; i < p->count; i++)
        sum += log_part(p->k[i], p->k[i] / p->n[i]) + log_part(p->n[i] - p->k[i], 1 - p->k[i] / p->n[i]);
    return sum;
}
