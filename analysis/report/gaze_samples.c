// One file's gaze, sample by sample, to the records of its sessions and eyes.
#include "analysis/report/gaze_private.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { EYES = 3 };

struct trial {
    int64_t id, session_id, segment_id, started_ns, ended_ns;
    const char *fixation; // owned by the sample; NULL where the distance to a target is not asked for
    bool tracker, moving; // the target moves
    double ipd_m;
    unsigned seen; // eyes that had a sample, as bits
};

// What one eye is at: its record, its trial, its last sample.
struct eye {
    char name;
    struct gaze_track track;
    size_t record; // SAMPLE_NONE: none yet
    int64_t session_id;
    struct trial *trial; // NULL between trials
    int64_t last_host_ns;
};

struct reading {
    struct gaze_report *out;
    struct sample *sample;
    size_t file;
    struct trial *trials;
    size_t trial_count;
    struct eye eyes[EYES];
    struct trial *current;     // the last sample's
    struct gaze_places places; // of that trial's target
    bool no_memory;
};

static bool add_trial(void *user, const struct store_gaze_trial *row)
{
    struct reading *r = user;
    if (!sample_grow(&r->trials, r->trial_count, sizeof r->trials[0]))
        return !(r->no_memory = true);
    struct trial *trial = &r->trials[r->trial_count++];
    *trial = (struct trial){.id = row->id,
                            .session_id = row->session_id,
                            .segment_id = row->segment_id,
                            .started_ns = row->started_ns,
                            .ended_ns = row->ended_ns,
                            .tracker = row->tracker,
                            .moving = strcmp(row->fixation, "moving") == 0,
                            .ipd_m = row->ipd_m};
    if (row->fixation[0] && strcmp(row->fixation, "free") != 0 && row->done && !row->practice &&
        !sample_trial_excluded(r->sample, r->file, row->id)) {
        trial->fixation = sample_keep(r->sample, row->fixation);
        r->no_memory = !trial->fixation;
    }
    return !r->no_memory;
}

static int by_id(const void *x, const void *y)
{
    int64_t a = *(const int64_t *)x, b = ((const struct trial *)y)->id;
    return (a > b) - (a < b);
}

static bool change_trial(struct reading *r, int64_t trial_id)
{
    r->current = trial_id && r->trial_count
                     ? bsearch(&trial_id, r->trials, r->trial_count, sizeof r->trials[0], by_id)
                     : NULL;
    return !r->current || !r->current->fixation ||
           gaze_places_read(&r->places, r->sample->files[r->file], trial_id);
}

static struct gaze_record *record_of(const struct reading *r, const struct eye *eye)
{
    return &r->out->records[eye->record];
}

static void leave_trial(struct reading *r, struct eye *eye)
{
    gaze_track_break(&eye->track);
    if (eye->trial && eye->trial->ended_ns >= 0)
        gaze_bins_add(&record_of(r, eye)->edges,
                      fmax(0, (double)(eye->trial->ended_ns - eye->last_host_ns) / 1e6));
    eye->trial = NULL;
}

static void enter_trial(struct reading *r, struct eye *eye, int64_t host_ns)
{
    eye->trial = r->current;
    if (eye->trial->started_ns >= 0)
        gaze_bins_add(&record_of(r, eye)->edges, fmax(0, (double)(host_ns - eye->trial->started_ns) / 1e6));
    eye->trial->seen |= 1U << (eye - r->eyes);
    eye->track.moving = eye->trial->moving;
}

static bool change_session(struct reading *r, struct eye *eye, int64_t session_id)
{
    struct gaze_report *out = r->out;
    eye->session_id = session_id;
    eye->record = SAMPLE_NONE;
    size_t session = sample_find_session(r->sample, r->file, session_id);
    if (session == SAMPLE_NONE)
        return true;
    for (size_t i = 0; i < out->record_count && eye->record == SAMPLE_NONE; i++)
        if (out->records[i].session == session && out->records[i].eye == eye->name)
            eye->record = i;
    if (eye->record == SAMPLE_NONE) {
        if (!sample_grow(&out->records, out->record_count, sizeof out->records[0]))
            return !(r->no_memory = true);
        struct gaze_record *record = &out->records[out->record_count];
        *record = (struct gaze_record){
            .person = r->sample->sessions[session].person, .session = session, .eye = eye->name};
        if (!gaze_record_init(record))
            return !(r->no_memory = true);
        eye->record = out->record_count++;
        // growing may have moved the records whose qualities the other eyes' tracks point to
        for (int i = 0; i < EYES; i++)
            if (r->eyes[i].record != SAMPLE_NONE)
                r->eyes[i].track.quality = &record_of(r, &r->eyes[i])->quality;
    }
    gaze_track_begin(&eye->track, &record_of(r, eye)->quality);
    return true;
}

static bool compare(struct reading *r, struct eye *eye, const struct store_gaze_sample *row)
{
    struct gaze_target *target = gaze_record_target(record_of(r, eye), eye->trial->fixation);
    if (!target)
        return !(r->no_memory = true);
    gaze_compare(&r->places, &r->out->options, eye->trial->ipd_m, row, target);
    return true;
}

