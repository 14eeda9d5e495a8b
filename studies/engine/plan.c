// A participant's trials put together from what draw.c drew.
#include "studies/engine/plan.h"

#include "studies/engine/draw.h"
#include "studies/protocol/text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct maker {
    struct plan *plan;
    struct draw_person person;
    struct draw *draws; // one per block
    bool bare;
};

const char *plan_slot_name(enum plan_slot slot)
{
    return slot == PLAN_SLOT_A ? "a" : slot == PLAN_SLOT_B ? "b" : NULL;
}

const char *plan_trial_kind(const struct plan_trial *trial)
{
    return trial->role == PROTOCOL_MAIN ? protocol_kind_name(trial->kind) : protocol_role_name(trial->role);
}

double plan_level(double level)
{
    char digits[32];
    snprintf(digits, sizeof digits, "%.9g", level);
    return strtod(digits, NULL);
}

struct protocol_option plan_level_option(const struct plan *plan, const struct plan_trial *trial, double level)
{
    const struct protocol_block *block = &plan->protocol->blocks[trial->block];
    struct protocol_option option = block->cells[trial->cell].option[0];
    option.values[block->staircase.parameter] = plan_level(level);
    return option;
}

static bool same_values(const double *a, const double *b)
{
    for (uint32_t i = 0; i < CATALOGUE_PARAMETERS; i++)
        if (a[i] < b[i] || a[i] > b[i])
            return false;
    return true;
}

// Index of a condition, added where it is new; -1: its JSON does not fit.
static int32_t condition_index(const struct maker *maker, const struct protocol_option *option)
{
    struct plan *plan = maker->plan;
    for (uint32_t i = 0; i < plan->condition_count; i++)
        if (plan->conditions[i].mode_index == option->mode &&
            same_values(plan->conditions[i].values, option->values))
            return (int32_t)i;
    struct plan_condition *made = &plan->conditions[plan->condition_count];
    made->mode = plan->protocol->catalogue->modes[option->mode].name;
    made->mode_index = option->mode;
    memcpy(made->values, option->values, sizeof made->values);
    if (!maker->bare &&
        !protocol_option_json(plan->protocol, option, made->parameters, sizeof made->parameters))
        return -1;
    return (int32_t)plan->condition_count++;
}

static const struct protocol_cell *cell_of(const struct protocol_block *block, uint32_t cell)
{
    return cell < block->cell_count ? &block->cells[cell] : &block->extras[cell - block->cell_count].cell;
}

// A rating of one of two options says which, and whether it is the first or the second of its pair.
static void drawn_option_json(const struct protocol *protocol, uint32_t index, uint32_t option,
                              struct text *text)
{
    const struct protocol_block *block = &protocol->blocks[index];
    bool first = false;
    for (uint32_t i = 0; i < protocol->block_count; i++)
        first = first || protocol->blocks[i].complement_of == (int32_t)index;
    text_add(text, ",\"option\":");
    text_json_string(text, protocol->options[block->options[option]].name);
    if (first || block->complement_of >= 0)
        text_add(text, ",\"order\":\"%s\"", first ? "first" : "second");
}

static bool factors_json(const struct maker *maker, const struct protocol_cell *cell, struct plan_trial *trial,
                         const struct draw *draw, uint32_t scene)
{
    const struct protocol *protocol = maker->plan->protocol;
    const struct protocol_block *block = &protocol->blocks[trial->block];
    struct text text = {0};
    if (block->kind == PROTOCOL_RATE && block->option_count == 2)
        drawn_option_json(protocol, trial->block, draw->option, &text);
    text_add(&text, "%s", cell->labels);
    for (uint32_t f = 0; f < block->factor_count && trial->cell < block->cell_count; f++)
        text_add(&text, ",\"%s\":%s", block->factors[f].name, block->factors[f].level[cell->level[f]]);
    text_add(&text, "%s", protocol->scene_labels[scene]);
    char *members = text_take(&text);
    struct text whole = {0};
    text_add(&whole, "{%s}", members && *members ? members + 1 : "");
    free(members);
    return text_copy(&whole, trial->factors, sizeof trial->factors);
}

