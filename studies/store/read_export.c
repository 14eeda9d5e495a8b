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
#define OUT(sets)                                                                                              \
    "EXISTS (SELECT 1 FROM exclusion AS x WHERE x.rule_set " sets " AND (x.trial_id = t.id OR x.session_id = " \
    "t.session_id OR x.participant_id = s.participant_id)) "
#define OF_TRIAL                                                                                               \
    "trial AS t JOIN session AS s ON s.id = t.session_id JOIN participant AS p ON p.id = s.participant_id "
#define IN_TRIAL(table)                                                                                        \
    " FROM " table " AS c JOIN trial AS t ON t.id = c.trial_id JOIN session AS s ON s.id = "                   \
    "t.session_id JOIN participant AS p ON p.id = s.participant_id ORDER BY c.id"
#define OF_SESSION(table)                                                                                      \
    " FROM " table " AS c JOIN session AS s ON s.id = c.session_id JOIN participant AS p ON "                  \
    "p.id = s.participant_id ORDER BY c.id"

static const char *const names[] = {"participants", "attributes", "sessions", "segments",   "conditions",
                                    "trials",       "choices",    "ratings",  "responses",  "adjustments",
                                    "staircases",   "exposures",  "gaze",     "gazechecks", "frames",
                                    "exclusions",   "protocols",  NULL};

static const char *const queries[] = {
    "SELECT code AS participant_id, number AS participant_number, kind AS participant_kind FROM participant "
    "ORDER BY id",
    "SELECT p.code AS participant_id, j.key AS attribute, CAST(j.value AS TEXT) AS attribute_value FROM "
    "participant "
    "AS p, json_each(p.attributes) AS j ORDER BY p.id, j.id",
    "SELECT p.code AS participant_id, s.id AS session_id, o.name AS protocol, o.sha256 AS protocol_sha256, "
    "printf('%u', s.seed) AS seed, s.status AS session_status, s.started_at, s.ended_at, s.consent_at, "
    "s.consent_version, s.device, s.driver, s.display, s.refresh_hz, s.width_px, s.height_px, s.fov_deg, "
    "s.settings AS session_settings FROM session AS s JOIN participant AS p ON p.id = s.participant_id JOIN "
    "protocol "
    "AS o ON o.id = s.protocol_id ORDER BY s.id",
    "SELECT p.code AS participant_id, c.session_id, c.id AS segment_id, c.started_at, c.mono_origin_ns, "
    "c.clock, "
    "c.app_version, c.reason AS segment_reason" OF_SESSION("segment"),
    "SELECT id AS condition_id, mode, parameters FROM condition ORDER BY id",
    "SELECT " TRIAL_KEYS "t.segment_id, t.settings AS trial_settings, t.option_a, t.option_b, t.test_slot, "
    "t.first_shown, t.fixation, printf('%u', t.seed) AS seed, t.repeat_of, t.attempt, t.started_ns, "
    "t.ended_ns, " OUT("<> 'stricter'") "AS excluded, " OUT(
        "= 'stricter'") "AS excluded_stricter FROM " OF_TRIAL "ORDER BY t.id",
    "SELECT " TRIAL_KEYS
    "c.id AS row_id, c.segment_id, CASE t.test_slot WHEN 'b' THEN t.option_b WHEN 'a' THEN "
    "t.option_a END AS test_condition_id, CASE t.test_slot WHEN 'b' THEN t.option_a WHEN 'a' THEN t.option_b "
    "END AS "
    "reference_condition_id, c.chosen AS chosen_slot, CASE WHEN c.chosen = 'equal' THEN 'equal' WHEN c.chosen "
    "= "
    "t.test_slot THEN 'test' WHEN t.test_slot IS NOT NULL THEN 'reference' END AS chosen, t.first_shown, "
    "c.correct, "
    "c.reaction_ns, c.answered_ns, c.toggles, " OUT("<> 'stricter'") "AS excluded, " OUT(
        "= 'stricter'") "AS excluded_stricter" IN_TRIAL("choice"),
    "SELECT p.code AS participant_id, s.id AS session_id, c.trial_id, t.ordinal, t.block, t.kind AS "
    "trial_kind, "
    "t.scene, t.factors, t.status AS trial_status, c.id AS row_id, c.segment_id, c.question, c.subject AS "
    "rated_subject, c.condition_id, c.value AS rating, c.scale_min, c.scale_max, c.answered_ns, EXISTS (SELECT "
    "1 FROM "
    "exclusion AS x WHERE x.rule_set <> 'stricter' AND (x.trial_id = t.id OR x.session_id = s.id OR "
    "x.participant_id = "
    "p.id)) AS excluded FROM rating AS c LEFT JOIN trial AS t ON t.id = c.trial_id JOIN session AS s ON s.id = "
    "coalesce(c.session_id, t.session_id) JOIN participant AS p ON p.id = s.participant_id ORDER BY c.id",
    "SELECT " TRIAL_KEYS
    "c.id AS row_id, c.segment_id, c.question, c.value AS response, c.expected, c.answered_ns, "
    "c.device AS input_device" IN_TRIAL("response"),
    "SELECT " TRIAL_KEYS
    "c.id AS row_id, c.segment_id, c.at_ns, c.parameter, c.value AS parameter_value" IN_TRIAL("adjust_step"),
    "SELECT " TRIAL_KEYS
    "c.id AS row_id, c.level, c.outcome, c.reversal, c.estimate" IN_TRIAL("staircase_step"),
    "SELECT " TRIAL_KEYS
    "c.id AS row_id, c.segment_id, c.attempt, c.option AS shown_slot, c.start_ns, c.end_ns, "
    "c.full_start_ns, c.full_end_ns" IN_TRIAL("exposure"),
    "SELECT p.code AS participant_id, c.session_id, c.segment_id, c.trial_id, c.id AS row_id, c.device_ns, "
    "c.host_ns, "
    "c.eye, c.x_deg, c.y_deg, c.pupil_mm, c.valid, c.confidence" OF_SESSION("gaze"),
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