static bool add_sample(void *user, const struct store_gaze_sample *row)
{
    struct reading *r = user;
    struct eye *eye = &r->eyes[row->eye == 'l' ? 0 : row->eye == 'r' ? 1 : 2];
    bool moved = r->current ? r->current->id != row->trial_id : row->trial_id != 0;
    if (moved && !change_trial(r, row->trial_id))
        return false;
    bool last_attempt = r->current && r->current->segment_id == row->segment_id;
    if (eye->trial && (eye->trial != r->current || !last_attempt || eye->session_id != row->session_id))
        leave_trial(r, eye);
    if (eye->session_id != row->session_id && !change_session(r, eye, row->session_id))
        return false;
    if (eye->record == SAMPLE_NONE)
        return true;
    record_of(r, eye)->received++;
    record_of(r, eye)->received_invalid += !row->valid;
    if (!last_attempt) {
        record_of(r, eye)->between += !r->current;
        record_of(r, eye)->superseded += r->current != NULL;
        return true;
    }
    // An attempt within the same run of the program that was begun again: what came before its start is not of
    // it.
    if (row->host_ns < r->current->started_ns) {
        record_of(r, eye)->superseded++;
        return true;
    }
    if (!eye->trial)
        enter_trial(r, eye, row->host_ns);
    eye->last_host_ns = row->host_ns;
    gaze_track_sample(&eye->track, row->device_ns, row->x_deg, row->y_deg, row->valid);
    return !r->current->fixation || !row->valid || !isfinite(row->x_deg) || !isfinite(row->y_deg) ||
           compare(r, eye, row);
}

static bool keep_saccade(struct gaze_record *record, const struct gaze_event *event)
{
    if (!sample_grow(&record->amplitude, record->saccade_count, sizeof record->amplitude[0]) ||
        !sample_grow(&record->peak, record->saccade_count, sizeof record->peak[0]) ||
        !sample_grow(&record->span, record->saccade_count, sizeof record->span[0]))
        return false;
    record->amplitude[record->saccade_count] = event->amplitude_deg;
    record->span[record->saccade_count] = event->peak_span_ms;
    record->peak[record->saccade_count++] = event->peak_deg_s;
    return true;
}

struct listener {
    struct reading *reading;
    int eye;
};

static void hear(void *user, const struct gaze_event *event, const struct gaze_point *points)
{
    struct listener *listener = user;
    struct reading *r = listener->reading;
    const struct eye *eye = &r->eyes[listener->eye];
    const struct gaze_options *options = &r->out->options;
    (void)points;
    if (event->kind == GAZE_SACCADE && !event->cut && !keep_saccade(record_of(r, eye), event))
        r->no_memory = true;
    if (options->each && eye->trial)
        options->each(options->user, record_of(r, eye)->session, eye->trial->id, eye->name, event);
}

static bool add_silence(struct reading *r, size_t session, double ms)
{
    struct gaze_report *out = r->out;
    size_t i = 0;
    while (i < out->silent_count && out->silent[i].session != session)
        i++;
    if (i == out->silent_count) {
        if (!sample_grow(&out->silent, i, sizeof out->silent[0]) || !gaze_silent_init(&out->silent[i], session))
            return !(r->no_memory = true);
        out->silent_count++;
    }
    gaze_bins_add(&out->silent[i].time, ms);
    return true;
}

// Trials that the tracker missed from start to end: nothing else would show them.
static bool missed_trial(struct reading *r, const struct trial *t, size_t session)
{
    double ms = (double)(t->ended_ns - t->started_ns) / 1e6;
    bool heard = false;
    for (size_t i = 0; i < r->out->record_count; i++) {
        struct gaze_record *record = &r->out->records[i];
        if (record->session != session || record->quality.samples == 0)
            continue;
        heard = true;
        if (!(t->seen & (record->eye == 'l' ? 1U : record->eye == 'r' ? 2U : 4U)))
            gaze_bins_add(&record->edges, ms);
    }
    return heard || add_silence(r, session, ms);
}

static bool missed_trials(struct reading *r)
{
    for (size_t i = 0; i < r->trial_count; i++) {
        const struct trial *t = &r->trials[i];
        bool all = t->seen == (1U << EYES) - 1;
        if (!t->tracker || t->ended_ns <= t->started_ns || t->started_ns < 0 || all)
            continue;
        size_t session = sample_find_session(r->sample, r->file, t->session_id);
        if (session != SAMPLE_NONE && !missed_trial(r, t, session))
            return false;
    }
    return true;
}

static bool read_file(struct reading *r)
{
    struct store_reader *reader = r->sample->files[r->file];
    struct listener listeners[EYES];
    bool ok = store_read_gaze_trials(reader, add_trial, r);
    for (int i = 0; i < EYES; i++) {
        listeners[i] = (struct listener){r, i};
        r->eyes[i] = (struct eye){.name = "lrb"[i], .record = SAMPLE_NONE};
    }
    for (int i = 0; i < EYES && ok; i++)
        if (!gaze_track_init(&r->eyes[i].track, &r->out->options.rules, r->out->options.gap_ms, hear,
                             &listeners[i]))
            ok = !(r->no_memory = true);
    ok = ok && store_read_gaze(reader, add_sample, r);
    for (int i = 0; i < EYES; i++) {
        if (ok && r->eyes[i].record != SAMPLE_NONE)
            leave_trial(r, &r->eyes[i]);
        gaze_track_finish(&r->eyes[i].track);
    }
    return ok && missed_trials(r) && !r->no_memory;
}

bool gaze_read_samples(struct gaze_report *out, struct sample *sample, size_t file, char *error,
                       size_t error_size)
{
    struct reading r = {.out = out, .sample = sample, .file = file};
    bool ok = read_file(&r);
    if (!ok)
        snprintf(error, error_size, "%s",
                 r.no_memory || r.places.no_memory ? "not enough memory"
                                                   : store_reader_error(sample->files[file]));
    free(r.trials);
    gaze_places_finish(&r.places);
    return ok;
}
