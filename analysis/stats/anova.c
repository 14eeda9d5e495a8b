// Within-participant analysis of variance by orthonormal contrasts. Each person's cells are turned along every
// factor by Helmert's matrix: coefficient 0 of an axis is its mean, the others are contrasts. An effect is the
// set of coefficients that are contrasts in its factors and means in the rest, so sums of squares, errors and
// the contrasts' covariance S fall out of one pass.
//   F: univariate, mixed model of repeated measures (Winer, Brown & Michels 1991, chapters 4 and 7).
//   Greenhouse, S. W. & Geisser, S. (1959), Psychometrika 24, 95-112: tr(S)^2 / (q tr(S^2)), q the effect's df.
//   Huynh, H. & Feldt, L. S. (1976), J. Educational Statistics 1, 69-82: (N q e - 2) / (q (N - 1 - q e)).
//   Lecoutre, B. (1991), J. Educational Statistics 16, 371-372, corrects it for several groups of people; with
//   one group, all there is here, his form and theirs are the same, and R's.
//   Generalised eta squared: Olejnik, S. & Algina, J. (2003), Psychological Methods 8, 434-447; Bakeman, R.
//   (2005), Behavior Research Methods 37, 379-384: every factor here is manipulated.
// Values are taken less their first one, so that 1e9 in all of them changes nothing.
#include "analysis/stats/anova.h"

#include <Rmath.h>
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static size_t cells_of(const size_t *levels, size_t factors)
{
    size_t cells = 1;
    for (size_t j = 0; j < factors; j++) {
        if (levels[j] < 2 || cells > SIZE_MAX / 64 / levels[j])
            return 0;
        cells *= levels[j];
    }
    return cells;
}

// x[0], x[stride], ...: the mean times sqrt(n), then x[k] against the mean of those before it. Keeps lengths.
static void helmert(double *x, size_t n, size_t stride)
{
    double sum = x[0];
    for (size_t k = 1; k < n; k++) {
        double value = x[k * stride], mean = sum / (double)k;
        sum += value;
        x[k * stride] = (value - mean) * sqrt((double)k / (double)(k + 1));
    }
    x[0] = sum / sqrt((double)n);
}

static void turn(double *cells, size_t cell_count, const size_t *levels, size_t factors)
{
    size_t stride = cell_count;
    for (size_t j = 0; j < factors; j++) {
        stride /= levels[j];
        for (size_t i = 0; i < cell_count; i++)
            if (i / stride % levels[j] == 0)
                helmert(cells + i, levels[j], stride);
    }
}

// The effect a coefficient belongs to: the factors along which it is a contrast.
static unsigned effect_of(size_t coefficient, const size_t *levels, size_t factors)
{
    unsigned mask = 0;
    for (size_t j = factors; j-- > 0; coefficient /= levels[j])
        mask |= coefficient % levels[j] ? 1u << j : 0;
    return mask;
}

// Sums over the coefficients of one effect: people times squared means, and deviations from them; those are
// left in `turned`.
static void sum_squares(double *turned, size_t people, size_t cells, const unsigned *masks,
                        struct stat_anova_effect *e)
{
    for (size_t c = 0; c < cells; c++) {
        double sum = 0, rest = 0;
        if (masks[c] != e->factors)
            continue;
        for (size_t i = 0; i < people; i++)
            sum += turned[i * cells + c];
        double mean = sum / (double)people;
        for (size_t i = 0; i < people; i++) {
            double d = turned[i * cells + c] -= mean;
            e->ss_error += d * d;
            rest += d;
        }
        e->ss += mean * mean * (double)people;
        e->ss_error -= rest * rest / (double)people; // the mean's rounding, as in moments.c
        e->df++;
    }
    e->ss_error = fmax(0, e->ss_error);
    e->df_error = e->df * ((double)people - 1);
}

