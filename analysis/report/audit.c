#include "analysis/report/audit.h"

#include "analysis/report/audit_private.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char *key, *words;
} counts[AUDIT_COUNTS] = {
    [AUDIT_MISSING] = {"missing", "frames without a row"},
    [AUDIT_REPEATED] = {"repeated", "rows out of order"},
    [AUDIT_LATE_STIMULUS] = {"late_stimulus", "late stimulus frames"},
    [AUDIT_LATE_FADE] = {"late_fade", "late frames in fades"},
    [AUDIT_LATE_OTHER] = {"late_other", "late frames of questions and rest"},
    [AUDIT_STALE] = {"stale", "frames with stale gaze"},
    [AUDIT_FIXED] = {"fixed", "frames with fixed foveation"},
    [AUDIT_LOST] = {"lost", "foveated frames with lost gaze"},
    [AUDIT_WRONG] = {"wrong_source", "frames with another fovea than asked"},
    [AUDIT_DIFFERS] = {"differs", "frames rendered otherwise than asked"},
    [AUDIT_COPIED] = {"copied_eye", "frames with one fovea for both eyes"},
    [AUDIT_FADES] = {"fades_off", "fades off the protocol"},
};

const char *audit_words(enum audit_count count)
{
    return counts[count].words;
}

const char *audit_key(enum audit_count count)
{
    return counts[count].key;
}

const struct store_audit_trial_row *audit_find_trial(const struct audit_pass *pass, int64_t id)
{
    size_t low = 0, high = pass->trial_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (pass->trials[middle].id == id)
            return &pass->trials[middle];
        if (pass->trials[middle].id < id)
            low = middle + 1;
        else
            high = middle;
    }
    return NULL;
}

size_t audit_find_session(struct audit_pass *pass, int64_t session_id)
{
    struct audit *audit = pass->audit;
    size_t index = sample_any_session(pass->sample, pass->file, session_id);
    for (size_t i = 0; i < audit->session_count; i++)
        if (audit->sessions[i].session == index)
            return index == SAMPLE_NONE ? SAMPLE_NONE : i;
    if (index == SAMPLE_NONE || !sample_grow(&audit->sessions, audit->session_count, sizeof *audit->sessions))
        return SAMPLE_NONE;
    audit->sessions[audit->session_count] = (struct audit_session){.session = index};
    return audit->session_count++;
}

bool audit_note(struct audit_pass *pass, size_t session, int64_t trial_id, enum audit_count what, int64_t by)
{
    struct audit *audit = pass->audit;
    size_t i = pass->trial; // most often the one of the finding before
    audit->sessions[session].counts[what] += by;
    audit->findings += by;
    if (i >= audit->trial_count || audit->trials[i].session != session || audit->trials[i].trial_id != trial_id)
        i = 0;
    while (i < audit->trial_count &&
           (audit->trials[i].session != session || audit->trials[i].trial_id != trial_id))
        i++;
    if (i == audit->trial_count) {
        const struct store_audit_trial_row *trial = audit_find_trial(pass, trial_id);
        if (!sample_grow(&audit->trials, audit->trial_count, sizeof *audit->trials))
            return false;
        audit->trials[audit->trial_count++] = (struct audit_trial){
            .session = session, .trial_id = trial_id, .ordinal = trial ? trial->ordinal : 0};
    }
    audit->trials[i].counts[what] += by;
    pass->trial = i;
    return true;
}

// --- rows against frames submitted ---

static bool take_segment(void *user, const struct store_segment_row *row)
{
    struct audit_pass *pass = user;
    if (sample_any_session(pass->sample, pass->file, row->session_id) == SAMPLE_NONE)
        return true;
    if (!sample_grow(&pass->segments, pass->segment_count, sizeof *pass->segments))
        return false;
    pass->segments[pass->segment_count++] = *row;
    if (!row->drew)
        return true;
    size_t index = audit_find_session(pass, row->session_id);
    if (index == SAMPLE_NONE)
        return false;
    struct audit_session *session = &pass->audit->sessions[index];
    session->segments++;
    session->uncounted += row->submitted < 0;
    session->submitted += row->submitted < 0 ? 0 : row->submitted;
    session->dropped += row->dropped;
    return true;
}