// What a trial's settings say beyond the block's: where its target moves, what is played back.
static bool settings_json(const struct maker *maker, struct plan_trial *trial)
{
    if (maker->bare)
        return true;
    struct text text = {0};
    if (trial->resolved->fixation == PROTOCOL_FIXATION_MOVING)
        text_add(&text, ",\"target_seed\":%u", trial->target_seed);
    if (trial->prerendered[0] || trial->prerendered[1])
        text_add(&text, ",\"prerendered\":[%s%s%s]", trial->prerendered[0] ? "\"a\"" : "",
                 trial->prerendered[0] && trial->prerendered[1] ? "," : "",
                 trial->prerendered[1] ? "\"b\"" : "");
    if (trial->spheres[0] > 0)
        text_add(&text, ",\"spheres\":%u", trial->spheres[0] + trial->spheres[1]);
    char *more = text_take(&text);
    bool ok = protocol_settings_json(maker->plan->protocol, trial->kind, trial->resolved, more ? more : "",
                                     trial->settings, sizeof trial->settings);
    free(more);
    return ok;
}

static void draw_details(const struct maker *maker, const struct protocol_block *block,
                         struct plan_trial *trial)
{
    struct random_stream stream = draw_trial_stream(&maker->person, trial->ordinal);
    const uint32_t *range = trial->resolved->spheres;
    for (uint32_t i = 0; i < (trial->kind == PROTOCOL_SEQUENTIAL ? 2u : 1u) && range[1] > 0; i++)
        trial->spheres[i] = range[0] + random_below(&stream, range[1] - range[0] + 1);
    for (uint32_t i = 0; i < block->adjust_count; i++) { // in whole steps: the same on every machine
        const struct protocol_adjust *adjust = &block->adjusts[i];
        double steps = floor((adjust->start_max - adjust->start_min) / adjust->step + 1e-9);
        uint32_t most = steps < 1e9 ? (uint32_t)steps : 1000000000u;
        trial->adjust_start[i] = adjust->start_min + adjust->step * random_below(&stream, most + 1);
    }
}

static bool place_options(struct maker *maker, const struct protocol_block *block,
                          const struct protocol_cell *cell, const struct draw *draw, uint32_t which,
                          struct plan_trial *trial)
{
    const struct protocol_option *option = cell->option;
    if (!protocol_kind_is_pair(block->kind)) {
        trial->option[0] = condition_index(maker, &option[draw->option]);
        trial->option[1] = -1;
        trial->test_slot = draw->option == 0 ? PLAN_SLOT_A : PLAN_SLOT_NONE;
        trial->first_shown = PLAN_SLOT_A;
        trial->prerendered[0] = option[draw->option].playback == PROTOCOL_PRERENDERED;
        return trial->option[0] >= 0;
    }
    uint32_t side = draw->pair[which] & 1, reference_first = draw->pair[which] >> 1;
    trial->test_slot = (enum plan_slot)side;
    // One after the other: the first is called A.
    trial->first_shown =
        trial->kind == PROTOCOL_SEQUENTIAL ? PLAN_SLOT_A : (enum plan_slot)(side ^ reference_first);
    for (uint32_t i = 0; i < 2; i++) {
        trial->option[side ^ i] = condition_index(maker, &option[i]);
        trial->prerendered[side ^ i] = option[i].playback == PROTOCOL_PRERENDERED;
    }
    return trial->option[0] >= 0 && trial->option[1] >= 0;
}

