// The queries of export.h. Every table names its rows by participant, session and trial, so that each file is
// complete in itself; the same column name means the same in all of them.
#include "studies/store/export.h"

#include "studies/store/read_private.h"

#include <string.h>

enum { COLUMNS = 48 };

#define TRIAL_KEYS                                                                                             \
    "p.code AS participant_id, t.session_id AS session_id, t.id AS trial_id, t.ordinal AS ordinal, t.block "   \
    "AS block, "                                                                                               \
    "t.kind AS trial_kind, t.scene AS scene, t.factors AS factors, t.status AS trial_status, "

// Which rules take a row out, by its person, session and trial: 0 where a row has none, so that a session has
// the verdict of trial 0. `of_trial`: which exclusions of its trial concern a row; the rule is sample.h's. The
// CASTs let SQLite make an index over what it materializes: it makes none over a column without a type.
#define VERDICTS(of_trial)                                                                                     \
    "WITH place (person, session, trial) AS ("                                                                 \
    "SELECT id, 0, 0 FROM participant "                                                                        \
    "UNION ALL SELECT participant_id, id, 0 FROM session "                                                     \
    "UNION ALL SELECT s.participant_id, s.id, t.id FROM trial AS t JOIN session AS s ON s.id = "               \
    "t.session_id), "                                                                                          \
    "hit AS (SELECT p.*, x.* FROM exclusion AS x JOIN place AS p ON p.trial = x.trial_id WHERE " of_trial      \
    " UNION ALL SELECT p.*, x.* FROM exclusion AS x JOIN place AS p ON p.session = x.session_id "              \
    "UNION ALL SELECT p.*, x.* FROM exclusion AS x JOIN place AS p ON p.person = x.participant_id), "          \
    "verdict AS MATERIALIZED (SELECT CAST(person AS INTEGER) AS person, CAST(session AS INTEGER) AS session, " \
    "CAST(trial AS INTEGER) AS trial, max(rule_set <> 'stricter') AS applied, max(rule_set = 'stricter') AS "  \
    "stricter, group_concat(rule || ' (' || rule_set || ')', '; ') AS rules "                                  \
    "FROM (SELECT * FROM hit ORDER BY id) GROUP BY person, session, trial) "
#define RATED VERDICTS("TRUE") ", " BEGAN
#define ANSWERED VERDICTS("NOT " RATINGS_ONLY("x")) ", " BEGAN
#define OUT                                                                                                    \
    "coalesce(v.applied, 0) AS excluded, coalesce(v.stricter, 0) AS excluded_stricter, v.rules AS "            \
    "excluded_rules "

// The attempt at its trial that a row of some time is of. Of the last one the store knows the begin, and what
// came before a second one is of the first; of more, frames and stretches tell when each but the last began.
#define BEGAN                                                                                                  \
    "start (trial, segment, attempt, at_ns) AS (SELECT trial_id, segment_id, attempt, min(start_ns) FROM ("    \
    "SELECT t.attempt AS last, f.trial_id, f.segment_id, f.attempt, f.start_ns "                               \
    "FROM trial AS t CROSS JOIN frame AS f ON f.trial_id = t.id WHERE t.attempt > 2 "                          \
    "UNION ALL SELECT t.attempt, e.trial_id, e.segment_id, e.attempt, e.start_ns "                             \
    "FROM trial AS t CROSS JOIN exposure AS e ON e.trial_id = t.id WHERE t.attempt > 2) "                      \
    "WHERE attempt < last GROUP BY 1, 2, 3), "                                                                 \
    "began AS MATERIALIZED (SELECT CAST(trial AS INTEGER) AS trial_id, CAST(segment AS INTEGER) AS "           \
    "segment_id, attempt, at_ns AS start_ns, coalesce((SELECT min(n.at_ns) FROM start AS n WHERE n.trial = "   \
    "start.trial AND n.segment = start.segment AND (n.at_ns, n.attempt) > (start.at_ns, start.attempt)), "     \
    "9223372036854775807) AS until_ns FROM start) "
