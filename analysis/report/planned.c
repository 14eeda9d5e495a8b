#include "analysis/report/planned_data.h"

#include "analysis/stats/multiple.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct planned_row *planned_row_add(struct planned *out, size_t plan)
{
    const double none = (double)NAN;
    if (!sample_grow(&out->rows, out->row_count, sizeof out->rows[0]))
        return NULL;
    struct planned_row *row = &out->rows[out->row_count++];
    *row = (struct planned_row){.plan = plan,
                                .estimate = none,
                                .low = none,
                                .high = none,
                                .conf = out->conf,
                                .margin = none,
                                .unit = "",
                                .p_value = none,
                                .holm = none};
    return row;
}

void planned_row_t(struct planned_row *row, const struct stat_ttest *t, const char *unit, bool tested)
{
    row->estimate = t->estimate;
    row->low = t->ci_low;
    row->high = t->ci_high;
    row->unit = unit;
    if (tested)
        row->p_value = t->p_value;
    if (tested && !isnan(t->p_value))
        snprintf(row->test, sizeof row->test, "t(%.4g) = %.3f", t->df, t->t);
    else if (isnan(t->ci_low))
        snprintf(row->note, sizeof row->note, "%s",
                 row->people < 2 ? "one person alone has no interval"
                                 : "no spread, or one person alone: no interval");
}

// Means over people, tested against 0 where they are differences already.
static void mean_row(struct planned_row *row, const struct planned_data *data,
                     const struct planned_group *group, bool tested, double conf, double *room)
{
    size_t n = 0;
    for (size_t p = 0; p < data->sample->person_count; p++) {
        double sum = 0;
        size_t cells = 0;
        for (size_t i = 0; i < group->cell_count; i++) {
            const struct planned_cell *cell = &data->cells[group->cells[i]];
            if (cell->count[p] > 0)
                sum += cell->sum[p] / (double)cell->count[p];
            cells += cell->count[p] > 0;
        }
        if (cells)
            room[n++] = sum / (double)cells;
    }
    row->people = n;
    struct stat_ttest t = stat_ttest_one_sample(room, n, &(struct stat_ttest_options){.conf = conf});
    t.estimate = stat_moments(room, n).mean;
    planned_row_t(row, &t, data->unit, tested);
}

// People who lack cells that others have.
static size_t count_partial(const struct planned_data *data, const struct planned_group *group)
{
    size_t most = 0, partial = 0;
    for (int pass = 0; pass < 2; pass++)
        for (size_t p = 0; p < data->sample->person_count; p++) {
            size_t cells = 0;
            for (size_t i = 0; i < group->cell_count; i++)
                cells += data->cells[group->cells[i]].count[p] > 0;
            most = pass == 0 && cells > most ? cells : most;
            partial += pass == 1 && cells > 0 && cells < most;
        }
    return partial;
}

static bool differences(const struct planned_data *data)
{
    return data->cell_count > 0 && data->cells[0].difference;
}

static bool group_row(struct planned *out, const struct planned_data *data, const struct planned_group *group,
                      const struct plan *plan, size_t index, void *room)
{
    if (data->counts && !plan_is(plan, "paired_t", NULL, NULL))
        return planned_choices(out, data, group, plan, index, count_partial(data, group), room);
    struct planned_row *row = planned_row_add(out, index);
    if (!row)
        return false;
    snprintf(row->words, sizeof row->words, "%s", group->words);
    row->difference = differences(data);
    row->partial = count_partial(data, group);
    mean_row(row, data, group, plan_is(plan, "paired_t", NULL, NULL), out->conf, room);
    return true;
}

static bool group_rows(struct planned *out, const struct planned_data *data,
                       const struct planned_groups *groups, const struct plan *plan, size_t index)
{
    size_t people = data->sample->person_count + 1;
    void *room = malloc(people * (sizeof(struct stat_person) + sizeof(double)));
    bool ok = room != NULL;
    for (size_t i = 0; ok && i < groups->count; i++)
        ok = group_row(out, data, &groups->items[i], plan, index, room);
    free(room);
    return ok;
}

// First ratings between the two orders; what is compared is not the same people's.
static bool order_rows(struct planned *out, const struct ratings *ratings, const struct sample *sample,
                       size_t index)
{
    for (size_t i = 0; i < ratings->question_count; i++) {
        const struct rating_question *q = &ratings->questions[i];
        struct planned_row *row = planned_row_add(out, index);
        if (!row)
            return false;
        if (!q->compared) {
            snprintf(row->words, sizeof row->words, "%.100s", q->question);
            snprintf(row->note, sizeof row->note, "not computed: %s",
                     q->overlap ? "somebody rated in both orders" : "that needs two order groups");
            continue;
        }
        snprintf(row->words, sizeof row->words, "%.60s, first ratings: %.110s \u2212 %.110s", q->question,
                 sample->conditions[q->groups[0].first_condition].words,
                 sample->conditions[q->groups[1].first_condition].words);
        row->people = q->groups[0].n + q->groups[1].n;
        planned_row_t(row, &q->first_between, "", true);
    }
    return true;
}

