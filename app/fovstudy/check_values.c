#include "app/fovstudy/check_values.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The first rating of a pair while the second is waited for.
struct waiting {
    const struct protocol_question *question;
    uint32_t option;
};

struct adding {
    struct check_values *values;
    const struct protocol_analysis *analysis;
    const struct plan *plan;
    uint32_t person;
    struct waiting waiting;
};

const char *check_level_of(const struct check_cell *cell, const char *factor)
{
    if (strcmp(factor, "scene") == 0 && cell->scene[0])
        return cell->scene;
    for (uint32_t i = 0; i < cell->level_count; i++)
        if (strcmp(cell->levels[i].factor, factor) == 0)
            return cell->levels[i].level;
    return NULL;
}

// The next member of {"a":1,"b":"x"}; false: none is left.
static bool next_member(const char **json, struct check_level *out)
{
    size_t length = strcspn(*json, ",}"), kept = 0;
    char member[PROTOCOL_LABELS];
    for (size_t i = 0; i < length && kept + 1 < sizeof member; i++)
        if (!strchr("{\"", (*json)[i]))
            member[kept++] = (*json)[i];
    member[kept] = '\0';
    *json += length + ((*json)[length] != '\0');
    const char *colon = strchr(member, ':');
    if (!colon)
        return false;
    snprintf(out->factor, sizeof out->factor, "%.*s", (int)(colon - member), member);
    snprintf(out->level, sizeof out->level, "%.*s", (int)sizeof out->level - 1, colon + 1);
    return true;
}

static void take_factors(struct check_cell *cell, const char *json)
{
    struct check_level level;
    while (cell->level_count < CHECK_MEMBERS && next_member(&json, &level)) {
        if (strcmp(level.factor, "trial") == 0)
            snprintf(cell->trial, sizeof cell->trial, "%s", level.level);
        else
            cell->levels[cell->level_count++] = level;
    }
}

static bool same(const struct check_cell *a, const struct check_cell *b)
{
    bool equal = strcmp(a->series, b->series) == 0 && strcmp(a->block, b->block) == 0 &&
                 strcmp(a->trial, b->trial) == 0 && strcmp(a->scene, b->scene) == 0 && a->tested == b->tested &&
                 a->reference == b->reference && a->level_count == b->level_count;
    for (uint32_t i = 0; equal && i < a->level_count; i++)
        equal = strcmp(a->levels[i].factor, b->levels[i].factor) == 0 &&
                strcmp(a->levels[i].level, b->levels[i].level) == 0;
    return equal;
}

static bool count(struct adding *a, const struct check_cell *like)
{
    struct check_values *values = a->values;
    uint32_t i = 0;
    while (i < values->cell_count && !same(&values->cells[i], like))
        i++;
    if (i == values->cell_count) {
        struct check_cell *cells = realloc(values->cells, (i + 1) * sizeof *cells);
        uint8_t *counts = calloc(values->people + 1, sizeof *counts);
        values->cells = cells ? cells : values->cells;
        if (!cells || !counts) {
            free(counts);
            return false;
        }
        cells[i] = *like;
        cells[i].count = counts;
        values->cell_count++;
    }
    uint8_t *of = &values->cells[i].count[a->person];
    *of = *of < UINT8_MAX ? (uint8_t)(*of + 1) : *of;
    return true;
}

// From 1; 0: none is shown, or memory ran out, which the next allocation says.
static uint32_t option_of(struct adding *a, int32_t condition)
{
    if (condition < 0)
        return 0;
    struct check_values *values = a->values;
    const struct plan_condition *c = &a->plan->conditions[condition];
    uint32_t i = 0;
    while (i < values->option_count && (values->options[i].mode != c->mode_index ||
                                        memcmp(values->options[i].values, c->values, sizeof c->values) != 0))
        i++;
    if (i == values->option_count) {
        struct check_option *options = realloc(values->options, (i + 1) * sizeof *options);
        if (!options)
            return 0;
        values->options = options;
        options[i].mode = c->mode_index;
        memcpy(options[i].values, c->values, sizeof c->values);
        values->option_count++;
    }
    return i + 1;
}

static struct check_cell cell_of(const struct adding *a, const struct plan_trial *trial)
{
    struct check_cell cell = {0};
    snprintf(cell.block, sizeof cell.block, "%s", a->plan->protocol->blocks[trial->block].name);
    if (strcmp(a->analysis->per, "scene") == 0)
        snprintf(cell.scene, sizeof cell.scene, "%s", trial->scene);
    take_factors(&cell, trial->factors);
    return cell;
}

// Choices, and what comes with them: their times and toggles.
static bool add_choice(struct adding *a, const struct plan_trial *trial)
{
    const struct protocol_question *question = trial->question;
    bool toggle = trial->kind == PROTOCOL_TOGGLE;
    if ((!toggle && trial->kind != PROTOCOL_SEQUENTIAL) || !question || question->type != PROTOCOL_ASK_CHOICE ||
        (strcmp(a->analysis->of, "toggles") == 0 && !toggle))
        return true;
    struct check_cell cell = cell_of(a, trial);
    uint32_t test = trial->test_slot == PLAN_SLOT_B;
    cell.tested = option_of(a, trial->option[test]);
    cell.reference = option_of(a, trial->option[1 - test]);
    if (strcmp(a->analysis->of, "choice") == 0 && question->correct != PROTOCOL_NO_CORRECT)
        snprintf(cell.series, sizeof cell.series, "right answers");
    return count(a, &cell);
}

