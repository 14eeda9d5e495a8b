// The queries of read.h: one statement and one function that fills a row, each.
#include "studies/store/read.h"

#include "studies/store/read_private.h"
#include "studies/store/sitting.h"

#include <math.h>
#include <string.h>

// Whom a call hands its rows to: the member that fits is set.
struct call {
    void *user;
    store_session_fn session;
    store_member_fn member;
    store_trial_fn trial;
    store_rating_fn rating;
    store_frame_fn frame;
    store_exclusion_fn exclusion;
    store_step_fn step;
    store_adjusted_fn adjusted;
    const struct store_log_columns *log; // of gaze and frames
};

typedef bool (*row_fn)(sqlite3_stmt *statement, const struct call *call);

static bool read_rows(struct store_reader *reader, const char *sql, row_fn row, const struct call *call)
{
    reader->error[0] = '\0';
    sqlite3_stmt *statement = NULL;
    int code = sqlite3_prepare_v2(reader->db, sql, -1, &statement, NULL);
    if (code != SQLITE_OK) {
        store_reader_fail_sqlite(reader, code);
        return false;
    }
    bool going = true;
    struct store_log_progress at = {0};
    while (going && (code = sqlite3_step(statement)) == SQLITE_ROW)
        going = (!call->log || store_reader_log_row(reader, statement, call->log, &at)) && row(statement, call);
    if (going && code != SQLITE_DONE) {
        store_reader_fail_sqlite(reader, code);
        going = false;
    }
    sqlite3_finalize(statement);
    return going && store_reader_unchanged(reader);
}

static const char *text(sqlite3_stmt *statement, int column)
{
    const unsigned char *value = sqlite3_column_text(statement, column);
    return value ? (const char *)value : "";
}

static double real(sqlite3_stmt *statement, int column)
{
    return sqlite3_column_type(statement, column) == SQLITE_NULL ? (double)NAN
                                                                 : sqlite3_column_double(statement, column);
}

// A measurement that is no number is not known.
static double finite_real(sqlite3_stmt *statement, int column)
{
    double value = real(statement, column);
    return isfinite(value) ? value : (double)NAN;
}

static bool session_row(sqlite3_stmt *s, const struct call *call)
{
    struct store_session_row row = {
        .id = sqlite3_column_int64(s, 0),
        .participant_id = sqlite3_column_int64(s, 1),
        .number = sqlite3_column_int64(s, 2),
        .code = text(s, 3),
        .simulated = sqlite3_column_int(s, 4),
        .status = text(s, 5),
        .started_at = text(s, 6),
        .ended_at = text(s, 7),
        .seed = (uint64_t)sqlite3_column_int64(s, 8),
        .protocol_name = text(s, 9),
        .protocol_sha256 = text(s, 10),
        .device = text(s, 11),
        .driver = text(s, 12),
        .display = text(s, 13),
        .refresh_hz = finite_real(s, 14),
        .width_px = real(s, 15),
        .height_px = real(s, 16),
        .fov_deg = real(s, 17),
        .app_version = text(s, 18),
        .simulated_clock = sqlite3_column_int(s, 19),
        .segments = sqlite3_column_int64(s, 20),
        .scenes = text(s, 21),
        .observer = text(s, 22),
        .planned = text(s, 23),
        .title = text(s, 24),
        .sitting = text(s, 25),
    };
    return call->session(call->user, &row);
}

