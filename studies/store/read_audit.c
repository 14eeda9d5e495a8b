// The queries of audit.h.
#include "studies/store/audit.h"

#include "studies/store/read_private.h"

#include <math.h>
#include <string.h>

struct call {
    void *user;
    store_segment_fn segment;
    store_audit_trial_fn trial;
    store_moment_fn moment;
    store_audit_frame_fn frame;
    store_exposure_fn exposure;
    const struct store_log_columns *log; // of gaze and frames
};

static bool read_all(struct store_reader *reader, const char *sql,
                     bool (*row)(sqlite3_stmt *, const struct call *), const struct call *call)
{
    sqlite3_stmt *statement = NULL;
    reader->error[0] = '\0';
    int code = sqlite3_prepare_v2(reader->db, sql, -1, &statement, NULL);
    bool going = code == SQLITE_OK;
    struct store_log_progress at = {0};
    while (going && (code = sqlite3_step(statement)) == SQLITE_ROW)
        going = (!call->log || store_reader_log_row(reader, statement, call->log, &at)) && row(statement, call);
    if (code != SQLITE_DONE && code != SQLITE_ROW) {
        store_reader_fail_sqlite(reader, code);
        going = false;
    }
    sqlite3_finalize(statement);
    return going && store_reader_unchanged(reader);
}

// The first letter of a word of a closed set, 0 for NULL.
static char letter(sqlite3_stmt *statement, int column)
{
    const unsigned char *value = sqlite3_column_text(statement, column);
    return value ? (char)value[0] : '\0';
}

static bool segment_row(sqlite3_stmt *s, const struct call *call)
{
    struct store_segment_row row = {
        .id = sqlite3_column_int64(s, 0),
        .session_id = sqlite3_column_int64(s, 1),
        .submitted = sqlite3_column_type(s, 2) == SQLITE_NULL ? -1 : sqlite3_column_int64(s, 2),
        .dropped = sqlite3_column_int64(s, 3),
        .drew = sqlite3_column_int(s, 4),
    };
    return call->segment(call->user, &row);
}

bool store_read_segments(struct store_reader *reader, store_segment_fn each, void *user)
{
    static const char sql[] =
        "SELECT g.id, g.session_id,"
        " (SELECT max(e.detail ->> '$.frames') FROM event e WHERE e.session_id = g.session_id AND"
        "  e.segment_id = g.id AND e.kind = 'frames_submitted'),"
        " (SELECT total(e.detail ->> '$.frame') FROM event e WHERE e.session_id = g.session_id AND"
        "  e.segment_id = g.id AND e.kind = 'log_overflow'),"
        " coalesce(s.display, 'none') <> 'none' FROM segment g JOIN session s ON s.id = g.session_id ORDER BY "
        "g.id";
    return read_all(reader, sql, segment_row, &(struct call){.user = user, .segment = each});
}

static bool trial_row(sqlite3_stmt *s, const struct call *call)
{
    struct store_audit_trial_row row = {
        .id = sqlite3_column_int64(s, 0),
        .session_id = sqlite3_column_int64(s, 1),
        .ordinal = sqlite3_column_int64(s, 2),
        .foveate = letter(s, 3),
        .switches = sqlite3_column_int(s, 4),
        .fade_ns = {sqlite3_column_int64(s, 5), sqlite3_column_int64(s, 6), sqlite3_column_int64(s, 7)},
        .sequence = sqlite3_column_int(s, 8),
        .view_ns = sqlite3_column_int64(s, 9),
        .gap_ns = sqlite3_column_int64(s, 10),
    };
    return call->trial(call->user, &row);
}

bool store_read_audit_trials(struct store_reader *reader, store_audit_trial_fn each, void *user)
{
    static const char sql[] =
        "SELECT id, session_id, ordinal, coalesce(settings ->> '$.foveate', 'gaze'),"
        " coalesce(settings ->> '$.procedure', kind) IN ('toggle', 'adjust', 'staircase') AND"
        "  json_array_length(settings, '$.fade_s') = 3,"
        " round(1e9 * (settings ->> '$.fade_s[0]')), round(1e9 * (settings ->> '$.fade_s[1]')),"
        " round(1e9 * (settings ->> '$.fade_s[2]')),"
        " coalesce(settings ->> '$.procedure', kind) = 'sequential' AND json_array_length(settings, "
        "'$.fade_s') = 3"
        "  AND settings ->> '$.view_s' > 0 AND settings ->> '$.gap_s' IS NOT NULL,"
        " round(1e9 * (settings ->> '$.view_s')), round(1e9 * (settings ->> '$.gap_s')) FROM trial ORDER BY id";
    return read_all(reader, sql, trial_row, &(struct call){.user = user, .trial = each});
}

static bool moment_row(sqlite3_stmt *s, const struct call *call)
{
    struct store_moment_row row = {
        .session_id = sqlite3_column_int64(s, 0),
        .segment_id = sqlite3_column_int64(s, 1),
        .trial_id = sqlite3_column_int64(s, 2),
        .at_ns = sqlite3_column_int64(s, 3),
        .what = sqlite3_column_int(s, 4) ? STORE_MOMENT_TOGGLE : STORE_MOMENT_PAUSE,
    };
    return call->moment(call->user, &row);
}

