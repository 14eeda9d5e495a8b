// Which cells a row joins: one cell, a level of a factor, a scene, or all of a series.
#include "analysis/report/level.h"
#include "analysis/report/planned_data.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool differs(const char *a, const char *b)
{
    return a != b && (!a || !b || strcmp(a, b) != 0);
}

// Whether the series has cells of other blocks, and the words do not say which.
static bool name_block(const struct planned_data *data, const struct planned_cell *cell)
{
    bool several = false;
    for (size_t i = 0; i < data->cell_count; i++)
        several = several || (strcmp(data->cells[i].series, cell->series) == 0 &&
                              strcmp(data->cells[i].block, cell->block) != 0);
    return several && cell->factors[0] && strncmp(cell->words, cell->block, strlen(cell->block)) != 0;
}

// `factor` and `level` NULL where the row is no level's.
static bool join(struct planned_groups *groups, const struct planned_data *data, size_t cell,
                 const char *factor, const char *level, bool alone)
{
    const struct planned_cell *c = &data->cells[cell];
    size_t i = alone ? groups->count : 0;
    while (i < groups->count &&
           (differs(groups->items[i].series, c->series) || differs(groups->items[i].factor, factor) ||
            differs(groups->items[i].level, level)))
        i++;
    if (i == groups->count) {
        struct planned_group group = {.series = c->series, .factor = factor, .level = level};
        char words[96] = "";
        if (level)
            level_words(factor, level, true, words);
        bool named = alone && name_block(data, c), all = strcmp(c->words, "all") == 0;
        const char *rest = alone && !(named && all) ? c->words : words;
        snprintf(group.words, sizeof group.words, "%.280s%s%.40s%s%.160s", c->series,
                 c->series[0] && (named || rest[0]) ? ": " : "", named ? c->block : "",
                 named && !all ? ": " : "", rest);
        if (!sample_grow(&groups->items, groups->count, sizeof groups->items[0]))
            return false;
        groups->items[groups->count++] = group;
    }
    struct planned_group *group = &groups->items[i];
    if (!sample_grow(&group->cells, group->cell_count, sizeof group->cells[0]))
        return false;
    group->cells[group->cell_count++] = cell;
    return true;
}

// Every level of a cell; a listed trial's name is no factor.
static bool join_levels(struct planned_groups *groups, const struct planned_data *data, size_t cell)
{
    for (size_t i = 0; i < data->sample->factor_count; i++) {
        const struct sample_factor *f = &data->sample->factors[i];
        if (strcmp(f->factors, data->cells[cell].factors) == 0 && strcmp(f->key, "trial") != 0 &&
            !join(groups, data, cell, f->key, f->value, false))
            return false;
    }
    return true;
}

// Of both options of a trial: which from which, where that is the same in all cells of a group.
static void name_options(struct planned_group *group, const struct planned_data *data)
{
    const struct planned_cell *first = &data->cells[group->cells[0]];
    bool same = first->difference && first->minuend != SAMPLE_NONE;
    for (size_t i = 1; i < group->cell_count && same; i++)
        same = data->cells[group->cells[i]].minuend == first->minuend &&
               data->cells[group->cells[i]].subtrahend == first->subtrahend;
    size_t used = strlen(group->words);
    if (same && first->words[0]) // before and after are named already
        snprintf(group->words + used, sizeof group->words - used, "%s%.120s \u2212 %.120s",
                 group->words[0] ? ": " : "", data->sample->conditions[first->minuend].words,
                 data->sample->conditions[first->subtrahend].words);
}

static int by_words(const void *x, const void *y)
{
    const struct planned_group *a = x, *b = y;
    int order = strcmp(a->series, b->series);
    if (order == 0 && a->factor && b->factor)
        order = strcmp(a->factor, b->factor);
    return order ? order : level_order(a->words, b->words);
}

bool planned_groups_load(struct planned_groups *out, const struct planned_data *data, const struct plan *plan)
{
    bool ok = true, choices = plan_is(plan, "binomial", NULL, "-"); // a person's cells are joined only if asked
    *out = (struct planned_groups){0};
    for (size_t i = 0; ok && i < data->cell_count; i++) {
        const char *scene =
            plan_is(plan, NULL, NULL, "scene") ? planned_level(data, &data->cells[i], "scene") : NULL;
        if (plan_is(plan, NULL, NULL, "cell") || plan_is(plan, NULL, NULL, "order") || choices)
            ok = join(out, data, i, NULL, NULL, true);
        else if (plan_is(plan, NULL, NULL, "factor"))
            ok = join_levels(out, data, i);
        else if (plan_is(plan, NULL, NULL, "scene"))
            ok = !scene || join(out, data, i, "scene", scene, false);
        else
            ok = join(out, data, i, NULL, NULL, false);
    }
    for (size_t i = 0; ok && i < out->count; i++)
        name_options(&out->items[i], data);
    if (ok && out->count > 1)
        qsort(out->items, out->count, sizeof out->items[0], by_words);
    if (!ok)
        planned_groups_free(out);
    return ok;
}

void planned_groups_free(struct planned_groups *groups)
{
    for (size_t i = 0; i < groups->count; i++)
        free(groups->items[i].cells);
    free(groups->items);
    *groups = (struct planned_groups){0};
}
