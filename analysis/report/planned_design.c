// How two groups lie to people: by the design of every factor in which they differ (factor_design.h), so that
// two cells lie between people as soon as one such factor does. Groups that differ in no factor are judged by
// all cells of their series.
#include "analysis/report/planned_data.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Whether what sessions planned tells a cell from all others of its series; cells may differ in options alone.
static bool told_apart(const struct planned_data *data, size_t cell)
{
    const struct planned_cell *a = &data->cells[cell];
    for (size_t i = 0; i < data->cell_count; i++) {
        const struct planned_cell *b = &data->cells[i];
        if (i != cell && strcmp(a->series, b->series) == 0 && strcmp(a->block, b->block) == 0 &&
            strcmp(a->factors, b->factors) == 0 && strcmp(a->scene, b->scene) == 0)
            return false;
    }
    return true;
}

// Fills who was to be at which level of a factor (NULL: in which cell) and who has values where; `numbers` has
// a text for each cell.
static void see(const struct planned_data *data, const char *series, const char *factor,
                struct factor_design *planned, struct factor_design *seen, char (*numbers)[24])
{
    for (size_t i = 0; i < data->cell_count; i++) {
        const struct planned_cell *cell = &data->cells[i];
        const char *level = factor ? planned_level(data, cell, factor) : numbers[i];
        snprintf(numbers[i], sizeof numbers[i], "%zu", i);
        if (strcmp(cell->series, series) != 0 || !level)
            continue;
        for (size_t p = 0; p < data->sample->person_count; p++)
            if (cell->count[p] > 0) {
                factor_design_see(planned, p, level);
                factor_design_see(seen, p, level);
            }
        if (factor || told_apart(data, i))
            factor_design_planned(planned, data->sample, cell->block, cell->factors, cell->scene, level);
    }
}

static bool add_factor(struct planned_design *out, const struct planned_data *data, const char *series,
                       const char *factor)
{
    struct factor_design planned = {0}, seen = {0};
    char(*numbers)[24] = calloc(data->cell_count + 1, sizeof *numbers);
    bool ok = numbers && factor_design_init(&planned, data->sample) && factor_design_init(&seen, data->sample);
    if (ok) {
        see(data, series, factor, &planned, &seen, numbers);
        const struct choice_design is = factor_design_decide(&planned);
        if (out->is.within)
            out->is = is;
        for (size_t p = 0; !is.within && p < data->sample->person_count; p++)
            out->stray[p] = out->stray[p] || seen.several[p];
    }
    factor_design_finish(&planned);
    factor_design_finish(&seen);
    free(numbers);
    return ok;
}

static bool known_key(const struct sample *sample, size_t factor)
{
    for (size_t i = 0; i < factor; i++)
        if (strcmp(sample->factors[i].key, sample->factors[factor].key) == 0)
            return true;
    return false;
}

// The factors in which two single cells differ.
static bool add_cells(struct planned_design *out, const struct planned_data *data,
                      const struct planned_group *a, const struct planned_group *b)
{
    bool ok = true, any = false;
    for (size_t i = 0; ok && i < data->sample->factor_count; i++) {
        const char *key = data->sample->factors[i].key;
        const char *x = planned_level(data, &data->cells[a->cells[0]], key),
                   *y = planned_level(data, &data->cells[b->cells[0]], key);
        if (known_key(data->sample, i) || strcmp(key, "trial") == 0 || !x || !y || strcmp(x, y) == 0)
            continue;
        ok = add_factor(out, data, a->series, key);
        any = true;
    }
    return ok && (any || add_factor(out, data, a->series, NULL));
}

bool planned_design_load(struct planned_design *out, const struct planned_data *data,
                         const struct planned_group *a, const struct planned_group *b)
{
    *out = (struct planned_design){.is = {.within = true},
                                   .stray = calloc(data->sample->person_count + 1, sizeof *out->stray)};
    if (out->stray && (a->factor ? add_factor(out, data, a->series, a->factor) : add_cells(out, data, a, b)))
        return true;
    planned_design_free(out);
    return false;
}

void planned_design_free(struct planned_design *design)
{
    free(design->stray);
    *design = (struct planned_design){0};
}

bool planned_design_refuses(struct planned_row *row, const struct planned_design *design, bool paired)
{
    if (design->is.within == paired)
        return false;
    snprintf(row->note, sizeof row->note,
             "not computed: %zu %s to answer at one level and %zu at several, so that it lies %s people; %s "
             "test is theirs",
             design->is.one, design->is.one == 1 ? "person was" : "people were", design->is.several,
             paired ? "between" : "within", paired ? "an unpaired" : "a paired");
    return true;
}

void planned_row_left_out(struct planned_row *row, const char *why)
{
    size_t used = strlen(row->note);
    if (row->left_out)
        snprintf(row->note + used, sizeof row->note - used, "%sleft out, people %s: %zu", used ? "; " : "", why,
                 row->left_out);
}
