// From cells to people's answers level by level, and whom a test takes.
#include "analysis/report/choice_factors_private.h"

#include <stdlib.h>

static bool make(struct factor_people *out, size_t people, size_t levels)
{
    *out = (struct factor_people){.people = people, .levels = levels};
    out->counts = calloc(people * levels + 1, sizeof *out->counts);
    out->stray = calloc(people + 1, sizeof *out->stray);
    if (out->counts && out->stray)
        return true;
    factor_people_free(out);
    return false;
}

void factor_people_free(struct factor_people *people)
{
    free(people->counts);
    free(people->stray);
    *people = (struct factor_people){0};
}

const struct stat_person *factor_people_at(const struct factor_people *people, size_t level)
{
    return &people->counts[level * people->people];
}

static size_t levels_answered(const struct factor_people *p, size_t person, const size_t *levels, size_t count)
{
    size_t answered = 0;
    for (size_t i = 0; i < count; i++)
        answered += p->counts[(levels ? levels[i] : i) * p->people + person].n > 0;
    return answered;
}

// The row of each person of the sample, from 1 on in the order in which they come; 0: no answer.
static size_t number_people(const struct factor_set *set, size_t *row)
{
    size_t people = 0;
    for (size_t i = 0; i < set->count; i++)
        for (size_t k = 0; k < set->cells[i]->people; k++) {
            size_t person = set->cells[i]->person[k];
            if (set->cells[i]->counts[k].n > 0 && row[person] == 0)
                row[person] = ++people;
        }
    return people;
}

bool factor_people_all(struct factor_people *out, const struct factor_set *set)
{
    size_t most = 0;
    for (size_t i = 0; i < set->count; i++)
        for (size_t k = 0; k < set->cells[i]->people; k++)
            most = set->cells[i]->person[k] > most ? set->cells[i]->person[k] : most;
    size_t *row = calloc(most + 1, sizeof *row);
    bool ok = row && make(out, number_people(set, row), set->count);
    for (size_t i = 0; ok && i < set->count; i++)
        for (size_t k = 0; k < set->cells[i]->people; k++)
            if (set->cells[i]->counts[k].n > 0)
                out->counts[i * out->people + row[set->cells[i]->person[k]] - 1] = set->cells[i]->counts[k];
    for (size_t p = 0; ok && p < out->people; p++) {
        out->stray[p] = !set->design.within && levels_answered(out, p, NULL, out->levels) > 1;
        for (size_t i = 0; i < out->levels; i++)
            out->several = out->several || (!out->stray[p] && out->counts[i * out->people + p].n > 1);
    }
    free(row);
    return ok;
}

bool factor_people_take(struct factor_people *out, const struct factor_people *all, bool within,
                        const size_t *levels, size_t count)
{
    size_t *kept = calloc(all->people + 1, sizeof *kept), people = 0, left_out = 0;
    for (size_t p = 0; kept && p < all->people; p++) {
        size_t answered = levels_answered(all, p, levels, count);
        if (answered > 0 && (all->stray[p] || (within && answered < count)))
            left_out++;
        else if (answered > 0)
            kept[people++] = p;
    }
    bool ok = kept && make(out, people, count);
    for (size_t i = 0; ok && i < count; i++)
        for (size_t p = 0; p < people; p++)
            out->counts[i * people + p] = all->counts[levels[i] * all->people + kept[p]];
    if (ok) {
        out->left_out = left_out;
        out->several = all->several;
    }
    free(kept);
    return ok;
}
