// Two levels, scenes or cells compared, within or between people as the plan says, if that is how they lie.
//
// Within: a person's difference is the mean over what is otherwise the same at both levels (the block, and the
// levels of all factors that neither follow from the compared one nor fix it), so that no level is favoured by
// what else it stood with. Between: Welch's t of the people's means, without those who have values at several
// levels. Who was to see what decides which of them fits (planned_design.c).
#include "analysis/report/planned_data.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// A factor's level in every cell; NULL where it has none or is of another series.
static void levels_of(const struct planned_data *data, const char *series, const char *factor, const char **out)
{
    for (size_t i = 0; i < data->cell_count; i++)
        out[i] =
            strcmp(data->cells[i].series, series) == 0 ? planned_level(data, &data->cells[i], factor) : NULL;
}

// Whether a level of `from` never comes with two levels of `to`.
static bool fixes(const char *const *from, const char *const *to, size_t cells)
{
    for (size_t i = 0; i < cells; i++)
        for (size_t j = i + 1; from[i] && to[i] && j < cells; j++)
            if (from[j] && to[j] && strcmp(from[i], from[j]) == 0 && strcmp(to[i], to[j]) != 0)
                return false;
    return true;
}

static bool known_key(const struct sample *sample, size_t factor)
{
    for (size_t i = 0; i < factor; i++)
        if (strcmp(sample->factors[i].key, sample->factors[factor].key) == 0)
            return true;
    return false;
}

// Each cell without the factor compared, as a text: equal where cells are otherwise the same. False where
// memory ran out.
static bool fill_rests(const struct planned_data *data, const struct planned_group *group, char (*rests)[512])
{
    const struct sample *sample = data->sample;
    const size_t cells = data->cell_count;
    const char **room = calloc(2 * cells + 1, sizeof *room), **compared = room, **other = room + cells;
    for (size_t c = 0; c < cells; c++)
        snprintf(rests[c], sizeof rests[c], "%.100s", group->factor ? data->cells[c].block : "");
    if (room && group->factor)
        levels_of(data, group->series, group->factor, compared);
    for (size_t i = 0; room && group->factor && i < sample->factor_count; i++) {
        const char *key = sample->factors[i].key;
        if (known_key(sample, i) || strcmp(key, group->factor) == 0 || strcmp(key, "trial") == 0)
            continue;
        levels_of(data, group->series, key, other);
        if (fixes(compared, other, cells) || fixes(other, compared, cells))
            continue;
        for (size_t c = 0; c < cells; c++) {
            size_t used = strlen(rests[c]);
            snprintf(rests[c] + used, sizeof rests[c] - used, "|%s=%s", key, other[c] ? other[c] : "");
        }
    }
    free(room);
    return room != NULL;
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

static bool has_value(const struct planned_data *data, const struct planned_group *group, size_t person)
{
    return !isnan(mean_of(data, group, NULL, NULL, person));
}

static bool within(struct planned_row *row, const struct planned_data *data, const struct planned_group *a,
                   const struct planned_group *b, char (*rests)[512], double conf, double *room)
{
    size_t n = 0, most = 0, *pairs = calloc(data->sample->person_count + 1, sizeof *pairs);
    if (!pairs)
        return false;
    for (size_t p = 0; p < data->sample->person_count; p++) {
        double d = difference(data, a, b, rests, p, &pairs[n]);
        if (!isnan(d)) {
            most = pairs[n] > most ? pairs[n] : most;
            room[n++] = d;
        } else {
            row->left_out += has_value(data, a, p) || has_value(data, b, p);
        }
    }
    for (size_t i = 0; i < n; i++)
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
    else
        planned_row_left_out(row, "without values of both");
    return true;
}

static void between(struct planned_row *row, const struct planned_data *data, const struct planned_group *a,
                    const struct planned_group *b, const bool *stray, double conf, double *room)
{
    size_t n_a = 0, n_b = 0;
    double *x = room, *y = room + data->sample->person_count;
    for (size_t p = 0; p < data->sample->person_count; p++) {
        double u = mean_of(data, a, NULL, NULL, p), v = mean_of(data, b, NULL, NULL, p);
        if (stray[p])
            row->left_out += !isnan(u) || !isnan(v);
        else if (!isnan(u))
            x[n_a++] = u;
        else if (!isnan(v))
            y[n_b++] = v;
    }
    row->people = n_a + n_b;
    if (n_a == 0 || n_b == 0) {
        snprintf(row->note, sizeof row->note,
                 "not estimable: everybody with values of one of them has values at other levels too");
    } else {
        struct stat_ttest t = stat_ttest_welch(x, n_a, y, n_b, &(struct stat_ttest_options){.conf = conf});
        planned_row_t(row, &t, data->unit, true);
    }
    planned_row_left_out(row, "with values at several levels");
}

static size_t people_of(const struct planned_data *data, const struct planned_group *a,
                        const struct planned_group *b)
{
    size_t people = 0;
    for (size_t p = 0; p < data->sample->person_count; p++)
        people += has_value(data, a, p) || has_value(data, b, p);
    return people;
}

static bool compare(struct planned_row *row, const struct planned_data *data, const struct planned_group *a,
                    const struct planned_group *b, bool paired, char (*rests)[512], double conf, double *room)
{
    struct planned_design design;
    if (!planned_design_load(&design, data, a, b))
        return false;
    bool ok = true;
    if (planned_design_refuses(row, &design, paired))
        row->people = people_of(data, a, b);
    else if (paired)
        ok = within(row, data, a, b, rests, conf, room);
    else
        between(row, data, a, b, design.stray, conf, room);
    planned_design_free(&design);
    return ok;
}

static bool add_pair(struct planned *out, const struct planned_data *data, const struct planned_group *a,
                     const struct planned_group *b, const struct plan *plan, size_t index, char (*rests)[512])
{
    struct planned_row *row = planned_row_add(out, index);
    double *room = malloc((2 * data->sample->person_count + 1) * sizeof *room);
    bool ok = row && room;
    if (ok) {
        const char *second = a->series[0] && strncmp(b->words, a->series, strlen(a->series)) == 0 &&
                                     b->words[strlen(a->series)] == ':'
                                 ? b->words + strlen(a->series) + 2
                                 : b->words;
        snprintf(row->words, sizeof row->words, "%.170s \u2212 %.140s", a->words, second);
        row->share = data->counts;
        row->difference = true;
        ok = compare(row, data, a, b, plan_is(plan, "paired_t", NULL, NULL), rests, out->conf, room);
    }
    free(room);
    return ok;
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
            ok = fill_rests(data, a, rests);
        for (size_t j = i + 1; ok && j < groups->count; j++)
            if (are_pair(a, &groups->items[j])) {
                ok = add_pair(out, data, a, &groups->items[j], plan, index, rests);
                done++;
            }
    }
    free(rests);
    return ok && done == pairs;
}
