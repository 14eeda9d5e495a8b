#include "analysis/stats/thurstone.h"

#include "analysis/stats/draw.h"
#include "analysis/stats/quantile.h"

#include <Rmath.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = STAT_JOD_OPTIONS, ROUNDS = 100, HALVINGS = 40 };

static const double sigma = 1.48260221850560186; // 1 / qnorm(0.75)

struct counts {
    size_t options;
    double wins[MOST][MOST]; // i over j
};

// --- who can be scaled ---

// reach[i][j]: i beat j, or beat one who reaches j.
static void set_reach(const struct counts *c, bool reach[MOST][MOST])
{
    for (size_t i = 0; i < c->options; i++)
        for (size_t j = 0; j < c->options; j++)
            reach[i][j] = i == j || c->wins[i][j] > 0;
    for (size_t k = 0; k < c->options; k++)
        for (size_t i = 0; i < c->options; i++)
            for (size_t j = 0; j < c->options; j++)
                reach[i][j] = reach[i][j] || (reach[i][k] && reach[k][j]);
}

static enum stat_jod_status status_of(bool reach[MOST][MOST], size_t i, size_t reference)
{
    if (i == reference)
        return STAT_JOD_REFERENCE;
    if (reach[i][reference] && reach[reference][i])
        return STAT_JOD_OK;
    return reach[i][reference] ? STAT_JOD_ALWAYS : reach[reference][i] ? STAT_JOD_NEVER : STAT_JOD_ALONE;
}

// --- maximum likelihood ---

static double log_likelihood(const struct counts *c, const size_t *member, size_t count, const double *score)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        for (size_t j = 0; j < count; j++)
            if (c->wins[member[i]][member[j]] > 0)
                sum += c->wins[member[i]][member[j]] * pnorm((score[i] - score[j]) / sigma, 0, 1, true, true);
    return sum;
}

// Gradient and negative Hessian over members 1 to count - 1; member 0 is the reference.
static void derivatives(const struct counts *c, const size_t *member, size_t count, const double *score,
                        double *gradient, double *hessian)
{
    memset(gradient, 0, count * sizeof *gradient);
    memset(hessian, 0, count * count * sizeof *hessian);
    for (size_t i = 0; i < count; i++)
        for (size_t j = 0; j < count; j++) {
            double wins = c->wins[member[i]][member[j]], z = (score[i] - score[j]) / sigma;
            if (!(wins > 0))
                continue;
            double mills = exp(dnorm(z, 0, 1, true) - pnorm(z, 0, 1, true, true));
            double first = wins * mills / sigma, second = wins * mills * (mills + z) / (sigma * sigma);
            gradient[i] += first;
            gradient[j] -= first;
            hessian[i * count + i] += second;
            hessian[j * count + j] += second;
            hessian[i * count + j] -= second;
            hessian[j * count + i] -= second;
        }
}

// Solves for the step by Cholesky's factors; false where the matrix is not positive.
static bool solve(double *h, double *g, size_t count)
{
    for (size_t j = 1; j < count; j++)
        for (size_t i = j; i < count; i++) {
            double sum = h[i * count + j];
            for (size_t k = 1; k < j; k++)
                sum -= h[i * count + k] * h[j * count + k];
            if (i == j && !(sum > 0))
                return false;
            h[i * count + j] = i == j ? sqrt(sum) : sum / h[j * count + j];
        }
    for (size_t i = 1; i < count; i++) {
        for (size_t k = 1; k < i; k++)
            g[i] -= h[i * count + k] * g[k];
        g[i] /= h[i * count + i];
    }
    for (size_t i = count - 1; i >= 1; i--) {
        for (size_t k = i + 1; k < count; k++)
            g[i] -= h[k * count + i] * g[k];
        g[i] /= h[i * count + i];
    }
    return true;
}

// Newton's method with steps halved until the likelihood, which is concave, no longer falls.
static bool maximise(const struct counts *c, const size_t *member, size_t count, double *score, double *work)
{
    double *gradient = work, *hessian = work + count, *next = work + count + count * count;
    memset(score, 0, count * sizeof *score);
    double here = log_likelihood(c, member, count, score);
    for (int round = 0; round < ROUNDS; round++) {
        derivatives(c, member, count, score, gradient, hessian);
        if (!solve(hessian, gradient, count))
            return false;
        double largest = 0, there = here;
        for (size_t i = 1; i < count; i++)
            largest = fmax(largest, fabs(gradient[i]));
        for (int halving = 0; halving < HALVINGS; halving++) {
            next[0] = 0;
            for (size_t i = 1; i < count; i++)
                next[i] = score[i] + ldexp(gradient[i], -halving);
            there = log_likelihood(c, member, count, next);
            if (there >= here - 1e-13 * fabs(here)) // rounding, near the maximum
                break;
        }
        memcpy(score, next, count * sizeof *score);
        here = there;
        if (largest < 1e-10)
            return true;
    }
    return false;
}

// Scores of all options; infinite where answers go one way only, NaN where there are none or the search failed.
static void scale(const struct counts *c, size_t reference, double *out, enum stat_jod_status *out_status,
                  double *work)
{
    bool reach[MOST][MOST];
    size_t member[MOST] = {reference}, count = 1;
    double score[MOST];
    set_reach(c, reach);
    for (size_t i = 0; i < c->options; i++) {
        out_status[i] = status_of(reach, i, reference);
        out[i] = i == reference                     ? 0
                 : out_status[i] == STAT_JOD_ALWAYS ? (double)INFINITY
                 : out_status[i] == STAT_JOD_NEVER  ? -(double)INFINITY
                                                    : (double)NAN;
        if (out_status[i] == STAT_JOD_OK)
            member[count++] = i;
    }
    if (count > 1 && maximise(c, member, count, score, work))
        for (size_t i = 0; i < count; i++)
            out[member[i]] = score[i];
}