static bool make_trial(struct maker *maker, uint32_t index, uint32_t place, struct plan_trial *trial)
{
    struct plan *plan = maker->plan;
    const struct protocol *protocol = plan->protocol;
    const struct protocol_block *block = &protocol->blocks[index];
    const struct draw *draw = &maker->draws[index];
    uint32_t which = draw->order[place], extra = which - draw->count;
    *trial = (struct plan_trial){.ordinal = ++plan->trial_count, .block = index, .kind = block->kind};
    if (which < draw->count) {
        trial->cell = draw->cell[which / block->repetitions];
        trial->repetition = which % block->repetitions;
    } else {
        bool is_catch = extra >= block->extras[0].count;
        trial->cell = block->cell_count + is_catch;
        trial->repetition = extra - (is_catch ? block->extras[0].count : 0);
    }
    const struct protocol_cell *cell = cell_of(block, trial->cell);
    trial->role = cell->role;
    trial->scene = protocol->scenes[draw->scene[which]];
    trial->resolved = &cell->settings;
    trial->question = trial->resolved->asked_count > 0 && trial->kind != PROTOCOL_ADJUST
                          ? &protocol->questions[trial->resolved->asked[0]]
                          : NULL;
    trial->fixation = protocol_fixation_name(trial->resolved->fixation);
    trial->seed = draw_trial_seed(&maker->person, trial->ordinal);
    trial->target_seed = draw_target_seed(&maker->person, index, trial->cell);
    trial->break_before = block->break_every > 0 && place > 0 && place % block->break_every == 0;
    draw_details(maker, block, trial);
    return place_options(maker, block, cell, draw, which, trial) &&
           factors_json(maker, cell, trial, draw, draw->scene[which]) && settings_json(maker, trial);
}

// Conditions in the protocol's order, so that every participant of a study has the same list.
static bool list_conditions(const struct maker *maker)
{
    const struct protocol *protocol = maker->plan->protocol;
    for (uint32_t b = 0; b < protocol->block_count; b++) {
        const struct protocol_block *block = &protocol->blocks[b];
        for (uint32_t i = 0; i < block->cell_count + 2; i++) {
            if (i >= block->cell_count && block->extras[i - block->cell_count].count == 0)
                continue;
            for (uint32_t k = 0; k < block->option_count; k++)
                if (condition_index(maker, &cell_of(block, i)->option[k]) < 0)
                    return false;
        }
    }
    return true;
}

static bool fill(struct maker *maker)
{
    struct plan *plan = maker->plan;
    const struct protocol *protocol = plan->protocol;
    uint32_t total = 0, cells = 0;
    for (uint32_t b = 0; b < protocol->block_count; b++) {
        struct draw *draw = &maker->draws[b];
        draw_block(protocol, &maker->person, b, maker->draws);
        total += draw->total;
        cells += protocol->blocks[b].cell_count + 2;
        plan->imbalance = draw->excess > plan->imbalance ? draw->excess : plan->imbalance;
    }
    plan->trials = calloc(total, sizeof *plan->trials);
    plan->conditions = calloc(2 * (size_t)cells, sizeof *plan->conditions);
    if (!plan->trials || !plan->conditions || !list_conditions(maker))
        return false;
    for (uint32_t b = 0; b < protocol->block_count; b++)
        for (uint32_t place = 0; place < maker->draws[b].total; place++)
            if (!make_trial(maker, b, place, &plan->trials[plan->trial_count]))
                return false;
    return true;
}

static struct plan *create(const struct protocol *protocol, uint64_t seed, uint32_t number, bool bare)
{
    struct plan *plan = calloc(1, sizeof *plan);
    struct maker maker = {plan, draw_person(protocol, seed, number),
                          calloc(protocol->block_count, sizeof *maker.draws), bare};
    bool ok = plan && maker.draws;
    if (ok) {
        *plan =
            (struct plan){.protocol = protocol, .seed = seed, .number = number, .group = maker.person.group};
        ok = fill(&maker);
    }
    free(maker.draws);
    if (ok)
        return plan;
    plan_destroy(plan);
    return NULL;
}

struct plan *plan_create(const struct protocol *protocol, uint64_t seed, uint32_t number)
{
    return create(protocol, seed, number, false);
}

struct plan *plan_create_bare(const struct protocol *protocol, uint64_t seed, uint32_t number)
{
    return create(protocol, seed, number, true);
}

void plan_destroy(struct plan *plan)
{
    if (!plan)
        return;
    free(plan->conditions);
    free(plan->trials);
    free(plan);
}