// tr(S^2) times (people - 1)^2: the squared products of any two people's deviations.
static double trace_of_square(const double *turned, size_t people, size_t cells, const unsigned *masks,
                              unsigned mask)
{
    double sum = 0;
    for (size_t i = 0; i < people; i++)
        for (size_t k = 0; k <= i; k++) {
            double product = 0;
            for (size_t c = 0; c < cells; c++)
                product += masks[c] == mask ? turned[i * cells + c] * turned[k * cells + c] : 0;
            sum += (i == k ? 1 : 2) * product * product;
        }
    return sum;
}

static void test_effect(struct stat_anova_effect *e, double people, double trace_square, double scale)
{
    e->f = e->p_value = e->p_gg = e->p_hf = e->epsilon_gg = e->epsilon_hf = e->eta2_partial = (double)NAN;
    if (!(sqrt(e->ss_error / e->df_error) > 10 * DBL_EPSILON * scale)) // constant, as ttest.c has it
        return;
    e->f = e->ss / e->df / (e->ss_error / e->df_error);
    e->p_value = pf(e->f, e->df, e->df_error, false, false);
    e->eta2_partial = e->ss / (e->ss + e->ss_error);
    double q = e->df, gg = e->ss_error * e->ss_error / (q * trace_square);
    double hf = (people * q * gg - 2) / (q * (people - 1 - q * gg));
    e->epsilon_gg = q == 1 ? 1 : fmin(1, gg);
    // q e reaches people - 1 only where S has no rank left to estimate it from
    e->epsilon_hf = q == 1 ? 1 : people - 1 - q * gg > 1e-9 * people ? fmin(1, hf) : (double)NAN;
    e->p_gg = pf(e->f, q * e->epsilon_gg, e->df_error * e->epsilon_gg, false, false);
    e->p_hf = pf(e->f, q * e->epsilon_hf, e->df_error * e->epsilon_hf, false, false);
}

static void list_effects(struct stat_anova *out, size_t factors)
{
    for (size_t size = 1; size <= factors; size++)
        for (unsigned mask = 1; mask < 1u << factors; mask++) {
            size_t bits = 0;
            for (size_t j = 0; j < factors; j++)
                bits += mask >> j & 1;
            if (bits == size)
                out->effects[out->effect_count++].factors = mask;
        }
}

static void analyse(double *turned, size_t people, size_t cells, const unsigned *masks, double scale,
                    struct stat_anova *out)
{
    struct stat_anova_effect all = {0}; // coefficient 0 is a person's mean
    sum_squares(turned, people, cells, masks, &all);
    out->ss_people = all.ss_error;
    out->df_people = all.df_error;
    double errors = all.ss_error;
    for (size_t i = 0; i < out->effect_count; i++) {
        struct stat_anova_effect *e = &out->effects[i];
        sum_squares(turned, people, cells, masks, e);
        test_effect(e, (double)people, trace_of_square(turned, people, cells, masks, e->factors), scale);
        errors += e->ss_error;
    }
    for (size_t i = 0; i < out->effect_count; i++) {
        double ss = out->effects[i].ss;
        out->effects[i].eta2_generalised = ss + errors > 0 ? ss / (ss + errors) : (double)NAN;
    }
}

bool stat_anova_within(const double *values, size_t people, const size_t *levels, size_t factors,
                       struct stat_anova *out)
{
    *out = (struct stat_anova){0};
    if (factors < 1 || factors > STAT_ANOVA_FACTORS || people < 2)
        return false;
    size_t cells = cells_of(levels, factors);
    if (cells == 0 || people > SIZE_MAX / 64 / cells)
        return false;
    double *turned = malloc(people * cells * sizeof *turned), scale = 0;
    unsigned *masks = malloc(cells * sizeof *masks);
    bool ok = turned && masks;
    for (size_t i = 0; ok && i < people * cells; i++) {
        turned[i] = values[i] - values[0];
        scale = fmax(scale, fabs(values[i]));
    }
    for (size_t i = 0; ok && i < people; i++)
        turn(turned + i * cells, cells, levels, factors);
    for (size_t c = 0; ok && c < cells; c++)
        masks[c] = effect_of(c, levels, factors);
    if (ok) {
        list_effects(out, factors);
        analyse(turned, people, cells, masks, scale, out);
    }
    free(turned);
    free(masks);
    return ok;
}
