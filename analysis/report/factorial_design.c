// From ratings that carry their factors as text to a full table of people and cells.
#include "analysis/report/factorial_private.h"

#include "analysis/report/factor_design.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct key {
    const char *name;
    size_t level_count;
    const struct sample_factor **levels; // ordered
    size_t *of_text;                     // the level of each cell's text
    bool dropped;
};

struct keys {
    size_t count;
    struct key items[FACTORIAL_KEYS];
};

static void refuse(struct factorial *f, const char *text)
{
    snprintf(f->refusal, sizeof f->refusal, "%s", text);
}

static const struct sample_factor *find_member(const struct sample *sample, const char *factors,
                                               const char *key)
{
    for (size_t i = 0; i < sample->factor_count; i++)
        if (strcmp(sample->factors[i].factors, factors) == 0 && strcmp(sample->factors[i].key, key) == 0)
            return &sample->factors[i];
    return NULL;
}

static int by_level(const void *x, const void *y)
{
    const struct sample_factor *const *a = x, *const *b = y;
    double p = (*a)->number, q = (*b)->number;
    if (!isnan(p) && !isnan(q) && p != q)
        return p < q ? -1 : 1;
    return strcmp((*a)->value, (*b)->value);
}

static bool find_levels(struct key *key, const struct factorial *f, const struct sample *sample)
{
    key->levels = calloc(f->text_count, sizeof *key->levels);
    key->of_text = calloc(f->text_count, sizeof *key->of_text);
    if (!key->levels || !key->of_text)
        return false;
    for (size_t t = 0; t < f->text_count; t++) {
        const struct sample_factor *member = find_member(sample, f->texts[t], key->name);
        size_t k = 0;
        while (k < key->level_count && strcmp(key->levels[k]->value, member->value) != 0)
            k++;
        if (k == key->level_count)
            key->levels[key->level_count++] = member;
    }
    qsort(key->levels, key->level_count, sizeof *key->levels, by_level);
    for (size_t t = 0; t < f->text_count; t++)
        while (strcmp(key->levels[key->of_text[t]]->value,
                      find_member(sample, f->texts[t], key->name)->value) != 0)
            key->of_text[t]++;
    return true;
}

// The keys of the first cell; all other cells must have the same ones.
static bool find_keys(struct keys *keys, struct factorial *f, const struct sample *sample)
{
    for (size_t i = 0; i < sample->factor_count; i++) {
        if (strcmp(sample->factors[i].factors, f->texts[0]) != 0)
            continue;
        if (keys->count == FACTORIAL_KEYS) {
            refuse(f, "there are too many factors");
            return true;
        }
        keys->items[keys->count++].name = sample->factors[i].key;
    }
    for (size_t t = 0; t < f->text_count; t++) {
        size_t members = 0;
        bool same = true;
        for (size_t i = 0; i < sample->factor_count; i++)
            members += strcmp(sample->factors[i].factors, f->texts[t]) == 0;
        for (size_t k = 0; k < keys->count; k++)
            same = same && find_member(sample, f->texts[t], keys->items[k].name);
        if (!same || members != keys->count) {
            refuse(f, "its trials do not all have the same factors");
            return true;
        }
    }
    for (size_t k = 0; k < keys->count; k++)
        if (!find_levels(&keys->items[k], f, sample))
            return false;
    return true;
}

// Whether every level of `of` has one level of `key`, so that `key` says nothing more.
static bool follows(const struct key *key, const struct key *of, size_t texts)
{
    for (size_t a = 0; a < texts; a++)
        for (size_t b = 0; b < a; b++)
            if (of->of_text[a] == of->of_text[b] && key->of_text[a] != key->of_text[b])
                return false;
    return true;
}

static void drop(struct factorial *f, struct key *key, const char *why, const char *of)
{
    size_t used = strlen(f->dropped);
    key->dropped = true;
    snprintf(f->dropped + used, sizeof f->dropped - used, "%s%.40s (%s%.40s)", used ? ", " : "", key->name, why,
             of);
}

static void drop_keys(struct factorial *f, struct keys *keys)
{
    for (size_t k = 0; k < keys->count; k++)
        if (keys->items[k].level_count < 2)
            drop(f, &keys->items[k], "one level only", "");
    for (size_t k = keys->count; k-- > 0;)
        for (size_t j = 0; j < keys->count && !keys->items[k].dropped; j++)
            if (j != k && !keys->items[j].dropped && follows(&keys->items[k], &keys->items[j], f->text_count))
                drop(f, &keys->items[k], "follows from ", keys->items[j].name);
}

static bool take_factors(struct factorial *f, const struct keys *keys)
{
    f->cells = 1;
    for (size_t k = 0; k < keys->count; k++) {
        const struct key *key = &keys->items[k];
        if (key->dropped)
            continue;
        if (f->factor_count == STAT_ANOVA_FACTORS || key->level_count > FACTORIAL_CELLS / f->cells) {
            refuse(f, "there are too many factors or cells (at most 6 and 4096)");
            return true;
        }
        struct factorial_factor *factor = &f->factors[f->factor_count++];
        *factor = (struct factorial_factor){.name = key->name, .level_count = key->level_count};
        factor->levels = calloc(key->level_count, sizeof *factor->levels);
        factor->mean = calloc(key->level_count, sizeof *factor->mean);
        factor->half_width = calloc(key->level_count, sizeof *factor->half_width);
        if (!factor->levels || !factor->mean || !factor->half_width)
            return false;
        for (size_t i = 0; i < key->level_count; i++)
            factor->levels[i] = key->levels[i]->value;
        f->cells *= key->level_count;
    }
    if (f->factor_count == 0)
        refuse(f, "there is no factor with two levels to compare");
    return true;
}

