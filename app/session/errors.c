#include "app/session/errors.h"

#include "app/session/measure.h"
#include "renderer/mode.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LINE = 1024, ERRORS_FILE_LINES = 4096 };

struct line {
    char scene[64];
    double error;
    const struct mode *mode;
    char parameters[PLAN_JSON];
};

struct table {
    struct line *lines; // owned
    size_t count;
};

static bool read_line(const char *file, int number, char *text, struct line *out, char *error,
                      size_t error_size)
{
    char why[256] = "";
    struct mode_choice choice;
    char *scene = text, *value = strchr(text, ','), *option = value ? strchr(value + 1, ',') : NULL,
         *end = NULL;
    if (!option) {
        snprintf(error, error_size, "%s:%d: a line is SCENE,ERROR,MODE[:p=v,...]", file, number);
        return false;
    }
    *value++ = *option++ = '\0';
    out->error = strtod(value, &end);
    if (end == value || *end || !(out->error >= 0.0) || !isfinite(out->error)) {
        snprintf(error, error_size, "%s:%d: '%s' is no error; it is a number from 0 up", file, number, value);
        return false;
    }
    if (!mode_parse(option, &choice, why, sizeof why)) {
        snprintf(error, error_size, "%s:%d: %s", file, number, why);
        return false;
    }
    if (strlen(scene) >= sizeof out->scene) {
        snprintf(error, error_size, "%s:%d: the scene's name is longer than %zu bytes", file, number,
                 sizeof out->scene - 1);
        return false;
    }
    strcpy(out->scene, scene);
    out->mode = choice.mode;
    return mode_parameters_json(&choice, out->parameters, sizeof out->parameters);
}

static bool read_table(struct table *table, const char *path, char *error, size_t error_size)
{
    char text[LINE];
    *table = (struct table){0};
    if (!*path)
        return true;
    FILE *file = fopen(path, "r");
    table->lines = calloc(ERRORS_FILE_LINES, sizeof *table->lines);
    if (!file || !table->lines) {
        snprintf(error, error_size, "the errors file '%s' cannot be read: %s", path, strerror(errno));
        if (file)
            fclose(file);
        return false;
    }
    bool good = true;
    for (int number = 1; good && fgets(text, sizeof text, file); number++) {
        text[strcspn(text, "\r\n")] = '\0';
        if (!*text || *text == '#')
            continue;
        if (table->count == ERRORS_FILE_LINES) {
            snprintf(error, error_size, "%s:%d: more than %d lines", path, number, ERRORS_FILE_LINES);
            good = false;
        } else {
            good = read_line(path, number, text, &table->lines[table->count], error, error_size);
            table->count += good;
        }
    }
    fclose(file);
    return good;
}

// Two parameter lists mean the same option; the plan's and the mode table's JSON may be spelt differently.
static bool same_option(const struct plan_condition *condition, const struct line *line)
{
    struct mode_choice choice = {.mode = line->mode};
    char parameters[PLAN_JSON];
    if (strcmp(condition->mode, line->mode->name) != 0)
        return false;
    for (uint32_t i = 0; i < line->mode->parameter_count; i++)
        choice.values[i] = condition->values[i];
    return mode_parameters_json(&choice, parameters, sizeof parameters) &&
           strcmp(parameters, line->parameters) == 0;
}

static double from_table(const struct table *table, const struct plan_condition *condition, const char *scene)
{
    for (size_t i = 0; i < table->count; i++)
        if (strcmp(table->lines[i].scene, scene) == 0 && same_option(condition, &table->lines[i]))
            return table->lines[i].error;
    return NAN;
}

static bool find(const struct plan *plan, struct store *store, const struct store_error_key *key,
                 int32_t condition, const char *scene, const struct table *table, double *out, char *error,
                 size_t error_size)
{
    struct store_error why;
    *out = NAN;
    if (key->condition_id == key->reference_id)
        *out = 0.0;
    else if (store_get_measured_error(store, key, out, &why) != STORE_OK) {
        snprintf(error, error_size, "%s", why.text);
        return false;
    }
    if (isnan(*out))
        *out = from_table(table, &plan->conditions[condition], scene);
    if (!isnan(*out))
        return true;
    snprintf(error, error_size,
             "the study file holds no measured error of %s %s on '%s'; run one session with --display headless "
             "first, or "
             "give --observer sim:errors=FILE",
             plan->conditions[condition].mode, plan->conditions[condition].parameters, key->scene);
    return false;
}

static uint32_t scene_of(const struct plan *plan, const char *scene)
{
    uint32_t i = 0;
    while (strcmp(plan->protocol->scenes[i], scene) != 0)
        i++;
    return i;
}

bool errors_init(struct errors *errors, const struct plan *plan, struct store *store,
                 const int64_t *condition_ids, int64_t reference_id, const char *const *specs, const char *file,
                 char *error, size_t error_size)
{
    struct table table = {0};
    // Thousands of trials share a few options and scenes: each pair is looked up once. NAN: not yet.
    size_t pairs = (size_t)plan->condition_count * plan->protocol->scene_count;
    double *known = malloc((pairs + 1) * sizeof *known);
    *errors = (struct errors){.plan = plan,
                              .slots = calloc((size_t)plan->trial_count * 2 + 1, sizeof *errors->slots)};
    bool good = known && errors->slots && read_table(&table, file, error, error_size);
    for (size_t i = 0; good && i < pairs; i++)
        known[i] = NAN;
    for (size_t i = 0; good && i < 2 * (size_t)plan->trial_count; i++) {
        const struct plan_trial *trial = &plan->trials[i / 2];
        int32_t condition = trial->option[i % 2];
        if (condition < 0)
            continue;
        uint32_t scene = scene_of(plan, trial->scene);
        double *value = &known[(size_t)condition * plan->protocol->scene_count + scene];
        struct store_error_key key = {.condition_id = condition_ids[condition],
                                      .reference_id = reference_id,
                                      .scene = specs[scene],
                                      .metric = MEASURE_METRIC};
        if (isnan(*value))
            good = find(plan, store, &key, condition, trial->scene, &table, value, error, error_size);
        errors->slots[i] = *value;
    }
    free(table.lines);
    free(known);
    if (!good)
        errors_finish(errors);
    return good;
}

void errors_finish(struct errors *errors)
{
    free(errors->slots);
    errors->slots = NULL;
}

struct observer_errors errors_of(const struct errors *errors, uint32_t trial)
{
    struct observer_errors of = {{0.0, 0.0}};
    if (trial < errors->plan->trial_count)
        for (int slot = 0; slot < 2; slot++)
            of.slot[slot] = errors->slots[2 * trial + (uint32_t)slot];
    return of;
}
