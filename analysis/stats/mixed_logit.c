// Logistic regression with a normal random intercept.
//   Quadrature is adaptive as in Pinheiro, J. C. & Bates, D. M. (1995), J. Computational and Graphical
//   Statistics 4, 12-35: centred on each person's mode and scaled by the curvature there. The rule is the
//   trapezoidal one, which for such integrands converges faster than any power of the step: Trefethen, L. N. &
//   Weideman, J. A. C. (2014), SIAM Review 56, 385-458. It takes some 40 points. The 25
//   Gauss-Hermite ones of glmer(nAGQ = 25) do not always suffice where many people always chose the same: its
//   log-likelihood is then off by 4e-4 ("mostly all" in tests/reference/people.R). Derivatives: Louis, T. A.
//   (1982), J. R. Statist. Soc. B 44, 226-233, from the same points. Maximum by Newton steps in (intercept,
//   sd), damped (Levenberg, K. (1944), Quart. Appl. Math. 2, 164-168). Standard errors from the observed
//   information of both. The population mean's interval is the delta method's on the logit scale. Degrees of
//   freedom: Li, P. & Redden, D. T. (2015), BMC Medical Research Methodology 15, 38, find N - 1
//   (between-within) to keep the level with few people.
// The likelihood is even in the SD, so SD = 0 is always stationary; it is the estimate where nothing else found
// is better.
#include "analysis/stats/mixed_logit.h"

#include <Rmath.h>
#include <math.h>
#include <stdlib.h>

enum { STEPS = 200 };

static const double most_sd = 200;      // logits; nobody's preferences are that far apart
static const double step_size = 0.5;    // of the narrower of the person's likelihood and the logistic's bend
static const double least_mass = 1e-18; // of the mode's, where a sum over points ends

// People with the same counts have the same likelihood.
struct group {
    int64_t k, n;
    double people;
};

struct parameters {
    double intercept, sd;
};

// Log-likelihood with its gradient and Hessian in (intercept, sd).
struct likelihood {
    double value, g0, g1, h00, h01, h11;
};

struct solution {
    struct parameters at;
    struct likelihood value;
    bool converged;
};

static double logistic(double x)
{
    return x > 0 ? 1 / (1 + exp(-x)) : exp(x) / (1 + exp(x));
}

static double log_one_plus_exp(double x)
{
    return x > 0 ? x + log1p(exp(-x)) : log1p(exp(x));
}

// The logarithm of a person's likelihood times the density of b, without the density's constant.
static double joint(const struct group *g, struct parameters p, double b)
{
    double x = p.intercept + p.sd * b;
    return (double)g->k * x - (double)g->n * log_one_plus_exp(x) - b * b / 2;
}

// Its maximum in b: the derivative falls, and has its zero in the bracket since 0 <= logistic <= 1.
static double find_mode(const struct group *g, struct parameters p, double *out_width)
{
    double k = (double)g->k, n = (double)g->n;
    double low = p.sd * (k - n), high = p.sd * k, b = fmin(fmax(0, low), high), curvature = 1;
    for (int i = 0; i < STEPS; i++) {
        double share = logistic(p.intercept + p.sd * b);
        double slope = p.sd * (k - n * share) - b;
        curvature = 1 + n * p.sd * p.sd * share * (1 - share);
        if (slope > 0)
            low = b;
        else
            high = b;
        double next = b + slope / curvature;
        if (!(next > low && next < high))
            next = low + (high - low) / 2;
        if (fabs(next - b) <= 1e-13 * (1 + fabs(b)))
            break;
        b = next;
    }
    *out_width = 1 / sqrt(curvature);
    return b;
}

// Points in b from the mode outwards.
struct points {
    double mode, top, step; // top: the joint density's logarithm at the mode
};

// The logistic has poles at a distance of pi / sd from the real line.
static struct points lay_points(const struct group *g, struct parameters p)
{
    double width, mode = find_mode(g, p, &width);
    return (struct points){mode, joint(g, p, mode), step_size * (p.sd > 1 / width ? 1 / p.sd : width)};
}

