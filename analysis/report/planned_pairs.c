// Two levels, scenes or cells compared: within people where they saw both, else between people.
//
// Within: a person's difference is the mean over what is otherwise the same at both levels (the block, and the
// levels of all factors that neither follow from the compared one nor fix it), so that no level is favoured by
// what else it stood with. Between: Welch's t of the people's means, where nobody saw both.
#include "analysis/report/planned_data.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Whether a level of `from` never comes with two levels of `to` in the series.
static bool fixes(const struct planned_data *data, const char *series, const char *from, const char *to)
{
    for (size_t i = 0; i < data->cell_count; i++)
        for (size_t j = i + 1; j < data->cell_count; j++) {
            const struct planned_cell *a = &data->cells[i], *b = &data->cells[j];
            if (strcmp(a->series, series) != 0 || strcmp(b->series, series) != 0)
                continue;
            const char *x = planned_level(data, a, from), *y = planned_level(data, b, from),
                       *u = planned_level(data, a, to), *v = planned_level(data, b, to);
            if (x && y && u && v && strcmp(x, y) == 0 && strcmp(u, v) != 0)
                return false;
        }
    return true;
}

// The cell without the compared factor, as a text: equal where cells are otherwise the same.
static void rest_of(const struct planned_data *data, const struct planned_group *group,
                    const struct planned_cell *cell, char out[512])
{
    out[0] = '\0';
    if (!group->factor)
        return;
    snprintf(out, 512, "%.100s", cell->block);
    for (size_t i = 0; i < data->sample->factor_count; i++) {
        const struct sample_factor *f = &data->sample->factors[i];
        if (strcmp(f->factors, cell->factors) != 0 || strcmp(f->key, group->factor) == 0 ||
            strcmp(f->key, "trial") == 0 || fixes(data, group->series, group->factor, f->key) ||
            fixes(data, group->series, f->key, group->factor))
            continue;
        size_t used = strlen(out);
        snprintf(out + used, 512 - used, "|%s=%s", f->key, f->value);
    }
}

// A person's mean over the cells of a group with that rest (NULL: any); NaN where there is no value.
static double mean_of(const struct planned_data *data, const struct planned_group *group, char (*rests)[512],
                      const char *rest, size_t person)
{
    double sum = 0;
    size_t count = 0;
    for (size_t i = 0; i < group->cell_count; i++) {
        const struct planned_cell *cell = &data->cells[group->cells[i]];
        if (cell->count[person] == 0 || (rest && strcmp(rests[group->cells[i]], rest) != 0))
            continue;
        sum += cell->sum[person] / (double)cell->count[person];
        count++;
    }
    return count ? sum / (double)count : (double)NAN;
}

// The mean difference over common rests; NaN where the person has none. *io_pairs: over how many.
static double difference(const struct planned_data *data, const struct planned_group *a,
                         const struct planned_group *b, char (*rests)[512], size_t person, size_t *out_pairs)
{
    double sum = 0;
    *out_pairs = 0;
    for (size_t i = 0; i < a->cell_count; i++) {
        const char *rest = rests[a->cells[i]];
        bool known = false;
        for (size_t j = 0; j < i && !known; j++)
            known = strcmp(rests[a->cells[j]], rest) == 0;
        double d =
            known ? (double)NAN : mean_of(data, a, rests, rest, person) - mean_of(data, b, rests, rest, person);
        if (isnan(d))
            continue;
        sum += d;
        ++*out_pairs;
    }
    return *out_pairs ? sum / (double)*out_pairs : (double)NAN;
}

static void within(struct planned_row *row, const struct planned_data *data, const struct planned_group *a,
                   const struct planned_group *b, char (*rests)[512], double conf, double *room)
{
    size_t n = 0, most = 0, *pairs = calloc(data->sample->person_count + 1, sizeof *pairs);
    for (size_t p = 0; pairs && p < data->sample->person_count; p++) {
        double d = difference(data, a, b, rests, p, &pairs[n]);
        if (!isnan(d)) {
            most = pairs[n] > most ? pairs[n] : most;
            room[n++] = d;
        }
    }
    for (size_t i = 0; pairs && i < n; i++)
        row->partial += pairs[i] < most;
    free(pairs);
    row->people = n;
    struct stat_ttest t = stat_ttest_one_sample(room, n, &(struct stat_ttest_options){.conf = conf});
    if (n)
        t.estimate = stat_moments(room, n).mean;
    planned_row_t(row, &t, data->unit, true);
    if (n == 0)
        snprintf(row->note, sizeof row->note,
                 "not estimable: nobody has values of both in what is otherwise the same");
}

