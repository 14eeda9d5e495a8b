// A planned analysis of variance: the effects that factorial.h finds, of ratings as they are loaded, of
// anything else from the people's means per cell.
#include "analysis/report/planned_data.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool effect_row(struct planned *out, const struct factorial *f, const struct stat_anova_effect *effect,
                       bool name_block, size_t index)
{
    struct planned_row *row = planned_row_add(out, index);
    if (!row)
        return false;
    char name[256];
    factorial_effect_name(f, effect->factors, " \u00d7 ", name);
    snprintf(row->words, sizeof row->words, "%.60s%s%.40s%s%.200s", f->question, f->question[0] ? ": " : "",
             name_block ? f->block : "", name_block ? ": " : "", name);
    row->people = f->people;
    row->left_out = f->left_count;
    row->effect_size = true;
    row->estimate = effect->eta2_partial;
    row->p_value = effect->p_gg;
    if (isnan(effect->p_gg))
        snprintf(row->note, sizeof row->note, "not estimable: the values have no spread within people");
    else
        snprintf(row->test, sizeof row->test, "F(%.2f, %.2f) = %.2f", effect->df * effect->epsilon_gg,
                 effect->df_error * effect->epsilon_gg, effect->f);
    planned_row_left_out(row, "without a value in every cell");
    return true;
}

static bool add_effects(struct planned *out, const struct factorial_list *list, const struct plan *plan,
                        size_t index)
{
    for (size_t i = 0; i < list->count; i++) {
        const struct factorial *f = &list->items[i];
        size_t first = out->row_count;
        bool blocks = strcmp(list->items[0].block, list->items[list->count - 1].block) != 0; // by block
        for (size_t j = 0; !f->refusal[0] && j < f->anova.effect_count; j++) {
            char name[256];
            factorial_effect_name(f, f->anova.effects[j].factors, " ", name);
            if ((!plan_is(plan, NULL, NULL, "scene") || strcmp(name, "scene") == 0) &&
                !effect_row(out, f, &f->anova.effects[j], blocks, index))
                return false;
        }
        if (out->row_count > first)
            continue;
        struct planned_row *row = planned_row_add(out, index);
        if (!row)
            return false;
        snprintf(row->words, sizeof row->words, "%.60s%s%.60s", f->question,
                 blocks && f->question[0] ? ": " : "", blocks ? f->block : "");
        snprintf(row->note, sizeof row->note, "not computed: %.200s",
                 f->refusal[0] ? f->refusal : "scenes are no factor of it");
    }
    return true;
}

// One value per person and cell, as if it were a rating.
static bool add_values(struct factorial_list *list, const struct planned_data *data)
{
    for (size_t c = 0; c < data->cell_count; c++)
        for (size_t p = 0; p < data->sample->person_count; p++) {
            const struct planned_cell *cell = &data->cells[c];
            struct store_rating_row row = {.question = cell->series,
                                           .block = cell->block,
                                           .factors = cell->factors,
                                           .value = cell->sum[p] / (double)cell->count[p]};
            if (cell->count[p] > 0 && !factorial_add(list, data->sample, &row, p))
                return false;
        }
    return true;
}

bool planned_anova(struct planned *out, const struct planned_data *data, const struct plan *plan, size_t index,
                   const struct planned_sources *sources)
{
    if (plan_is(plan, NULL, "rating", NULL) && sources->ratings->factorials.count)
        return add_effects(out, &sources->ratings->factorials, plan, index);
    struct factorial_list list = {0};
    bool ok = add_values(&list, data) && factorial_finish(&list, data->sample, out->conf) &&
              add_effects(out, &list, plan, index);
    factorial_free(&list);
    return ok;
}