// Sums over the points of b's distribution given the counts; with s = k - n share, the score of one person is
// the mean of (s, b s) over it.
struct sums {
    double mass, s0, s1, c00, c01, c11;
};

static void add_point(struct sums *sums, const struct group *g, struct parameters p, double b, double mass)
{
    double share = logistic(p.intercept + p.sd * b), n = (double)g->n;
    double s = (double)g->k - n * share, curvature = s * s - n * share * (1 - share);
    sums->mass += mass;
    sums->s0 += mass * s;
    sums->s1 += mass * b * s;
    sums->c00 += mass * curvature;
    sums->c01 += mass * b * curvature;
    sums->c11 += mass * b * b * curvature;
}

static void add_group(const struct group *g, struct parameters p, struct likelihood *sum)
{
    struct points at = lay_points(g, p);
    struct sums y = {.mass = 0};
    add_point(&y, g, p, at.mode, 1);
    for (int side = -1; side <= 1; side += 2) {
        double mass = 1;
        for (int64_t j = 1; mass > least_mass; j++) {
            double b = at.mode + side * (double)j * at.step;
            mass = exp(joint(g, p, b) - at.top);
            add_point(&y, g, p, b, mass);
        }
    }
    double s0 = y.s0 / y.mass, s1 = y.s1 / y.mass;
    sum->value += g->people * (at.top + log(y.mass * at.step / sqrt(2 * M_PI)));
    sum->g0 += g->people * s0;
    sum->g1 += g->people * s1;
    sum->h00 += g->people * (y.c00 / y.mass - s0 * s0);
    sum->h01 += g->people * (y.c01 / y.mass - s0 * s1);
    sum->h11 += g->people * (y.c11 / y.mass - s1 * s1);
}

static struct likelihood evaluate(const struct group *groups, size_t count, struct parameters p)
{
    struct likelihood sum = {0};
    for (size_t i = 0; i < count; i++)
        add_group(&groups[i], p, &sum);
    return sum;
}

// Newton steps; what is added to the curvature grows until a step climbs, and shrinks after one that did.
static struct solution climb(const struct group *groups, size_t count, struct parameters start)
{
    struct solution s = {start, evaluate(groups, count, start), false};
    double damping = 0;
    for (int i = 0; i < STEPS && !s.converged; i++) {
        const struct likelihood *v = &s.value;
        double a = damping - v->h00, b = -v->h01, d = damping - v->h11, det = a * d - b * b;
        bool climbs = a > 0 && det > 0;
        struct parameters next = s.at;
        if (climbs) {
            double step0 = (d * v->g0 - b * v->g1) / det, step1 = (a * v->g1 - b * v->g0) / det;
            next.intercept += step0;
            next.sd = fabs(next.sd + step1);
            double moved = fmax(fabs(step0), fabs(step1)), gain = step0 * v->g0 + step1 * v->g1;
            struct likelihood there =
                evaluate(groups, count, (struct parameters){next.intercept, fmin(next.sd, most_sd)});
            climbs = next.sd <= most_sd && there.value >= v->value - 1e-12 * fabs(v->value);
            if (climbs) {
                // Where the likelihood is flat in the SD, steps shrink slowly and there is nothing to gain by
                // them.
                s.converged = (moved < 1e-9 * (1 + next.sd) || gain < 1e-14) && damping < 1e-2;
                s.at = next;
                s.value = there;
            }
        }
        damping = climbs ? (damping < 1e-6 ? 0 : damping / 10) : fmax(damping * 4, 1e-3);
        if (damping > 1e12)
            break;
    }
    return s;
}

// SD = 0: the pooled answers.
static struct solution without_sd(const struct stat_people *sum)
{
    double k = (double)sum->k, n = (double)sum->n, share = k / n;
    struct solution s = {.at = {log(k / (n - k)), 0}, .converged = true};
    s.value.value = k * log(share) + (n - k) * log1p(-share);
    s.value.h00 = -n * share * (1 - share);
    return s;
}