#define ATTEMPT(first, time)                                                                                   \
    "CASE " first " WHEN c.segment_id = t.segment_id AND " time                                                \
    " >= t.started_ns THEN t.attempt WHEN t.attempt = 2 THEN 1 ELSE b.attempt END AS attempt, "
#define ONLY_ONE "WHEN t.attempt = 1 THEN 1"
#define OF_ANSWER ATTEMPT(ONLY_ONE, "c.answered_ns")
#define OF_MOMENT ATTEMPT(ONLY_ONE, "c.at_ns")
#define OF_SAMPLE ATTEMPT("", "c.host_ns") // one from before the first attempt is of none
#define WHEN(time)                                                                                             \
    "LEFT JOIN began AS b ON b.trial_id = c.trial_id AND b.segment_id = c.segment_id AND " time                \
    " >= b.start_ns AND " time " < b.until_ns "
#define WHEN_ANSWERED WHEN("c.answered_ns")
#define AT_MOMENT WHEN("c.at_ns")
#define ON_ARRIVAL WHEN("c.host_ns")

#define IN_TRIAL(table, attempt)                                                                               \
    "FROM " table " AS c JOIN trial AS t ON t.id = c.trial_id JOIN session AS s ON s.id = "                    \
    "t.session_id JOIN participant AS p ON p.id = s.participant_id LEFT JOIN verdict AS v ON v.trial = "       \
    "t.id " attempt "ORDER BY c.id"
#define OF_SESSION(table)                                                                                      \
    " FROM " table " AS c JOIN session AS s ON s.id = c.session_id JOIN participant AS p ON "                  \
    "p.id = s.participant_id ORDER BY c.id"

static const char *const names[] = {"participants", "attributes", "sessions", "segments",       "conditions",
                                    "trials",       "choices",    "ratings",  "responses",      "adjustments",
                                    "staircases",   "exposures",  "gaze",     "gazechecks",     "frames",
                                    "exclusions",   "protocols",  "events",   "measurederrors", NULL};

