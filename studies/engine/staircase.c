// Up-down methods and the face all adaptive methods share; sources, rules and units in staircase.h.
#include "studies/engine/staircase.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct staircase {
    struct staircase_desc desc;
    uint32_t trials, reversals;
    // up-down
    double level;
    int direction;  // of the last move: +1 easier, -1 harder, 0 none yet
    uint32_t right; // in a row at this level
    uint32_t kept;  // reversals made with the last step size
    double sum;     // of their levels (logarithms on logarithmic levels)
    double sum_but_first;
    struct quest_plus *quest; // owned; NULL for up-down
};

struct staircase_method {
    const char *name;
    bool (*check)(const struct staircase_desc *desc, char *error, size_t error_size);
    void (*answer)(struct staircase *staircase, struct staircase_step *step);
    uint32_t right_needed; // up-down: right answers that make it harder
    bool weighted;         // wrong answers step by another size
    bool posterior;        // has a struct quest_plus
};

static bool fail(char *error, size_t error_size, const char *format, ...) __attribute__((format(printf, 3, 4)));

static bool fail(char *error, size_t error_size, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error, error_size, format, arguments);
    va_end(arguments);
    return false;
}

static bool logarithmic(const struct staircase_desc *desc)
{
    return desc->level.spacing == QUEST_PLUS_LOG;
}

static bool check_steps(const struct staircase_desc *desc, char *error, size_t error_size)
{
    if (desc->step_count == 0 || desc->step_count > STAIRCASE_STEPS)
        return fail(error, error_size, "%u step sizes are given; give 1 to %d", desc->step_count,
                    STAIRCASE_STEPS);
    double least = logarithmic(desc) ? 1 : 0;
    double most = logarithmic(desc) ? desc->level.max / desc->level.min : desc->level.max - desc->level.min;
    for (uint32_t i = 0; i < desc->step_count; i++) {
        if (!(desc->steps[i] > least))
            return fail(error, error_size, "step %u is %g; %s", i + 1, desc->steps[i],
                        logarithmic(desc) ? "on logarithmic levels a step is a factor above 1"
                                          : "a step is above 0");
        if (!(desc->steps[i] <= most))
            return fail(error, error_size, "step %u is %g; from min to max it is only %g", i + 1,
                        desc->steps[i], most);
    }
    return true;
}

static bool check_model_left_out(const struct staircase_desc *desc, char *error, size_t error_size)
{
    const struct quest_plus_model *model = &desc->model;
    if (model->family || model->outcomes || model->threshold.count || model->slope.count ||
        model->guess.count || model->lapse.count || desc->threshold || desc->level.count)
        return fail(error, error_size,
                    "%s has no psychometric function; family, outcomes and grids are for quest_plus",
                    desc->method->name);
    return true;
}

static bool check_up_down(const struct staircase_desc *desc, char *error, size_t error_size)
{
    if (!isfinite(desc->start) || desc->start < desc->level.min || desc->start > desc->level.max)
        return fail(error, error_size, "start is %g; it must lie between min %g and max %g", desc->start,
                    desc->level.min, desc->level.max);
    if (!check_steps(desc, error, error_size) || !check_model_left_out(desc, error, error_size))
        return false;
    if (desc->reversals == 0 && desc->trials == 0)
        return fail(error, error_size, "nothing stops it; give reversals, trials or both");
    // A turn takes at least one trial, and the first move is none.
    uint32_t trials = desc->trials ? desc->trials : STAIRCASE_TRIALS;
    if (desc->reversals >= trials)
        return fail(error, error_size, "%u reversals cannot come in %u trials", desc->reversals, trials);
    if (desc->reversals > 0 && desc->reversals < desc->step_count + 1)
        return fail(
            error, error_size,
            "%u reversals with %u step sizes give no estimate; it takes 2 with the last size, so at least %u",
            desc->reversals, desc->step_count, desc->step_count + 1);
    if (desc->method->weighted && !(desc->target > 0 && desc->target < 1))
        return fail(error, error_size, "target is %g; it is a share of right answers above 0 and below 1",
                    desc->target);
    if (!desc->method->weighted && desc->target != 0)
        return fail(error, error_size, "target is %g; 1up2down always goes to 0.707, weighted has a target",
                    desc->target);
    return true;
}

