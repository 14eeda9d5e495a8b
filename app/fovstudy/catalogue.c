#include "app/fovstudy/catalogue.h"

#include "app/session/stage.h"
#include "renderer/mode.h"
#include "stimuli/builtin/builtin.h"
#include "studies/engine/plan.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

_Static_assert((int)CATALOGUE_PARAMETERS >= (int)MODE_PARAMETERS, "a protocol holds every parameter of a mode");

static const char *const off_on[] = {"off", "on", NULL};
static const struct catalogue_parameter settings[] = {
    [STUDY_MOVING_OBJECTS] = {.name = "moving_objects",
                              .unit = "",
                              .max = 1,
                              .choices = off_on,
                              .about = "objects of the scene move"},
    [STUDY_SSAO] = {.name = "ssao", .unit = "", .max = 1, .choices = off_on, .about = "ambient occlusion"},
    [STUDY_TAA] = {.name = "taa", .unit = "", .max = 1, .choices = off_on, .about = "temporal antialiasing"},
};

bool study_bind_scene(struct bound_scene *bound, size_t *count, const char *text, char *error,
                      size_t error_size)
{
    size_t length = strcspn(text, "=");
    if (text[length] != '=' || length == 0 || !text[length + 1]) {
        snprintf(error, error_size, "'%s' binds no scene; write NAME=FILE.glb or NAME=town:triangles=200000",
                 text);
        return false;
    }
    if (*count == STUDY_BOUND_SCENES || length >= sizeof bound->name) {
        snprintf(error, error_size, "at most %d scenes are bound, with names of at most %zu bytes",
                 STUDY_BOUND_SCENES, sizeof bound->name - 1);
        return false;
    }
    struct bound_scene *next = &bound[(*count)++];
    memcpy(next->name, text, length);
    next->name[length] = '\0';
    next->spec = text + length + 1;
    return true;
}

// The last binding of a name holds.
const char *study_scene_spec(const struct bound_scene *bound, size_t count, const char *name)
{
    for (size_t i = count; i > 0; i--)
        if (strcmp(bound[i - 1].name, name) == 0)
            return bound[i - 1].spec;
    return name;
}

const char *study_shown_scene(const struct protocol *protocol, uint32_t scene, const struct bound_scene *bound,
                              size_t count)
{
    const char *name = protocol->scenes[scene], *spec = study_scene_spec(bound, count, name);
    return spec == name && *protocol->stand_ins[scene] ? protocol->stand_ins[scene] : spec;
}

// The modes of the papers, README "The modes".
static const char *const planned_modes[STUDY_PLANNED_MODES] = {
    "regular",    "time_warped",     "vrs",           "adaptive",
    "ray_traced", "ray_traced_full", "phase_aligned", "latency_inset"};

static void list_missing(struct study_names *names)
{
    size_t count = 0;
    for (size_t i = 0; i < STUDY_PLANNED_MODES; i++) {
        size_t m = 0;
        while (modes[m] && strcmp(modes[m]->name, planned_modes[i]) != 0)
            m++;
        if (!modes[m])
            names->missing[count++] = planned_modes[i];
    }
}

static size_t count_modes(size_t *out_parameters)
{
    size_t count = 0;
    for (*out_parameters = 0; modes[count]; count++)
        *out_parameters += modes[count]->parameter_count;
    return count;
}

static void copy_modes(struct study_names *names)
{
    struct catalogue_parameter *next = names->parameters;
    for (size_t m = 0; modes[m]; m++) {
        names->modes[m] = (struct catalogue_mode){.name = modes[m]->name,
                                                  .parameters = next,
                                                  .parameter_count = modes[m]->parameter_count,
                                                  .about = modes[m]->description,
                                                  .foveated = modes[m]->foveated};
        for (uint32_t i = 0; i < modes[m]->parameter_count; i++) {
            const struct mode_parameter *from = &modes[m]->parameters[i];
            *next++ = (struct catalogue_parameter){.name = from->name,
                                                   .unit = from->unit,
                                                   .min = from->min,
                                                   .max = from->max,
                                                   .fallback = from->fallback,
                                                   .choices = from->choices,
                                                   .about = from->description};
        }
    }
}

bool study_names_init(struct study_names *names, const struct bound_scene *bound, size_t count)
{
    size_t parameter_count = 0, mode_count = count_modes(&parameter_count), built_in = 0;
    while (builtin_scenes[built_in].name)
        built_in++;
    *names = (struct study_names){
        .modes = calloc(mode_count + 1, sizeof *names->modes),
        .parameters = calloc(parameter_count + 1, sizeof *names->parameters),
        .scenes = calloc(built_in + count + 1, sizeof *names->scenes),
    };
    if (!names->modes || !names->parameters || !names->scenes) {
        study_names_finish(names);
        return false;
    }
    copy_modes(names);
    list_missing(names);
    for (size_t i = 0; i < built_in; i++)
        names->scenes[i] = builtin_scenes[i].name;
    for (size_t i = 0; i < count; i++)
        names->scenes[built_in + i] = bound[i].name;
    names->catalogue = (struct catalogue){
        .modes = names->modes,
        .mode_count = (uint32_t)mode_count,
        .missing_modes = names->missing,
        .scenes = names->scenes,
        .scene_count = (uint32_t)(built_in + count),
        .settings = settings,
        .setting_count = sizeof settings / sizeof settings[0],
    };
    return true;
}

void study_names_finish(struct study_names *names)
{
    free(names->modes);
    free(names->parameters);
    free(names->scenes);
    *names = (struct study_names){0};
}

