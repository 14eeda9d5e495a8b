// Psychometric functions and grids of QUEST+; equations and units in quest_plus.h.
#include "studies/engine/quest_plus_state.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

// F(z) and 1 - F(z), each to full relative precision: the small one is never a difference from 1.
struct tails {
    double lower, upper;
};

struct quest_plus_family {
    const char *name;
    bool logarithmic; // on ln x whatever the levels' spacing
    struct tails (*tails)(double z);
};

static struct tails logistic_tails(double z)
{
    double e = exp(-fabs(z)), large = 1 / (1 + e), small = e / (1 + e);
    return z >= 0 ? (struct tails){large, small} : (struct tails){small, large};
}

static struct tails normal_tails(double z)
{
    const double root_half = 0.70710678118654752440; // sqrt(1/2)
    return (struct tails){0.5 * erfc(-z * root_half), 0.5 * erfc(z * root_half)};
}

static struct tails gumbel_tails(double z)
{
    double t = exp(z);
    return (struct tails){-expm1(-t), exp(-t)};
}

static const struct quest_plus_family logistic = {"logistic", false, logistic_tails};
static const struct quest_plus_family weibull = {"weibull", true, gumbel_tails};
static const struct quest_plus_family normal = {"normal", false, normal_tails};
static const struct quest_plus_family gumbel = {"gumbel", false, gumbel_tails};
const struct quest_plus_family *const quest_plus_families[] = {&logistic, &weibull, &normal, &gumbel, NULL};

const struct quest_plus_family *quest_plus_find_family(const char *name)
{
    for (size_t i = 0; quest_plus_families[i]; i++)
        if (strcmp(quest_plus_families[i]->name, name) == 0)
            return quest_plus_families[i];
    return NULL;
}

const char *quest_plus_family_name(const struct quest_plus_family *family)
{
    return family->name;
}

double quest_plus_grid_value(const struct quest_plus_grid *grid, uint32_t index)
{
    if (index == 0)
        return grid->min;
    if (index + 1 >= grid->count)
        return grid->max;
    double along = (double)index / (double)(grid->count - 1);
    if (grid->spacing == QUEST_PLUS_LOG)
        return exp(log(grid->min) + along * (log(grid->max) - log(grid->min)));
    return grid->min + along * (grid->max - grid->min);
}

static bool on_log_axis(const struct quest_plus_desc *desc)
{
    return desc->model.family->logarithmic || desc->level.spacing == QUEST_PLUS_LOG;
}

// P(at least this) - P(at least the next), from the tails that are small.
static double between(struct tails this, struct tails next)
{
    return this.lower > 0.5 && next.upper < 0.5 ? next.upper - this.upper : this.lower - next.lower;
}

void quest_plus_probabilities(const struct quest_plus_desc *desc, double level, const double *set, double *out)
{
    bool logarithmic = on_log_axis(desc);
    uint32_t outcomes = desc->model.outcomes;
    double guess = outcomes == 2 ? set[QUEST_PLUS_GUESS] : 0, lapse = set[QUEST_PLUS_LAPSE];
    double x = logarithmic ? log(level) : level,
           slope = desc->falling ? -set[QUEST_PLUS_SLOPE] : set[QUEST_PLUS_SLOPE];
    struct tails this = {1, 0}; // every outcome is at least 0
    for (uint32_t k = 0; k < outcomes; k++) {
        struct tails next = {0, 1}; // none is at least K
        if (k + 1 < outcomes) {
            double threshold = set[QUEST_PLUS_THRESHOLD + k];
            next = desc->model.family->tails(slope * (x - (logarithmic ? log(threshold) : threshold)));
        }
        double base = outcomes > 2 ? lapse / outcomes : k == 0 ? lapse : guess;
        double p = base + (1 - guess - lapse) * between(this, next);
        out[k] = p < DBL_MIN ? DBL_MIN : p;
        this = next;
    }
}

// Choices of outcomes - 1 thresholds out of the grid: the binomial coefficient.
static double threshold_choices(const struct quest_plus_model *model)
{
    uint32_t n = model->threshold.count, k = model->outcomes - 1;
    double choices = 1;
    if (k > n)
        return 0;
    for (uint32_t i = 1; i <= (k < n - k ? k : n - k) && choices < 1e18; i++)
        choices = choices * (n - i + 1) / i; // stays whole
    return choices;
}

double quest_plus_sets(const struct quest_plus_model *model)
{
    return threshold_choices(model) * model->slope.count * (model->outcomes == 2 ? model->guess.count : 1) *
           model->lapse.count;
}

double quest_plus_doubles(const struct quest_plus_desc *desc)
{
    double outcomes = desc->model.outcomes, levels = desc->level.count;
    // Per set: probabilities and their entropy by level, its values, log-posterior and posterior.
    double per_set = levels * (outcomes + 1) + (outcomes + 2) + 2;
    return quest_plus_sets(&desc->model) * per_set + levels;
}

// The next choice of k out of n in lexicographic order; false after the last.
static bool next_choice(uint32_t *order, uint32_t k, uint32_t n)
{
    uint32_t i = k;
    while (i > 0 && order[i - 1] == n - k + i - 1)
        i--;
    if (i == 0)
        return false;
    order[i - 1]++;
    for (; i < k; i++)
        order[i] = order[i - 1] + 1;
    return true;
}

