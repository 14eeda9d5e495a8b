#include "analysis/report/ratings.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The ratings of one session and question while they arrive.
struct open_pair {
    size_t file;
    int64_t session_id;
    size_t question; // SAMPLE_NONE: none yet
    size_t count;
    size_t conditions[2];
    double values[2];
};

struct filling {
    struct ratings *ratings;
    struct sample *sample;
    size_t file;
    struct open_pair pair;
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
    struct rating_group *group = find_group(q, pair);
    if (!group || !sample_grow(&group->first, group->n, sizeof group->first[0]) ||
        !sample_grow(&group->second, group->n, sizeof group->second[0]))
        return false;
    group->first[group->n] = pair->values[0];
    group->second[group->n++] = pair->values[1];
    f->ratings->used += 2;
    return true;
}

static bool add_rating(void *user, const struct store_rating_row *row)
{
    struct filling *f = user;
    struct ratings *r = f->ratings;
    if (sample_find_session(f->sample, f->file, row->session_id) == SAMPLE_NONE)
        return true;
    size_t condition = sample_find_condition(f->sample, f->file, row->condition_id);
    if (row->trial_id == 0 || condition == SAMPLE_NONE) {
        r->no_condition++;
        return true;
    }
    if (strcmp(row->trial_status, "done") != 0) {
        r->not_done++;
        return true;
    }
    if (strcmp(row->trial_kind, "practice") == 0 || strcmp(row->trial_kind, "catch") == 0 ||
        strcmp(row->trial_kind, "null") == 0) {
        r->other_kinds++;
        return true;
    }
    if (sample_ratings_excluded(f->sample, f->file, row->trial_id)) {
        r->excluded++;
        return true;
    }
    if (!*row->order) { // of no rate block with a complement: nothing says what it would be paired with
        r->more++;
        return true;
    }
    size_t question = find_question(f, row);
    if (question == SAMPLE_NONE)
        return false;
    struct open_pair *pair = &f->pair;
    if (pair->session_id != row->session_id || pair->question != question) {
        if (!close_pair(f))
            return false;
        pair->session_id = row->session_id;
        pair->question = question;
    }
    if (pair->count == 2) {
        r->more++;
        return true;
    }
    pair->conditions[pair->count] = condition;
    pair->values[pair->count++] = row->value;
    return true;
}

static int by_first(const void *x, const void *y)
{
    const struct rating_group *a = x, *b = y;
    if (a->first_condition != b->first_condition)
        return a->first_condition < b->first_condition ? -1 : 1;
    return (a->second_condition > b->second_condition) - (a->second_condition < b->second_condition);
}

static void finish(struct rating_question *q, double conf)
{
    const struct stat_ttest_options options = {.conf = conf};
    qsort(q->groups, q->group_count, sizeof q->groups[0], by_first);
    for (size_t i = 0; i < q->group_count; i++) {
        struct rating_group *g = &q->groups[i];
        g->first_of = stat_moments(g->first, g->n);
        g->second_of = stat_moments(g->second, g->n);
        g->change = stat_ttest_paired(g->second, g->first, g->n, &options);
    }
    q->compared = q->group_count == 2;
    if (q->compared)
        q->first_between =
            stat_ttest_welch(q->groups[0].first, q->groups[0].n, q->groups[1].first, q->groups[1].n, &options);
}

bool ratings_load(struct ratings *out, struct sample *sample, double conf, char *error, size_t error_size)
{
    *out = (struct ratings){.conf = conf};
    bool ok = true;
    snprintf(error, error_size, "not enough memory");
    for (size_t i = 0; ok && i < sample->file_count; i++) {
        struct filling f = {.ratings = out, .sample = sample, .file = i, .pair = {.question = SAMPLE_NONE}};
        ok = store_read_ratings(sample->files[i], add_rating, &f) && close_pair(&f);
        if (!ok && store_reader_error(sample->files[i])[0])
            snprintf(error, error_size, "%s", store_reader_error(sample->files[i]));
    }
    if (!ok) {
        ratings_free(out);
        return false;
    }
    for (size_t i = 0; i < out->question_count; i++)
        if (out->questions[i].group_count)
            finish(&out->questions[i], conf);
    error[0] = '\0';
    return true;
}

void ratings_free(struct ratings *ratings)
{
    for (size_t i = 0; i < ratings->question_count; i++) {
        for (size_t j = 0; j < ratings->questions[i].group_count; j++) {
            free(ratings->questions[i].groups[j].first);
            free(ratings->questions[i].groups[j].second);
        }
        free(ratings->questions[i].groups);
    }
    free(ratings->questions);
    *ratings = (struct ratings){0};
}