// Both ends of what a trial's course may set, each with each, on top of a planned option.
static bool ends_agree(const struct protocol_block *block, const struct mode_choice *planned, char *error,
                       size_t error_size)
{
    uint32_t count = block->kind == PROTOCOL_ADJUST ? block->adjust_count : 1;
    bool ok = true;
    for (uint32_t ends = 0; ends < 1u << count && ok; ends++) {
        struct mode_choice choice = *planned;
        for (uint32_t i = 0; i < count; i++) {
            bool upper = ends >> i & 1;
            const struct protocol_adjust *adjust = &block->adjusts[i];
            const struct quest_plus_grid *level = &block->staircase.desc.level;
            if (block->kind == PROTOCOL_ADJUST)
                choice.values[adjust->parameter] = upper ? adjust->max : adjust->min;
            else
                choice.values[block->staircase.parameter] = upper ? level->max : level->min;
        }
        ok = mode_check(&choice, error, error_size);
    }
    if (!ok) {
        size_t used = strlen(error);
        snprintf(error + used, error_size - used, "; block '%s' may come to that: set narrower ends",
                 block->name);
    }
    return ok;
}

static void add_place(struct protocol_place at, char *error, size_t error_size)
{
    char why[480]; // the longest sentence of a mode is far shorter
    snprintf(why, sizeof why, "%.479s", error);
    snprintf(error, error_size, "%u:%u: %s", at.line, at.column, why);
}

// Where a condition comes from: the option that is so as it is written, else the block that makes it so.
static void place_condition(const struct plan *plan, uint32_t index, char *error, size_t error_size)
{
    const struct protocol *protocol = plan->protocol;
    const struct plan_condition *condition = &plan->conditions[index];
    for (uint32_t i = 0; i < protocol->option_count; i++)
        if (protocol->options[i].mode == condition->mode_index &&
            memcmp(protocol->options[i].values, condition->values, sizeof condition->values) == 0) {
            add_place(protocol->option_places[i], error, error_size);
            return;
        }
    uint32_t block = 0; // where no trial of this group of people has it
    for (uint32_t i = 0; i < plan->trial_count; i++)
        if (plan->trials[i].option[0] == (int32_t)index || plan->trials[i].option[1] == (int32_t)index)
            block = plan->trials[i].block;
    add_place(protocol->block_places[block], error, error_size);
    size_t used = strlen(error);
    snprintf(error + used, error_size - used, "; block '%s' comes to that", protocol->blocks[block].name);
}

static bool courses_agree(const struct plan *plan, char *error, size_t error_size)
{
    bool ok = true;
    for (uint32_t i = 0; i < plan->trial_count && ok; i++) {
        struct mode_choice choice;
        const struct plan_trial *trial = &plan->trials[i];
        if (trial->kind != PROTOCOL_ADJUST && trial->kind != PROTOCOL_STAIRCASE)
            continue;
        ok = stage_choice(&plan->conditions[trial->option[trial->test_slot]], &choice) &&
             ends_agree(&plan->protocol->blocks[trial->block], &choice, error, error_size);
        if (!ok)
            add_place(plan->protocol->block_places[trial->block], error, error_size);
    }
    return ok;
}

// The conditions are the same for every participant, so the first one's plan names them all.
static bool conditions_agree(const struct protocol *protocol, char *error, size_t error_size)
{
    struct plan *plan = plan_create(protocol, protocol->seed, 0);
    if (!plan) {
        snprintf(error, error_size, "out of memory");
        return false;
    }
    bool ok = true;
    for (uint32_t i = 0; i < plan->condition_count && ok; i++) {
        struct mode_choice choice;
        ok = stage_choice(&plan->conditions[i], &choice) && mode_check(&choice, error, error_size);
        if (!ok)
            place_condition(plan, i, error, error_size);
    }
    ok = ok && courses_agree(plan, error, error_size);
    plan_destroy(plan);
    return ok;
}

// A misspelt binding would leave the built-in scene in place without a word.
static bool bindings_known(const struct protocol *protocol, const struct bound_scene *bound, size_t count,
                           char *error, size_t error_size)
{
    for (size_t b = 0; b < count; b++) {
        uint32_t i = 0;
        while (i < protocol->scene_count && strcmp(protocol->scenes[i], bound[b].name) != 0)
            i++;
        if (i < protocol->scene_count)
            continue;
        snprintf(error, error_size,
                 "--scene binds '%s', which is no scene of this protocol; it has: ", bound[b].name);
        for (i = 0; i < protocol->scene_count; i++) {
            size_t used = strlen(error);
            snprintf(error + used, error_size - used, "%s%s", i ? ", " : "", protocol->scenes[i]);
        }
        return false;
    }
    return true;
}

static struct protocol *checked(const char *path, struct protocol *protocol, const struct bound_scene *bound,
                                size_t count, char *error, size_t error_size)
{
    char why[512];
    if (!protocol)
        return NULL;
    bool agree = conditions_agree(protocol, why, sizeof why);
    if (agree && bindings_known(protocol, bound, count, why, sizeof why))
        return protocol;
    snprintf(error, error_size, agree ? "%s: %s" : "%s:%s", path, why);
    protocol_destroy(protocol);
    return NULL;
}

struct protocol *study_load(const char *path, const struct study_names *names, const struct bound_scene *bound,
                            size_t count, char *error, size_t error_size)
{
    struct protocol *protocol = protocol_load(path, &names->catalogue, error, error_size);
    return checked(path, protocol, bound, count, error, error_size);
}

struct protocol *study_parse(const char *name, const char *text, const struct study_names *names,
                             const struct bound_scene *bound, size_t count, char *error, size_t error_size)
{
    struct protocol *protocol = protocol_parse(name, text, strlen(text), &names->catalogue, error, error_size);
    return checked(name, protocol, bound, count, error, error_size);
}