static struct quest_plus_desc quest_desc(const struct staircase_desc *desc)
{
    return (struct quest_plus_desc){
        .level = desc->level, .falling = desc->larger == STAIRCASE_LARGER_HARDER, .model = desc->model};
}

static bool check_quest(const struct staircase_desc *desc, char *error, size_t error_size)
{
    struct quest_plus_desc quest = quest_desc(desc);
    if (desc->reversals > 0)
        return fail(error, error_size, "quest_plus has no reversals; stop it by trials");
    if (desc->trials == 0)
        return fail(error, error_size, "nothing stops it; give trials");
    if (desc->start != 0 || desc->step_count > 0 || desc->target != 0)
        return fail(error, error_size,
                    "quest_plus chooses every level itself; start, steps and target are for up-down methods");
    if (!quest_plus_check(&quest, error, error_size))
        return false;
    if (desc->threshold >= desc->model.outcomes)
        return fail(error, error_size, "threshold %u is not there; %u outcomes have %u", desc->threshold,
                    desc->model.outcomes, desc->model.outcomes - 1);
    return true;
}

bool staircase_check(const struct staircase_desc *desc, char *error, size_t error_size)
{
    const struct quest_plus_grid *level = &desc->level;
    if (!desc->method)
        return fail(error, error_size, "no method is given; it is 1up2down, weighted or quest_plus");
    if (desc->larger != STAIRCASE_LARGER_EASIER && desc->larger != STAIRCASE_LARGER_HARDER)
        return fail(error, error_size, "say whether larger levels are easier or harder");
    if (!isfinite(level->min) || !isfinite(level->max) || !(level->min < level->max))
        return fail(error, error_size, "levels go from %g to %g; min must be below max, both finite",
                    level->min, level->max);
    if (logarithmic(desc) && !(level->min > 0))
        return fail(error, error_size, "levels are logarithmic; min is %g and must be above 0", level->min);
    if (desc->trials > STAIRCASE_TRIALS_MOST)
        return fail(error, error_size, "%u trials are more than %d", desc->trials, STAIRCASE_TRIALS_MOST);
    return desc->method->check(desc, error, error_size);
}

// The level one step on, easier (+1) or harder (-1).
static double stepped(const struct staircase *staircase, int direction)
{
    const struct staircase_desc *desc = &staircase->desc;
    uint32_t last = desc->step_count - 1;
    double step = desc->steps[staircase->reversals < last ? staircase->reversals : last];
    double weight = desc->method->weighted && direction > 0 ? desc->target / (1 - desc->target) : 1;
    bool up = (direction > 0) == (desc->larger == STAIRCASE_LARGER_EASIER);
    double level = staircase->level;
    if (logarithmic(desc)) {
        double factor = weight == 1 ? step : pow(step, weight);
        level = up ? level * factor : level / factor;
    } else
        level += (up ? 1 : -1) * step * weight;
    return fmin(fmax(level, desc->level.min), desc->level.max);
}

static void count_reversal(struct staircase *staircase, double level)
{
    double value = logarithmic(&staircase->desc) ? log(level) : level;
    if (++staircase->reversals < staircase->desc.step_count)
        return; // a larger step made it
    staircase->sum += value;
    if (staircase->kept++ > 0)
        staircase->sum_but_first += value;
}

static double up_down_estimate(const struct staircase *staircase)
{
    bool odd = staircase->kept % 2 == 1;
    uint32_t even = staircase->kept - odd;
    if (even == 0)
        return (double)NAN;
    double mean = (odd ? staircase->sum_but_first : staircase->sum) / even;
    return logarithmic(&staircase->desc) ? exp(mean) : mean;
}