static void between(struct planned_row *row, const struct planned_data *data, const struct planned_group *a,
                    const struct planned_group *b, double conf, double *room)
{
    size_t n_a = 0, n_b = 0, both = 0;
    double *x = room, *y = room + data->sample->person_count;
    for (size_t p = 0; p < data->sample->person_count; p++) {
        double u = mean_of(data, a, NULL, NULL, p), v = mean_of(data, b, NULL, NULL, p);
        both += !isnan(u) && !isnan(v);
        if (!isnan(u))
            x[n_a++] = u;
        if (!isnan(v))
            y[n_b++] = v;
    }
    row->people = n_a + n_b - both;
    if (both) {
        snprintf(row->note, sizeof row->note,
                 "not computed: %zu %s values of both, so they are not independent; a paired test is theirs",
                 both, both == 1 ? "person has" : "people have");
        return;
    }
    struct stat_ttest t = stat_ttest_welch(x, n_a, y, n_b, &(struct stat_ttest_options){.conf = conf});
    planned_row_t(row, &t, data->unit, true);
}

static bool add_pair(struct planned *out, const struct planned_data *data, const struct planned_group *a,
                     const struct planned_group *b, const struct plan *plan, size_t index, char (*rests)[512])
{
    struct planned_row *row = planned_row_add(out, index);
    double *room = malloc((2 * data->sample->person_count + 1) * sizeof *room);
    if (row && room) {
        const char *second = a->series[0] && strncmp(b->words, a->series, strlen(a->series)) == 0 &&
                                     b->words[strlen(a->series)] == ':'
                                 ? b->words + strlen(a->series) + 2
                                 : b->words;
        snprintf(row->words, sizeof row->words, "%.170s \u2212 %.140s", a->words, second);
        row->share = data->counts;
        if (plan_is(plan, "paired_t", NULL, NULL))
            within(row, data, a, b, rests, out->conf, room);
        else
            between(row, data, a, b, out->conf, room);
    }
    free(room);
    return row && room;
}

static bool are_pair(const struct planned_group *a, const struct planned_group *b)
{
    return strcmp(a->series, b->series) == 0 &&
           (a->factor == b->factor || (a->factor && b->factor && strcmp(a->factor, b->factor) == 0));
}

bool planned_pairs(struct planned *out, const struct planned_data *data, const struct planned_groups *groups,
                   const struct plan *plan, size_t index)
{
    size_t pairs = 0, done = 0;
    for (size_t i = 0; i < groups->count; i++)
        for (size_t j = i + 1; j < groups->count; j++)
            pairs += are_pair(&groups->items[i], &groups->items[j]);
    if (pairs == 0 || pairs > PLANNED_PAIRS) {
        struct planned_row *row = planned_row_add(out, index);
        if (row && pairs)
            snprintf(row->note, sizeof row->note,
                     "not computed: %zu pairs are more than %d; plan it per factor or scene", pairs,
                     PLANNED_PAIRS);
        else if (row)
            snprintf(row->note, sizeof row->note, "not computed: it compares two, and the data have %s",
                     groups->count ? "one alone" : "none");
        return row != NULL;
    }
    char(*rests)[512] = calloc(data->cell_count + 1, sizeof *rests);
    bool ok = rests != NULL;
    for (size_t i = 0; ok && i < groups->count; i++) {
        const struct planned_group *a = &groups->items[i];
        if (i == 0 || !are_pair(&groups->items[i - 1], a)) // another factor: cells have another rest
            for (size_t c = 0; c < data->cell_count; c++)
                rest_of(data, a, &data->cells[c], rests[c]);
        for (size_t j = i + 1; ok && j < groups->count; j++)
            if (are_pair(a, &groups->items[j])) {
                ok = add_pair(out, data, a, &groups->items[j], plan, index, rests);
                done++;
            }
    }
    free(rests);
    return ok && done == pairs;
}
