#include "analysis/report/factorial_private.h"

#include "analysis/stats/multiple.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct factorial *find(struct factorial_list *list, struct sample *sample,
                              const struct store_rating_row *row)
{
    for (size_t i = 0; i < list->count; i++)
        if (strcmp(list->items[i].question, row->question) == 0 &&
            strcmp(list->items[i].block, row->block) == 0)
            return &list->items[i];
    struct factorial item = {.question = sample_keep(sample, row->question),
                             .block = sample_keep(sample, row->block),
                             .scale_min = row->scale_min,
                             .scale_max = row->scale_max};
    if (!item.question || !item.block || !sample_grow(&list->items, list->count, sizeof list->items[0]))
        return NULL;
    list->items[list->count] = item;
    return &list->items[list->count++];
}

bool factorial_add(struct factorial_list *list, struct sample *sample, const struct store_rating_row *row,
                   size_t person)
{
    struct factorial *f = find(list, sample, row);
    if (!f)
        return false;
    size_t cell = 0;
    while (cell < f->text_count && strcmp(f->texts[cell], row->factors) != 0)
        cell++;
    if (cell == f->text_count) {
        const char *text = sample_keep(sample, row->factors);
        if (!text || !sample_grow(&f->texts, cell, sizeof f->texts[0]))
            return false;
        f->texts[f->text_count++] = text;
    }
    if (!sample_grow(&f->ratings, f->rating_count, sizeof f->ratings[0]))
        return false;
    f->ratings[f->rating_count++] = (struct factorial_rating){person, cell, row->value, 0};
    list->used++;
    return true;
}

// How far apart two neighbouring levels of a factor stand in a person's cells.
static size_t stride_of(const struct factorial *f, size_t factor)
{
    size_t stride = 1;
    for (size_t j = factor + 1; j < f->factor_count; j++)
        stride *= f->factors[j].level_count;
    return stride;
}

// People's means per level of one factor over all others: out[person * levels + level].
static void marginals(const struct factorial *f, size_t factor, double *out)
{
    size_t levels = f->factors[factor].level_count, stride = stride_of(f, factor);
    for (size_t i = 0; i < f->people; i++) {
        for (size_t c = 0; c < f->cells; c++)
            out[i * levels + c / stride % levels] += f->values[i * f->cells + c];
        for (size_t k = 0; k < levels; k++)
            out[i * levels + k] /= (double)(f->cells / levels);
    }
}

static void column(const double *table, size_t people, size_t columns, size_t which, double *out)
{
    for (size_t i = 0; i < people; i++)
        out[i] = table[i * columns + which];
}

// `room`: two columns of people and two rows of pairs.
static void test_pairs(struct factorial_factor *factor, const double *means, size_t people, double conf,
                       double *room)
{
    size_t levels = factor->level_count, pair = 0;
    double *x = room, *y = x + people, *p = y + people, *holm = p + factor->pair_count;
    for (size_t a = 0; a < levels; a++)
        for (size_t b = a + 1; b < levels; b++, pair++) {
            column(means, people, levels, a, x);
            column(means, people, levels, b, y);
            factor->pairs[pair] = (struct factorial_pair){
                .a = a,
                .b = b,
                .test = stat_ttest_paired(x, y, people, &(struct stat_ttest_options){.conf = conf}),
                .effect = stat_effect_paired(x, y, people, conf)};
            p[pair] = factor->pairs[pair].test.p_value;
        }
    stat_adjust_holm(p, pair, holm);
    for (size_t i = 0; i < pair; i++)
        factor->pairs[i].p_holm = holm[i];
}

static bool finish_factor(struct factorial *f, size_t index, double conf)
{
    struct factorial_factor *factor = &f->factors[index];
    size_t levels = factor->level_count;
    double *means = calloc(f->people * levels, sizeof *means);
    if (!means)
        return false;
    marginals(f, index, means);
    bool ok = stat_within_intervals(means, f->people, levels, conf, factor->mean, factor->half_width);
    factor->significant = f->anova.effects[index].p_gg <= 1 - conf; // main effects stand first
    if (ok && factor->significant) {
        factor->pair_count = levels * (levels - 1) / 2;
        factor->pairs = calloc(factor->pair_count, sizeof *factor->pairs);
        double *room = calloc(2 * (f->people + factor->pair_count), sizeof *room);
        ok = factor->pairs && room;
        if (ok)
            test_pairs(factor, means, f->people, conf, room);
        free(room);
    }
    free(means);
    return ok;
}

