// The queries of gaze.h.
#include "studies/store/gaze.h"

#include "studies/store/read_private.h"

#include <math.h>

struct call {
    void *user;
    store_gaze_sample_fn sample;
    store_gaze_trial_fn trial;
    store_target_fn target;
    store_gaze_use_fn use;
    store_gaze_check_fn check;
    const struct store_log_columns *log; // of gaze and frames
};

static bool read_all(struct store_reader *reader, const char *sql, int64_t bound,
                     bool (*row)(sqlite3_stmt *, const struct call *), const struct call *call)
{
    sqlite3_stmt *statement = NULL;
    reader->error[0] = '\0';
    int code = sqlite3_prepare_v2(reader->db, sql, -1, &statement, NULL);
    bool going = code == SQLITE_OK;
    if (going && bound)
        sqlite3_bind_int64(statement, 1, bound);
    struct store_log_progress at = {0};
    while (going && (code = sqlite3_step(statement)) == SQLITE_ROW)
        going = (!call->log || store_reader_log_row(reader, statement, call->log, &at)) && row(statement, call);
    if (code != SQLITE_DONE && code != SQLITE_ROW) {
        store_reader_fail_sqlite(reader, code);
        going = false;
    }
    sqlite3_finalize(statement);
    return going;
}

// The first letter of a word. As a blob SQLite hands it out without making a copy that ends in a zero.
static char letter(sqlite3_stmt *s, int column)
{
    const char *value = sqlite3_column_blob(s, column);
    return value ? value[0] : '\0';
}

static const char *text(sqlite3_stmt *s, int column)
{
    const unsigned char *value = sqlite3_column_text(s, column);
    return value ? (const char *)value : "";
}

// A measurement that is no number is not known.
static double real(sqlite3_stmt *s, int column)
{
    double value = sqlite3_column_double(s, column);
    return sqlite3_column_type(s, column) != SQLITE_NULL && isfinite(value) ? value : (double)NAN;
}

static bool sample_row(sqlite3_stmt *s, const struct call *call)
{
    struct store_gaze_sample row = {.session_id = sqlite3_column_int64(s, 0),
                                    .segment_id = sqlite3_column_int64(s, 1),
                                    .trial_id = sqlite3_column_int64(s, 2),
                                    .device_ns = sqlite3_column_int64(s, 3),
                                    .host_ns = sqlite3_column_int64(s, 4),
                                    .eye = letter(s, 5),
                                    .x_deg = real(s, 6),
                                    .y_deg = real(s, 7),
                                    .valid = sqlite3_column_int(s, 8)};
    return call->sample(call->user, &row);
}

bool store_read_gaze(struct store_reader *reader, store_gaze_sample_fn each, void *user)
{
    static const char sql[] = "SELECT session_id, segment_id, trial_id, device_ns, host_ns, eye, x_deg, y_deg,"
                              " valid, id FROM gaze ORDER BY id";
    static const struct store_log_columns log = {9, 0, 1, 2, -1};
    return read_all(reader, sql, 0, sample_row, &(struct call){.user = user, .sample = each, .log = &log}) &&
           store_reader_unchanged(reader);
}

static bool trial_row(sqlite3_stmt *s, const struct call *call)
{
    bool started = sqlite3_column_type(s, 4) != SQLITE_NULL, ended = sqlite3_column_type(s, 5) != SQLITE_NULL;
    struct store_gaze_trial row = {.id = sqlite3_column_int64(s, 0),
                                   .session_id = sqlite3_column_int64(s, 1),
                                   .segment_id = sqlite3_column_int64(s, 2),
                                   .ordinal = sqlite3_column_int64(s, 3),
                                   .started_ns = started ? sqlite3_column_int64(s, 4) : -1,
                                   .ended_ns = ended ? sqlite3_column_int64(s, 5) : -1,
                                   .fixation = text(s, 6),
                                   .done = sqlite3_column_int(s, 7),
                                   .practice = sqlite3_column_int(s, 8),
                                   .tracker = sqlite3_column_int(s, 9),
                                   .ipd_m = real(s, 10)};
    return call->trial(call->user, &row);
}