// What is missing after a segment's last row, or all of it.
static bool close_segment(struct audit_pass *pass, int64_t segment_id, int64_t next_number, int64_t trial_id)
{
    for (size_t i = 0; i < pass->segment_count; i++) {
        const struct store_segment_row *segment = &pass->segments[i];
        if (segment->id != segment_id || segment->submitted <= next_number)
            continue;
        size_t session = audit_find_session(pass, segment->session_id);
        return session != SAMPLE_NONE &&
               audit_note(pass, session, trial_id, AUDIT_MISSING, segment->submitted - next_number);
    }
    return true;
}

static bool check_number(struct audit_pass *pass, const struct store_audit_frame_row *row)
{
    bool same = pass->segment_id == row->segment_id;
    int64_t expected = same ? pass->last_number + 1 : 0;
    if (!same && pass->segment_id &&
        !close_segment(pass, pass->segment_id, pass->last_number + 1, pass->last_trial))
        return false;
    if (row->number < expected)
        return audit_note(pass, pass->session, row->trial_id, AUDIT_REPEATED, 1);
    int64_t trial_id = same && pass->last_trial ? pass->last_trial : row->trial_id;
    return row->number == expected ||
           audit_note(pass, pass->session, trial_id, AUDIT_MISSING, row->number - expected);
}

// Segments that submitted frames and have no row at all.
static bool check_empty(struct audit_pass *pass, const bool *has_frames)
{
    for (size_t i = 0; i < pass->segment_count; i++)
        if (!has_frames[i] && !close_segment(pass, pass->segments[i].id, 0, 0))
            return false;
    return true;
}

// --- frame by frame ---

static bool check_late(struct audit_pass *pass, const struct store_audit_frame_row *row)
{
    enum audit_count what = row->phase == 's'   ? AUDIT_LATE_STIMULUS
                            : row->phase == 'f' ? AUDIT_LATE_FADE
                                                : AUDIT_LATE_OTHER;
    pass->audit->sessions[pass->session].late_unknown += row->late < 0;
    return row->late <= 0 || audit_note(pass, pass->session, row->trial_id, what, 1);
}

static bool check_stale(struct audit_pass *pass, const struct store_audit_frame_row *row)
{
    if (row->source != 'g' || !row->rendered)
        return true;
    if (row->gaze_id != pass->gaze_id || row->segment_id != pass->segment_id) {
        pass->gaze_id = row->gaze_id;
        pass->gaze_first_ns = row->start_ns;
    }
    struct store_gaze_after after;
    double used_ms = row->gaze_id ? (double)(row->start_ns - pass->gaze_first_ns) / 1e6 : 0;
    if (!(row->gaze_age_ms > AUDIT_STALE_MS || used_ms > AUDIT_STALE_MS))
        return true;
    if (!store_read_gaze_after(pass->sample->files[pass->file], row->gaze_id, row->segment_id, &after))
        return false;
    double limit = after.blink ? AUDIT_BLINK_MS : AUDIT_STALE_MS;
    return !(row->gaze_age_ms > limit || used_ms > limit) ||
           audit_note(pass, pass->session, row->trial_id, AUDIT_STALE, 1);
}

static bool check_fovea(struct audit_pass *pass, const struct store_audit_frame_row *row)
{
    const struct store_audit_trial_row *trial = audit_find_trial(pass, row->trial_id);
    if (!row->rendered || !trial)
        return true;
    if (row->foveated && row->source != trial->foveate) {
        enum audit_count what = row->source == 'f'   ? AUDIT_FIXED
                                : row->source == 'l' ? AUDIT_LOST
                                                     : AUDIT_WRONG;
        if (!audit_note(pass, pass->session, row->trial_id, what, 1))
            return false;
    }
    if (row->differs && row->source != 'l' && !audit_note(pass, pass->session, row->trial_id, AUDIT_DIFFERS, 1))
        return false;
    struct store_gaze_after after;
    if (row->source != 'g' || !row->same_fovea)
        return true;
    if (!store_read_gaze_after(pass->sample->files[pass->file], row->gaze_id, row->segment_id, &after))
        return false;
    return !after.other_eye || audit_note(pass, pass->session, row->trial_id, AUDIT_COPIED, 1);
}

struct frames_pass {
    struct audit_pass *pass;
    bool *has_frames; // by segment
};

static void mark(struct frames_pass *frames, int64_t segment_id)
{
    for (size_t i = 0; i < frames->pass->segment_count; i++)
        if (frames->pass->segments[i].id == segment_id)
            frames->has_frames[i] = true;
}

