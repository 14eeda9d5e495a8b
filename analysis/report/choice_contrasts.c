// Within-person factors by the per-person test: a person's share at one level minus the share at another, in
// cells that are otherwise the same, averaged over such pairs of cells; then Student's t over people. No
// person's answers are joined, and a cell of many answers weighs no more than one of few.
#include "analysis/report/choice_design.h"
#include "analysis/stats/multiple.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct person_sum {
    size_t person;
    double difference; // summed over pairs of cells
    size_t pairs;
};

struct people_sums {
    struct person_sum *people;
    size_t count;
};

// Whether somebody answered several times at a level of that cell's set: then all pairs of the set are compared
// here, those of one answer each too, so that none is missing and Holm's p counts them all.
static bool set_is_several(const struct choices *c, size_t cell, size_t level)
{
    for (size_t i = 0; i < c->cell_count; i++)
        if (c->cells[i].several && choice_same_but(&c->cells[cell], &c->cells[i], level))
            return true;
    return false;
}

// Whether two cells are the same but for one factor's level.
static bool are_pair(const struct choice_cell *a, const struct choice_cell *b, size_t *out_level)
{
    for (size_t i = 0; i < a->level_count; i++)
        if (choice_same_but(a, b, i) && strcmp(a->levels[i].value, b->levels[i].value) != 0) {
            *out_level = i;
            return true;
        }
    return false;
}

static const struct stat_person *counts_of(const struct choice_cell *cell, size_t person)
{
    for (size_t i = 0; i < cell->people; i++)
        if (cell->person[i] == person)
            return cell->counts[i].n ? &cell->counts[i] : NULL;
    return NULL;
}

static struct person_sum *find_sum(struct people_sums *sums, size_t person)
{
    for (size_t i = 0; i < sums->count; i++)
        if (sums->people[i].person == person)
            return &sums->people[i];
    if (!sample_grow(&sums->people, sums->count, sizeof sums->people[0]))
        return NULL;
    sums->people[sums->count] = (struct person_sum){.person = person};
    return &sums->people[sums->count++];
}

static bool add_pair(struct people_sums *sums, const struct choice_cell *a, const struct choice_cell *b)
{
    for (size_t i = 0; i < a->people; i++) {
        const struct stat_person *x = &a->counts[i], *y = counts_of(b, a->person[i]);
        if (x->n == 0 || !y)
            continue;
        struct person_sum *sum = find_sum(sums, a->person[i]);
        if (!sum)
            return false;
        sum->difference += (double)x->k / (double)x->n - (double)y->k / (double)y->n;
        sum->pairs++;
    }
    return true;
}

static bool is_of(const struct choice_contrast *contrast, const struct choice_cell *a,
                  const struct choice_cell *b, size_t level)
{
    const struct choice_level *x = &a->levels[level], *y = &b->levels[level];
    return strcmp(contrast->block, a->block) == 0 && strcmp(contrast->factor, x->factor) == 0 &&
           strcmp(contrast->a, x->value) == 0 && strcmp(contrast->b, y->value) == 0;
}

// Cells are in the order of their levels, so that a pair of levels comes in one order only.
static bool fill(struct choice_contrast *contrast, const struct choices *c)
{
    struct people_sums sums = {NULL, 0};
    bool ok = true;
    size_t level;
    for (size_t i = 0; i < c->cell_count; i++)
        for (size_t j = i + 1; ok && j < c->cell_count; j++)
            if (are_pair(&c->cells[i], &c->cells[j], &level) &&
                is_of(contrast, &c->cells[i], &c->cells[j], level) && set_is_several(c, i, level)) {
                struct choice_design design;
                ok = choice_design(c, i, level, &design);
                if (!ok || !design.within)
                    continue;
                contrast->cell_pairs++;
                ok = add_pair(&sums, &c->cells[i], &c->cells[j]);
            }
    double *differences = malloc((sums.count + 1) * sizeof *differences);
    ok = ok && differences;
    for (size_t i = 0; ok && i < sums.count; i++)
        differences[i] = sums.people[i].difference / (double)sums.people[i].pairs;
    if (ok) {
        contrast->people = sums.count;
        contrast->t =
            stat_ttest_one_sample(differences, sums.count, &(struct stat_ttest_options){.conf = c->conf});
    }
    free(differences);
    free(sums.people);
    return ok;
}

static bool same_family(const struct choice_contrast *x, const struct choice_contrast *y)
{
    return strcmp(x->block, y->block) == 0 && strcmp(x->factor, y->factor) == 0;
}

// Behind the last of its factor.
static bool insert(struct choices *c, struct choice_contrast contrast)
{
    if (!sample_grow(&c->contrasts, c->contrast_count, sizeof c->contrasts[0]))
        return false;
    size_t place = c->contrast_count;
    for (size_t i = 0; i < c->contrast_count; i++)
        if (same_family(&c->contrasts[i], &contrast))
            place = i + 1;
    memmove(&c->contrasts[place + 1], &c->contrasts[place], (c->contrast_count - place) * sizeof contrast);
    c->contrasts[place] = contrast;
    c->contrast_count++;
    return true;
}

static bool collect(struct choices *c)
{
    size_t level;
    for (size_t i = 0; i < c->cell_count; i++)
        for (size_t j = i + 1; j < c->cell_count; j++) {
            const struct choice_cell *a = &c->cells[i], *b = &c->cells[j];
            struct choice_design design;
            bool known = !are_pair(a, b, &level);
            for (size_t k = 0; k < c->contrast_count && !known; k++)
                known = is_of(&c->contrasts[k], a, b, level);
            if (known || !set_is_several(c, i, level))
                continue;
            if (!choice_design(c, i, level, &design))
                return false;
            if (!design.within) // compared between people, by choice_factors.h
                continue;
            const struct choice_level *x = &a->levels[level], *y = &b->levels[level];
            if (!insert(c, (struct choice_contrast){
                               .block = a->block, .factor = x->factor, .a = x->value, .b = y->value}))
                return false;
        }
    return true;
}

// Over the pairs of one factor's levels.
static void adjust(struct choices *c, double *p, double *adjusted)
{
    for (size_t i = 0; i < c->contrast_count; i++) {
        size_t size = 0, place = 0;
        for (size_t j = 0; j < c->contrast_count; j++)
            if (same_family(&c->contrasts[i], &c->contrasts[j])) {
                place = j == i ? size : place;
                p[size++] = c->contrasts[j].t.p_value;
            }
        stat_adjust_holm(p, size, adjusted);
        c->contrasts[i].holm = adjusted[place];
    }
}

bool choices_contrast(struct choices *c)
{
    if (!collect(c))
        return false;
    double *room = malloc((2 * c->contrast_count + 1) * sizeof *room);
    bool ok = room != NULL;
    for (size_t i = 0; ok && i < c->contrast_count; i++)
        ok = fill(&c->contrasts[i], c);
    if (ok)
        adjust(c, room, room + c->contrast_count);
    free(room);
    return ok;
}