#define THIS_SITTING SITTING("main")
bool store_read_sessions(struct store_reader *reader, store_session_fn each, void *user)
{
    static const char sql[] =
        "SELECT s.id, s.participant_id, p.number, p.code, p.kind = 'simulated', s.status, s.started_at, "
        "s.ended_at,"
        " s.seed, o.name, o.sha256, s.device, s.driver, s.display, s.refresh_hz, s.width_px, s.height_px, "
        "s.fov_deg,"
        " (SELECT app_version FROM segment WHERE session_id = s.id ORDER BY id LIMIT 1),"
        " (SELECT max(clock = 'simulated') FROM segment WHERE session_id = s.id),"
        " (SELECT count(*) FROM segment WHERE session_id = s.id),"
        " coalesce((SELECT group_concat(key || ': ' || value, ', ') FROM json_each(s.settings, '$.scenes')), "
        "''),"
        " coalesce((SELECT group_concat(key || ' ' || printf('%g', value), ', ')"
        "           FROM json_each(s.settings, '$.observer')), ''),"
        " coalesce((SELECT group_concat((value ->> '$.method') || ' ' || (value ->> '$.of') || ' ' ||"
        "   (value ->> '$.per') || iif(value ->> '$.margin' IS NULL, '', printf(' %.15g', value ->> "
        "'$.margin')),"
        "   char(10)) FROM json_each(s.settings, '$.planned')), ''),"
        " coalesce(s.settings ->> '$.title', ''), " THIS_SITTING
        " FROM session s JOIN participant p ON p.id = s.participant_id JOIN protocol o ON o.id = s.protocol_id"
        " ORDER BY s.id";
    return read_rows(reader, sql, session_row, &(struct call){.user = user, .session = each});
}

static bool member_row(sqlite3_stmt *s, const struct call *call)
{
    bool number = sqlite3_column_type(s, 4) == SQLITE_INTEGER || sqlite3_column_type(s, 4) == SQLITE_FLOAT;
    struct store_member_row row = {
        .owner = sqlite3_column_int64(s, 0),
        .owner_text = text(s, 1),
        .key = text(s, 2),
        .number = number ? finite_real(s, 4) : (double)NAN,
        .value = text(s, 3),
    };
    return call->member(call->user, &row);
}

bool store_read_factors(struct store_reader *reader, store_member_fn each, void *user)
{
    // value ->> '$' spells a number as the file does; j.atom would make 0.10 of it what SQLite likes.
    static const char sql[] =
        "SELECT 0, f.factors, j.key, CAST(j.value AS TEXT), j.atom FROM (SELECT DISTINCT factors FROM trial) f,"
        " json_each(f.factors) j ORDER BY f.factors, j.id";
    return read_rows(reader, sql, member_row, &(struct call){.user = user, .member = each});
}

bool store_read_conditions(struct store_reader *reader, store_member_fn each, void *user)
{
    static const char sql[] = "SELECT c.id, c.mode, j.key, CAST(j.value AS TEXT), j.atom FROM condition c LEFT "
                              "JOIN json_each(c.parameters) j"
                              " ORDER BY c.id, j.id";
    return read_rows(reader, sql, member_row, &(struct call){.user = user, .member = each});
}

bool store_read_attributes(struct store_reader *reader, store_member_fn each, void *user)
{
    static const char sql[] = "SELECT p.id, p.code, j.key, CAST(j.value AS TEXT), j.atom FROM participant p, "
                              "json_each(p.attributes) j"
                              " ORDER BY p.id, j.id";
    return read_rows(reader, sql, member_row, &(struct call){.user = user, .member = each});
}

// Slots become test and reference here, so that no analysis can forget to.
static bool trial_row(sqlite3_stmt *s, const struct call *call)
{
    const char *slot = text(s, 10), *chosen = text(s, 12);
    int test = slot[0] == 'b' ? 9 : 8, reference = slot[0] == 'b' ? 8 : 9;
    struct store_trial_row row = {
        .id = sqlite3_column_int64(s, 0),
        .session_id = sqlite3_column_int64(s, 1),
        .ordinal = sqlite3_column_int64(s, 2),
        .repeat_of = sqlite3_column_int64(s, 3),
        .block = text(s, 4),
        .kind = text(s, 5),
        .scene = text(s, 6),
        .factors = text(s, 7),
        .status = text(s, 16),
        .test_id = sqlite3_column_int64(s, test),
        .reference_id = sqlite3_column_int64(s, reference),
        .choice_id = sqlite3_column_int64(s, 11),
        .reaction_s = real(s, 13),
        .toggles = sqlite3_column_int64(s, 14),
        .chosen_first = sqlite3_column_type(s, 15) == SQLITE_NULL ? -1 : sqlite3_column_int(s, 15),
        .chosen_a = strcmp(chosen, "a") == 0,
        .correct = sqlite3_column_type(s, 17) == SQLITE_NULL ? -1 : sqlite3_column_int(s, 17),
        .attempt = sqlite3_column_int64(s, 18),
    };
    if (strcmp(chosen, "equal") == 0)
        row.chosen = '=';
    else if (chosen[0])
        row.chosen = (char)(slot[0] == '\0' ? '?' : slot[0] == chosen[0] ? 't' : 'r');
    return call->trial(call->user, &row);
}