// The best of two climbs, from little and from much difference between people, and of none.
static struct solution maximise(const struct group *groups, size_t count, const struct stat_people *sum)
{
    static const double starts[] = {0.5, 3};
    struct solution best = without_sd(sum);
    for (size_t i = 0; i < sizeof starts / sizeof starts[0]; i++) {
        struct parameters start = {best.at.intercept, starts[i]};
        struct solution s = climb(groups, count, start);
        if (s.value.value > best.value.value + 1e-10 && s.at.sd > 1e-4)
            best = s;
    }
    return best;
}

// --- what is reported at the estimate ---

// The people's mean preference, and its derivatives by the intercept and by the SD.
struct mean {
    double share, by_intercept, by_sd;
};

static struct mean mean_preference(struct parameters p)
{
    const struct group nobody = {0, 0, 1}; // leaves the standard normal density of b
    struct points at = lay_points(&nobody, p);
    struct mean mean = {0, 0, 0};
    int64_t reach = (int64_t)ceil(9 / at.step);
    for (int64_t j = -reach; j <= reach; j++) {
        double b = (double)j * at.step, mass = exp(-b * b / 2) * at.step / sqrt(2 * M_PI);
        double share = logistic(p.intercept + p.sd * b);
        mean.share += mass * share;
        mean.by_intercept += mass * share * (1 - share);
        mean.by_sd += mass * share * (1 - share) * b;
    }
    return mean;
}

static struct stat_interval around(double centre, double std_error, double df, double conf,
                                   enum stat_alternative alternative)
{
    double tail = alternative == STAT_TWO_SIDED ? (1 - conf) / 2 : 1 - conf;
    double reach = qt(tail, df, false, false) * std_error;
    return (struct stat_interval){alternative == STAT_LESS ? -(double)INFINITY : centre - reach,
                                  alternative == STAT_GREATER ? (double)INFINITY : centre + reach};
}

static struct stat_interval to_share(struct stat_interval logits)
{
    return (struct stat_interval){logistic(logits.low), logistic(logits.high)};
}

static double t_p(double t, double df, enum stat_alternative alternative)
{
    if (alternative == STAT_TWO_SIDED)
        return 2 * pt(-fabs(t), df, true, false);
    return pt(t, df, alternative == STAT_LESS, false);
}

static void describe(struct stat_mixed_logit *fit, const struct solution *best, double p0, double conf,
                     enum stat_alternative alternative)
{
    const struct likelihood *v = &best->value;
    bool zero = best->at.sd == 0;
    double det = zero ? 1 : v->h00 * v->h11 - v->h01 * v->h01;
    // Covariance: minus the inverse of the Hessian; an SD of 0 is taken as known.
    double var0 = zero ? -1 / v->h00 : -v->h11 / det, var1 = zero ? 0 : -v->h00 / det,
           both = zero ? 0 : v->h01 / det;
    if (!(var0 > 0) || !(var1 >= 0))
        return;
    fit->state = zero ? STAT_MIXED_SD_ZERO : STAT_MIXED_FITTED;
    fit->intercept = best->at.intercept;
    fit->sd = best->at.sd;
    fit->log_likelihood = v->value;
    fit->std_error = sqrt(var0);
    fit->df = (double)fit->people - 1;
    fit->t = (fit->intercept - log(p0 / (1 - p0))) / fit->std_error;
    fit->p_value = t_p(fit->t, fit->df, alternative);
    fit->intercept_ci = around(fit->intercept, fit->std_error, fit->df, conf, alternative);
    fit->conditional = logistic(fit->intercept);
    fit->conditional_ci = to_share(fit->intercept_ci);
    struct mean mean = mean_preference(best->at);
    double variance = mean.by_intercept * mean.by_intercept * var0 + 2 * mean.by_intercept * mean.by_sd * both +
                      mean.by_sd * mean.by_sd * var1;
    double spread = mean.share * (1 - mean.share);
    fit->population = mean.share;
    fit->population_ci = to_share(
        around(log(mean.share / (1 - mean.share)), sqrt(variance) / spread, fit->df, conf, alternative));
}