// --- bootstrap ---

static void count_wins(struct counts *c, const struct stat_preference *answers, size_t count,
                       const uint32_t *weight)
{
    memset(c->wins, 0, sizeof c->wins);
    for (size_t i = 0; i < count; i++)
        c->wins[answers[i].winner][answers[i].loser] += weight ? weight[answers[i].person] : 1;
}

struct resampling {
    size_t people, *list; // indices that answered
    uint32_t *weight;     // by person
    double *scores;       // by option and replicate
};

static void resample(const struct stat_jod_desc *d, const struct stat_preference *answers, size_t count,
                     const struct resampling *r, struct counts *c, double *work)
{
    double score[MOST];
    enum stat_jod_status status[MOST];
    for (size_t replicate = 0; replicate < d->replicates; replicate++) {
        for (size_t i = 0; i < r->people; i++)
            r->weight[r->list[i]] = 0;
        for (size_t i = 0; i < r->people; i++)
            r->weight[r->list[(size_t)(stat_draw(d->seed, replicate, i) * (double)r->people)]]++;
        count_wins(c, answers, count, r->weight);
        scale(c, d->reference, score, status, work);
        for (size_t i = 0; i < d->options; i++)
            r->scores[i * d->replicates + replicate] = score[i];
    }
}

static void set_interval(const struct stat_jod_desc *d, double *scores, struct stat_jod *out)
{
    double conf = d->conf == 0 ? 0.95 : d->conf;
    size_t found = 0;
    for (size_t i = 0; i < d->replicates; i++) {
        out->below += scores[i] == -(double)INFINITY;
        out->above += scores[i] == (double)INFINITY;
        if (!isnan(scores[i]))
            scores[found++] = scores[i];
    }
    stat_sort(scores, found);
    out->failed = d->replicates - found;
    out->unreliable = 20 * out->failed > d->replicates;
    if (found == 0)
        return;
    out->alike = scores[found - 1] - scores[0] <= 1e-9; // the scores' own precision
    if (out->alike)
        return;
    out->interval.low = stat_quantile(scores, found, (1 - conf) / 2);
    out->interval.high = stat_quantile(scores, found, (1 + conf) / 2);
    out->unreliable = out->unreliable || !(out->interval.low <= out->score && out->score <= out->interval.high);
}

static void bootstrap(const struct stat_jod_desc *d, const struct stat_preference *answers, size_t count,
                      struct counts *c, double *work, struct stat_jod *out)
{
    size_t most = 0;
    for (size_t i = 0; i < count; i++)
        most = answers[i].person + 1 > most ? answers[i].person + 1 : most;
    struct resampling r = {.list = malloc(most * sizeof *r.list),
                           .weight = calloc(most, sizeof *r.weight),
                           .scores = malloc(d->options * d->replicates * sizeof *r.scores)};
    for (size_t i = 0; r.weight && i < count; i++)
        r.weight[answers[i].person] = 1;
    for (size_t i = 0; r.list && r.weight && i < most; i++)
        if (r.weight[i])
            r.list[r.people++] = i;
    if (r.list && r.weight && r.scores && r.people > 1) {
        resample(d, answers, count, &r, c, work);
        for (size_t i = 0; i < d->options; i++)
            if (out[i].status == STAT_JOD_OK)
                set_interval(d, r.scores + i * d->replicates, &out[i]);
    }
    free(r.list);
    free(r.weight);
    free(r.scores);
}

static bool input_ok(const struct stat_preference *answers, size_t count, const struct stat_jod_desc *d)
{
    if (d->options == 0 || d->options > MOST || d->reference >= d->options || !(d->conf >= 0 && d->conf < 1))
        return false;
    for (size_t i = 0; i < count; i++)
        if (answers[i].winner >= d->options || answers[i].loser >= d->options ||
            answers[i].winner == answers[i].loser)
            return false;
    return true;
}

bool stat_jod_scale(const struct stat_preference *answers, size_t count, const struct stat_jod_desc *d,
                    struct stat_jod *out)
{
    if (!input_ok(answers, count, d))
        return false;
    struct counts *c = calloc(1, sizeof *c);
    double *work = malloc((MOST * MOST + 2 * MOST) * sizeof *work);
    bool ok = c && work;
    if (ok) {
        double score[MOST];
        enum stat_jod_status status[MOST];
        c->options = d->options;
        count_wins(c, answers, count, NULL);
        scale(c, d->reference, score, status, work);
        for (size_t i = 0; i < d->options; i++) {
            out[i] = (struct stat_jod){.status = status[i],
                                       .score = isfinite(score[i]) ? score[i] : (double)NAN,
                                       .interval = {(double)NAN, (double)NAN}};
            for (size_t j = 0; j < d->options; j++) {
                out[i].won += (int64_t)c->wins[i][j];
                out[i].n += (int64_t)(c->wins[i][j] + c->wins[j][i]);
            }
        }
        if (count > 0 && d->replicates > 0)
            bootstrap(d, answers, count, c, work, out);
    }
    free(c);
    free(work);
    return ok;
}

double stat_jod_log_likelihood(const struct stat_preference *answers, size_t count, const double *scores)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += pnorm((scores[answers[i].winner] - scores[answers[i].loser]) / sigma, 0, 1, true, true);
    return sum;
}
