// Answers of people as a plan needs them: with their scene, and with times per person. The same are left out as
// the sections on choices and ratings leave out.
#include "analysis/report/late_first.h"
#include "analysis/report/level.h"
#include "analysis/report/planned_data.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

struct filling {
    struct planned_data *data;
    const struct plan *plan;
    size_t file;
    struct late_first late_firsts;
    // The first of a person's two ratings while the second is waited for.
    int64_t trial_id, session_id;
    char question[128], subject;
    double value;
    size_t condition;
    bool second; // it, or one before it, was planned as the second
};

static void cell_words(const struct sample *sample, const struct planned_cell *cell, char out[256])
{
    level_all(sample, cell->factors, out);
    if (!out[0] && cell->test != SAMPLE_NONE && cell->reference != SAMPLE_NONE)
        snprintf(out, 256, "%.60s: %.80s or %.80s", cell->block, sample->conditions[cell->test].words,
                 sample->conditions[cell->reference].words);
    else if (!out[0])
        snprintf(out, 256, "%.60s", cell->block);
}

static bool add(struct filling *f, const struct planned_cell *like, size_t person, double value, int64_t count)
{
    char words[256];
    struct planned_cell named = *like;
    cell_words(f->data->sample, like, words);
    named.words = words;
    return planned_data_add(f->data, &named, person, value, count);
}

static bool add_trial(void *user, const struct store_trial_row *row)
{
    struct filling *f = user;
    struct sample *sample = f->data->sample;
    size_t session = sample_find_session(sample, f->file, row->session_id);
    bool toggle = strcmp(row->kind, "toggle") == 0;
    if (row->choice_id == 0 || session == SAMPLE_NONE || (!toggle && strcmp(row->kind, "sequential") != 0) ||
        strcmp(row->status, "done") != 0 || sample_trial_excluded(sample, f->file, row->id) ||
        row->chosen == '?')
        return true;
    bool right = f->data->counts && row->correct >= 0;
    struct planned_cell like = {.series = right ? "right answers" : "",
                                .block = row->block,
                                .factors = row->factors,
                                .scene = plan_is(f->plan, NULL, NULL, "scene") ? row->scene : "",
                                .test = sample_find_condition(sample, f->file, row->test_id),
                                .reference = sample_find_condition(sample, f->file, row->reference_id)};
    size_t person = sample->sessions[session].person;
    if (f->data->counts)
        return row->chosen == '=' || add(f, &like, person, right ? row->correct == 1 : row->chosen == 't', 1);
    if (plan_is(f->plan, NULL, "toggles", NULL)) // there is nothing to switch in a sequential trial
        return !toggle || add(f, &like, person, (double)row->toggles, 1);
    return isnan(row->reaction_s) || add(f, &like, person, row->reaction_s, 1);
}

// Before and after: of each pair of options in their order by itself, for the differences have other meanings.
// What was planned first but rated after the second had been seen was rated second, and makes no pair
// (ratings.h).
static bool add_before_after(struct filling *f, const struct store_rating_row *row, size_t person,
                             size_t condition)
{
    const struct sample *sample = f->data->sample;
    char series[384], words[384];
    bool paired = plan_is(f->plan, "paired_t", NULL, NULL), second = strcmp(row->order, "second") == 0;
    bool waited = f->session_id == row->session_id && strcmp(f->question, row->question) == 0;
    bool late = !second && ((waited && f->second) || late_first_has(&f->late_firsts, row->trial_id));
    const char *order = late ? "second" : row->order;
    if (!second || !waited) {
        f->session_id = row->session_id;
        snprintf(f->question, sizeof f->question, "%.127s", row->question);
        f->value = row->value;
        f->condition = condition;
        f->second = second || late;
    }
    struct planned_cell like = {.block = paired ? "" : order,
                                .factors = "",
                                .scene = plan_is(f->plan, NULL, NULL, "scene") ? row->scene : "",
                                .test = paired ? SAMPLE_NONE : condition,
                                .reference = SAMPLE_NONE,
                                .series = series,
                                .words = words,
                                .difference = paired};
    snprintf(series, sizeof series, "%.100s", row->question);
    snprintf(words, sizeof words, "%.200s, rated %s", sample->conditions[condition].words, order);
    if (!paired)
        return planned_data_add(f->data, &like, person, row->value, 1);
    if (!second || !waited || f->second || f->condition == condition)
        return true;
    f->session_id = 0;
    snprintf(series, sizeof series, "%.100s, second minus first: %.120s \u2212 %.120s", row->question,
             sample->conditions[condition].words, sample->conditions[f->condition].words);
    words[0] = '\0';
    like.minuend = condition;
    like.subtrahend = f->condition;
    return planned_data_add(f->data, &like, person, row->value - f->value, 1);
}

