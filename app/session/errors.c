#include "app/session/errors.h"

#include "app/session/errors_table.h"
#include "renderer/mode.h"
#include "studies/protocol/text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct mode_choice choice_of(const struct plan *plan, uint32_t mode, const double *values)
{
    struct mode_choice choice = {.mode = mode_find(plan->protocol->catalogue->modes[mode].name)};
    for (uint32_t i = 0; choice.mode && i < choice.mode->parameter_count; i++)
        choice.values[i] = values[i];
    return choice;
}

static struct mode_choice planned_choice(const struct plan *plan, int32_t condition)
{
    return choice_of(plan, plan->conditions[condition].mode_index, plan->conditions[condition].values);
}

// The parameters of the tested option that the trial's course sets.
static uint32_t moving_parameters(const struct plan *plan, const struct plan_trial *trial, int slot,
                                  uint32_t out[PROTOCOL_ADJUSTED])
{
    const struct protocol_block *block = &plan->protocol->blocks[trial->block];
    if (slot != (int)trial->test_slot)
        return 0;
    if (trial->kind == PROTOCOL_STAIRCASE)
        out[0] = block->staircase.parameter;
    for (uint32_t i = 0; trial->kind == PROTOCOL_ADJUST && i < block->adjust_count; i++)
        out[i] = block->adjusts[i].parameter;
    return trial->kind == PROTOCOL_STAIRCASE ? 1 : trial->kind == PROTOCOL_ADJUST ? block->adjust_count : 0;
}

static struct errors_place place_of(const struct plan *plan, const struct plan_trial *trial,
                                    const char *const *specs)
{
    uint32_t i = 0;
    while (strcmp(plan->protocol->scenes[i], trial->scene) != 0)
        i++;
    struct errors_place place = {.scene = trial->scene, .spec = specs[i]};
    measure_metric(plan->protocol, trial->resolved, place.metric);
    return place;
}

// The option as a line of the errors file has it: what is at its default is left out, but for `named` (the
// number of parameters: none).
static void option_spec(const struct mode_choice *choice, uint32_t named, char *out, size_t out_size)
{
    struct text text = {0};
    char sign = ':';
    text_add(&text, "%s", choice->mode->name);
    for (uint32_t i = 0; i < choice->mode->parameter_count; i++) {
        const struct mode_parameter *parameter = &choice->mode->parameters[i];
        const double value = choice->values[i];
        if (i != named && !(value < parameter->fallback) && !(value > parameter->fallback))
            continue;
        text_add(&text, "%c%s=", sign, parameter->name);
        sign = ',';
        if (parameter->choices)
            text_add(&text, "%s", parameter->choices[(size_t)value]);
        else
            text_number(&text, value);
    }
    text_copy(&text, out, out_size);
}

// moving: the parameter of which two values must be known, of which `known` are; the number of parameters:
// none.
static bool missing(const struct errors *errors, const struct errors_place *place,
                    const struct mode_choice *choice, uint32_t moving, uint32_t known, char *error,
                    size_t error_size)
{
    char what[256] = "", spec[512];
    const char *settings = strchr(place->metric, ';'), *file = errors->file;
    const bool moves = moving < choice->mode->parameter_count;
    settings = settings ? settings : "";
    option_spec(choice, moving, spec, sizeof spec);
    if (moves)
        snprintf(what, sizeof what,
                 " at two values of '%s' (it has %u), which it takes to know those between them",
                 choice->mode->parameters[moving].name, known);
    if (*file)
        snprintf(
            error, error_size,
            "neither %s nor the study file holds the error of %s on '%s%s'%s; add %s '%s%s,ERROR,%s', ERROR "
            "being a number from 0 to 1",
            file, spec, place->scene, settings, what, moves ? "lines like" : "the line", place->scene, settings,
            spec);
    else
        snprintf(
            error, error_size,
            "the study file holds no measured error of %s on '%s%s'%s; run a session with --display headless "
            "first, of somebody who sees it (one of each group, where a factor is between people), or give "
            "--observer sim:errors=FILE with %s '%s%s,ERROR,%s'",
            spec, place->spec, settings, what, moves ? "lines like" : "the line", place->scene, settings, spec);
    return false;
}

static bool enough_known(const struct errors *errors, const struct errors_place *place, int32_t condition,
                         const uint32_t *parameters, uint32_t count, char *error, size_t error_size)
{
    const struct mode_choice choice = planned_choice(errors->plan, condition);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t known = 0;
        errors_table_between(errors->table, place, &choice, parameters[i], 0.0, &known);
        if (known >= 2)
            continue;
        return missing(errors, place, &choice, parameters[i], known, error, error_size);
    }
    return true;
}

