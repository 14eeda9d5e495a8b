#include "analysis/report/frames_private.h"
#include "analysis/stats/quantile.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool take_trial(void *user, const struct store_trial_row *row)
{
    struct frames_pairing *f = user;
    size_t session = sample_find_session(f->sample, f->file, row->session_id);
    if (session == SAMPLE_NONE || row->test_id == 0 || row->reference_id == 0 ||
        row->test_id == row->reference_id || strcmp(row->kind, "practice") == 0 ||
        strcmp(row->status, "done") != 0 || sample_trial_excluded(f->sample, f->file, row->id))
        return true;
    if (!sample_grow(&f->trials, f->trial_count, sizeof f->trials[0]))
        return false;
    f->trials[f->trial_count++] =
        (struct frames_trial){row->id,
                              row->attempt,
                              {row->test_id, row->reference_id},
                              f->sample->sessions[session].person,
                              sample_find_condition(f->sample, f->file, row->test_id),
                              sample_find_condition(f->sample, f->file, row->reference_id)};
    return true;
}

static int by_id(const void *x, const void *y)
{
    const struct frames_trial *a = x, *b = y;
    return (a->id > b->id) - (a->id < b->id);
}

static double median(double *values, size_t count)
{
    stat_sort(values, count);
    return stat_quantile(values, count, 0.5);
}

static bool close_trial(struct frames_pairing *f)
{
    struct frames_arriving *t = &f->times;
    bool ok = true;
    enum frames_measure m = t->count[0][FRAMES_GPU] && t->count[1][FRAMES_GPU] ? FRAMES_GPU : FRAMES_CPU;
    if (f->trial && t->count[0][m] && t->count[1][m]) {
        double test = median(t->ms[0][m], t->count[0][m]), reference = median(t->ms[1][m], t->count[1][m]);
        ok = sample_grow(&f->values, f->value_count, sizeof f->values[0]);
        if (ok)
            f->values[f->value_count++] = (struct frames_value){
                .person = f->trial->person,
                .test = f->trial->test,
                .reference = f->trial->reference,
                .measure = m,
                .values = {test - reference, test > 0 && reference > 0 ? log(test / reference) : (double)NAN,
                           t->late_known ? (double)t->late[0] / (double)t->frames[0] -
                                               (double)t->late[1] / (double)t->frames[1]
                                         : (double)NAN}};
    }
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < FRAMES_MEASURES; k++)
            free(t->ms[i][k]);
    *t = (struct frames_arriving){.late_known = true};
    f->trial = NULL;
    return ok;
}

static bool add(struct frames_arriving *t, int option, enum frames_measure measure, double ms)
{
    if (isnan(ms))
        return true;
    if (!sample_grow(&t->ms[option][measure], t->count[option][measure], sizeof(double)))
        return false;
    t->ms[option][measure][t->count[option][measure]++] = ms;
    return true;
}

bool frames_pairing_frame(struct frames_pairing *f, const struct store_frame_row *row)
{
    if (strcmp(row->phase, "stimulus") != 0 || row->condition_id == 0)
        return true;
    if (!f->trial || f->trial->id != row->trial_id) {
        const struct frames_trial key = {.id = row->trial_id};
        if (!close_trial(f))
            return false;
        f->trial = f->trial_count ? bsearch(&key, f->trials, f->trial_count, sizeof f->trials[0], by_id) : NULL;
    }
    int option = !f->trial || f->trial->attempt != row->attempt   ? -1
                 : f->trial->condition_id[0] == row->condition_id ? 0
                 : f->trial->condition_id[1] == row->condition_id ? 1
                                                                  : -1;
    if (option < 0)
        return true;
    f->times.frames[option]++;
    f->times.late[option] += row->late;
    f->times.late_known = f->times.late_known && row->late_known;
    f->simulated_clock = f->simulated_clock || row->simulated_clock;
    return add(&f->times, option, FRAMES_GPU, row->gpu_us / 1e3) &&
           add(&f->times, option, FRAMES_CPU, row->cpu_us / 1e3);
}

static int by_pair(const void *x, const void *y)
{
    const struct frames_value *a = x, *b = y;
    if (a->test != b->test)
        return a->test < b->test ? -1 : 1;
    if (a->reference != b->reference)
        return a->reference < b->reference ? -1 : 1;
    if (a->measure != b->measure)
        return a->measure < b->measure ? -1 : 1;
    return (a->person > b->person) - (a->person < b->person);
}

// One of the three values of a pair's trials, person after person; `means` has room for as many.
static struct frames_mean mean_of(const struct frames_value *trials, size_t count, int which, double *means,
                                  double conf)
{
    struct frames_mean out = {0};
    for (size_t from = 0, to; from < count; from = to) {
        double sum = 0;
        size_t known = 0;
        for (to = from; to < count && trials[to].person == trials[from].person; to++) {
            if (isnan(trials[to].values[which]))
                continue;
            sum += trials[to].values[which];
            known++;
        }
        if (known)
            means[out.people++] = sum / (double)known;
    }
    for (size_t i = 0; i < out.people; i++)
        out.mean += means[i] / (double)out.people;
    if (out.people == 0)
        out.mean = (double)NAN;
    out.t = stat_ttest_one_sample(means, out.people, &(struct stat_ttest_options){.conf = conf});
    return out;
}

static bool add_pair(struct frames_pairs *out, const struct frames_value *trials, size_t count, double conf)
{
    double *room = malloc(count * sizeof *room);
    if (!room || !sample_grow(&out->pairs, out->count, sizeof out->pairs[0])) {
        free(room);
        return false;
    }
    struct frames_pair pair = {.test = trials[0].test,
                               .reference = trials[0].reference,
                               .measure = trials[0].measure,
                               .trials = count,
                               .difference_ms = mean_of(trials, count, 0, room, conf),
                               .log_ratio = mean_of(trials, count, 1, room, conf),
                               .late = mean_of(trials, count, 2, room, conf)};
    pair.people = pair.difference_ms.people;
    out->pairs[out->count++] = pair;
    free(room);
    return true;
}

bool frames_pairing_begin(struct frames_pairing *f, size_t file)
{
    f->file = file;
    f->times.late_known = true;
    bool ok = store_read_trials(f->sample->files[file], take_trial, f);
    if (f->trial_count)
        qsort(f->trials, f->trial_count, sizeof f->trials[0], by_id);
    return ok;
}

bool frames_pairing_end(struct frames_pairing *f)
{
    bool ok = close_trial(f);
    free(f->trials);
    f->trials = NULL;
    f->trial_count = 0;
    return ok;
}

bool frames_pairing_finish(struct frames_pairing *f, struct frames_pairs *out, double conf)
{
    bool ok = true;
    if (f->value_count)
        qsort(f->values, f->value_count, sizeof f->values[0], by_pair);
    for (size_t from = 0, to; ok && from < f->value_count; from = to) {
        for (to = from; to < f->value_count && f->values[to].test == f->values[from].test &&
                        f->values[to].reference == f->values[from].reference &&
                        f->values[to].measure == f->values[from].measure;)
            to++;
        ok = add_pair(out, f->values + from, to - from, conf);
    }
    free(f->values);
    f->values = NULL;
    out->simulated_clock = f->simulated_clock;
    return ok;
}

void frames_pairs_free(struct frames_pairs *pairs)
{
    free(pairs->pairs);
    *pairs = (struct frames_pairs){0};
}
