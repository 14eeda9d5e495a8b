#include "analysis/report/adjusted.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct filling {
    struct adjusted *adjusted;
    struct sample *sample;
    size_t file;
};

static struct adjusted_cell *find_cell(struct filling *f, const struct store_adjusted_row *row)
{
    struct adjusted *a = f->adjusted;
    for (size_t i = 0; i < a->cell_count; i++)
        if (strcmp(a->cells[i].block, row->block) == 0 && strcmp(a->cells[i].factors, row->factors) == 0 &&
            strcmp(a->cells[i].parameter, row->parameter) == 0)
            return &a->cells[i];
    struct adjusted_cell cell = {.block = sample_keep(f->sample, row->block),
                                 .factors = sample_keep(f->sample, row->factors),
                                 .label = threshold_label(f->sample, row->factors, NULL, false),
                                 .words = threshold_label(f->sample, row->factors, NULL, true),
                                 .parameter = sample_keep(f->sample, row->parameter)};
    if (!cell.block || !cell.factors || !cell.label || !cell.words || !cell.parameter ||
        !sample_grow(&a->cells, a->cell_count, sizeof a->cells[0]))
        return NULL;
    a->cells[a->cell_count] = cell;
    return &a->cells[a->cell_count++];
}

static struct adjusted_person *find_person(struct adjusted_cell *cell, size_t person)
{
    for (size_t i = 0; i < cell->person_count; i++)
        if (cell->people[i].person == person)
            return &cell->people[i];
    if (!sample_grow(&cell->people, cell->person_count, sizeof cell->people[0]))
        return NULL;
    cell->people[cell->person_count] =
        (struct adjusted_person){.person = person, .low = INFINITY, .high = -INFINITY};
    return &cell->people[cell->person_count++];
}

static bool add_value(void *user, const struct store_adjusted_row *row)
{
    struct filling *f = user;
    struct adjusted *a = f->adjusted;
    size_t session = sample_find_session(f->sample, f->file, row->session_id);
    if (session == SAMPLE_NONE)
        return true;
    if (strcmp(row->status, "done") != 0) {
        a->not_done++;
        return true;
    }
    if (sample_trial_excluded(f->sample, f->file, row->trial_id)) {
        a->excluded++;
        return true;
    }
    if (!isfinite(row->value)) {
        a->not_done++; // which no program of ours writes
        return true;
    }
    struct adjusted_cell *cell = find_cell(f, row);
    struct adjusted_person *p = cell ? find_person(cell, f->sample->sessions[session].person) : NULL;
    if (!p)
        return false;
    p->mean += (row->value - p->mean) / (double)++p->count;
    p->low = fmin(p->low, row->value);
    p->high = fmax(p->high, row->value);
    a->values++;
    return true;
}

static int by_name(const void *x, const void *y)
{
    const struct adjusted_cell *a = x, *b = y;
    int order = strcmp(a->block, b->block);
    if (order == 0)
        order = strcmp(a->parameter, b->parameter);
    return order ? order : strcmp(a->factors, b->factors);
}

static bool finish_cell(struct adjusted_cell *cell, double conf)
{
    double *values = malloc(cell->person_count * sizeof *values);
    if (!values)
        return false;
    for (size_t i = 0; i < cell->person_count; i++)
        values[i] = cell->people[i].mean;
    cell->over_people = threshold_mean_of(values, cell->person_count, conf);
    free(values);
    return true;
}

bool adjusted_load(struct adjusted *out, struct sample *sample, double conf, char *error, size_t error_size)
{
    *out = (struct adjusted){.conf = conf};
    bool ok = true;
    snprintf(error, error_size, "not enough memory");
    for (size_t i = 0; ok && i < sample->file_count; i++) {
        struct filling f = {out, sample, i};
        ok = store_read_adjusted(sample->files[i], add_value, &f);
        if (!ok && store_reader_error(sample->files[i])[0])
            snprintf(error, error_size, "%s", store_reader_error(sample->files[i]));
    }
    if (ok && out->cell_count > 1)
        qsort(out->cells, out->cell_count, sizeof out->cells[0], by_name);
    for (size_t i = 0; ok && i < out->cell_count; i++)
        ok = finish_cell(&out->cells[i], conf);
    if (ok)
        error[0] = '\0';
    else
        adjusted_free(out);
    return ok;
}

void adjusted_free(struct adjusted *adjusted)
{
    for (size_t i = 0; i < adjusted->cell_count; i++)
        free(adjusted->cells[i].people);
    free(adjusted->cells);
    *adjusted = (struct adjusted){0};
}
