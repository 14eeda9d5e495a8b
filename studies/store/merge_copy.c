// Copies the chosen sessions of an input, with every id moved past those that the output has.
#include "studies/store/merge_private.h"
#include "studies/store/migrate.h"

#define TAKEN "IN (SELECT id FROM temp.take)"
#define TAKEN_TRIALS "IN (SELECT t.id FROM src.trial AS t WHERE t.session_id IN (SELECT id FROM temp.take))"
#define CONDITION(column) "(SELECT new FROM temp.conditions WHERE old = " column ")"

static const char *const maps[] = {
    "DELETE FROM temp.protocols", "DELETE FROM temp.conditions", "DELETE FROM temp.people",
    "INSERT INTO main.protocol SELECT id + ?1, name, sha256, text FROM src.protocol WHERE sha256 NOT IN "
    "(SELECT sha256 FROM main.protocol)",
    "INSERT INTO temp.protocols SELECT s.id, m.id FROM src.protocol AS s JOIN main.protocol AS m USING "
    "(sha256)",
    "INSERT INTO main.condition SELECT id + ?1, mode, parameters FROM src.condition WHERE (mode, parameters) "
    "NOT IN "
    "(SELECT mode, parameters FROM main.condition)",
    "INSERT INTO temp.conditions SELECT s.id, m.id FROM src.condition AS s JOIN main.condition AS m "
    "USING (mode, parameters)",
    "INSERT INTO temp.people SELECT DISTINCT s.participant_id, m.participant_id FROM temp.twin JOIN "
    "src.session AS "
    "s ON s.id = twin.src JOIN main.session AS m ON m.id = twin.main",
    // A tombstone of the same erasure is the same person.
    "INSERT OR IGNORE INTO temp.people SELECT s.id, m.id FROM src.participant AS s JOIN main.participant AS m "
    "USING "
    "(number) JOIN src.exclusion AS e ON e.participant_id = s.id AND e.rule = 'forgotten' JOIN main.exclusion "
    "AS f "
    "ON f.participant_id = m.id AND f.rule = 'forgotten' AND f.applied_at = e.applied_at",
    "DELETE FROM main.session WHERE id IN (SELECT main FROM temp.replaced)", NULL};

static const char *const tables[] = {
    "INSERT INTO main.session SELECT s.id + ?1, o.new, p.new, s.seed, s.status, s.started_at, s.ended_at, "
    "s.consent_at,"
    " s.consent_version, s.device, s.driver, s.display, s.refresh_hz, s.width_px, s.height_px, s.fov_deg, "
    "s.settings"
    " FROM src.session AS s JOIN temp.protocols AS o ON o.old = s.protocol_id JOIN temp.people AS p ON p.old = "
    "s.participant_id WHERE s.id " TAKEN " ORDER BY s.id",
    "INSERT INTO main.segment SELECT id + ?1, session_id + ?1, started_at, mono_origin_ns, clock, boot_id, "
    "app_version, reason FROM src.segment WHERE session_id " TAKEN " ORDER BY id",
    "INSERT INTO main.trial SELECT id + ?1, session_id + ?1, segment_id + ?1, ordinal, block, kind, scene, "
    "settings,"
    " factors, " CONDITION("option_a") ", " CONDITION(
        "option_b") ", test_slot, first_shown, fixation, seed,"
                    " repeat_of + ?1, status, attempt, started_ns, ended_ns FROM src.trial WHERE "
                    "session_id " TAKEN " ORDER BY id",
    "INSERT INTO main.choice SELECT id + ?1, trial_id + ?1, segment_id + ?1, chosen, correct, reaction_ns, "
    "answered_ns, toggles FROM src.choice WHERE trial_id " TAKEN_TRIALS " ORDER BY id",
    "INSERT INTO main.rating SELECT id + ?1, trial_id + ?1, session_id + ?1, segment_id + ?1, question, "
    "subject, " CONDITION(
        "condition_id") ", value, scale_min, scale_max, answered_ns FROM src.rating WHERE session_id " TAKEN
                        " OR trial_id " TAKEN_TRIALS " ORDER BY id",
    "INSERT INTO main.response SELECT id + ?1, trial_id + ?1, segment_id + ?1, question, value, expected, "
    "answered_ns,"
    " device FROM src.response WHERE trial_id " TAKEN_TRIALS " ORDER BY id",
    "INSERT INTO main.adjust_step SELECT id + ?1, trial_id + ?1, segment_id + ?1, at_ns, parameter, value FROM "
    "src.adjust_step WHERE trial_id " TAKEN_TRIALS " ORDER BY id",
    "INSERT INTO main.staircase_step SELECT id + ?1, trial_id + ?1, level, outcome, reversal, estimate FROM "
    "src.staircase_step WHERE trial_id " TAKEN_TRIALS " ORDER BY id",
    "INSERT INTO main.exposure SELECT id + ?1, trial_id + ?1, segment_id + ?1, attempt, option, start_ns, "
    "end_ns,"
    " full_start_ns, full_end_ns FROM src.exposure WHERE trial_id " TAKEN_TRIALS " ORDER BY id",
    "INSERT INTO main.gaze SELECT id + ?1, session_id + ?1, segment_id + ?1, trial_id + ?1, device_ns, "
    "host_ns, eye,"
    " x_deg, y_deg, pupil_mm, valid, confidence FROM src.gaze WHERE session_id " TAKEN " ORDER BY id",
    "INSERT INTO main.gaze_check SELECT id + ?1, session_id + ?1, segment_id + ?1, at_ns, block, x_deg, y_deg, "
    "eye,"
    " accuracy_deg, rms_s2s_deg, sd_deg, loss, passed FROM src.gaze_check WHERE session_id " TAKEN
    " ORDER BY id",
    "INSERT INTO main.frame SELECT id + ?1, session_id + ?1, segment_id + ?1, trial_id + ?1, attempt, number, "
    "option, " CONDITION(
        "condition_id") ", phase, fade_level, start_ns, cpu_us, gpu_us, present_ns, present_estimated, late,"
                        " gaze_id + ?1, gaze_age_us, fovea, fovea_source, effective, target_x_deg, "
                        "target_y_deg, head_pose, shaded_px,"
                        " triangles, target_m FROM temp.src_frame WHERE session_id " TAKEN " ORDER BY id",
    "INSERT INTO main.event SELECT id + ?1, session_id + ?1, segment_id + ?1, trial_id + ?1, at_ns, kind, "
    "detail "
    "FROM src.event WHERE session_id " TAKEN " ORDER BY id",
    "INSERT INTO main.exclusion SELECT id + ?1, trial_id + ?1, session_id + ?1, NULL, rule, rule_set, reason, "
    "\"by\","
    " applied_at FROM src.exclusion WHERE session_id " TAKEN " OR trial_id " TAKEN_TRIALS " ORDER BY id",
    "INSERT INTO main.exclusion SELECT e.id + ?1, NULL, NULL, p.new, e.rule, e.rule_set, e.reason, e.\"by\", "
    "e.applied_at FROM src.exclusion AS e JOIN temp.people AS p ON p.old = e.participant_id WHERE NOT EXISTS "
    "(SELECT 1 FROM main.exclusion AS f WHERE f.participant_id = p.new AND f.rule = e.rule AND f.rule_set = "
    "e.rule_set AND f.reason = e.reason AND f.applied_at = e.applied_at) ORDER BY e.id",
    "INSERT OR IGNORE INTO main.measured_error SELECT " CONDITION("condition_id") ", " CONDITION(
        "reference_id") ", scene, metric, value FROM src.measured_error",
    NULL};

