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
    if (ok && !gaze_join_people(out, sample)) {
        snprintf(error, error_size, "not enough memory");
        ok = false;
    }
    if (ok)
        error[0] = '\0';
    else
        gaze_free(out);
    return ok;
}

int64_t gaze_flat_samples(const struct gaze_report *report)
{
    int64_t flat = 0;
    for (size_t i = 0; i < report->person_count; i++)
        for (size_t j = 0; j < report->people[i].target_count; j++)
            flat += report->people[i].targets[j].flat;
    return flat;
}

int64_t gaze_lost_frames(const struct gaze_report *report, int64_t *out_all)
{
    int64_t lost = 0;
    *out_all = 0;
    for (size_t i = 0; i < report->latency_count; i++) {
        lost += report->latencies[i].lost;
        *out_all += report->latencies[i].lost + report->latencies[i].frames;
    }
    return lost;
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
    for (size_t i = 0; i < report->silent_count; i++)
        gaze_bins_finish(&report->silent[i].time);
    free(report->records);
    free(report->people);
    free(report->latencies);
    free(report->checks);
    free(report->silent);
    *report = (struct gaze_report){.record_count = 0};
}