static bool find_slot(struct errors *errors, uint32_t index, int slot, int32_t reference,
                      const struct errors_place *place, char *error, size_t error_size)
{
    uint32_t moving[PROTOCOL_ADJUSTED];
    const struct plan_trial *trial = &errors->plan->trials[index];
    int32_t condition = trial->option[slot];
    double *out = &errors->slots[2 * index + (uint32_t)slot];
    *out = 0.0;
    if (condition < 0)
        return true;
    uint32_t count = moving_parameters(errors->plan, trial, slot, moving);
    if (count > 0) {
        *out = (double)NAN;
        return enough_known(errors, place, condition, moving, count, error, error_size);
    }
    if (condition == reference)
        return true;
    const struct mode_choice choice = planned_choice(errors->plan, condition);
    *out = errors_table_find(errors->table, place, &choice);
    return !isnan(*out) || missing(errors, place, &choice, MODE_PARAMETERS, 0, error, error_size);
}

// The protocol's reference among the plan's conditions; -1: it is not shown.
static int32_t reference_of(const struct plan *plan)
{
    const struct protocol_option *option = &plan->protocol->options[plan->protocol->reference];
    for (uint32_t i = 0; i < plan->condition_count; i++)
        if (plan->conditions[i].mode_index == option->mode &&
            memcmp(plan->conditions[i].values, option->values, sizeof option->values) == 0)
            return (int32_t)i;
    return -1;
}

// An earlier trial that shows the same under the same settings, so that thousands of trials are looked up once.
static uint32_t same_before(const struct plan *plan, uint32_t index)
{
    const struct plan_trial *trial = &plan->trials[index];
    for (uint32_t i = index > 64 ? index - 64 : 0; i < index; i++) {
        const struct plan_trial *other = &plan->trials[i];
        if (other->resolved == trial->resolved && other->scene == trial->scene && other->kind == trial->kind &&
            other->option[0] == trial->option[0] && other->option[1] == trial->option[1] &&
            other->test_slot == trial->test_slot)
            return i;
    }
    return index;
}

bool errors_init(struct errors *errors, const struct plan *plan, struct store *store, int64_t reference_id,
                 const char *const *specs, const char *file, char *error, size_t error_size)
{
    *errors = (struct errors){.plan = plan,
                              .specs = specs,
                              .file = file,
                              .slots = calloc((size_t)plan->trial_count * 2 + 1, sizeof *errors->slots)};
    snprintf(error, error_size, "out of memory");
    if (errors->slots)
        errors->table = errors_table_read(store, reference_id, file, error, error_size);
    bool good = errors->table != NULL;
    const int32_t reference = reference_of(plan);
    for (uint32_t i = 0; good && i < plan->trial_count; i++) {
        uint32_t same = same_before(plan, i);
        if (same < i) {
            memcpy(&errors->slots[2 * i], &errors->slots[2 * same], 2 * sizeof *errors->slots);
            continue;
        }
        const struct errors_place place = place_of(plan, &plan->trials[i], specs);
        for (int slot = 0; good && slot < 2; slot++)
            good = find_slot(errors, i, slot, reference, &place, error, error_size);
    }
    if (!good)
        errors_finish(errors);
    return good;
}

void errors_finish(struct errors *errors)
{
    errors_table_destroy(errors->table);
    free(errors->slots);
    errors->table = NULL;
    errors->slots = NULL;
}

// The effects of several parameters add up: f(x, y) = f(x, y0) + f(x0, y) - f(x0, y0).
static double moving_error(const struct errors *errors, const struct machine *machine,
                           const struct plan_trial *trial, int slot)
{
    struct protocol_option option;
    uint32_t moving[PROTOCOL_ADJUSTED];
    uint32_t count = moving_parameters(errors->plan, trial, slot, moving);
    const struct errors_place place = place_of(errors->plan, trial, errors->specs);
    const struct mode_choice planned = planned_choice(errors->plan, trial->option[slot]);
    double sum = 0.0, base = 0.0;
    if (!machine_option(machine, (enum plan_slot)slot, &option))
        return 0.0;
    for (uint32_t i = 0; i < count; i++) {
        sum += errors_table_between(errors->table, &place, &planned, moving[i], option.values[moving[i]], NULL);
        if (count > 1)
            base += errors_table_between(errors->table, &place, &planned, moving[i], planned.values[moving[i]],
                                         NULL);
    }
    return fmax(0.0, sum - base * (count - 1) / count);
}

struct observer_errors errors_at(const struct errors *errors, const struct machine *machine)
{
    struct machine_view view;
    struct observer_errors of = {{0.0, 0.0}};
    machine_look(machine, &view);
    if (!view.trial)
        return of;
    size_t index = (size_t)(view.trial - errors->plan->trials);
    for (int slot = 0; slot < 2; slot++) {
        double value = errors->slots[2 * index + (size_t)slot];
        of.slot[slot] = isnan(value) ? moving_error(errors, machine, view.trial, slot) : value;
    }
    return of;
}