static bool finish_cells(struct factorial *f)
{
    double *x = calloc(f->people, sizeof *x);
    f->cell_of = calloc(f->cells, sizeof *f->cell_of);
    for (size_t c = 0; x && f->cell_of && c < f->cells; c++) {
        column(f->values, f->people, f->cells, c, x);
        f->cell_of[c] = stat_moments(x, f->people);
    }
    free(x);
    return x && f->cell_of;
}

// Each person once, whatever was rated.
static bool finish_overall(struct factorial *f, size_t people)
{
    double *sum = calloc(people + 1, sizeof *sum), *count = calloc(people + 1, sizeof *count);
    size_t used = 0;
    for (size_t i = 0; sum && count && i < f->rating_count; i++) {
        sum[f->ratings[i].person] += f->ratings[i].value;
        count[f->ratings[i].person]++;
    }
    for (size_t i = 0; sum && count && i < people; i++)
        if (count[i] > 0)
            sum[used++] = sum[i] / count[i];
    bool ok = sum && count;
    if (ok)
        f->overall = stat_moments(sum, used);
    free(sum);
    free(count);
    return ok;
}

static int by_name(const void *x, const void *y)
{
    const struct factorial *a = x, *b = y;
    int order = strcmp(a->block, b->block);
    return order ? order : strcmp(a->question, b->question);
}

bool factorial_finish(struct factorial_list *list, const struct sample *sample, double conf)
{
    bool ok = true;
    if (list->count > 1)
        qsort(list->items, list->count, sizeof list->items[0], by_name);
    for (size_t i = 0; ok && i < list->count; i++) {
        struct factorial *f = &list->items[i];
        size_t levels[STAT_ANOVA_FACTORS];
        ok = finish_overall(f, sample->person_count) && factorial_design(f, sample);
        if (!ok || f->refusal[0])
            continue;
        for (size_t j = 0; j < f->factor_count; j++)
            levels[j] = f->factors[j].level_count;
        ok = stat_anova_within(f->values, f->people, levels, f->factor_count, &f->anova) && finish_cells(f);
        for (size_t j = 0; ok && j < f->factor_count; j++)
            ok = finish_factor(f, j, conf);
    }
    return ok;
}

void factorial_refusal(const struct factorial *f, char out[512])
{
    char sd[48] = "";
    if (!isnan(f->overall.sd))
        snprintf(sd, sizeof sd, " (SD %.2f)", f->overall.sd);
    snprintf(out, 512, "No analysis of %zu rating%s of %zu participant%s, mean %.2f%s: %s.", f->rating_count,
             f->rating_count == 1 ? "" : "s", f->overall.n, f->overall.n == 1 ? "" : "s", f->overall.mean, sd,
             f->refusal);
}

size_t factorial_untested(const struct factorial *f, char out[256])
{
    size_t count = 0;
    out[0] = '\0';
    for (size_t j = 0; j < f->factor_count; j++) {
        size_t used = strlen(out);
        if (isnan(f->anova.effects[j].p_gg)) // main effects stand first
            snprintf(out + used, 256 - used, "%s%.60s", count++ ? ", " : "", f->factors[j].name);
    }
    return count;
}

void factorial_effect_name(const struct factorial *f, unsigned factors, const char *cross, char out[256])
{
    out[0] = '\0';
    for (size_t j = 0; j < f->factor_count; j++) {
        size_t used = strlen(out);
        if (factors >> j & 1)
            snprintf(out + used, 256 - used, "%s%.60s", used ? cross : "", f->factors[j].name);
    }
}

void factorial_free(struct factorial_list *list)
{
    for (size_t i = 0; i < list->count; i++) {
        struct factorial *f = &list->items[i];
        for (size_t j = 0; j < f->factor_count; j++) {
            free(f->factors[j].levels);
            free(f->factors[j].mean);
            free(f->factors[j].half_width);
            free(f->factors[j].pairs);
        }
        free(f->ratings);
        free(f->texts);
        free(f->values);
        free(f->cell_of);
        free(f->left);
    }
    free(list->items);
    *list = (struct factorial_list){0};
}