// What the language permits and nothing can mean; NULL where there is a meaning.
static const char *senseless(const struct plan *plan)
{
    bool rating = plan_is(plan, NULL, "rating", NULL), order = plan_is(plan, NULL, NULL, "order");
    bool whole = plan_is(plan, NULL, NULL, "study") || plan_is(plan, NULL, NULL, "-");
    if (plan_is(plan, "binomial", NULL, NULL) && !plan_is(plan, NULL, "choice", NULL))
        return "a binomial test counts choices; these values have means";
    if (order && !rating)
        return "only ratings before and after have an order of people; what was shown first is checked in "
               "section "
               "\u201cEffects on choices that are no preference\u201d";
    if (plan_is(plan, "anova", NULL, NULL) &&
        (order || plan_is(plan, NULL, NULL, "cell") || plan_is(plan, NULL, NULL, "study")))
        return "an analysis of variance compares levels of factors; plan it per factor";
    if (plan_is(plan, "unpaired_t", NULL, NULL) && whole)
        return "all people together are one group; plan it per factor, scene or order";
    if (plan_is(plan, "paired_t", NULL, NULL) && whole && !rating)
        return "one value per person makes no pair; plan it per factor, scene or cell";
    return NULL;
}

static bool plan_rows(struct planned *out, const struct planned_data *data, const struct plan *plan,
                      size_t index, const struct planned_sources *sources)
{
    struct planned_groups groups;
    if (plan_is(plan, "anova", NULL, NULL))
        return planned_anova(out, data, plan, index, sources);
    if (plan_is(plan, "unpaired_t", "rating", "order"))
        return order_rows(out, sources->ratings, data->sample, index);
    if (!planned_groups_load(&groups, data, plan))
        return false;
    bool pairs = plan_is(plan, "unpaired_t", NULL, NULL) ||
                 (plan_is(plan, "paired_t", NULL, NULL) && !differences(data));
    bool ok = pairs && groups.count > 0 ? planned_pairs(out, data, &groups, plan, index)
                                        : group_rows(out, data, &groups, plan, index);
    planned_groups_free(&groups);
    return ok;
}

// Why a plan has no row.
static const char *missing(const struct planned_data *data, const struct plan *plan)
{
    if (data->cell_count == 0)
        return "no such value was recorded that counts";
    if (plan_is(plan, NULL, NULL, "order"))
        return "no ratings before and after were recorded that count";
    return plan_is(plan, NULL, NULL, "scene")
               ? "scenes are no factor of these trials, so that no value is of one scene alone"
               : "the trials have no factor";
}

static bool add_plan(struct planned *out, struct sample *sample, const struct plans *plans, size_t index,
                     const struct planned_sources *sources, char *error, size_t error_size)
{
    const struct plan *plan = &plans->items[index];
    const char *why = senseless(plan);
    size_t first = out->row_count;
    struct planned_data data = {0};
    bool ok = why || planned_data_load(&data, sample, plan, sources, error, error_size);
    ok = ok && (why || plan_rows(out, &data, plan, index, sources));
    if (ok && !why && out->row_count == first)
        why = missing(&data, plan);
    struct planned_row *row = ok && why ? planned_row_add(out, index) : NULL;
    if (row)
        snprintf(row->note, sizeof row->note, "not computed: %s", why);
    planned_data_free(&data);
    return ok && (!why || row);
}

// Over the planned family. No preference has both no difference and one beyond the margin.
static bool adjust(struct planned *out)
{
    double *p = calloc(out->row_count + 1, sizeof *p);
    size_t *set = calloc(out->row_count + 1, sizeof *set);
    for (size_t i = 0; p && set && i < out->row_count; i++) {
        p[i] = out->rows[i].p_value;
        set[i] = isnan(out->rows[i].margin) ? i : i - 1;
        out->tested += isnan(p[i]) ? 0 : 1;
    }
    bool ok = p && set;
    if (ok)
        stat_adjust_exclusive(p, set, out->row_count, p);
    for (size_t i = 0; ok && i < out->row_count; i++)
        out->rows[i].holm = p[i];
    free(p);
    free(set);
    if (ok)
        planned_verdicts(out);
    return ok;
}

bool planned_load(struct planned *out, struct sample *sample, const struct plans *plans,
                  const struct planned_sources *sources, double conf, char *error, size_t error_size)
{
    *out = (struct planned){.conf = conf};
    bool ok = true;
    snprintf(error, error_size, "not enough memory");
    for (size_t i = 0; ok && i < plans->count; i++)
        ok = add_plan(out, sample, plans, i, sources, error, error_size);
    ok = ok && adjust(out);
    if (ok)
        error[0] = '\0';
    else
        planned_free(out);
    return ok;
}

void planned_free(struct planned *planned)
{
    free(planned->rows);
    *planned = (struct planned){0};
}
