#include "analysis/report/planned_data.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool same(const struct planned_cell *a, const struct planned_cell *b)
{
    return strcmp(a->series, b->series) == 0 && strcmp(a->block, b->block) == 0 &&
           strcmp(a->factors, b->factors) == 0 && strcmp(a->scene, b->scene) == 0 && a->test == b->test &&
           a->reference == b->reference;
}

static struct planned_cell *find(struct planned_data *data, const struct planned_cell *like)
{
    struct sample *sample = data->sample;
    for (size_t i = 0; i < data->cell_count; i++)
        if (same(&data->cells[i], like))
            return &data->cells[i];
    if (!sample_grow(&data->cells, data->cell_count, sizeof data->cells[0]))
        return NULL;
    struct planned_cell *cell = &data->cells[data->cell_count];
    *cell = *like;
    cell->series = sample_keep(sample, like->series);
    cell->block = sample_keep(sample, like->block);
    cell->factors = sample_keep(sample, like->factors);
    cell->scene = sample_keep(sample, like->scene);
    cell->words = sample_keep(sample, like->words);
    cell->sum = calloc(sample->person_count + 1, sizeof *cell->sum);
    cell->count = calloc(sample->person_count + 1, sizeof *cell->count);
    data->cell_count++;
    return cell->series && cell->block && cell->factors && cell->scene && cell->words && cell->sum &&
                   cell->count
               ? cell
               : NULL;
}

bool planned_data_add(struct planned_data *data, const struct planned_cell *like, size_t person, double value,
                      int64_t count)
{
    struct planned_cell *cell = find(data, like);
    if (!cell)
        return false;
    if (cell->minuend != like->minuend || cell->subtrahend != like->subtrahend)
        cell->minuend = cell->subtrahend = SAMPLE_NONE;
    cell->sum[person] += value;
    cell->count[person] += count;
    return true;
}

const char *planned_level(const struct planned_data *data, const struct planned_cell *cell, const char *factor)
{
    if (strcmp(factor, "scene") == 0 && cell->scene[0])
        return cell->scene;
    for (size_t i = 0; i < data->sample->factor_count; i++) {
        const struct sample_factor *f = &data->sample->factors[i];
        if (strcmp(f->factors, cell->factors) == 0 && strcmp(f->key, factor) == 0)
            return f->value;
    }
    return NULL;
}

// Each person's own threshold: the staircase's estimate, or of constant levels the fitted one.
static bool add_thresholds(struct planned_data *data, const struct thresholds *thresholds)
{
    for (size_t i = 0; i < thresholds->cell_count; i++) {
        const struct threshold_cell *c = &thresholds->cells[i];
        bool stairs = c->source == THRESHOLD_STAIRCASES;
        char series[160];
        snprintf(series, sizeof series, "%.100s%s", c->parameter, stairs ? "" : ", of constant levels");
        for (size_t j = 0; j < c->person_count; j++) {
            const struct threshold_person *p = &c->people[j];
            double value = stairs                         ? p->estimate
                           : p->fit.status == STAT_FIT_OK ? p->fit.function.threshold
                                                          : (double)NAN;
            if (p->person != SAMPLE_NONE && isfinite(value) &&
                !planned_data_add(data,
                                  &(struct planned_cell){.series = series,
                                                         .block = c->block,
                                                         .factors = c->factors,
                                                         .scene = "",
                                                         .test = SAMPLE_NONE,
                                                         .reference = SAMPLE_NONE,
                                                         .words = c->words},
                                  p->person, value, 1))
                return false;
        }
    }
    return true;
}

static bool add_adjusted(struct planned_data *data, const struct adjusted *adjusted)
{
    for (size_t i = 0; i < adjusted->cell_count; i++) {
        const struct adjusted_cell *c = &adjusted->cells[i];
        for (size_t j = 0; j < c->person_count; j++)
            if (!planned_data_add(data,
                                  &(struct planned_cell){.series = c->parameter,
                                                         .block = c->block,
                                                         .factors = c->factors,
                                                         .scene = "",
                                                         .test = SAMPLE_NONE,
                                                         .reference = SAMPLE_NONE,
                                                         .words = c->words},
                                  c->people[j].person, c->people[j].mean, 1))
                return false;
    }
    return true;
}

bool planned_data_load(struct planned_data *out, struct sample *sample, const struct plan *plan,
                       const struct planned_sources *sources, char *error, size_t error_size)
{
    *out = (struct planned_data){.sample = sample,
                                 .unit = plan_is(plan, NULL, "reaction", NULL) ? "s" : "",
                                 .counts = plan_is(plan, NULL, "choice", NULL)};
    snprintf(error, error_size, "not enough memory");
    if (plan_is(plan, NULL, "threshold", NULL))
        return add_thresholds(out, sources->thresholds);
    if (plan_is(plan, NULL, "adjusted", NULL))
        return add_adjusted(out, sources->adjusted);
    if (plan_is(plan, NULL, "rating", NULL))
        return planned_read_ratings(out, plan, error, error_size);
    return planned_read_trials(out, plan, error, error_size);
}

void planned_data_free(struct planned_data *data)
{
    for (size_t i = 0; i < data->cell_count; i++) {
        free(data->cells[i].sum);
        free(data->cells[i].count);
    }
    free(data->cells);
    *data = (struct planned_data){0};
}
