#include "analysis/report/rating_options.h"

#include "analysis/report/level.h"

#include "analysis/stats/multiple.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct rating_options *find_question(struct rating_options_list *list, struct sample *sample,
                                            const struct store_rating_row *row)
{
    for (size_t i = 0; i < list->count; i++)
        if (strcmp(list->items[i].question, row->question) == 0)
            return &list->items[i];
    struct rating_options item = {.question = sample_keep(sample, row->question),
                                  .scale_min = row->scale_min,
                                  .scale_max = row->scale_max};
    if (!item.question || !sample_grow(&list->items, list->count, sizeof list->items[0]))
        return NULL;
    list->items[list->count] = item;
    return &list->items[list->count++];
}

static struct rating_option_cell *find_cell(struct rating_options *q, struct sample *sample,
                                            const struct store_rating_row *row, size_t test, size_t reference)
{
    for (size_t i = 0; i < q->cell_count; i++) {
        struct rating_option_cell *cell = &q->cells[i];
        if (cell->test == test && cell->reference == reference && strcmp(cell->block, row->block) == 0 &&
            strcmp(cell->factors, row->factors) == 0)
            return cell;
    }
    struct rating_option_cell cell = {.block = sample_keep(sample, row->block),
                                      .factors = sample_keep(sample, row->factors),
                                      .test = test,
                                      .reference = reference};
    if (!cell.block || !cell.factors || !sample_grow(&q->cells, q->cell_count, sizeof q->cells[0]))
        return NULL;
    q->cells[q->cell_count] = cell;
    return &q->cells[q->cell_count++];
}

static bool add_pair(struct rating_option_cell *cell, size_t person, double test, double reference)
{
    size_t i = 0;
    while (i < cell->n && cell->person[i] != person)
        i++;
    if (i == cell->n) {
        if (!sample_grow(&cell->person, i, sizeof cell->person[0]) ||
            !sample_grow(&cell->count, i, sizeof cell->count[0]) ||
            !sample_grow(&cell->test_value, i, sizeof cell->test_value[0]) ||
            !sample_grow(&cell->reference_value, i, sizeof cell->reference_value[0]))
            return false;
        cell->person[i] = person;
        cell->count[i] = cell->test_value[i] = cell->reference_value[i] = 0;
        cell->n++;
    }
    cell->count[i]++;
    cell->test_value[i] += test;
    cell->reference_value[i] += reference;
    cell->trials++;
    return true;
}

bool rating_options_add(struct rating_options_list *list, struct sample *sample,
                        struct rating_options_open *open, const struct store_rating_row *row, size_t person,
                        size_t condition)
{
    struct rating_options *q = find_question(list, sample, row);
    if (!q)
        return false;
    size_t question = (size_t)(q - list->items);
    if (open->trial_id != row->trial_id || open->question != question || open->subject == row->subject) {
        rating_options_close(list, open);
        *open = (struct rating_options_open){row->trial_id, question, row->subject, condition, row->value};
        return true;
    }
    bool test = row->subject == 't';
    struct rating_option_cell *cell =
        find_cell(q, sample, row, test ? condition : open->condition, test ? open->condition : condition);
    bool ok = cell && add_pair(cell, person, test ? row->value : open->value, test ? open->value : row->value);
    open->trial_id = 0;
    list->used += 2;
    return ok;
}

void rating_options_close(struct rating_options_list *list, struct rating_options_open *open)
{
    list->unpaired += open->trial_id != 0;
    open->trial_id = 0;
}

static int by_cell(const void *x, const void *y)
{
    const struct rating_option_cell *a = x, *b = y;
    if (a->test != b->test)
        return a->test < b->test ? -1 : 1;
    if (a->reference != b->reference)
        return a->reference < b->reference ? -1 : 1;
    int order = strcmp(a->block, b->block);
    return order ? order : strcmp(a->factors, b->factors);
}

static bool finish_question(struct rating_options *q, double conf, bool pratt)
{
    size_t most = 0;
    for (size_t i = 0; i < q->cell_count; i++)
        most = q->cells[i].n > most ? q->cells[i].n : most;
    double *p = malloc((2 * q->cell_count + 1) * sizeof *p),
           *difference = malloc((most + 1) * sizeof *difference);
    bool ok = p && difference;
    if (q->cell_count > 1)
        qsort(q->cells, q->cell_count, sizeof q->cells[0], by_cell);
    for (size_t i = 0; ok && i < q->cell_count; i++) {
        struct rating_option_cell *c = &q->cells[i];
        for (size_t k = 0; k < c->n; k++) {
            // of sums, so that equal differences stay equal and tie
            difference[k] = (c->test_value[k] - c->reference_value[k]) / c->count[k];
            c->test_value[k] /= c->count[k];
            c->reference_value[k] /= c->count[k];
        }
        c->test_of = stat_moments(c->test_value, c->n);
        c->reference_of = stat_moments(c->reference_value, c->n);
        c->difference = stat_ttest_one_sample(difference, c->n, &(struct stat_ttest_options){.conf = conf});
        c->rank =
            stat_wilcoxon(difference, c->n, &(struct stat_wilcoxon_options){.conf = conf, .pratt = pratt});
        c->effect = stat_effect_one_sample(difference, c->n, 0, conf);
        c->average = stat_effect_average(c->test_value, c->reference_value, c->n, conf);
        p[i] = c->difference.p_value;
    }
    if (ok)
        stat_adjust_holm(p, q->cell_count, p + q->cell_count);
    for (size_t i = 0; ok && i < q->cell_count; i++)
        q->cells[i].p_holm = p[q->cell_count + i];
    for (size_t i = 0; i < q->cell_count; i++)
        for (size_t k = 0; k < q->cell_count && !q->cells[i].name_block; k++)
            q->cells[i].name_block = strcmp(q->cells[i].block, q->cells[k].block) != 0;
    free(p);
    free(difference);
    return ok;
}

bool rating_options_finish(struct rating_options_list *list, double conf, bool pratt)
{
    bool ok = true;
    for (size_t i = 0; ok && i < list->count; i++)
        ok = finish_question(&list->items[i], conf, pratt);
    return ok;
}

void rating_option_words(const struct sample *sample, const struct rating_option_cell *cell, char out[384])
{
    char words[256];
    level_all(sample, cell->factors, words);
    bool block = cell->name_block || !words[0];
    snprintf(out, 384, "%.120s%s%s", block ? cell->block : "", block && words[0] ? ": " : "", words);
}

void rating_options_free(struct rating_options_list *list)
{
    for (size_t i = 0; i < list->count; i++) {
        for (size_t k = 0; k < list->items[i].cell_count; k++) {
            struct rating_option_cell *c = &list->items[i].cells[k];
            free(c->person);
            free(c->count);
            free(c->test_value);
            free(c->reference_value);
        }
        free(list->items[i].cells);
    }
    free(list->items);
    *list = (struct rating_options_list){0};
}