bool store_read_trials(struct store_reader *reader, store_trial_fn each, void *user)
{
    static const char sql[] =
        "SELECT t.id, t.session_id, t.ordinal, t.repeat_of, t.block, t.kind, t.scene, t.factors, t.option_a,"
        " t.option_b, t.test_slot, c.id, c.chosen, c.reaction_ns / 1e9, c.toggles, c.chosen = t.first_shown, "
        "t.status, c.correct, t.attempt"
        " FROM trial t LEFT JOIN choice c ON c.trial_id = t.id ORDER BY t.session_id, t.ordinal";
    return read_rows(reader, sql, trial_row, &(struct call){.user = user, .trial = each});
}

static bool rating_row(sqlite3_stmt *s, const struct call *call)
{
    struct store_rating_row row = {
        .id = sqlite3_column_int64(s, 0),
        .session_id = sqlite3_column_int64(s, 1),
        .trial_id = sqlite3_column_int64(s, 2),
        .ordinal = sqlite3_column_int64(s, 3),
        .trial_status = text(s, 4),
        .question = text(s, 5),
        .block = text(s, 6),
        .scene = text(s, 7),
        .condition_id = sqlite3_column_int64(s, 8),
        .value = real(s, 9),
        .scale_min = real(s, 10),
        .scale_max = real(s, 11),
        .trial_kind = text(s, 12),
        .order = text(s, 13),
        .factors = text(s, 14),
        .subject = text(s, 15)[0],
    };
    return call->rating(call->user, &row);
}

bool store_read_ratings(struct store_reader *reader, store_rating_fn each, void *user)
{
    static const char sql[] =
        "SELECT r.id, coalesce(r.session_id, t.session_id) AS session, r.trial_id, t.ordinal, t.status, "
        "r.question,"
        " t.block, t.scene, r.condition_id, r.value, r.scale_min, r.scale_max, t.kind,"
        " t.factors ->> '$.order', t.factors, CASE WHEN r.subject = 'scene' OR t.test_slot IS NULL THEN 's' "
        "WHEN "
        "r.subject = t.test_slot THEN 't' ELSE 'r' END FROM rating r LEFT JOIN trial t ON t.id = r.trial_id "
        "ORDER BY session, "
        "r.question, t.ordinal, r.id";
    return read_rows(reader, sql, rating_row, &(struct call){.user = user, .rating = each});
}

static bool frame_row(sqlite3_stmt *s, const struct call *call)
{
    struct store_frame_row row = {
        .session_id = sqlite3_column_int64(s, 0),
        .segment_id = sqlite3_column_int64(s, 1),
        .trial_id = sqlite3_column_int64(s, 2),
        .number = sqlite3_column_int64(s, 3),
        .condition_id = sqlite3_column_int64(s, 4),
        .phase = text(s, 5),
        .start_ns = sqlite3_column_int64(s, 6),
        .cpu_us = finite_real(s, 7),
        .gpu_us = finite_real(s, 8),
        .late = sqlite3_column_int(s, 9),
        .late_known = sqlite3_column_type(s, 9) != SQLITE_NULL,
        .gaze_age_us = finite_real(s, 10),
        .shaded_px = real(s, 11),
        .simulated_clock = sqlite3_column_int(s, 12),
        .attempt = sqlite3_column_int64(s, 13),
    };
    return call->frame(call->user, &row);
}

bool store_read_frames(struct store_reader *reader, store_frame_fn each, void *user)
{
    static const char sql[] =
        "SELECT f.session_id, f.segment_id, f.trial_id, f.number, f.condition_id, "
        "f.phase, f.start_ns, f.cpu_us,"
        " f.gpu_us, f.late, f.gaze_age_us, f.shaded_px, g.clock = 'simulated', f.attempt, f.id"
        " FROM frame f LEFT JOIN segment g ON g.id = f.segment_id ORDER BY f.id";
    static const struct store_log_columns log = {14, 0, 1, 2, 4};
    return read_rows(reader, sql, frame_row, &(struct call){.user = user, .frame = each, .log = &log});
}