static bool refuse_code(struct merging *m, sqlite3_stmt *row)
{
    return merge_fail(
        m,
        "%s: participant %s is also in another file, without a session in common; if they are two "
        "people, tell the files apart with --lab NAME=FILE",
        m->input->path, sqlite3_column_text(row, 0));
}

static bool add_people(struct merging *m)
{
    // The code as the output will have it; a tombstone's is made of its id, as forget.c does.
    static const char named[] =
        "CREATE TEMP TABLE newcomer AS SELECT p.id AS old, p.id + ?1 AS new, CASE WHEN EXISTS (SELECT 1 FROM "
        "src.exclusion AS e WHERE e.participant_id = p.id AND e.rule = 'forgotten') THEN 'forgotten-' || (p.id "
        "+ ?1) "
        "ELSE coalesce((SELECT name FROM temp.lab) || '-', '') || p.code END AS code FROM src.participant AS p "
        "WHERE "
        "p.id NOT IN (SELECT old FROM temp.people)";
    static const char clash[] =
        "SELECT code FROM temp.newcomer WHERE code IN (SELECT code FROM main.participant)";
    bool ok = merge_run(m, "DROP TABLE IF EXISTS temp.newcomer") && merge_run(m, named) &&
              merge_none(m, clash, refuse_code);
    return ok &&
           merge_run(m,
                     "INSERT INTO main.participant SELECT n.new, p.number, n.code, p.kind, p.attributes FROM "
                     "temp.newcomer AS n JOIN src.participant AS p ON p.id = n.old ORDER BY n.new") &&
           merge_run(m, "INSERT INTO temp.people SELECT old, new FROM temp.newcomer");
}

static bool say_errors(struct merging *m)
{
    static const char sql[] =
        "SELECT count(*) FROM src.measured_error AS s JOIN main.measured_error AS m ON m.condition_id "
        "= " CONDITION("s.condition_id") " AND m.reference_id = " CONDITION(
            "s.reference_id") " AND m.scene = s.scene AND m.metric = s.metric AND m.value <> s.value";
    sqlite3_stmt *statement = NULL;
    bool ok = sqlite3_prepare_v2(m->db, sql, -1, &statement, NULL) == SQLITE_OK &&
              sqlite3_step(statement) == SQLITE_ROW;
    int64_t count = ok ? sqlite3_column_int64(statement, 0) : 0;
    sqlite3_finalize(statement);
    if (count)
        merge_say(m, "%s: %lld measured image errors differ from an earlier file's, which were kept",
                  m->input->path, (long long)count);
    return ok || merge_fail_sqlite(m);
}

// What an older version lacks is NULL.
static bool view_frames(struct merging *m)
{
    char *sql = sqlite3_mprintf("CREATE TEMP VIEW src_frame AS SELECT %s FROM src.frame",
                                migrate_frame_columns(m->version));
    bool ok = sql ? merge_run(m, sql) : merge_fail(m, "not enough memory");
    sqlite3_free(sql);
    return ok;
}

bool merge_copy(struct merging *m)
{
    bool ok = view_frames(m);
    for (size_t i = 0; ok && maps[i]; i++)
        ok = merge_run(m, maps[i]);
    ok = ok && merge_attributes(m) && add_people(m) && say_errors(m);
    for (size_t i = 0; ok && tables[i]; i++)
        ok = merge_run(m, tables[i]);
    return ok && merge_run(m, "DROP VIEW temp.src_frame");
}
