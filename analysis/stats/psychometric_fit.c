#include "analysis/stats/psychometric_fit.h"

#include "analysis/stats/draw.h"
#include "analysis/stats/psychometric_problem.h"
#include "analysis/stats/quantile.h"

#include <Rmath.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    COARSE = 10,       // cells of a bootstrap replicate's grid along one side
    COARSE_STARTS = 4, // its peaks that are followed
    SCAN = 32,         // steps from the search's end to the interval
    BISECTIONS = 40    // 2^-40 of such a step
};

static const struct stat_search thorough = {.fine = 30, .thorough = true, .starts = 12};

// Two log-likelihoods are the same within this: a likelihood ratio of one in a million.
static const double same = 1e-6;

const char *stat_fit_reason(enum stat_fit_status status)
{
    static const char *const reasons[] = {
        "",
        "the answers cannot be used",
        "no answers",
        "a level is not above 0, and a logarithmic axis (weibull) has no other",
        "one level only",
        "every answer is a no (or wrong)",
        "every answer is a yes (or right)",
        "the level has no effect on the answers",
        "the answers jump from one level to the next, so the slope has no upper limit",
        "the threshold lies beyond the levels",
        "its interval does not close near the levels",
    };
    return reasons[status];
}

static enum stat_fit_status look(const struct stat_problem *p)
{
    double k = 0;
    for (size_t i = 0; i < p->count; i++)
        k += p->k[i];
    if (p->count < 2 || p->range <= 0)
        return STAT_FIT_ONE_LEVEL;
    return k == 0 ? STAT_FIT_ALL_NO : k == p->total ? STAT_FIT_ALL_YES : STAT_FIT_OK;
}

static enum stat_fit_status judge(struct stat_problem *p, const struct stat_point *best, size_t step[2])
{
    if (stat_problem_constant(p) >= best->log_likelihood - same)
        return STAT_FIT_NO_EFFECT;
    if (stat_problem_step(p, step) >= best->log_likelihood - same)
        return STAT_FIT_STEP;
    double end = 1e-5 * p->range;
    return best->at < p->at_low + end || best->at > p->at_high - end ? STAT_FIT_OUTSIDE : STAT_FIT_OK;
}

// One end of an interval: the search comes from outside, so that a second hump belongs to it too. `from` itself
// where even the search's end is as likely.
static double profile_end(struct stat_problem *p, bool slope, double from, double to, double limit)
{
    double outside = from, inside = to;
    for (int i = 0; i < SCAN; i++) {
        double x = from + (to - from) * i / SCAN;
        if (stat_problem_profile(p, slope, x) >= limit) {
            if (i == 0)
                return from;
            inside = x;
            break;
        }
        outside = x;
    }
    for (int i = 0; i < BISECTIONS && fabs(inside - outside) > 1e-9 * fabs(to - from); i++) {
        double middle = (inside + outside) / 2;
        if (stat_problem_profile(p, slope, middle) >= limit)
            inside = middle;
        else
            outside = middle;
    }
    return inside;
}

static void set_intervals(struct stat_problem *p, const struct stat_point *best, struct stat_fit *fit)
{
    double limit = best->log_likelihood - qchisq(p->desc.conf, 1, true, false) / 2;
    double low = profile_end(p, false, p->at_low, best->at, limit),
           high = profile_end(p, false, p->at_high, best->at, limit);
    bool open_low = low == p->at_low, open_high = high == p->at_high;
    fit->threshold.low = open_low ? -(double)INFINITY : stat_problem_level(p, low);
    fit->threshold.high = open_high ? (double)INFINITY : stat_problem_level(p, high);
    if (open_low && p->logarithmic)
        fit->threshold.low = 0;
    if (open_low || open_high)
        fit->status = STAT_FIT_OPEN;
    low = profile_end(p, true, p->ln_slope_low, best->ln_slope, limit);
    high = profile_end(p, true, p->ln_slope_high, best->ln_slope, limit);
    fit->slope.low = low == p->ln_slope_low ? 0 : exp(low);
    fit->slope.high = high == p->ln_slope_high ? (double)INFINITY : exp(high);
}

static void set_function(const struct stat_problem *p, const struct stat_point *best, struct stat_fit *fit)
{
    fit->function.threshold = stat_problem_level(p, best->at);
    fit->function.slope = exp(best->ln_slope);
    fit->function.guess = best->guess;
    fit->function.lapse = best->lapse;
}

static struct stat_fit nothing(const struct stat_fit_desc *desc)
{
    const double none = (double)NAN;
    return (struct stat_fit){
        .status = STAT_FIT_BAD_INPUT,
        .function = {.family = desc->family,
                     .logarithmic = desc->logarithmic || stat_family_logarithmic(desc->family),
                     .falling = desc->falling,
                     .threshold = none,
                     .slope = none,
                     .guess = none,
                     .lapse = none},
        .threshold = {none, none},
        .slope = {none, none},
        .log_likelihood = none,
        .deviance = none,
        .step = {none, none}};
}