static int by_counts(const void *x, const void *y)
{
    const struct group *a = x, *b = y;
    int order = (a->n > b->n) - (a->n < b->n);
    return order ? order : (a->k > b->k) - (a->k < b->k);
}

// Groups of people with the same counts; returns how many. `out` has room for `count`.
static size_t make_groups(const struct stat_person *people, size_t count, struct group *out)
{
    size_t used = 0, groups = 0;
    for (size_t i = 0; i < count; i++)
        if (people[i].n)
            out[used++] = (struct group){people[i].k, people[i].n, 1};
    qsort(out, used, sizeof *out, by_counts);
    for (size_t i = 0; i < used; i++) {
        if (groups && by_counts(&out[groups - 1], &out[i]) == 0)
            out[groups - 1].people++;
        else
            out[groups++] = out[i];
    }
    return groups;
}

static enum stat_mixed_state check(const struct stat_person *people, size_t count,
                                   const struct stat_people *sum, double p0, double conf)
{
    if (!sum->ok || !(p0 > 0 && p0 < 1) || !(conf > 0 && conf < 1))
        return STAT_MIXED_BAD;
    if (sum->people < 2)
        return STAT_MIXED_TOO_FEW;
    if (sum->k == 0 || sum->k == sum->n)
        return STAT_MIXED_ALL_SAME;
    if (sum->most_n < 2)
        return STAT_MIXED_ONE_EACH;
    for (size_t i = 0; i < count; i++)
        if (people[i].k > 0 && people[i].k < people[i].n)
            return STAT_MIXED_FITTED;
    return STAT_MIXED_SPLIT;
}

struct stat_mixed_logit stat_mixed_logit(const struct stat_person *people, size_t count,
                                         const struct stat_mixed_options *options)
{
    const struct stat_mixed_options defaults = {0};
    const struct stat_mixed_options *o = options ? options : &defaults;
    double p0 = o->p0 == 0 ? 0.5 : o->p0, conf = o->conf == 0 ? 0.95 : o->conf; // exactly 0 is "not set"
    const double none = (double)NAN;
    struct stat_people sum = stat_people_sum(people, count);
    struct stat_mixed_logit fit = {STAT_MIXED_BAD, sum.people,   none, none,        none,
                                   none,           none,         none, none,        {none, none},
                                   none,           {none, none}, none, {none, none}};
    enum stat_mixed_state state = check(people, count, &sum, p0, conf);
    struct group *groups = state == STAT_MIXED_FITTED ? malloc(count * sizeof *groups) : NULL;
    if (!groups) {
        fit.state = state == STAT_MIXED_FITTED ? STAT_MIXED_BAD : state;
        return fit;
    }
    size_t group_count = make_groups(people, count, groups);
    struct solution best = maximise(groups, group_count, &sum);
    if (best.converged)
        describe(&fit, &best, p0, conf, o->alternative);
    free(groups);
    return fit;
}

const char *stat_mixed_words(enum stat_mixed_state state)
{
    static const char *const words[] = {
        [STAT_MIXED_FITTED] = "",
        [STAT_MIXED_SD_ZERO] = "the SD between people is estimated as 0",
        [STAT_MIXED_ONE_EACH] = "not estimable with one answer per person",
        [STAT_MIXED_ALL_SAME] = "separation: all answers are the same, the intercept has no bound",
        [STAT_MIXED_SPLIT] = "separation: nobody ever changed their choice, the SD has no bound",
        [STAT_MIXED_TOO_FEW] = "not estimable with fewer than two people",
        [STAT_MIXED_BAD] = "not fitted",
    };
    return words[state];
}
