#include "analysis/report/ratings.h"

#include "analysis/report/late_first.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The ratings of one session and question while they arrive.
struct open_pair {
    size_t file;
    int64_t session_id;
    size_t person;
    size_t question; // SAMPLE_NONE: none yet
    size_t count;
    size_t conditions[2];
    double values[2];
    bool second[2]; // planned as the second, or planned as the first and late
};

struct filling {
    struct ratings *ratings;
    struct sample *sample;
    size_t file;
    struct late_first late;
    struct open_pair pair;
    struct rating_options_open option;
};

static size_t find_question(struct filling *f, const struct store_rating_row *row)
{
    struct ratings *r = f->ratings;
    for (size_t i = 0; i < r->question_count; i++)
        if (strcmp(r->questions[i].question, row->question) == 0)
            return i;
    struct rating_question question = {.question = sample_keep(f->sample, row->question),
                                       .scale_min = row->scale_min,
                                       .scale_max = row->scale_max};
    if (!question.question || !sample_grow(&r->questions, r->question_count, sizeof r->questions[0]))
        return SAMPLE_NONE;
    r->questions[r->question_count] = question;
    return r->question_count++;
}

static struct rating_group *find_group(struct rating_question *q, const struct open_pair *pair)
{
    for (size_t i = 0; i < q->group_count; i++)
        if (q->groups[i].first_condition == pair->conditions[0] &&
            q->groups[i].second_condition == pair->conditions[1])
            return &q->groups[i];
    if (!sample_grow(&q->groups, q->group_count, sizeof q->groups[0]))
        return NULL;
    q->groups[q->group_count] =
        (struct rating_group){.first_condition = pair->conditions[0], .second_condition = pair->conditions[1]};
    return &q->groups[q->group_count++];
}

// The place of a person in a group; SAMPLE_NONE where memory ran out.
static size_t find_person(struct rating_group *group, size_t person)
{
    size_t i = 0;
    while (i < group->n && group->person[i] != person)
        i++;
    if (i < group->n)
        return i;
    if (!sample_grow(&group->first, i, sizeof group->first[0]) ||
        !sample_grow(&group->second, i, sizeof group->second[0]) ||
        !sample_grow(&group->change_of, i, sizeof group->change_of[0]) ||
        !sample_grow(&group->person, i, sizeof group->person[0]) ||
        !sample_grow(&group->sittings, i, sizeof group->sittings[0]))
        return SAMPLE_NONE;
    group->person[i] = person;
    group->first[i] = group->second[i] = group->sittings[i] = 0;
    return group->n++;
}

static bool close_pair(struct filling *f)
{
    struct open_pair *pair = &f->pair;
    size_t count = pair->count;
    pair->count = 0;
    if (count == 0)
        return true;
    struct rating_question *q = &f->ratings->questions[pair->question];
    if (count < 2 || pair->conditions[0] == pair->conditions[1]) {
        q->unpaired++;
        return true;
    }
    if (pair->second[0] || !pair->second[1]) {
        q->late_first++;
        return true;
    }
    struct rating_group *group = find_group(q, pair);
    size_t i = group ? find_person(group, pair->person) : SAMPLE_NONE;
    if (i == SAMPLE_NONE)
        return false;
    group->first[i] += pair->values[0];
    group->second[i] += pair->values[1];
    group->sittings[i]++;
    f->ratings->used += 2;
    return true;
}

// Ratings that do not count, each under its reason.
static bool left_out(struct filling *f, const struct store_rating_row *row, size_t condition)
{
    struct ratings *r = f->ratings;
    int64_t *why = NULL;
    if (row->trial_id == 0 || condition == SAMPLE_NONE)
        why = &r->no_condition;
    else if (strcmp(row->trial_status, "done") != 0)
        why = &r->not_done;
    else if (strcmp(row->trial_kind, "practice") == 0 || strcmp(row->trial_kind, "catch") == 0 ||
             strcmp(row->trial_kind, "null") == 0)
        why = &r->other_kinds;
    else if (sample_ratings_excluded(f->sample, f->file, row->trial_id))
        why = &r->excluded;
    else if (!isfinite(row->value))
        why = &r->not_finite;
    if (why)
        ++*why;
    return why != NULL;
}

static bool add_before_after(struct filling *f, const struct store_rating_row *row, size_t person,
                             size_t condition)
{
    size_t question = find_question(f, row);
    if (question == SAMPLE_NONE)
        return false;
    struct open_pair *pair = &f->pair;
    if (pair->session_id != row->session_id || pair->question != question) {
        if (!close_pair(f))
            return false;
        pair->session_id = row->session_id;
        pair->person = person;
        pair->question = question;
    }
    if (pair->count == 2) {
        f->ratings->more++;
        return true;
    }
    pair->conditions[pair->count] = condition;
    pair->second[pair->count] = strcmp(row->order, "second") == 0 || late_first_has(&f->late, row->trial_id);
    pair->values[pair->count++] = row->value;
    return true;
}