static const char *const queries[] = {
    ANSWERED "SELECT p.code AS participant_id, p.number AS participant_number, p.kind AS participant_kind, " OUT
             "FROM participant AS p LEFT JOIN verdict AS v ON v.person = p.id AND v.session = 0 ORDER BY p.id",
    "SELECT p.code AS participant_id, j.key AS attribute, CAST(j.value AS TEXT) AS attribute_value FROM "
    "participant "
    "AS p, json_each(p.attributes) AS j ORDER BY p.id, j.id",
    ANSWERED
    "SELECT p.code AS participant_id, s.id AS session_id, o.name AS protocol, o.sha256 AS protocol_sha256, "
    "printf('%u', s.seed) AS seed, s.status AS session_status, s.started_at, s.ended_at, s.consent_at, "
    "s.consent_version, s.device, s.driver, s.display, s.refresh_hz, s.width_px, s.height_px, s.fov_deg, "
    "s.settings AS session_settings, " OUT
    "FROM session AS s JOIN participant AS p ON p.id = s.participant_id JOIN protocol AS o ON o.id = "
    "s.protocol_id LEFT JOIN verdict AS v ON v.session = s.id AND v.trial = 0 ORDER BY s.id",
    "SELECT p.code AS participant_id, c.session_id, c.id AS segment_id, c.started_at, c.mono_origin_ns, "
    "c.clock, "
    "c.app_version, c.reason AS segment_reason" OF_SESSION("segment"),
    "SELECT id AS condition_id, mode, parameters FROM condition ORDER BY id",
    ANSWERED "SELECT " TRIAL_KEYS
             "t.segment_id, t.settings AS trial_settings, t.option_a, t.option_b, t.test_slot, t.first_shown, "
             "t.fixation, printf('%u', t.seed) AS seed, t.repeat_of, t.attempt, t.started_ns, t.ended_ns, " OUT
             "FROM trial AS t JOIN session AS s ON s.id = t.session_id JOIN participant AS p ON p.id = "
             "s.participant_id LEFT JOIN verdict AS v ON v.trial = t.id ORDER BY t.id",
    ANSWERED
    "SELECT " TRIAL_KEYS "c.id AS row_id, c.segment_id, " OF_ANSWER
    "CASE t.test_slot WHEN 'b' THEN t.option_b WHEN 'a' THEN t.option_a END AS test_condition_id, "
    "CASE t.test_slot WHEN 'b' THEN t.option_a WHEN 'a' THEN t.option_b END AS reference_condition_id, "
    "c.chosen AS chosen_slot, CASE WHEN c.chosen = 'equal' THEN 'equal' WHEN c.chosen = t.test_slot THEN "
    "'test' WHEN t.test_slot IS NOT NULL THEN 'reference' END AS chosen, t.first_shown, c.correct, "
    "c.reaction_ns, c.answered_ns, c.toggles, " OUT IN_TRIAL("choice", WHEN_ANSWERED),
    RATED
    "SELECT p.code AS participant_id, s.id AS session_id, c.trial_id, t.ordinal, t.block, t.kind AS "
    "trial_kind, t.scene, t.factors, t.status AS trial_status, c.id AS row_id, c.segment_id, " OF_ANSWER
    "c.question, c.subject AS rated_subject, c.condition_id, c.value AS rating, c.scale_min, c.scale_max, "
    "c.answered_ns, " OUT
    "FROM rating AS c LEFT JOIN trial AS t ON t.id = c.trial_id JOIN session AS s ON s.id = "
    "coalesce(c.session_id, t.session_id) JOIN participant AS p ON p.id = s.participant_id LEFT JOIN verdict "
    "AS v ON v.session = s.id AND v.trial = coalesce(c.trial_id, 0) " WHEN_ANSWERED "ORDER BY c.id",
    ANSWERED
    "SELECT " TRIAL_KEYS "c.id AS row_id, c.segment_id, " OF_ANSWER
    "c.question, c.value AS response, c.expected, c.answered_ns, c.device AS input_device, " OUT IN_TRIAL(
        "response", WHEN_ANSWERED),
    ANSWERED "SELECT " TRIAL_KEYS "c.id AS row_id, c.segment_id, " OF_MOMENT
             "c.at_ns, c.parameter, c.value AS parameter_value, " OUT IN_TRIAL("adjust_step", AT_MOMENT),
    ANSWERED "SELECT " TRIAL_KEYS
             "c.id AS row_id, c.level, c.outcome, c.reversal, c.estimate, " OUT IN_TRIAL("staircase_step", ""),
    ANSWERED
    "SELECT " TRIAL_KEYS
    "c.id AS row_id, c.segment_id, c.attempt, c.option AS shown_slot, c.start_ns, c.end_ns, c.full_start_ns, "
    "c.full_end_ns, " OUT IN_TRIAL("exposure", ""),
    "WITH " BEGAN
    "SELECT p.code AS participant_id, c.session_id, c.segment_id, c.trial_id, c.id AS row_id, " OF_SAMPLE
    "c.device_ns, c.host_ns, c.eye, c.x_deg, c.y_deg, c.pupil_mm, c.valid, c.confidence FROM gaze AS c JOIN "
    "session AS s ON s.id = c.session_id JOIN participant AS p ON p.id = s.participant_id LEFT JOIN trial AS "
    "t ON t.id = c.trial_id " ON_ARRIVAL "ORDER BY c.id",
    "SELECT p.code AS participant_id, c.session_id, c.segment_id, c.id AS row_id, c.at_ns, c.block, c.x_deg, "
    "c.y_deg, "
    "c.eye, c.accuracy_deg, c.rms_s2s_deg, c.sd_deg, c.loss, c.passed" OF_SESSION("gaze_check"),
    "SELECT p.code AS participant_id, c.session_id, c.segment_id, c.trial_id, c.id AS row_id, c.attempt, "
    "c.number AS "
    "frame_number, c.option AS shown_slot, c.condition_id, c.phase, c.fade_level, c.start_ns, c.cpu_us, "
    "c.gpu_us, "
    "c.present_ns, c.present_estimated, c.late, c.gaze_id, c.gaze_age_us, c.fovea, c.fovea_source, "
    "c.effective, "
    "c.target_x_deg, c.target_y_deg, c.target_m, c.head_pose, c.shaded_px, c.triangles" OF_SESSION("frame"),
    "SELECT coalesce(p.code, q.code) AS participant_id, coalesce(x.session_id, t.session_id) AS session_id, "
    "x.trial_id, x.rule, x.rule_set, x.reason AS exclusion_reason, x.\"by\" AS excluded_by, x.applied_at FROM "
    "exclusion AS x LEFT JOIN trial AS t ON t.id = x.trial_id LEFT JOIN session AS s ON s.id = "
    "coalesce(x.session_id, "
    "t.session_id) LEFT JOIN participant AS p ON p.id = x.participant_id LEFT JOIN participant AS q ON q.id = "
    "s.participant_id ORDER BY x.id",
    "SELECT name AS protocol, sha256 AS protocol_sha256, text AS protocol_text FROM protocol ORDER BY id",
    ANSWERED
    "SELECT p.code AS participant_id, c.session_id, c.segment_id, c.trial_id, c.id AS row_id, " OF_MOMENT
    "c.at_ns, c.kind AS event_kind, c.detail AS event_detail, " OUT
    "FROM event AS c JOIN session AS s ON s.id = c.session_id JOIN participant AS p ON p.id = "
    "s.participant_id LEFT JOIN trial AS t ON t.id = c.trial_id LEFT JOIN verdict AS v ON v.session = s.id "
    "AND v.trial = coalesce(c.trial_id, 0) " AT_MOMENT "ORDER BY c.id",
    ("SELECT condition_id, reference_id AS reference_condition_id, scene, metric, value AS image_error FROM "
     "measured_error ORDER BY condition_id, reference_id, scene, metric"),
};

