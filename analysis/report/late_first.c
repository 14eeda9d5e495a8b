#include "analysis/report/late_first.h"

#include <stdlib.h>
#include <string.h>

// A trial planned as the first, in the session that is being read.
struct first_trial {
    int64_t id;
    int64_t planned_at; // ordinal of the trial that it repeats, itself where it repeats none
};

struct filling {
    struct late_first *late;
    const struct sample *sample;
    int64_t session_id;
    int64_t second_at; // ordinal of the last trial planned as the second that was shown; 0: none
    size_t count;
    struct first_trial *firsts;
};

// "first" or "second"; "" of a trial that is neither.
static const char *order_of(const struct sample *sample, const char *factors)
{
    for (size_t i = 0; i < sample->factor_count; i++)
        if (strcmp(sample->factors[i].key, "order") == 0 && strcmp(sample->factors[i].factors, factors) == 0)
            return sample->factors[i].value;
    return "";
}

static bool add_first(struct filling *f, const struct store_trial_row *row)
{
    struct first_trial first = {row->id, row->ordinal};
    for (size_t i = 0; i < f->count && row->repeat_of; i++)
        if (f->firsts[i].id == row->repeat_of)
            first.planned_at = f->firsts[i].planned_at;
    if (!sample_grow(&f->firsts, f->count, sizeof f->firsts[0]))
        return false;
    f->firsts[f->count++] = first;
    if (f->second_at <= first.planned_at)
        return true;
    if (!sample_grow(&f->late->trials, f->late->count, sizeof f->late->trials[0]))
        return false;
    f->late->trials[f->late->count++] = row->id;
    return true;
}

static bool add_trial(void *user, const struct store_trial_row *row) // by session and ordinal
{
    struct filling *f = user;
    const char *order = order_of(f->sample, row->factors);
    if (row->session_id != f->session_id) {
        f->session_id = row->session_id;
        f->second_at = 0;
        f->count = 0;
    }
    if (strcmp(order, "first") == 0)
        return add_first(f, row);
    if (strcmp(order, "second") == 0 && row->attempt > 0)
        f->second_at = row->ordinal;
    return true;
}

bool late_first_load(struct late_first *out, const struct sample *sample, size_t file)
{
    struct filling f = {.late = out, .sample = sample};
    *out = (struct late_first){0};
    bool ok = store_read_trials(sample->files[file], add_trial, &f);
    free(f.firsts);
    if (!ok)
        late_first_free(out);
    return ok;
}

void late_first_free(struct late_first *late)
{
    free(late->trials);
    *late = (struct late_first){0};
}

bool late_first_has(const struct late_first *late, int64_t trial_id)
{
    for (size_t i = 0; i < late->count; i++)
        if (late->trials[i] == trial_id)
            return true;
    return false;
}
