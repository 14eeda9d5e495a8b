// Which cells make a set, what is compared in it, and Holm's adjustment; the tests are in
// choice_factors_test.c.
#include "analysis/report/choice_factors.h"

#include "analysis/report/choice_factors_private.h"
#include "analysis/stats/multiple.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The set of a cell; false where an earlier cell begins it, there is one level, or two cells have the same one.
static bool make_set(const struct choices *c, size_t first, size_t level, struct factor_set *set)
{
    const struct choice_cell *cell = &c->cells[first];
    *set = (struct factor_set){.level = level};
    for (size_t i = 0; i < c->cell_count; i++) {
        if (!choice_same_but(cell, &c->cells[i], level) || c->cells[i].n == 0)
            continue;
        for (size_t j = 0; j < set->count; j++)
            if (strcmp(set->cells[j]->levels[level].value, c->cells[i].levels[level].value) == 0)
                return false;
        if (i < first || set->count == CHOICE_FACTOR_LEVELS)
            return false;
        set->cells[set->count++] = &c->cells[i];
    }
    return set->count > 1 && set->cells[0] == cell;
}

static void describe(struct choice_factor_test *test, const struct factor_set *set, const size_t *levels,
                     size_t count)
{
    const struct choice_cell *cell = set->cells[0];
    const double none = (double)NAN;
    *test = (struct choice_factor_test){.block = cell->block,
                                        .factor = cell->levels[set->level].factor,
                                        .design = set->design,
                                        .pair = count < set->count,
                                        .levels = count,
                                        .p_value = none,
                                        .holm = none,
                                        .statistic = none,
                                        .df = none,
                                        .p_asymptotic = none,
                                        .share_a = none,
                                        .share_b = none,
                                        .difference = none,
                                        .ci = {none, none},
                                        .odds_ratio = none,
                                        .odds_ci = {none, none}};
    for (size_t i = 0; i < cell->level_count; i++) {
        size_t used = strlen(test->where);
        if (i != set->level)
            snprintf(test->where + used, sizeof test->where - used, "%s%s %s", used ? ", " : "",
                     cell->levels[i].factor, cell->levels[i].value);
    }
    for (size_t i = 0; i < count; i++)
        test->level[i] = set->cells[levels[i]]->levels[set->level].value;
}

static bool add(struct choice_factors *out, const struct factor_set *set, const struct factor_people *all,
                const size_t *levels, size_t count)
{
    struct factor_people people;
    if (!sample_grow(&out->tests, out->count, sizeof out->tests[0]) ||
        !factor_people_take(&people, all, set->design.within, levels, count))
        return false;
    struct choice_factor_test *test = &out->tests[out->count++];
    describe(test, set, levels, count);
    test->people = people.people;
    test->left_out = people.left_out;
    bool ok = set->design.within ? factor_test_within(test, &people, out->conf)
                                 : factor_test_between(test, &people, out->conf);
    factor_people_free(&people);
    return ok;
}

static bool add_set(struct choice_factors *out, const struct factor_set *set)
{
    struct factor_people all;
    size_t levels[CHOICE_FACTOR_LEVELS];
    for (size_t i = 0; i < set->count; i++)
        levels[i] = i;
    if (!factor_people_all(&all, set))
        return false;
    const bool contrasts = set->design.within && all.several; // those of choices.h
    bool ok = contrasts || add(out, set, &all, levels, set->count);
    for (size_t i = 0; ok && !contrasts && set->count > 2 && i < set->count; i++)
        for (size_t j = i + 1; ok && j < set->count; j++)
            ok = add(out, set, &all, (const size_t[]){i, j}, 2);
    factor_people_free(&all);
    return ok;
}

// Over the tests that are no pairs, or over the pairs that follow tests[of].
static void adjust(struct choice_factors *out, bool pairs, size_t of, double *p)
{
    size_t size = 0;
    const size_t from = pairs ? of + 1 : 0;
    for (size_t i = from; i < out->count && (!pairs || out->tests[i].pair); i++)
        if (out->tests[i].pair == pairs)
            p[size++] = out->tests[i].p_value;
    stat_adjust_holm(p, size, p);
    size = 0;
    for (size_t i = from; i < out->count && (!pairs || out->tests[i].pair); i++)
        if (out->tests[i].pair == pairs)
            out->tests[i].holm = p[size++];
}

static bool finish(struct choice_factors *out)
{
    double *room = malloc((out->count + 1) * sizeof *room);
    if (!room)
        return false;
    adjust(out, false, 0, room);
    for (size_t i = 0; i < out->count; i++) {
        if (!out->tests[i].pair)
            adjust(out, true, i, room);
        out->tests[i].name_block = strcmp(out->tests[0].block, out->tests[out->count - 1].block) != 0;
    }
    free(room);
    return true;
}

bool choice_factors_load(struct choice_factors *out, const struct choices *choices)
{
    struct factor_set set;
    bool ok = true;
    *out = (struct choice_factors){.conf = choices->conf};
    for (size_t i = 0; i < choices->cell_count; i++)
        for (size_t level = 0; ok && level < choices->cells[i].level_count; level++)
            if (make_set(choices, i, level, &set))
                ok = choice_design(choices, i, level, &set.design) && add_set(out, &set);
    if (ok && finish(out))
        return true;
    choice_factors_free(out);
    return false;
}

void choice_factors_free(struct choice_factors *factors)
{
    free(factors->tests);
    *factors = (struct choice_factors){0};
}