struct stat_fit stat_psychometric_fit(const struct stat_answers *answers, size_t count,
                                      const struct stat_fit_desc *desc)
{
    struct stat_fit fit = nothing(desc);
    struct stat_problem p;
    bool any = false, positive = true;
    for (size_t i = 0; i < count; i++) {
        any = any || answers[i].n > 0;
        positive = positive && !(answers[i].n > 0 && answers[i].level <= 0);
    }
    if (!stat_problem_init(&p, answers, count, desc)) {
        if (!any)
            fit.status = STAT_FIT_NO_ANSWERS;
        else if (!positive && fit.function.logarithmic)
            fit.status = STAT_FIT_NOT_POSITIVE;
        return fit;
    }
    fit.levels = p.count;
    fit.n = (int64_t)p.total;
    fit.status = look(&p);
    if (fit.status == STAT_FIT_OK) {
        size_t step[2] = {0, 0};
        struct stat_point best = stat_problem_maximum(&p, &thorough);
        fit.status = judge(&p, &best, step);
        fit.log_likelihood = best.log_likelihood;
        fit.deviance = fmax(0, 2 * (stat_problem_saturated(&p) - best.log_likelihood));
        if (fit.status == STAT_FIT_STEP)
            fit.step = (struct stat_interval){stat_problem_level(&p, p.u[step[0]]),
                                              stat_problem_level(&p, p.u[step[1]])};
        if (fit.status == STAT_FIT_OK) {
            set_function(&p, &best, &fit);
            set_intervals(&p, &best, &fit);
        }
    }
    stat_problem_finish(&p);
    return fit;
}

// --- bootstrap ---

static void draw_answers(const struct stat_fit *fit, const struct stat_answers *answers, size_t count,
                         uint64_t seed, size_t replicate, struct stat_answers *out)
{
    uint64_t index = 0;
    for (size_t i = 0; i < count; i++) {
        double share = answers[i].n ? stat_psychometric(&fit->function, answers[i].level) : 0;
        out[i] = (struct stat_answers){.level = answers[i].level, .n = answers[i].n};
        for (int64_t j = 0; j < answers[i].n; j++)
            out[i].k += stat_draw(seed, replicate, index++) < share;
    }
}

// Where the threshold is if a constant explains the answers: beyond all levels where only one asymptote can be
// that constant, and nowhere in particular (NaN) where both can, or neither.
static double beyond(const struct stat_problem *p)
{
    double k = 0;
    for (size_t i = 0; i < p->count; i++)
        k += p->k[i];
    double share = k / p->total;
    bool lower = share <= p->desc.guess_high, upper = share >= 1 - p->desc.lapse_high;
    if (lower == upper)
        return (double)NAN;
    return lower == p->desc.falling ? -(double)INFINITY : (double)INFINITY;
}

// The threshold of one replicate, infinite where it lies beyond the search and NaN where it has none, and its
// deviance (0 where a constant or a step says all).
static double replicate_threshold(const struct stat_answers *answers, size_t count,
                                  const struct stat_fit_desc *desc, const struct stat_fit *fit,
                                  double *out_deviance)
{
    struct stat_problem p;
    *out_deviance = 0;
    if (!stat_problem_init(&p, answers, count, desc))
        return (double)NAN;
    struct stat_point start = {.at = p.logarithmic ? log(fit->function.threshold) : fit->function.threshold,
                               .ln_slope = log(fit->function.slope)};
    struct stat_point best = stat_problem_maximum(
        &p, &(struct stat_search){.fine = COARSE, .starts = COARSE_STARTS, .start = &start});
    size_t step[2];
    double at_step = stat_problem_step(&p, step), constant = stat_problem_constant(&p),
           most = fmax(best.log_likelihood, fmax(at_step, constant));
    *out_deviance = fmax(0, 2 * (stat_problem_saturated(&p) - most));
    double end = 1e-5 * p.range, threshold = stat_problem_level(&p, best.at);
    if (constant >= most - same)
        threshold = beyond(&p);
    else if (at_step >= most - same)
        threshold = stat_problem_level(&p, (p.u[step[0]] + p.u[step[1]]) / 2);
    else if (best.at <= p.at_low + end)
        threshold = -(double)INFINITY;
    else if (best.at >= p.at_high - end)
        threshold = (double)INFINITY;
    stat_problem_finish(&p);
    return threshold;
}

static void set_bootstrap_interval(struct stat_fit_bootstrap *b, double *thresholds, size_t count, double conf,
                                   double estimate)
{
    conf = conf == 0 ? 0.95 : conf;
    stat_sort(thresholds, count);
    for (size_t i = 0; i < count; i++) {
        b->below += thresholds[i] == -(double)INFINITY;
        b->above += thresholds[i] == (double)INFINITY;
    }
    b->threshold.low = stat_quantile(thresholds, count, (1 - conf) / 2);
    b->threshold.high = stat_quantile(thresholds, count, (1 + conf) / 2);
    b->unreliable =
        !(b->threshold.low <= estimate && estimate <= b->threshold.high) || 20 * b->failed > b->replicates;
}

struct stat_fit_bootstrap stat_psychometric_bootstrap(const struct stat_answers *answers, size_t count,
                                                      const struct stat_fit_desc *desc,
                                                      const struct stat_fit *fit, size_t replicates,
                                                      uint64_t seed)
{
    struct stat_fit_bootstrap b = {
        .deviance_p = (double)NAN, .threshold = {(double)NAN, (double)NAN}, .unreliable = true};
    if (fit->status != STAT_FIT_OK || replicates == 0)
        return b;
    struct stat_answers *drawn = malloc(count * sizeof *drawn);
    double *thresholds = malloc(replicates * sizeof *thresholds);
    size_t found = 0, worse = 0;
    for (size_t i = 0; drawn && thresholds && i < replicates; i++) {
        double deviance;
        draw_answers(fit, answers, count, seed, i, drawn);
        double threshold = replicate_threshold(drawn, count, desc, fit, &deviance);
        worse += deviance >= fit->deviance - same;
        if (!isnan(threshold))
            thresholds[found++] = threshold;
        b.replicates++;
    }
    b.failed = b.replicates - found;
    if (b.replicates) {
        b.deviance_p = ((double)worse + 1) / ((double)b.replicates + 1);
        set_bootstrap_interval(&b, thresholds, found, desc->conf, fit->function.threshold);
    }
    free(drawn);
    free(thresholds);
    return b;
}
