#include "analysis/report/gaze_private.h"

#include "studies/store/gaze.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>

struct gaze_options gaze_options(enum gaze_method method)
{
    // A blink takes longer than 50 ms; at 60 Hz, the slowest tracker of the papers, that is two samples lost.
    return (struct gaze_options){.rules = gaze_rules(method),
                                 .gap_ms = 50,
                                 .region_x_deg = 10.3,
                                 .region_y_deg = 11.68,
                                 .bcea_share = GAZE_BCEA_SHARE,
                                 .conf = 0.95};
}

// --- checks ---

struct checks {
    struct gaze_report *out;
    struct sample *sample;
    size_t file;
};

static bool add_check(void *user, const struct store_gaze_check_row *row)
{
    struct checks *c = user;
    struct gaze_report *out = c->out;
    size_t session = sample_find_session(c->sample, c->file, row->session_id);
    if (session == SAMPLE_NONE)
        return true;
    if (!sample_grow(&out->checks, out->check_count, sizeof out->checks[0]))
        return false;
    const char *block = sample_keep(c->sample, row->block);
    if (!block)
        return false;
    out->checks[out->check_count++] =
        (struct gaze_check){session,          block,       row->x_deg, row->y_deg, row->accuracy_deg,
                            row->rms_s2s_deg, row->sd_deg, row->loss,  row->eye,   row->passed};
    return true;
}

static bool read_checks(struct gaze_report *out, struct sample *sample, char *error, size_t error_size)
{
    for (size_t i = 0; i < sample->file_count; i++) {
        struct checks checks = {out, sample, i};
        if (store_read_gaze_checks(sample->files[i], add_check, &checks))
            continue;
        const char *reason = store_reader_error(sample->files[i]);
        snprintf(error, error_size, "%s", reason[0] ? reason : "not enough memory");
        return false;
    }
    return true;
}

// --- people ---

static int eye_order(char eye)
{
    return eye == 'l' ? 0 : eye == 'r' ? 1 : 2;
}

static int by_session(const void *x, const void *y)
{
    const struct gaze_record *a = x, *b = y;
    if (a->session != b->session)
        return a->session < b->session ? -1 : 1;
    return eye_order(a->eye) - eye_order(b->eye);
}

static int by_person(const void *x, const void *y)
{
    const struct gaze_record *a = x, *b = y;
    if (a->person != b->person)
        return a->person < b->person ? -1 : 1;
    return eye_order(a->eye) - eye_order(b->eye);
}

static struct gaze_record *person_record(struct gaze_report *out, const struct gaze_record *of)
{
    for (size_t i = 0; i < out->person_count; i++)
        if (out->people[i].person == of->person && out->people[i].eye == of->eye)
            return &out->people[i];
    if (!sample_grow(&out->people, out->person_count, sizeof out->people[0]))
        return NULL;
    struct gaze_record *record = &out->people[out->person_count];
    *record = (struct gaze_record){.person = of->person, .session = SAMPLE_NONE, .eye = of->eye};
    if (!gaze_record_init(record))
        return NULL;
    out->person_count++;
    return record;
}

static bool join_people(struct gaze_report *out)
{
    for (size_t i = 0; i < out->record_count; i++) {
        struct gaze_record *record = &out->records[i], *person = person_record(out, record);
        if (!person || !gaze_record_join(person, record))
            return false;
        gaze_record_close(record, &out->options);
        person->missing_before += record->missing; // each sitting's at its own rate
    }
    for (size_t i = 0; i < out->person_count; i++) {
        gaze_record_close(&out->people[i], &out->options);
        out->people[i].missing = out->people[i].missing_before;
    }
    if (out->record_count > 1)
        qsort(out->records, out->record_count, sizeof out->records[0], by_session);
    if (out->person_count > 1)
        qsort(out->people, out->person_count, sizeof out->people[0], by_person);
    return true;
}

// --- the whole ---

// The other thread writes to `latencies` only, and reads of the sample what the first does not change.
struct uses {
    struct gaze_report *out;
    const struct sample *sample;
    char error[SAMPLE_ERROR_SIZE];
    bool ok;
};

static void *read_uses(void *user)
{
    struct uses *uses = user;
    uses->ok = gaze_read_uses(uses->out, uses->sample, uses->error, sizeof uses->error);
    return NULL;
}

bool gaze_load(struct gaze_report *out, struct sample *sample, const struct gaze_options *options, char *error,
               size_t error_size)
{
    *out = (struct gaze_report){.options = *options};
    struct uses uses = {.out = out, .sample = sample};
    pthread_t thread;
    bool threaded = pthread_create(&thread, NULL, read_uses, &uses) == 0;
    bool ok = read_checks(out, sample, error, error_size);
    for (size_t i = 0; i < sample->file_count && ok; i++)
        ok = gaze_read_samples(out, sample, i, error, error_size);
    if (threaded)
        pthread_join(thread, NULL);
    else
        read_uses(&uses);
    if (ok && !uses.ok)
        snprintf(error, error_size, "%s", uses.error);
    ok = ok && uses.ok;
    if (ok && !join_people(out)) {
        snprintf(error, error_size, "not enough memory");
        ok = false;
    }
    if (ok)
        error[0] = '\0';
    else
        gaze_free(out);
    return ok;
}

void gaze_free(struct gaze_report *report)
{
    for (size_t i = 0; i < report->record_count; i++)
        gaze_record_finish(&report->records[i]);
    for (size_t i = 0; i < report->person_count; i++)
        gaze_record_finish(&report->people[i]);
    for (size_t i = 0; i < report->latency_count; i++) {
        gaze_bins_finish(&report->latencies[i].age);
        gaze_bins_finish(&report->latencies[i].to_light);
    }
    free(report->records);
    free(report->people);
    free(report->latencies);
    free(report->checks);
    free(report->silent);
    *report = (struct gaze_report){.record_count = 0};
}