const char *const *store_export_tables(void)
{
    return names;
}

static void fill(sqlite3_stmt *statement, struct store_cell *cells, int count)
{
    for (int i = 0; i < count; i++) {
        struct store_cell *cell = &cells[i];
        switch (sqlite3_column_type(statement, i)) {
        case SQLITE_INTEGER:
            cell->kind = STORE_CELL_INTEGER;
            cell->integer = sqlite3_column_int64(statement, i);
            break;
        case SQLITE_FLOAT:
            cell->kind = STORE_CELL_REAL;
            cell->real = sqlite3_column_double(statement, i);
            break;
        case SQLITE_NULL:
            cell->kind = STORE_CELL_NONE;
            break;
        default:
            cell->kind = STORE_CELL_TEXT;
            cell->text = (const char *)sqlite3_column_text(statement, i);
        }
    }
}

bool store_read_export(struct store_reader *reader, const char *table, store_export_fn each, void *user)
{
    size_t which = 0;
    while (names[which] && strcmp(names[which], table) != 0)
        which++;
    reader->error[0] = '\0';
    if (!names[which]) {
        store_reader_fail(reader, "%s: there is no table %s to export", reader->path, table);
        return false;
    }
    sqlite3_stmt *statement = NULL;
    struct store_cell cells[COLUMNS] = {{0}};
    int code = sqlite3_prepare_v2(reader->db, queries[which], -1, &statement, NULL);
    int count = sqlite3_column_count(statement);
    for (int i = 0; i < count && i < COLUMNS; i++)
        cells[i].name = sqlite3_column_name(statement, i);
    bool going = code == SQLITE_OK && each(user, true, cells, (size_t)count);
    while (going && (code = sqlite3_step(statement)) == SQLITE_ROW) {
        fill(statement, cells, count);
        going = each(user, false, cells, (size_t)count);
    }
    if (code != SQLITE_OK && code != SQLITE_DONE && code != SQLITE_ROW) {
        store_reader_fail_sqlite(reader, code);
        going = false;
    }
    sqlite3_finalize(statement);
    return going && store_reader_unchanged(reader);
}