static bool paired(const struct adding *a)
{
    return strcmp(a->analysis->method, "paired_t") == 0;
}

// Before and after: a difference of each pair of options in its order, or each order's ratings by themselves.
static bool add_in_order(struct adding *a, const struct plan_trial *trial, const char *order,
                         const struct protocol_question *question)
{
    bool second = strcmp(order, "second") == 0;
    uint32_t option = option_of(a, trial->option[0]);
    const struct protocol *protocol = a->plan->protocol;
    struct check_cell cell = {.tested = option};
    const uint32_t which = trial->test_slot == PLAN_SLOT_A ? 0 : 1; // of the block's two
    snprintf(cell.rated, sizeof cell.rated, "%s",
             protocol->options[protocol->blocks[trial->block].options[which]].name);
    snprintf(cell.series, sizeof cell.series, "%s", question->name);
    snprintf(cell.block, sizeof cell.block, "%s", order);
    if (strcmp(a->analysis->per, "scene") == 0)
        snprintf(cell.scene, sizeof cell.scene, "%s", trial->scene);
    if (!paired(a))
        return count(a, &cell);
    const struct waiting first = a->waiting;
    a->waiting = second ? (struct waiting){0} : (struct waiting){question, option};
    if (!second || first.question != question || first.option == option)
        return true;
    cell = (struct check_cell){.difference = true};
    snprintf(cell.series, sizeof cell.series, "%s, second minus first: %u - %u", question->name, option,
             first.option);
    if (strcmp(a->analysis->per, "scene") == 0)
        snprintf(cell.scene, sizeof cell.scene, "%s", trial->scene);
    return count(a, &cell);
}

static bool add_rating(struct adding *a, const struct plan_trial *trial)
{
    const struct protocol_question *questions = a->plan->protocol->questions;
    const struct protocol_settings *s = trial->resolved;
    struct check_cell cell = cell_of(a, trial);
    const char *order = check_level_of(&cell, "order");
    bool ok = true;
    for (uint32_t i = 0; ok && i < s->asked_count && !protocol_kind_is_pair(trial->kind); i++) {
        const struct protocol_question *question = &questions[s->asked[i]];
        if (question->type != PROTOCOL_ASK_RATING)
            continue;
        snprintf(cell.series, sizeof cell.series, "%s", question->name);
        ok = order ? add_in_order(a, trial, order, question) : count(a, &cell);
    }
    for (uint32_t i = 0; ok && i < s->rating_count; i++) { // of both options
        const char *name = questions[s->ratings[i]].name;
        cell.difference = paired(a);
        snprintf(cell.series, sizeof cell.series, "%s, test option%s", name,
                 paired(a) ? " minus reference" : "");
        ok = count(a, &cell);
        if (!ok || paired(a))
            continue;
        snprintf(cell.series, sizeof cell.series, "%s, reference", name);
        ok = count(a, &cell);
    }
    return ok;
}

// The parameters that staircases or participants set are series.
static bool add_set(struct adding *a, const struct plan_trial *trial, bool threshold)
{
    const struct protocol_block *block = &a->plan->protocol->blocks[trial->block];
    const struct catalogue *catalogue = a->plan->protocol->catalogue;
    const uint32_t mode = a->plan->protocol->options[block->options[0]].mode;
    struct check_cell cell = cell_of(a, trial);
    cell.scene[0] = '\0'; // no value is of one scene alone
    bool ok = true;
    if (trial->kind != (threshold ? PROTOCOL_STAIRCASE : PROTOCOL_ADJUST))
        return true;
    for (uint32_t i = 0; ok && i < (threshold ? 1 : block->adjust_count); i++) {
        uint32_t index = threshold ? block->staircase.parameter : block->adjusts[i].parameter;
        snprintf(cell.series, sizeof cell.series, "%s", catalogue->modes[mode].parameters[index].name);
        ok = count(a, &cell);
    }
    return ok;
}

bool check_values_add(struct check_values *values, const struct protocol_analysis *analysis,
                      const struct plan *plan, uint32_t person)
{
    struct adding a = {.values = values, .analysis = analysis, .plan = plan, .person = person};
    const char *of = analysis->of;
    bool ok = true, threshold = strcmp(of, "threshold") == 0;
    for (uint32_t t = 0; ok && t < plan->trial_count; t++) {
        const struct plan_trial *trial = &plan->trials[t];
        if (trial->role != PROTOCOL_MAIN)
            continue;
        if (threshold || strcmp(of, "adjusted") == 0)
            ok = add_set(&a, trial, threshold);
        else
            ok = strcmp(of, "rating") == 0 ? add_rating(&a, trial) : add_choice(&a, trial);
    }
    return ok;
}

void check_values_finish(struct check_values *values)
{
    for (uint32_t i = 0; i < values->cell_count; i++)
        free(values->cells[i].count);
    free(values->cells);
    free(values->options);
    *values = (struct check_values){0};
}