// Both options of a trial: test minus reference where a paired test asks, else each by itself.
static bool add_option(struct filling *f, const struct store_rating_row *row, size_t person, size_t condition,
                       struct planned_cell *like)
{
    char series[192];
    bool paired = plan_is(f->plan, "paired_t", NULL, NULL);
    like->series = series;
    snprintf(series, sizeof series, "%.100s, %s", row->question,
             paired                ? "test option minus reference"
             : row->subject == 't' ? "test option"
                                   : "reference");
    if (!paired)
        return add(f, like, person, row->value, 1);
    if (f->trial_id != row->trial_id || strcmp(f->question, row->question) != 0 || f->subject == row->subject) {
        f->trial_id = row->trial_id;
        snprintf(f->question, sizeof f->question, "%.127s", row->question);
        f->subject = row->subject;
        f->value = row->value;
        f->condition = condition;
        return true;
    }
    f->trial_id = 0;
    like->difference = true;
    like->minuend = row->subject == 't' ? condition : f->condition;
    like->subtrahend = row->subject == 't' ? f->condition : condition;
    return add(f, like, person, row->subject == 't' ? row->value - f->value : f->value - row->value, 1);
}

static bool add_rating(void *user, const struct store_rating_row *row)
{
    struct filling *f = user;
    struct sample *sample = f->data->sample;
    size_t session = sample_find_session(sample, f->file, row->session_id);
    size_t condition = sample_find_condition(sample, f->file, row->condition_id);
    if (session == SAMPLE_NONE || row->trial_id == 0 || condition == SAMPLE_NONE ||
        strcmp(row->trial_status, "done") != 0 || strcmp(row->trial_kind, "practice") == 0 ||
        strcmp(row->trial_kind, "catch") == 0 || strcmp(row->trial_kind, "null") == 0 ||
        sample_ratings_excluded(sample, f->file, row->trial_id) || !isfinite(row->value))
        return true;
    size_t person = sample->sessions[session].person;
    if (*row->order)
        return add_before_after(f, row, person, condition);
    struct planned_cell like = {.series = row->question,
                                .block = row->block,
                                .factors = row->factors,
                                .scene = plan_is(f->plan, NULL, NULL, "scene") ? row->scene : "",
                                .test = SAMPLE_NONE,
                                .reference = SAMPLE_NONE};
    if (strcmp(row->trial_kind, "rate") != 0 && row->subject != 's')
        return add_option(f, row, person, condition, &like);
    return add(f, &like, person, row->value, 1);
}

static bool read_files(struct planned_data *out, const struct plan *plan, bool ratings, char *error,
                       size_t error_size)
{
    bool ok = true;
    for (size_t i = 0; ok && i < out->sample->file_count; i++) {
        struct store_reader *file = out->sample->files[i];
        struct filling f = {.data = out, .plan = plan, .file = i};
        ok = !ratings
                 ? store_read_trials(file, add_trial, &f)
                 : late_first_load(&f.late_firsts, out->sample, i) && store_read_ratings(file, add_rating, &f);
        late_first_free(&f.late_firsts);
        if (!ok && store_reader_error(file)[0])
            snprintf(error, error_size, "%s", store_reader_error(file));
    }
    return ok;
}

bool planned_read_trials(struct planned_data *out, const struct plan *plan, char *error, size_t error_size)
{
    return read_files(out, plan, false, error, error_size);
}

bool planned_read_ratings(struct planned_data *out, const struct plan *plan, char *error, size_t error_size)
{
    return read_files(out, plan, true, error, error_size);
}
