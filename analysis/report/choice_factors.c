// Which cells make a set, who answered in it, and Holm's adjustment; the tests are in choice_factors_test.c.
#include "analysis/report/choice_factors.h"

#include "analysis/report/choice_factors_private.h"
#include "analysis/stats/multiple.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Whether two cells differ in the level `of` at most.
static bool same_but(const struct choice_cell *a, const struct choice_cell *b, size_t of)
{
    if (a->level_count != b->level_count || a->reference != b->reference || a->right != b->right ||
        strcmp(a->block, b->block) != 0)
        return false;
    for (size_t i = 0; i < a->level_count; i++)
        if (strcmp(a->levels[i].factor, b->levels[i].factor) != 0 ||
            (i != of && strcmp(a->levels[i].value, b->levels[i].value) != 0))
            return false;
    return true;
}

// The set of a cell; false where an earlier cell begins it, there is one level, or two cells have the same one.
static bool make_set(const struct choices *c, size_t first, size_t level, struct factor_set *set)
{
    const struct choice_cell *cell = &c->cells[first];
    *set = (struct factor_set){.level = level};
    for (size_t i = 0; i < c->cell_count; i++) {
        if (!same_but(cell, &c->cells[i], level) || c->cells[i].n == 0)
            continue;
        for (size_t j = 0; j < set->count; j++)
            if (strcmp(set->cells[j]->levels[level].value, c->cells[i].levels[level].value) == 0)
                return false;
        if (i < first || set->count == FACTOR_LEVELS)
            return false;
        set->cells[set->count++] = &c->cells[i];
    }
    return set->count > 1 && set->cells[0] == cell;
}

const struct stat_person *factor_counts(const struct choice_cell *cell, size_t person)
{
    for (size_t i = 0; i < cell->people; i++)
        if (cell->person[i] == person)
            return cell->counts[i].n ? &cell->counts[i] : NULL;
    return NULL;
}

static size_t levels_of(const struct factor_set *set, size_t person)
{
    size_t levels = 0;
    for (size_t i = 0; i < set->count; i++)
        levels += factor_counts(set->cells[i], person) != NULL;
    return levels;
}

// Says who answered how: whether anybody saw two levels, and whether anybody answered a level twice.
static void look(struct factor_set *set)
{
    for (size_t i = 0; i < set->count; i++)
        for (size_t k = 0; k < set->cells[i]->people; k++) {
            if (set->cells[i]->counts[k].n == 0)
                continue;
            set->within = set->within || levels_of(set, set->cells[i]->person[k]) > 1;
            set->several = set->several || set->cells[i]->counts[k].n > 1;
            set->most++;
        }
}

static void describe(struct choice_factor_test *test, const struct factor_set *set, bool pair)
{
    const struct choice_cell *cell = set->cells[0];
    const double none = (double)NAN;
    *test = (struct choice_factor_test){.block = cell->block,
                                        .factor = cell->levels[set->level].factor,
                                        .pair = pair,
                                        .levels = set->count,
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
    if (set->count == 2) {
        test->a = cell->levels[set->level].value;
        test->b = set->cells[1]->levels[set->level].value;
    }
}

static bool add(struct choice_factors *out, const struct factor_set *set, bool pair)
{
    if (!sample_grow(&out->tests, out->count, sizeof out->tests[0]))
        return false;
    struct choice_factor_test *test = &out->tests[out->count++];
    describe(test, set, pair);
    return set->within ? factor_test_within(test, set, out->conf) : factor_test_between(test, set, out->conf);
}

static bool add_set(struct choice_factors *out, const struct factor_set *set)
{
    bool ok = add(out, set, false);
    for (size_t i = 0; ok && set->count > 2 && i < set->count; i++)
        for (size_t j = i + 1; ok && j < set->count; j++) {
            struct factor_set two = *set;
            two.cells[0] = set->cells[i];
            two.cells[1] = set->cells[j];
            two.count = 2;
            ok = add(out, &two, true);
        }
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
    for (size_t i = 0; i < out->count; i++)
        if (!out->tests[i].pair)
            adjust(out, true, i, room);
    free(room);
    return true;
}

bool choice_factors_load(struct choice_factors *out, const struct choices *choices)
{
    struct factor_set set;
    bool ok = true;
    *out = (struct choice_factors){.conf = choices->conf};
    for (size_t i = 0; i < choices->cell_count; i++)
        for (size_t level = 0; ok && level < choices->cells[i].level_count; level++) {
            if (!make_set(choices, i, level, &set))
                continue;
            look(&set);
            if (!(set.within && set.several))
                ok = add_set(out, &set);
        }
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
