#include "analysis/report/checks.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct filling {
    struct checks *checks;
    struct sample *sample;
    size_t file;
};

static struct check_person *find_person(struct filling *f, const struct sample_session *session)
{
    struct checks *c = f->checks;
    for (size_t i = 0; i < c->person_count; i++)
        if (c->people[i].person == session->person) {
            c->people[i].excluded = c->people[i].excluded && session->excluded;
            return &c->people[i];
        }
    if (!sample_grow(&c->people, c->person_count, sizeof c->people[0]))
        return NULL;
    c->people[c->person_count] =
        (struct check_person){.person = session->person, .excluded = session->excluded};
    return &c->people[c->person_count++];
}

static void add_null(struct checks *c, struct check_person *person, const struct store_trial_row *row)
{
    if (row->chosen == '=') {
        c->null_equal++;
        return;
    }
    c->null_people += person->nulls == 0;
    person->nulls++;
    person->null_a += row->chosen_a;
    c->nulls++;
    c->null_a += row->chosen_a;
    c->null_first += row->chosen_first;
}

static bool add_trial(void *user, const struct store_trial_row *row)
{
    struct filling *f = user;
    bool null = strcmp(row->kind, "null") == 0, caught = strcmp(row->kind, "catch") == 0;
    size_t index = sample_any_session(f->sample, f->file, row->session_id);
    if ((!null && !caught) || index == SAMPLE_NONE || row->choice_id == 0 || strcmp(row->status, "done") != 0)
        return true;
    const struct sample_session *session = &f->sample->sessions[index];
    if ((null && session->excluded) || sample_trial_excluded(f->sample, f->file, row->id))
        return true;
    struct check_person *person = find_person(f, session);
    if (!person)
        return false;
    if (null) {
        add_null(f->checks, person, row);
        return true;
    }
    // Where the question has no right answer, to take the obviously different option for the better one is
    // wrong.
    bool missed = row->correct >= 0 ? row->correct == 0 : row->chosen != 'r';
    person->catches++;
    person->missed += missed;
    f->checks->catches++;
    f->checks->missed += missed;
    return true;
}

bool checks_load(struct checks *out, struct sample *sample, double conf, char *error, size_t error_size)
{
    bool ok = true;
    *out = (struct checks){0};
    snprintf(error, error_size, "not enough memory");
    for (size_t i = 0; ok && i < sample->file_count; i++) {
        struct filling f = {out, sample, i};
        ok = store_read_trials(sample->files[i], add_trial, &f);
        if (!ok && store_reader_error(sample->files[i])[0])
            snprintf(error, error_size, "%s", store_reader_error(sample->files[i]));
    }
    if (!ok) {
        checks_free(out);
        return false;
    }
    out->side = stat_binomial_test(out->null_a, out->nulls, 0.5, conf, STAT_TWO_SIDED);
    out->first = stat_binomial_test(out->null_first, out->nulls, 0.5, conf, STAT_TWO_SIDED);
    error[0] = '\0';
    return true;
}

void checks_free(struct checks *checks)
{
    free(checks->people);
    *checks = (struct checks){0};
}