void quest_plus_fill_sets(const struct quest_plus_model *model, bool falling, uint32_t *order, double *out)
{
    uint32_t k = model->outcomes - 1, n = model->threshold.count;
    uint32_t guesses = model->outcomes == 2 ? model->guess.count : 1;
    for (uint32_t i = 0; i < k; i++)
        order[i] = i;
    do {
        for (uint32_t s = 0; s < model->slope.count; s++)
            for (uint32_t g = 0; g < guesses; g++)
                for (uint32_t l = 0; l < model->lapse.count; l++, out += model->outcomes + 2) {
                    out[QUEST_PLUS_SLOPE] = quest_plus_grid_value(&model->slope, s);
                    out[QUEST_PLUS_GUESS] = model->outcomes == 2 ? quest_plus_grid_value(&model->guess, g) : 0;
                    out[QUEST_PLUS_LAPSE] = quest_plus_grid_value(&model->lapse, l);
                    for (uint32_t i = 0; i < k; i++) // the easiest first
                        out[QUEST_PLUS_THRESHOLD + i] =
                            quest_plus_grid_value(&model->threshold, falling ? n - 1 - order[i] : order[i]);
                }
    } while (next_choice(order, k, n));
}

static bool fail(char *error, size_t error_size, const char *format, ...) __attribute__((format(printf, 3, 4)));

static bool fail(char *error, size_t error_size, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error, error_size, format, arguments);
    va_end(arguments);
    return false;
}

static bool check_grid(const struct quest_plus_grid *grid, const char *name, double low, double high,
                       char *error, size_t error_size)
{
    if (grid->count == 0)
        return fail(error, error_size, "the grid of %s is empty; give min, max and count", name);
    if (!isfinite(grid->min) || !isfinite(grid->max))
        return fail(error, error_size, "the grid of %s goes from %g to %g; both must be finite", name,
                    grid->min, grid->max);
    if (grid->min < low || grid->max > high)
        return fail(error, error_size, "the grid of %s goes from %g to %g; it must lie between %g and %g", name,
                    grid->min, grid->max, low, high);
    if (grid->count == 1 && grid->min != grid->max)
        return fail(error, error_size,
                    "the grid of %s has one value but goes from %g to %g; give it a 'count' of 2 or more", name,
                    grid->min, grid->max);
    if (grid->count > 1 && !(grid->min < grid->max))
        return fail(error, error_size, "the grid of %s has %u values; min %g must be below max %g", name,
                    grid->count, grid->min, grid->max);
    if (grid->spacing == QUEST_PLUS_LOG && !(grid->min > 0))
        return fail(error, error_size, "the grid of %s is logarithmic; min is %g and must be above 0", name,
                    grid->min);
    return true;
}

// Beyond these, differences of two values overflow. No study comes near.
#define GRID_MOST 1e300

static bool check_model(const struct quest_plus_model *model, char *error, size_t error_size)
{
    if (!model->family)
        return fail(error, error_size, "QUEST+ has no family; it is logistic, weibull, normal or gumbel");
    if (model->outcomes < 2)
        return fail(error, error_size, "QUEST+ has %u outcomes; it needs at least 2", model->outcomes);
    if (!check_grid(&model->threshold, "threshold", -GRID_MOST, GRID_MOST, error, error_size) ||
        !check_grid(&model->slope, "slope", -GRID_MOST, GRID_MOST, error, error_size) ||
        !check_grid(&model->lapse, "lapse", 0, 1, error, error_size))
        return false;
    if (model->threshold.count < model->outcomes - 1)
        return fail(error, error_size,
                    "%u outcomes need %u thresholds in order; the grid of threshold has %u values",
                    model->outcomes, model->outcomes - 1, model->threshold.count);
    if (!(model->slope.min > 0))
        return fail(error, error_size,
                    "the grid of slope begins at %g; slopes are above 0, whether larger is harder or easier",
                    model->slope.min);
    if (model->outcomes > 2 && model->guess.count > 0)
        return fail(error, error_size, "guess is for two outcomes; leave it out with %u", model->outcomes);
    if (model->outcomes == 2 && !check_grid(&model->guess, "guess", 0, 1, error, error_size))
        return false;
    double guess = model->outcomes == 2 ? model->guess.max : 0;
    if (!(guess + model->lapse.max < 1))
        return fail(error, error_size,
                    "guess up to %g and lapse up to %g leave nothing to the level; their sum must be below 1",
                    guess, model->lapse.max);
    return true;
}

bool quest_plus_check(const struct quest_plus_desc *desc, char *error, size_t error_size)
{
    if (!check_model(&desc->model, error, error_size) ||
        !check_grid(&desc->level, "level", -GRID_MOST, GRID_MOST, error, error_size))
        return false;
    if (desc->level.count < 2)
        return fail(error, error_size,
                    "the grid of level has one value; QUEST+ needs at least 2 to choose from");
    if (on_log_axis(desc) && !(desc->level.min > 0 && desc->model.threshold.min > 0))
        return fail(error, error_size,
                    "levels begin at %g and thresholds at %g; on a logarithmic axis (%s) both are above 0",
                    desc->level.min, desc->model.threshold.min,
                    desc->model.family->logarithmic ? desc->model.family->name : "logarithmic levels");
    double bytes = quest_plus_doubles(desc) * sizeof(double);
    if (!(bytes < 1e15)) // the count of sets is no longer exact
        return fail(error, error_size,
                    "the grids make more parameter sets than can be counted; at most %.0f MiB of tables, so "
                    "make them coarser",
                    QUEST_PLUS_BYTES / 1048576);
    if (!(bytes <= QUEST_PLUS_BYTES))
        return fail(
            error, error_size,
            "the grids make %.0f parameter sets and tables of %.0f MiB; at most %.0f MiB, so make them coarser",
            quest_plus_sets(&desc->model), bytes / 1048576, QUEST_PLUS_BYTES / 1048576);
    return true;
}
