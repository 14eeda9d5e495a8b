// The cases that a rehearsal's study file has: its cells of choices, or the factors of its ratings.
#include "analysis/report/choices.h"
#include "analysis/report/ratings.h"
#include "analysis/tools/arguments.h"
#include "analysis/tools/power_plan.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

// Those of a session that is analysed.
static size_t count_people(const struct sample *sample)
{
    size_t count = 0;
    for (size_t p = 0; p < sample->person_count; p++) {
        bool part = false;
        for (size_t i = 0; i < sample->session_count && !part; i++)
            part = sample->sessions[i].person == p && !sample->sessions[i].excluded;
        count += part;
    }
    return count;
}

static void name_cell(const struct choice_cell *cell, size_t everybody, char out[320])
{
    size_t none = 0;
    for (size_t i = 0; i < cell->people; i++)
        none += cell->counts[i].n == 0;
    int length = snprintf(out, 320, "%.60s: %.100s", cell->block, cell->label);
    if (cell->planned_count < everybody)
        length += snprintf(out + length, 320 - (size_t)length, " (%zu of %zu participants get this cell)",
                           cell->planned_count, everybody);
    if (cell->people < cell->planned_count)
        length += snprintf(out + length, 320 - (size_t)length, " (the answers of %zu of %zu count)",
                           cell->people, cell->planned_count);
    if (none)
        snprintf(out + length, 320 - (size_t)length, " (%zu of %zu people choose neither)", none, cell->people);
}

static int show_cell(const struct command *command, const struct power_plan *plan,
                     const struct choice_cell *cell, size_t everybody, struct json *json)
{
    char name[320];
    int64_t *choices = calloc(cell->people + 1, sizeof *choices);
    if (!choices)
        return command_fail(command, EXIT_FAILED, "not enough memory");
    for (size_t j = 0; j < cell->people; j++)
        choices[j] = cell->counts[j].n;
    name_cell(cell, everybody, name);
    bool part = cell->people < everybody; // the study's people are in it as the rehearsal's
    const struct power_case only = {.name = name,
                                    .choices = choices,
                                    .count = cell->people,
                                    .in = part ? (int64_t)cell->people : 0,
                                    .of = part ? (int64_t)everybody : 0};
    int code = power_show(command, plan, &only, json);
    free(choices);
    return code;
}

static void show_none(const struct power_plan *plan, const struct choice_cell *cell, struct json *json)
{
    static const char why[] = "not planned: everybody chose neither";
    char name[320];
    snprintf(name, sizeof name, "%.60s: %.100s", cell->block, cell->label);
    if (!plan->json) {
        printf("%s; %s\n\n", name, why);
        return;
    }
    json_open(json, NULL, '{');
    json_text(json, "cell", name);
    json_text(json, "method", why);
    json_open(json, "sizes", '[');
    json_close(json, ']');
    json_close(json, '}');
}

static int show_choices(const struct command *command, const struct power_plan *plan,
                        const struct sample *sample, const struct choices *cells, struct json *json)
{
    int code = -1;
    size_t with_choices = 0;
    const struct choice_cell *several = NULL;
    struct power_source source = {.hash = sample->data_hash};
    for (size_t i = 0; i < cells->cell_count; i++) {
        several = several || !cells->cells[i].several ? several : &cells->cells[i];
        with_choices += cells->cells[i].n > 0;
    }
    if (!with_choices)
        return command_fail(command, EXIT_FAILED, "%s: no choice was recorded, so no cell has a design",
                            store_reader_path(sample->files[0]));
    if (several && !plan->from)
        return command_fail(command, EXIT_USAGE,
                            "needs --participants N or FROM..TO: in %s: %s people choose several times, whose "
                            "power is simulated, size by size",
                            several->block, several->label);
    source.simulates = several != NULL;
    power_begin(plan, &source, json);
    for (size_t i = 0; i < cells->cell_count && code < 0; i++) {
        const struct choice_cell *cell = &cells->cells[i];
        if (cell->n > 0)
            code = show_cell(command, plan, cell, count_people(sample), json);
        else
            show_none(plan, cell, json);
    }
    return code;
}

