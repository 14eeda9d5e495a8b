#include "studies/store/statements.h"

// People excluded as a whole free their number; those out by a stricter rule only are part of the analysis.
#define HELD                                                                                                   \
    "WITH held (number) AS (SELECT number FROM participant AS p "                                              \
    "WHERE NOT EXISTS (SELECT 1 FROM exclusion AS e WHERE e.participant_id = p.id AND e.rule_set <> "          \
    "'stricter')) "

const char *const sql_statements[SQL_STATEMENTS] = {
    [SQL_BEGIN] = "BEGIN IMMEDIATE",
    [SQL_COMMIT] = "COMMIT",
    [SQL_ROLLBACK] = "ROLLBACK",

    [SQL_OTHER_SEED] =
        "SELECT s.seed FROM session s JOIN protocol p ON p.id = s.protocol_id WHERE s.seed <> ?1 AND "
        "p.name = ?2 LIMIT 1",
    [SQL_FIND_PROTOCOL] = "SELECT id FROM protocol WHERE sha256 = ?1",
    [SQL_INSERT_PROTOCOL] = "INSERT INTO protocol (name, sha256, text) VALUES (?1, ?2, ?3)",
    [SQL_FIND_PARTICIPANT] = "SELECT id, number, kind = ?2, "
                             "EXISTS (SELECT 1 FROM session WHERE participant_id = participant.id) "
                             "FROM participant WHERE code = ?1",
    [SQL_NUMBER_TAKEN] = HELD "SELECT 1 FROM held WHERE number = ?1",
    [SQL_FIRST_FREE_NUMBER] = HELD "SELECT min(n) FROM (SELECT 1 AS n UNION ALL SELECT number + 1 FROM held) "
                                   "WHERE n NOT IN (SELECT number FROM held)",
    [SQL_INSERT_PARTICIPANT] =
        "INSERT INTO participant (number, code, kind, attributes) VALUES (?1, ?2, ?3, ?4)",
    [SQL_INSERT_SESSION] =
        "INSERT INTO session (protocol_id, participant_id, seed, status, started_at, consent_at, "
        "consent_version, device, driver, display, refresh_hz, width_px, height_px, fov_deg, "
        "settings) "
        "VALUES (?1, ?2, ?3, 'running', ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14)",
    [SQL_INSERT_SEGMENT] = "INSERT INTO segment (session_id, started_at, mono_origin_ns, clock, boot_id, "
                           "app_version, reason) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7)",
    [SQL_FIND_CONDITION] = "SELECT id FROM condition WHERE mode = ?1 AND parameters = ?2",
    [SQL_INSERT_CONDITION] = "INSERT INTO condition (mode, parameters) VALUES (?1, ?2)",
    [SQL_INSERT_TRIAL] =
        "INSERT INTO trial (session_id, ordinal, block, kind, scene, settings, factors, option_a, "
        "option_b, test_slot, first_shown, fixation, seed, repeat_of, status) "
        "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, 'planned')",
    [SQL_SET_CONSENT] = "UPDATE session SET consent_at = ?2, consent_version = ?3 WHERE id = ?1",
    [SQL_END_SESSION] = "UPDATE session SET status = ?2, ended_at = ?3 WHERE id = ?1 AND status = 'running'",
    [SQL_SKIP_RUNNING] =
        "UPDATE trial SET status = 'skipped', ended_ns = ?2 WHERE session_id = ?1 AND status = "
        "'running'",
    [SQL_COUNT_SESSIONS] =
        "SELECT count(*), max(CASE s.status WHEN 'running' THEN s.id ELSE 0 END) "
        "FROM session AS s JOIN participant AS p ON p.id = s.participant_id WHERE p.code = ?1",

    [SQL_REPEAT_TRIAL] =
        "INSERT INTO trial (session_id, ordinal, block, kind, scene, settings, factors, option_a, option_b, "
        "test_slot, first_shown, fixation, seed, repeat_of, status) "
        "SELECT session_id, ?2, block, kind, scene, settings, factors, option_a, option_b, test_slot, "
        "first_shown, "
        "fixation, seed, id, 'planned' FROM trial WHERE id = ?1",
    [SQL_SET_TRIAL_OPTION] = "UPDATE trial SET option_a = CASE ?2 WHEN 'a' THEN ?3 ELSE option_a END, "
                             "option_b = CASE ?2 WHEN 'b' THEN ?3 ELSE option_b END WHERE id = ?1",
    [SQL_START_TRIAL] = "UPDATE trial SET status = 'running', attempt = attempt + 1, segment_id = ?2, "
                        "started_ns = ?3, ended_ns = NULL WHERE id = ?1 AND status IN ('planned', 'running')",
    [SQL_GET_ATTEMPT] = "SELECT attempt FROM trial WHERE id = ?1",
    [SQL_END_TRIAL] = "UPDATE trial SET status = ?2, ended_ns = ?3 WHERE id = ?1",
    [SQL_INSERT_CHOICE] =
        "INSERT INTO choice (trial_id, segment_id, chosen, correct, reaction_ns, answered_ns, "
        "toggles) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7)",
    [SQL_INSERT_RATING] =
        "INSERT INTO rating (trial_id, session_id, segment_id, question, subject, condition_id, "
        "value, scale_min, scale_max, answered_ns) "
        "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10)",
    [SQL_INSERT_RESPONSE] =
        "INSERT INTO response (trial_id, segment_id, question, value, expected, answered_ns, "
        "device) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7)",
    [SQL_INSERT_STAIRCASE_STEP] = "INSERT INTO staircase_step (trial_id, level, outcome, reversal, estimate) "
                                  "VALUES (?1, ?2, ?3, ?4, ?5)",
    [SQL_INSERT_GAZE_CHECK] =
        "INSERT INTO gaze_check (session_id, segment_id, at_ns, block, x_deg, y_deg, eye, "
        "accuracy_deg, rms_s2s_deg, sd_deg, loss, passed) "
        "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12)",
    [SQL_INSERT_EXCLUSION] =
        "INSERT INTO exclusion (trial_id, session_id, participant_id, rule, rule_set, reason, "
        "\"by\", applied_at) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)",
    [SQL_INSERT_NEW_EXCLUSION] =
        "INSERT INTO exclusion (trial_id, session_id, participant_id, rule, rule_set, reason, "
        "\"by\", applied_at) SELECT ?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8 WHERE NOT EXISTS "
        "(SELECT 1 FROM exclusion WHERE rule = ?4 AND rule_set IN (?5, 'planned') AND "
        "(trial_id = ?1 OR session_id = ?2 OR participant_id = ?3))",
    [SQL_SET_MEASURED_ERROR] = "INSERT INTO measured_error (condition_id, reference_id, scene, metric, value) "
                               "VALUES (?1, ?2, ?3, ?4, ?5) "
                               "ON CONFLICT (condition_id, reference_id, scene, metric) "
                               "DO UPDATE SET value = excluded.value",

    [SQL_LAST_GAZE] = "SELECT coalesce(max(id), 0) FROM gaze",
    [SQL_INSERT_GAZE] =
        "INSERT INTO gaze (id, session_id, segment_id, trial_id, device_ns, host_ns, eye, x_deg, "
        "y_deg, pupil_mm, valid, confidence) "
        "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12)",
    [SQL_INSERT_FRAME] =
        "INSERT INTO frame (session_id, segment_id, trial_id, attempt, number, option, "
        "condition_id, phase, fade_level, start_ns, cpu_us, gpu_us, present_ns, "
        "present_estimated, late, gaze_id, gaze_age_us, fovea, fovea_source, effective, "
        "target_x_deg, target_y_deg, head_pose, shaded_px, triangles, target_m) "
        "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15, ?16, ?17, ?18, "
        "?19, ?20, ?21, ?22, ?23, ?24, ?25, ?26)",
    [SQL_INSERT_EXPOSURE] = "INSERT INTO exposure (trial_id, segment_id, attempt, option, start_ns, end_ns, "
                            "full_start_ns, full_end_ns) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)",
    [SQL_INSERT_EVENT] = "INSERT INTO event (session_id, segment_id, trial_id, at_ns, kind, detail) "
                         "VALUES (?1, ?2, ?3, ?4, ?5, ?6)",
    [SQL_INSERT_ADJUST_STEP] = "INSERT INTO adjust_step (trial_id, segment_id, at_ns, parameter, value) "
                               "VALUES (?1, ?2, ?3, ?4, ?5)",
    [SQL_INSERT_OVERFLOW] = "INSERT INTO event (session_id, segment_id, at_ns, kind, detail) "
                            "SELECT session_id, id, ?2, 'log_overflow', json_object('gaze', ?3, 'frame', ?4, "
                            "'exposure', ?5, 'event', ?6, 'adjust_step', ?7) FROM segment WHERE id = ?1",
    [SQL_INSERT_REFUSED] = "INSERT INTO event (session_id, segment_id, at_ns, kind, detail) "
                           "SELECT session_id, id, ?2, 'log_refused', json_object('table', ?3, 'why', ?4) "
                           "FROM segment WHERE id = ?1",
};