static bool take_frame(void *user, const struct store_audit_frame_row *row)
{
    struct frames_pass *frames = user;
    struct audit_pass *pass = frames->pass;
    if (sample_any_session(pass->sample, pass->file, row->session_id) == SAMPLE_NONE)
        return true;
    pass->session = audit_find_session(pass, row->session_id);
    if (pass->session == SAMPLE_NONE || !check_number(pass, row))
        return false;
    if (pass->segment_id != row->segment_id)
        mark(frames, row->segment_id);
    pass->audit->sessions[pass->session].frames++;
    bool ok = check_late(pass, row) && check_stale(pass, row) && check_fovea(pass, row) &&
              audit_watch_frame(pass, row);
    pass->segment_id = row->segment_id;
    pass->last_number = row->number;
    pass->last_trial = row->trial_id;
    return ok;
}

// --- what frames are held against ---

static bool take_trial(void *user, const struct store_audit_trial_row *row)
{
    struct audit_pass *pass = user;
    if (!sample_grow(&pass->trials, pass->trial_count, sizeof *pass->trials))
        return false;
    pass->trials[pass->trial_count++] = *row;
    return true;
}

static bool take_moment(void *user, const struct store_moment_row *row)
{
    struct audit_pass *pass = user;
    struct audit_moment moment = {.row = *row};
    if (sample_any_session(pass->sample, pass->file, row->session_id) == SAMPLE_NONE)
        return true;
    if (!sample_grow(&pass->moments, pass->moment_count, sizeof *pass->moments))
        return false;
    if (row->what == STORE_MOMENT_TOGGLE) {
        moment.toggle = 1;
        for (size_t i = pass->moment_count; i > 0 && pass->moments[i - 1].row.trial_id == row->trial_id; i--)
            if (pass->moments[i - 1].toggle) {
                moment.toggle = pass->moments[i - 1].toggle + 1;
                break;
            }
    }
    pass->moments[pass->moment_count++] = moment;
    return true;
}

static bool count_toggles(struct audit_pass *pass)
{
    for (size_t i = 0; i < pass->moment_count; i++) {
        const struct audit_moment *moment = &pass->moments[i];
        bool drew = false;
        for (size_t k = 0; k < pass->segment_count && !drew; k++)
            drew = pass->segments[k].id == moment->row.segment_id && pass->segments[k].drew;
        if (!moment->toggle || !drew)
            continue;
        size_t session = audit_find_session(pass, moment->row.session_id);
        if (session == SAMPLE_NONE)
            return false;
        pass->audit->sessions[session].toggles++;
        pass->audit->sessions[session].judged += moment->judged;
    }
    return true;
}

static bool audit_file(struct audit_pass *pass)
{
    struct store_reader *reader = pass->sample->files[pass->file];
    struct frames_pass frames = {.pass = pass};
    bool ok = store_read_segments(reader, take_segment, pass) &&
              store_read_audit_trials(reader, take_trial, pass) &&
              store_read_moments(reader, take_moment, pass);
    frames.has_frames = calloc(pass->segment_count + 1, sizeof *frames.has_frames);
    ok = ok && frames.has_frames && store_read_audit_frames(reader, take_frame, &frames) &&
         (pass->segment_id == 0 ||
          close_segment(pass, pass->segment_id, pass->last_number + 1, pass->last_trial)) &&
         check_empty(pass, frames.has_frames) && store_read_exposures(reader, audit_take_exposure, pass) &&
         count_toggles(pass);
    free(frames.has_frames);
    free(pass->segments);
    free(pass->trials);
    free(pass->moments);
    return ok;
}

static int by_trial(const void *x, const void *y)
{
    const struct audit_trial *a = x, *b = y;
    if (a->session != b->session)
        return a->session < b->session ? -1 : 1;
    return (a->ordinal > b->ordinal) - (a->ordinal < b->ordinal);
}

bool audit_load(struct audit *out, struct sample *sample, char *error, size_t error_size)
{
    bool ok = true;
    *out = (struct audit){0};
    snprintf(error, error_size, "not enough memory");
    for (size_t i = 0; ok && i < sample->file_count; i++) {
        struct audit_pass pass = {.audit = out, .sample = sample, .file = i};
        ok = audit_file(&pass);
        if (!ok && store_reader_error(sample->files[i])[0])
            snprintf(error, error_size, "%s", store_reader_error(sample->files[i]));
    }
    if (!ok) {
        audit_free(out);
        return false;
    }
    if (out->trial_count)
        qsort(out->trials, out->trial_count, sizeof *out->trials, by_trial);
    error[0] = '\0';
    return true;
}

void audit_free(struct audit *audit)
{
    free(audit->sessions);
    free(audit->trials);
    free(audit->fades);
    *audit = (struct audit){0};
}