bool store_read_moments(struct store_reader *reader, store_moment_fn each, void *user)
{
    static const char sql[] = "SELECT session_id, segment_id, trial_id, at_ns, kind = 'toggle' FROM event"
                              " WHERE trial_id IS NOT NULL AND kind IN ('toggle', 'pause_began', 'abort_asked')"
                              " ORDER BY trial_id, segment_id, at_ns, id";
    return read_all(reader, sql, moment_row, &(struct call){.user = user, .moment = each});
}

// The texts in the brackets after "left" and "right"; a fovea that the store did not write so is no same one.
static bool same_fovea(const char *json)
{
    const char *left = json ? strstr(json, "\"left\":[") : NULL;
    const char *right = left ? strstr(left, "\"right\":[") : NULL;
    if (!right)
        return false;
    left += strlen("\"left\":[");
    right += strlen("\"right\":[");
    size_t length = strcspn(left, "]");
    return length == strcspn(right, "]") && strncmp(left, right, length) == 0;
}

static bool frame_row(sqlite3_stmt *s, const struct call *call)
{
    struct store_audit_frame_row row = {
        .session_id = sqlite3_column_int64(s, 0),
        .segment_id = sqlite3_column_int64(s, 1),
        .trial_id = sqlite3_column_int64(s, 2),
        .attempt = sqlite3_column_int64(s, 3),
        .number = sqlite3_column_int64(s, 4),
        .start_ns = sqlite3_column_int64(s, 5),
        .option = letter(s, 6),
        .phase = letter(s, 7),
        .fade_level = sqlite3_column_double(s, 8),
        .rendered = sqlite3_column_type(s, 9) != SQLITE_NULL,
        .foveated = sqlite3_column_int(s, 10),
        .late = sqlite3_column_type(s, 11) == SQLITE_NULL ? -1 : sqlite3_column_int(s, 11),
        .source = letter(s, 12),
        .gaze_id = sqlite3_column_int64(s, 13),
        .gaze_age_ms =
            sqlite3_column_type(s, 14) == SQLITE_NULL ? (double)NAN : sqlite3_column_double(s, 14) / 1e3,
        .same_fovea = same_fovea((const char *)sqlite3_column_text(s, 15)),
        .differs = sqlite3_column_int(s, 16),
    };
    return call->frame(call->user, &row);
}

bool store_read_audit_frames(struct store_reader *reader, store_audit_frame_fn each, void *user)
{
    static const char sql[] =
        "SELECT f.session_id, f.segment_id, f.trial_id, f.attempt, f.number, f.start_ns, f.option, f.phase,"
        " f.fade_level, f.condition_id, c.mode NOT IN ('regular', 'ray_traced_full'), f.late, f.fovea_source,"
        " f.gaze_id, f.gaze_age_us, f.fovea,"
        " " NOT_AS_ASKED(
            "f.") ", f.id FROM frame f LEFT JOIN condition c ON c.id = f.condition_id ORDER BY f.id";
    static const struct store_log_columns log = {17, 0, 1, 2, 9};
    return read_all(reader, sql, frame_row, &(struct call){.user = user, .frame = each, .log = &log});
}

bool store_read_gaze_after(struct store_reader *reader, int64_t gaze_id, int64_t segment_id,
                           struct store_gaze_after *out)
{
    // Of two eyes, samples alternate: a blink shows in one of the next two.
    static const char sql[] =
        "SELECT coalesce(m.valid = 0, 0) OR coalesce(n.valid = 0, 0),"
        " coalesce(m.valid = 1 AND m.eye <> 'both' AND g.eye <> 'both' AND m.eye <> g.eye, 0) FROM (SELECT 1)"
        " LEFT JOIN gaze g ON g.id = ?1 LEFT JOIN gaze m ON m.id = ?1 + 1 AND m.segment_id = ?2"
        " LEFT JOIN gaze n ON n.id = ?1 + 2 AND n.segment_id = ?2";
    int code = SQLITE_OK;
    *out = (struct store_gaze_after){0};
    if (gaze_id == 0)
        return true;
    if (!reader->after)
        code = sqlite3_prepare_v2(reader->db, sql, -1, &reader->after, NULL);
    if (code == SQLITE_OK) {
        sqlite3_bind_int64(reader->after, 1, gaze_id);
        sqlite3_bind_int64(reader->after, 2, segment_id);
        code = sqlite3_step(reader->after);
    }
    if (code == SQLITE_ROW)
        *out = (struct store_gaze_after){sqlite3_column_int(reader->after, 0) != 0,
                                         sqlite3_column_int(reader->after, 1) != 0};
    else
        store_reader_fail_sqlite(reader, code);
    sqlite3_reset(reader->after);
    return code == SQLITE_ROW;
}

static bool exposure_row(sqlite3_stmt *s, const struct call *call)
{
    bool full = sqlite3_column_type(s, 4) != SQLITE_NULL;
    struct store_exposure_row row = {
        .trial_id = sqlite3_column_int64(s, 0),
        .segment_id = sqlite3_column_int64(s, 1),
        .attempt = sqlite3_column_int64(s, 2),
        .option = letter(s, 3),
        .full_start_ns = full ? sqlite3_column_int64(s, 4) : -1,
        .full_end_ns = full ? sqlite3_column_int64(s, 5) : -1,
    };
    return call->exposure(call->user, &row);
}

bool store_read_exposures(struct store_reader *reader, store_exposure_fn each, void *user)
{
    static const char sql[] =
        "SELECT trial_id, segment_id, attempt, option, full_start_ns, full_end_ns FROM exposure"
        " ORDER BY trial_id, attempt, start_ns, id";
    return read_all(reader, sql, exposure_row, &(struct call){.user = user, .exposure = each});
}