bool store_read_gaze_trials(struct store_reader *reader, store_gaze_trial_fn each, void *user)
{
    static const char sql[] =
        "SELECT t.id, t.session_id, t.segment_id, t.ordinal, t.started_ns, t.ended_ns, t.fixation,"
        " t.status = 'done', t.kind = 'practice', coalesce(s.settings ->> '$.gaze', 'none') <> 'none',"
        " CASE WHEN json_type(s.settings, '$.ipd_m') IN ('real', 'integer') THEN s.settings ->> '$.ipd_m' END"
        " FROM trial t JOIN session s ON s.id = t.session_id ORDER BY t.id";
    return read_all(reader, sql, 0, trial_row, &(struct call){.user = user, .trial = each}) &&
           store_reader_unchanged(reader);
}

static bool target_row(sqlite3_stmt *s, const struct call *call)
{
    struct store_target_row row = {.segment_id = sqlite3_column_int64(s, 0),
                                   .shown_ns = sqlite3_column_int64(s, 1),
                                   .x_deg = real(s, 2),
                                   .y_deg = real(s, 3),
                                   .distance_m = real(s, 4)};
    return call->target(call->user, &row);
}

bool store_read_targets(struct store_reader *reader, int64_t trial_id, store_target_fn each, void *user)
{
    static const char sql[] =
        "SELECT segment_id, coalesce(present_ns, start_ns), target_x_deg, target_y_deg, target_m FROM frame"
        " WHERE trial_id = ?1 AND phase = 'stimulus' AND target_x_deg IS NOT NULL AND target_y_deg IS NOT NULL"
        " ORDER BY id";
    return read_all(reader, sql, trial_id, target_row, &(struct call){.user = user, .target = each});
}

static bool use_row(sqlite3_stmt *s, const struct call *call)
{
    if (!sqlite3_column_int(s, 5))
        return true;
    struct store_gaze_use row = {.session_id = sqlite3_column_int64(s, 0),
                                 .age_ms = real(s, 1) / 1e3,
                                 .to_light_ms = real(s, 2) / 1e6,
                                 .estimated = sqlite3_column_int(s, 3),
                                 .lost = sqlite3_column_int(s, 4)};
    return call->use(call->user, &row);
}

bool store_read_gaze_uses(struct store_reader *reader, store_gaze_use_fn each, void *user)
{
    static const char sql[] =
        "SELECT session_id, gaze_age_us, present_ns - start_ns, present_estimated, fovea_source = 'lost',"
        " phase = 'stimulus' AND fovea_source IN ('gaze', 'lost'), id, segment_id, trial_id, condition_id FROM "
        "frame ORDER BY id";
    static const struct store_log_columns log = {6, 0, 7, 8, 9};
    return read_all(reader, sql, 0, use_row, &(struct call){.user = user, .use = each, .log = &log}) &&
           store_reader_unchanged(reader);
}

static bool check_row(sqlite3_stmt *s, const struct call *call)
{
    struct store_gaze_check_row row = {.session_id = sqlite3_column_int64(s, 0),
                                       .block = text(s, 1),
                                       .x_deg = real(s, 2),
                                       .y_deg = real(s, 3),
                                       .eye = letter(s, 4),
                                       .accuracy_deg = real(s, 5),
                                       .rms_s2s_deg = real(s, 6),
                                       .sd_deg = real(s, 7),
                                       .loss = real(s, 8),
                                       .passed = sqlite3_column_int(s, 9)};
    return call->check(call->user, &row);
}

bool store_read_gaze_checks(struct store_reader *reader, store_gaze_check_fn each, void *user)
{
    static const char sql[] =
        "SELECT session_id, block, x_deg, y_deg, eye, accuracy_deg, rms_s2s_deg, sd_deg, loss,"
        " passed FROM gaze_check ORDER BY id";
    return read_all(reader, sql, 0, check_row, &(struct call){.user = user, .check = each}) &&
           store_reader_unchanged(reader);
}