// A complete person is enough to know a design, though not to analyse it.
static void take_design(const struct power_plan *plan, const struct factorial *f, struct power_design *out)
{
    *out = (struct power_design){.question = f->question, .block = f->block};
    if (f->factor_count == 0 || f->people == 0) {
        snprintf(out->refusal, sizeof out->refusal, "%s", f->refusal);
        return;
    }
    out->most = f->most;
    out->cells = (int64_t)f->cells;
    out->factors = f->factor_count;
    snprintf(out->left_out, sizeof out->left_out, "%s", f->dropped);
    for (size_t i = 0; i < f->factor_count; i++) {
        out->names[i] = f->factors[i].name;
        out->levels[i] = (int64_t)f->factors[i].level_count;
    }
    if (!power_design_fits(plan, out)) {
        snprintf(out->refusal, sizeof out->refusal, "--f is %g but F^2 times its %zu cells must be 100 at most",
                 plan->f, f->cells);
        out->factors = 0;
    }
}

// The levels typed hold, and the file's are said.
static int show_typed(const struct command *command, const struct power_plan *plan,
                      const struct power_source *file, struct json *json)
{
    const struct power_source source = {.designs = &plan->design, .design_count = 1};
    power_begin(plan, &source, json);
    for (size_t i = 0; i < file->design_count && !plan->json; i++) {
        char words[256];
        power_design_words(&file->designs[i], words);
        printf("%s, %s: the file has %s, which --levels overrides\n", file->designs[i].question,
               file->designs[i].block, file->designs[i].factors ? words : "no design of factors within people");
    }
    return power_show_design(command, plan, &plan->design, false, json);
}

static int show_designs(const struct command *command, const struct power_plan *plan,
                        const struct power_source *source, struct json *json)
{
    int code = -1;
    power_begin(plan, source, json);
    for (size_t i = 0; i < source->design_count && code < 0; i++) {
        const struct power_design *design = &source->designs[i];
        if (design->factors)
            code = power_show_design(command, plan, design, source->design_count > 1, json);
        else if (!plan->json)
            printf("%s, %s: not planned: %s\n\n", design->question, design->block, design->refusal);
    }
    return code;
}

static int show_ratings(const struct command *command, const struct power_plan *plan, struct sample *sample,
                        const struct factorial_list *list, struct json *json)
{
    const char *path = store_reader_path(sample->files[0]);
    struct power_design *designs = calloc(list->count + 1, sizeof *designs);
    size_t planned = 0;
    int code;
    for (size_t i = 0; designs && i < list->count; i++) {
        take_design(plan, &list->items[i], &designs[i]);
        planned += designs[i].factors > 0;
    }
    const struct power_source source = {
        .hash = sample->data_hash, .designs = designs, .design_count = list->count};
    if (!designs)
        code = command_fail(command, EXIT_FAILED, "not enough memory");
    else if (plan->design.factors)
        code = show_typed(command, plan, &source, json);
    else if (list->count == 0)
        code = command_fail(
            command, EXIT_FAILED,
            "%s: no ratings over factors were recorded, so it has no design; --levels states one", path);
    else if (planned == 0)
        code = command_fail(command, EXIT_FAILED,
                            "%s: no rated block can be planned: %s; --levels states a design", path,
                            designs[0].refusal);
    else
        code = show_designs(command, plan, &source, json);
    free(designs);
    return code;
}

int power_rehearsal(const struct command *command, const struct power_plan *plan, char **files, int count,
                    struct json *json)
{
    char error[SAMPLE_ERROR_SIZE];
    struct sample sample = {0};
    struct choices cells = {0};
    struct ratings ratings = {0};
    bool rated = !isnan(plan->f);
    int code;
    if (!sample_load(&sample, (const char *const *)files, (size_t)count, plan->simulated, NULL, error,
                     sizeof error) ||
        (rated ? !ratings_load(&ratings, &sample, 0.95, false, error, sizeof error)
               : !choices_load(&cells, &sample, 0.95, error, sizeof error)))
        code = command_fail(command, EXIT_FAILED, "%s", error);
    else if (rated)
        code = show_ratings(command, plan, &sample, &ratings.factorials, json);
    else
        code = show_choices(command, plan, &sample, &cells, json);
    choices_free(&cells);
    ratings_free(&ratings);
    sample_free(&sample);
    return code;
}