static bool add_rating(void *user, const struct store_rating_row *row)
{
    struct filling *f = user;
    size_t session = sample_find_session(f->sample, f->file, row->session_id);
    size_t condition = sample_find_condition(f->sample, f->file, row->condition_id);
    if (session == SAMPLE_NONE || left_out(f, row, condition))
        return true;
    size_t person = f->sample->sessions[session].person;
    if (*row->order)
        return add_before_after(f, row, person, condition);
    if (strcmp(row->trial_kind, "rate") == 0)
        return factorial_add(&f->ratings->factorials, f->sample, row, person);
    if (row->subject != 's')
        return rating_options_add(&f->ratings->options, f->sample, &f->option, row, person, condition);
    f->ratings->more++; // of nothing that it could be compared with
    return true;
}

static int by_first(const void *x, const void *y)
{
    const struct rating_group *a = x, *b = y;
    if (a->first_condition != b->first_condition)
        return a->first_condition < b->first_condition ? -1 : 1;
    return (a->second_condition > b->second_condition) - (a->second_condition < b->second_condition);
}

// Whether somebody rated in both orders, in different sittings: the groups are then not independent.
static bool overlap(const struct rating_group *a, const struct rating_group *b)
{
    for (size_t i = 0; i < a->n; i++)
        for (size_t k = 0; k < b->n; k++)
            if (a->person[i] == b->person[k])
                return true;
    return false;
}

static void finish(struct rating_question *q, double conf, bool pratt)
{
    const struct stat_ttest_options options = {.conf = conf};
    qsort(q->groups, q->group_count, sizeof q->groups[0], by_first);
    for (size_t i = 0; i < q->group_count; i++) {
        struct rating_group *g = &q->groups[i];
        for (size_t k = 0; k < g->n; k++) { // a person's sittings are averaged
            // of sums, so that equal changes stay equal and tie
            g->change_of[k] = (g->second[k] - g->first[k]) / g->sittings[k];
            g->first[k] /= g->sittings[k];
            g->second[k] /= g->sittings[k];
        }
        g->first_of = stat_moments(g->first, g->n);
        g->second_of = stat_moments(g->second, g->n);
        g->change = stat_ttest_one_sample(g->change_of, g->n, &options);
        g->rank =
            stat_wilcoxon(g->change_of, g->n, &(struct stat_wilcoxon_options){.conf = conf, .pratt = pratt});
        g->effect = stat_effect_one_sample(g->change_of, g->n, 0, conf);
        g->average = stat_effect_average(g->second, g->first, g->n, conf);
    }
    q->overlap = q->group_count == 2 && overlap(&q->groups[0], &q->groups[1]);
    q->compared = q->group_count == 2 && !q->overlap;
    if (!q->compared)
        return;
    const struct rating_group *a = &q->groups[0], *b = &q->groups[1];
    q->first_between = stat_ttest_welch(a->first, a->n, b->first, b->n, &options);
    q->between_effect = stat_effect_two_samples(a->first, a->n, b->first, b->n, conf);
}

bool ratings_load(struct ratings *out, struct sample *sample, double conf, bool pratt, char *error,
                  size_t error_size)
{
    *out = (struct ratings){.conf = conf};
    bool ok = true;
    snprintf(error, error_size, "not enough memory");
    for (size_t i = 0; ok && i < sample->file_count; i++) {
        struct filling f = {.ratings = out, .sample = sample, .file = i, .pair = {.question = SAMPLE_NONE}};
        ok = late_first_load(&f.late, sample, i) && store_read_ratings(sample->files[i], add_rating, &f) &&
             close_pair(&f);
        late_first_free(&f.late);
        rating_options_close(&out->options, &f.option);
        if (!ok && store_reader_error(sample->files[i])[0])
            snprintf(error, error_size, "%s", store_reader_error(sample->files[i]));
    }
    ok = ok && factorial_finish(&out->factorials, sample, conf) &&
         rating_options_finish(&out->options, conf, pratt);
    if (!ok) {
        ratings_free(out);
        return false;
    }
    for (size_t i = 0; i < out->question_count; i++)
        if (out->questions[i].group_count)
            finish(&out->questions[i], conf, pratt);
    error[0] = '\0';
    return true;
}

void ratings_free(struct ratings *ratings)
{
    for (size_t i = 0; i < ratings->question_count; i++) {
        for (size_t j = 0; j < ratings->questions[i].group_count; j++) {
            free(ratings->questions[i].groups[j].first);
            free(ratings->questions[i].groups[j].second);
            free(ratings->questions[i].groups[j].change_of);
            free(ratings->questions[i].groups[j].person);
            free(ratings->questions[i].groups[j].sittings);
        }
        free(ratings->questions[i].groups);
    }
    free(ratings->questions);
    rating_options_free(&ratings->options);
    factorial_free(&ratings->factorials);
    *ratings = (struct ratings){0};
}

bool ratings_any(const struct ratings *ratings)
{
    return ratings->question_count || ratings->options.count || ratings->factorials.count;
}