static size_t cell_of(const struct keys *keys, size_t text)
{
    size_t cell = 0;
    for (size_t k = 0; k < keys->count; k++)
        if (!keys->items[k].dropped)
            cell = cell * keys->items[k].level_count + keys->items[k].of_text[text];
    return cell;
}

// Who was to rate at which level of a factor, and who did. False where memory ran out.
static bool designs_of(const struct factorial *f, const struct key *key, const struct sample *sample,
                       struct choice_design *out_planned, struct choice_design *out_rated)
{
    struct factor_design planned, rated = {0};
    bool ok = factor_design_init(&planned, sample) && factor_design_init(&rated, sample);
    for (size_t t = 0; ok && t < f->text_count; t++)
        factor_design_planned(&planned, sample, f->block, f->texts[t], "", key->levels[key->of_text[t]]->value);
    for (size_t i = 0; ok && i < f->rating_count; i++) {
        const char *level = key->levels[key->of_text[f->ratings[i].cell]]->value;
        factor_design_see(&planned, f->ratings[i].person, level);
        factor_design_see(&rated, f->ratings[i].person, level);
    }
    if (ok) {
        *out_planned = factor_design_decide(&planned);
        *out_rated = factor_design_decide(&rated);
    }
    factor_design_finish(&planned);
    factor_design_finish(&rated);
    return ok;
}

// Refuses where a factor lies between people: those few who rated several of its levels are not the study.
static bool refuse_between(struct factorial *f, const struct keys *keys, const struct sample *sample)
{
    for (size_t k = 0; k < keys->count && !f->refusal[0]; k++) {
        const struct key *key = &keys->items[k];
        struct choice_design planned, rated;
        if (key->dropped)
            continue;
        if (!designs_of(f, key, sample, &planned, &rated))
            return false;
        if (rated.several == 0 && planned.within)
            snprintf(f->refusal, sizeof f->refusal,
                     "nobody rated two levels of %.80s, though %zu of %zu were to", key->name, planned.several,
                     planned.one + planned.several);
        else if (rated.several == 0)
            snprintf(f->refusal, sizeof f->refusal,
                     "nobody rated two levels of %.80s, and factors between people are not analysed",
                     key->name);
        else if (!planned.within)
            snprintf(f->refusal, sizeof f->refusal,
                     "%.60s lies between people (%zu were to answer at one of its levels, %zu at several), and "
                     "factors between people are not analysed",
                     key->name, planned.one, planned.several);
    }
    return true;
}

static bool keep_person(struct factorial *f, size_t person, const double *sum, const size_t *count)
{
    size_t missing = 0;
    for (size_t c = 0; c < f->cells; c++)
        missing += count[c] == 0;
    if (missing == f->cells)
        return true; // not one of them
    if (missing) {
        if (!sample_grow(&f->left, f->left_count, sizeof f->left[0]))
            return false;
        f->left[f->left_count++] = (struct factorial_left){person, missing};
        return true;
    }
    for (size_t c = 0; c < f->cells; c++) {
        f->values[f->people * f->cells + c] = sum[c] / (double)count[c];
        f->least = f->least == 0 || count[c] < f->least ? count[c] : f->least;
        f->most = count[c] > f->most ? count[c] : f->most;
    }
    f->people++;
    return true;
}

static bool fill(struct factorial *f, const struct keys *keys, size_t people)
{
    double *sum = calloc(f->cells, sizeof *sum);
    size_t *count = calloc(f->cells, sizeof *count);
    f->values = calloc(people * f->cells, sizeof *f->values);
    bool ok = sum && count && f->values;
    for (size_t i = 0; i < f->rating_count; i++)
        f->ratings[i].place = cell_of(keys, f->ratings[i].cell);
    for (size_t person = 0; ok && person < people; person++) {
        memset(sum, 0, f->cells * sizeof *sum);
        memset(count, 0, f->cells * sizeof *count);
        for (size_t i = 0; i < f->rating_count; i++)
            if (f->ratings[i].person == person) {
                sum[f->ratings[i].place] += f->ratings[i].value;
                count[f->ratings[i].place]++;
            }
        ok = keep_person(f, person, sum, count);
    }
    free(sum);
    free(count);
    return ok;
}

bool factorial_design(struct factorial *f, const struct sample *sample)
{
    struct keys keys = {0};
    bool ok = find_keys(&keys, f, sample);
    if (ok && !f->refusal[0]) {
        drop_keys(f, &keys);
        ok = take_factors(f, &keys);
    }
    ok = ok && (f->refusal[0] || refuse_between(f, &keys, sample));
    if (ok && !f->refusal[0]) {
        ok = fill(f, &keys, sample->person_count);
        if (f->people < 2)
            snprintf(f->refusal, sizeof f->refusal,
                     "it takes two participants with a rating in each of the %zu cells, and there %s %zu",
                     f->cells, f->people == 1 ? "is" : "are", f->people);
    }
    for (size_t k = 0; k < keys.count; k++) {
        free(keys.items[k].levels);
        free(keys.items[k].of_text);
    }
    return ok;
}
