#include "analysis/report/checks.h"

#include "analysis/stats/multiple.h"

#include <math.h>
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
    bool known = row->chosen_first >= 0;
    person->nulls++;
    person->null_a += row->chosen_a;
    person->first_known += known;
    person->null_first += row->chosen_first == 1;
    c->nulls++;
    c->first_unknown += !known;
}

// Where the question has no right answer, to take the obviously different option for the better one is wrong,
// and so is to call them equal.
static void add_catch(struct checks *c, struct check_person *person, const struct store_trial_row *row)
{
    if (row->correct < 0 && row->chosen == '?') {
        c->catch_unknown++;
        return;
    }
    bool missed = row->correct >= 0 ? row->correct == 0 : row->chosen != 'r';
    person->catches++;
    person->missed += missed;
    c->catches++;
    c->missed += missed;
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
    if (null)
        add_null(f->checks, person, row);
    else
        add_catch(f->checks, person, row);
    return true;
}

static void finish_bias(struct check_bias *bias, const struct stat_person *counts, size_t count, double conf)
{
    struct stat_people sum = stat_people_sum(counts, count);
    bias->people = sum.people;
    bias->several = sum.most_n > 1;
    bias->binomial = stat_binomial_test(sum.k, sum.n, 0.5, conf, STAT_TWO_SIDED);
    bias->estimate = bias->binomial.estimate;
    bias->p_value = bias->binomial.p_value;
    if (!bias->several)
        return;
    bias->flip = stat_signflip(counts, count, STAT_TWO_SIDED);
    bias->t = stat_people_t(counts, count, &(struct stat_ttest_options){.mean = 0.5, .conf = conf});
    bias->estimate = stat_people_share(counts, count);
    bias->p_value = bias->people > 1 ? bias->flip.p_value : (double)NAN; // one person has but one sign
}

static bool finish(struct checks *c, double conf)
{
    struct stat_person *counts = malloc((c->person_count + 1) * sizeof *counts);
    if (!counts)
        return false;
    for (size_t i = 0; i < c->person_count; i++)
        counts[i] = (struct stat_person){c->people[i].null_a, c->people[i].nulls};
    finish_bias(&c->side, counts, c->person_count, conf);
    for (size_t i = 0; i < c->person_count; i++)
        counts[i] = (struct stat_person){c->people[i].null_first, c->people[i].first_known};
    finish_bias(&c->first, counts, c->person_count, conf);
    free(counts);
    double p[2] = {c->side.p_value, c->first.p_value};
    stat_adjust_holm(p, 2, p);
    c->side.holm = p[0];
    c->first.holm = p[1];
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
    if (!finish(out, conf)) {
        checks_free(out);
        return false;
    }
    error[0] = '\0';
    return true;
}

void checks_free(struct checks *checks)
{
    free(checks->people);
    *checks = (struct checks){0};
}