static bool exclusion_row(sqlite3_stmt *s, const struct call *call)
{
    struct store_exclusion_row row = {
        .trial_id = sqlite3_column_int64(s, 0),
        .session_id = sqlite3_column_int64(s, 1),
        .participant_id = sqlite3_column_int64(s, 2),
        .rule = text(s, 3),
        .rule_set = text(s, 4),
        .reason = text(s, 5),
        .by = text(s, 6),
        .ratings_only = sqlite3_column_int(s, 7),
    };
    return call->exclusion(call->user, &row);
}

bool store_read_exclusions(struct store_reader *reader, store_exclusion_fn each, void *user)
{
    static const char sql[] =
        "SELECT trial_id, session_id, participant_id, rule, rule_set, reason, \"by\", " RATINGS_ONLY(
            "exclusion") " FROM exclusion ORDER BY id";
    return read_rows(reader, sql, exclusion_row, &(struct call){.user = user, .exclusion = each});
}

static bool step_row(sqlite3_stmt *s, const struct call *call)
{
    struct store_step_row row = {.trial_id = sqlite3_column_int64(s, 0),
                                 .session_id = sqlite3_column_int64(s, 1),
                                 .ordinal = sqlite3_column_int64(s, 2),
                                 .block = text(s, 3),
                                 .factors = text(s, 4),
                                 .status = text(s, 5),
                                 .test_id = sqlite3_column_int64(s, 6),
                                 .level = real(s, 7),
                                 .outcome = sqlite3_column_int64(s, 8),
                                 .reversal = sqlite3_column_int(s, 9),
                                 .estimate = real(s, 10),
                                 .graded = sqlite3_column_int(s, 11)};
    return call->step(call->user, &row);
}

bool store_read_staircase_steps(struct store_reader *reader, store_step_fn each, void *user)
{
    static const char sql[] =
        "SELECT t.id, t.session_id, t.ordinal, t.block, t.factors, t.status,"
        " CASE t.test_slot WHEN 'a' THEN t.option_a WHEN 'b' THEN t.option_b END, s.level, s.outcome, "
        "s.reversal,"
        " s.estimate, c.id IS NULL OR c.chosen = 'equal' OR c.correct IS NULL OR s.outcome > 1"
        " FROM staircase_step s JOIN trial t ON t.id = s.trial_id LEFT JOIN choice c ON c.trial_id = t.id"
        " WHERE t.kind = 'staircase' ORDER BY t.session_id, t.block, t.factors, t.ordinal, s.id";
    return read_rows(reader, sql, step_row, &(struct call){.user = user, .step = each});
}

static bool adjusted_row(sqlite3_stmt *s, const struct call *call)
{
    struct store_adjusted_row row = {.trial_id = sqlite3_column_int64(s, 0),
                                     .session_id = sqlite3_column_int64(s, 1),
                                     .ordinal = sqlite3_column_int64(s, 2),
                                     .block = text(s, 3),
                                     .factors = text(s, 4),
                                     .status = text(s, 5),
                                     .test_id = sqlite3_column_int64(s, 6),
                                     .parameter = text(s, 7),
                                     .value = real(s, 8)};
    return call->adjusted(call->user, &row);
}

bool store_read_adjusted(struct store_reader *reader, store_adjusted_fn each, void *user)
{
    static const char sql[] =
        "SELECT t.id, t.session_id, t.ordinal, t.block, t.factors, t.status,"
        " CASE t.test_slot WHEN 'a' THEN t.option_a WHEN 'b' THEN t.option_b END, r.question, r.value"
        " FROM response r JOIN trial t ON t.id = r.trial_id"
        " WHERE t.kind = 'adjust' ORDER BY t.session_id, t.ordinal, r.id";
    return read_rows(reader, sql, adjusted_row, &(struct call){.user = user, .adjusted = each});
}
