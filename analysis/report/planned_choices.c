// Planned tests of choices, and of equality within the protocol's margin.
//
// One answer each: answers are independent. Several: people are.
#include "analysis/report/planned_data.h"

#include "analysis/stats/people_equivalence.h"
#include "analysis/stats/signflip.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

// Each person's answers in the cells of a group.
static void sum_people(const struct planned_data *data, const struct planned_group *group,
                       struct stat_person *people)
{
    for (size_t p = 0; p < data->sample->person_count; p++) {
        people[p] = (struct stat_person){0, 0};
        for (size_t i = 0; i < group->cell_count; i++) {
            const struct planned_cell *cell = &data->cells[group->cells[i]];
            people[p].k += (int64_t)cell->sum[p];
            people[p].n += cell->count[p];
        }
    }
}

// The section on choices has the same cell, unless the plan tells scenes apart there.
static void name_cell(struct planned_row *row, const struct planned_data *data,
                      const struct planned_group *group)
{
    const struct planned_cell *cell = &data->cells[group->cells[0]];
    for (size_t i = 0; i < data->cell_count; i++) {
        const struct planned_cell *other = &data->cells[i];
        if (other != cell && other->test == cell->test && other->reference == cell->reference &&
            strcmp(other->series, cell->series) == 0 && strcmp(other->block, cell->block) == 0 &&
            strcmp(other->factors, cell->factors) == 0)
            return;
    }
    if (group->cell_count != 1)
        return;
    row->block = cell->block;
    row->factors = cell->factors;
    row->option = cell->test;
    row->reference = cell->reference;
}

static void difference_row(struct planned_row *row, const struct stat_person *people, size_t count, double conf,
                           bool tested)
{
    struct stat_people sum = stat_people_sum(people, count);
    bool several = sum.most_n > 1;
    struct stat_binomial b = stat_binomial_test(sum.k, sum.n, 0.5, conf, STAT_TWO_SIDED);
    struct stat_ttest t = stat_people_t(people, count, &(struct stat_ttest_options){.mean = 0.5, .conf = conf});
    struct stat_signflip flip = stat_signflip(people, several ? count : 0, STAT_TWO_SIDED);
    row->people = sum.people;
    row->share = true;
    row->estimate = stat_people_share(people, count);
    row->low = several ? t.ci_low : b.ci.low;
    row->high = several ? t.ci_high : b.ci.high;
    if (!tested)
        return;
    row->p_value = !several ? b.p_value : isnan(flip.p_value) ? t.p_value : flip.p_value;
    snprintf(row->test, sizeof row->test, "%s, %" PRId64 " of %" PRId64,
             !several              ? "exact binomial"
             : isnan(flip.p_value) ? "t of the people\u2019s shares"
                                   : "sign-flip of people",
             sum.k, sum.n);
    double least = several ? flip.least_p : stat_binomial_p(0, sum.n, 0.5, STAT_TWO_SIDED);
    if (least > 1 - conf)
        snprintf(row->note, sizeof row->note, "cannot reach %.4g: the smallest p of so few is %.3g", 1 - conf,
                 least);
}

// Why there is no test of equality over people: without spread there is no t. A share of everybody that lies
// outside the margin is no equality all the same.
static void equality_without_test(struct planned_row *row)
{
    if (row->people < 2)
        snprintf(row->note, sizeof row->note, "equality is not estimable: one person alone");
    else if (fabs(row->estimate - 0.5) >= row->margin)
        snprintf(
            row->note, sizeof row->note,
            "equality is not shown: all people have the same share, so that there is no t-test, and it lies "
            "outside the margin");
    else
        snprintf(row->note, sizeof row->note,
                 "equality is not estimable: all people have the same share, so that there is no t-test");
}

static void equality_row(struct planned_row *row, const struct stat_person *people, size_t count, double alpha,
                         double margin)
{
    struct stat_people sum = stat_people_sum(people, count);
    bool several = sum.most_n > 1;
    row->people = sum.people;
    row->share = true;
    row->margin = margin;
    if (!(alpha < 0.5)) {
        snprintf(row->note, sizeof row->note, "not computed: equality takes a confidence above 0.5");
        return;
    }
    struct stat_equivalence e = several ? stat_people_equivalence(people, count, 0.5, margin, alpha)
                                        : stat_binomial_equivalence(sum.k, sum.n, 0.5, margin, alpha);
    row->estimate = stat_people_share(people, count);
    row->conf = 1 - 2 * alpha;
    row->p_value = e.p_value;
    row->low = e.ci.low;
    row->high = e.ci.high;
    if (isnan(e.p_value))
        equality_without_test(row);
    else
        snprintf(row->test, sizeof row->test, "two one-sided %s",
                 several ? "t of the people\u2019s shares" : "exact binomials");
}

bool planned_choices(struct planned *out, const struct planned_data *data, const struct planned_group *group,
                     const struct plan *plan, size_t index, size_t partial, struct stat_person *room)
{
    size_t count = data->sample->person_count;
    struct planned_row *row = planned_row_add(out, index);
    if (!row)
        return false;
    sum_people(data, group, room);
    snprintf(row->words, sizeof row->words, "%s", group->words);
    row->partial = partial;
    difference_row(row, room, count, out->conf, plan_is(plan, "binomial", NULL, NULL));
    if (isnan(plan->margin) || !plan_is(plan, "binomial", NULL, NULL) || group->series[0])
        return true; // a margin is of preferences: right answers are a series
    struct planned_row *equality = planned_row_add(out, index);
    if (!equality)
        return false;
    snprintf(equality->words, sizeof equality->words, "%.400s%sequality within %.4g to %.4g\u00a0%%",
             group->words, group->words[0] ? ": " : "", 50 - 100 * plan->margin, 50 + 100 * plan->margin);
    equality->partial = partial;
    name_cell(equality, data, group);
    equality_row(equality, room, count, 1 - out->conf, plan->margin);
    return true;
}

void planned_verdicts(struct planned *planned)
{
    static const char *const words[] = {[STAT_UNDECIDED] = "neither equality nor a difference is shown",
                                        [STAT_DIFFERENT] = "equality is not shown, a difference is",
                                        [STAT_WITHIN] = "equality is shown",
                                        [STAT_DIFFERENT_WITHIN] = "equality is shown, beside a difference"};
    for (size_t i = 1; i < planned->row_count; i++) {
        struct planned_row *row = &planned->rows[i];
        if (isnan(row->margin) || isnan(row->holm))
            continue;
        row->verdict = stat_verdict(planned->rows[i - 1].holm, row->holm, 1 - planned->conf);
        snprintf(row->note, sizeof row->note, "%s", words[row->verdict]);
    }
}

size_t planned_equality(const struct planned *planned)
{
    size_t count = 0;
    for (size_t i = 0; i < planned->row_count; i++)
        count += !isnan(planned->rows[i].margin) && !isnan(planned->rows[i].p_value);
    return count;
}