static void answer_up_down(struct staircase *staircase, struct staircase_step *step)
{
    staircase->right = step->outcome ? staircase->right + 1 : 0;
    int direction = !step->outcome ? +1 : staircase->right >= staircase->desc.method->right_needed ? -1 : 0;
    if (direction != 0) {
        staircase->right = 0;
        double next = stepped(staircase, direction);
        if (next != staircase->level) {
            step->reversal = staircase->direction == -direction;
            if (step->reversal)
                count_reversal(staircase, step->level);
            staircase->direction = direction;
            // The turn itself already takes the smaller step.
            staircase->level = stepped(staircase, direction);
        }
    }
    step->estimate = up_down_estimate(staircase);
    step->sd = (double)NAN;
}

static void answer_quest(struct staircase *staircase, struct staircase_step *step)
{
    uint32_t threshold = staircase->desc.threshold ? staircase->desc.threshold : 1;
    quest_plus_outcome(staircase->quest, step->outcome);
    step->estimate = quest_plus_mean(staircase->quest, QUEST_PLUS_THRESHOLD + threshold - 1, &step->sd);
}

static const struct staircase_method one_up_two_down = {
    .name = "1up2down", .check = check_up_down, .answer = answer_up_down, .right_needed = 2};
static const struct staircase_method weighted = {
    .name = "weighted", .check = check_up_down, .answer = answer_up_down, .right_needed = 1, .weighted = true};
static const struct staircase_method quest_plus = {
    .name = "quest_plus", .check = check_quest, .answer = answer_quest, .posterior = true};
const struct staircase_method *const staircase_methods[] = {&one_up_two_down, &weighted, &quest_plus, NULL};

const struct staircase_method *staircase_find_method(const char *name)
{
    for (size_t i = 0; staircase_methods[i]; i++)
        if (strcmp(staircase_methods[i]->name, name) == 0)
            return staircase_methods[i];
    return NULL;
}

const char *staircase_method_name(const struct staircase_method *method)
{
    return method->name;
}

struct staircase *staircase_create(const struct staircase_desc *desc)
{
    char sentence[1];
    if (!staircase_check(desc, sentence, sizeof sentence))
        return NULL;
    struct staircase *staircase = calloc(1, sizeof *staircase);
    if (!staircase)
        return NULL;
    staircase->desc = *desc;
    staircase->level = desc->start;
    if (desc->trials == 0)
        staircase->desc.trials = STAIRCASE_TRIALS;
    struct quest_plus_desc quest = quest_desc(desc);
    if (desc->method->posterior && !(staircase->quest = quest_plus_create(&quest))) {
        free(staircase);
        return NULL;
    }
    return staircase;
}

void staircase_destroy(struct staircase *staircase)
{
    if (!staircase)
        return;
    quest_plus_destroy(staircase->quest);
    free(staircase);
}

double staircase_level(const struct staircase *staircase)
{
    return staircase->quest ? quest_plus_level(staircase->quest) : staircase->level;
}

bool staircase_done(const struct staircase *staircase)
{
    const struct staircase_desc *desc = &staircase->desc;
    return staircase->trials >= desc->trials ||
           (desc->reversals > 0 && staircase->reversals >= desc->reversals);
}

uint32_t staircase_outcomes(const struct staircase *staircase)
{
    return staircase->quest ? staircase->desc.model.outcomes : 2;
}

bool staircase_outcome(struct staircase *staircase, uint32_t outcome, struct staircase_step *out_step)
{
    if (staircase_done(staircase) || outcome >= staircase_outcomes(staircase))
        return false;
    *out_step = (struct staircase_step){.level = staircase_level(staircase), .outcome = outcome};
    staircase->desc.method->answer(staircase, out_step);
    staircase->trials++;
    return true;
}

uint32_t staircase_trials(const struct staircase *staircase)
{
    return staircase->trials;
}

const struct quest_plus *staircase_quest(const struct staircase *staircase)
{
    return staircase->quest;
}
