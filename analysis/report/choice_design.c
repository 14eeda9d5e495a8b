#include "analysis/report/choice_design.h"

#include <stdlib.h>
#include <string.h>

enum { SET_LEVELS = 64 }; // bits of a mask; a protocol permits 16

bool choice_same_but(const struct choice_cell *a, const struct choice_cell *b, size_t of)
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

// The number of a cell's level among those of its set; SET_LEVELS for a cell that is not part of it.
static size_t level_in_set(const struct choices *c, size_t first, size_t level, size_t cell)
{
    const char *seen[SET_LEVELS];
    size_t count = 0;
    if (!choice_same_but(&c->cells[first], &c->cells[cell], level))
        return SET_LEVELS;
    for (size_t i = 0; i <= cell; i++) {
        const char *value = c->cells[i].levels[level].value;
        size_t at = 0;
        if (!choice_same_but(&c->cells[first], &c->cells[i], level))
            continue;
        while (at < count && strcmp(seen[at], value) != 0)
            at++;
        if (i == cell || at == SET_LEVELS)
            return at;
        if (at == count)
            seen[count++] = value;
    }
    return SET_LEVELS;
}

static size_t people_of(const struct choices *c)
{
    size_t people = 0;
    for (size_t i = 0; i < c->cell_count; i++) {
        const struct choice_cell *cell = &c->cells[i];
        for (size_t k = 0; k < cell->planned_count; k++)
            people = cell->planned[k] >= people ? cell->planned[k] + 1 : people;
        for (size_t k = 0; k < cell->people; k++)
            people = cell->person[k] >= people ? cell->person[k] + 1 : people;
    }
    return people;
}

bool choice_design(const struct choices *c, size_t cell, size_t level, struct choice_design *out)
{
    const size_t people = people_of(c);
    uint64_t *levels = calloc(people + 1, sizeof *levels); // a bit for each level that a person was to see
    *out = (struct choice_design){0};
    for (size_t i = 0; levels && i < c->cell_count; i++) {
        size_t bit = level_in_set(c, cell, level, i);
        if (bit == SET_LEVELS)
            continue;
        for (size_t k = 0; k < c->cells[i].planned_count; k++)
            levels[c->cells[i].planned[k]] |= UINT64_C(1) << bit;
        for (size_t k = 0; k < c->cells[i].people; k++) // who answered was to answer
            levels[c->cells[i].person[k]] |= UINT64_C(1) << bit;
    }
    for (size_t p = 0; levels && p < people; p++) {
        bool several = levels[p] & (levels[p] - 1);
        out->several += several;
        out->one += levels[p] && !several;
    }
    out->within = out->several >= out->one;
    free(levels);
    return levels != NULL;
}
