// One eye sees a near target elsewhere than the middle between the eyes does; files that do not tell how far
// away it was. Expectations are what was written.
#include "gaze_said.h"
#include "study_file.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define FOVSTATS BUILD_DIR "/bin/fovstats"

// Both eyes exactly on a cross that stands a metre away straight ahead, 63 mm between them: each looks
// atan(0.0315) degrees inwards.
static void look_at_a_near_cross(const char *target_m)
{
    char sql[640];
    gaze_said_make("1", "8", "250", "90");
    snprintf(sql, sizeof sql,
             "UPDATE gaze SET eye = iif(id %% 2, 'left', 'right'), valid = 1, y_deg = 0,"
             " x_deg = iif(id %% 2, 1, -1) * degrees(atan(0.0315));"
             "UPDATE frame SET target_x_deg = 0, target_y_deg = 0, target_m = %s;",
             target_m);
    study_file_sql("s.db", sql);
}

static void an_eye_sees_a_near_target_inwards(void **state)
{
    (void)state;
    look_at_a_near_cross("1");
    struct program_result r = gaze_said("--json");
    const char *right = strstr(r.out, "\"eye\":\"right\"");
    assert_non_null(right);
    gaze_said_close(gaze_said_number(&r, "accuracy_deg"), 0, 1e-9);
    gaze_said_close(gaze_said_after(right, "", "accuracy_deg"), 0, 1e-9);
    gaze_said_close(gaze_said_after(right, "", "distance_mean_deg"), 0, 1e-9);
    gaze_said_close(gaze_said_after(right, "", "offset_x_deg"), 0, 1e-9);
    gaze_said_close(gaze_said_number(&r, "target_distance_not_known"), 0, 0);
    program_free(&r);
    // twice as far away each eye's direction is half as far inwards: the eyes are 0.902 degrees off
    study_file_sql("s.db", "UPDATE frame SET target_m = 2");
    r = gaze_said("--json");
    gaze_said_close(gaze_said_number(&r, "accuracy_deg"), 1.804199 - 0.902322, 1e-5);
    gaze_said_close(gaze_said_number(&r, "offset_x_deg"), 1.804199 - 0.902322, 1e-5);
    program_free(&r);
}

// A file of an older version does not tell how far away the target was; one direction for both eyes needs not
// know.
static void without_depth_an_eye_has_no_accuracy(void **state)
{
    (void)state;
    look_at_a_near_cross("NULL");
    struct program_result r = gaze_said("--json");
    assert_true(isnan(gaze_said_number(&r, "accuracy_deg")) && isnan(gaze_said_number(&r, "offset_x_deg")) &&
                isnan(gaze_said_number(&r, "distance_mean_deg")));
    assert_true(gaze_said_number(&r, "target_distance_not_known") > 950);
    program_free(&r);
    gaze_said_part("--simulated", "does not tell how far away it was: 1");
    look_at_a_near_cross("1");
    study_file_sql("s.db", "UPDATE session SET settings = '{\"gaze\":\"sim\"}'");
    r = gaze_said("--json");
    assert_true(isnan(gaze_said_number(&r, "accuracy_deg")));
    program_free(&r);
    study_file_sql("s.db", "UPDATE gaze SET eye = 'both', x_deg = 0.25; UPDATE frame SET target_m = NULL");
    r = gaze_said("--json");
    gaze_said_close(gaze_said_number(&r, "accuracy_deg"), 0.25, 1e-9);
    program_free(&r);
}

static struct program_result run(const char *command, const char *out)
{
    const char *argv[] = {FOVSTATS, command, "s.db", "--simulated", out ? "-o" : NULL, out, NULL};
    if (strcmp(command, "merge") == 0)
        argv[3] = "-o", argv[4] = out, argv[5] = NULL;
    return program_run(argv, NULL);
}

// The same rows in a file made by the schema of version 1.
static void make_older(void)
{
    static char schema[1 << 16];
    FILE *file = fopen(SOURCE_DIR "/tests/studies/store/schema_1.sql", "r");
    assert_non_null(file);
    schema[fread(schema, 1, sizeof schema - 1, file)] = '\0';
    fclose(file);
    assert_int_equal(rename("s.db", "now.db"), 0);
    study_file_sql("s.db", schema);
    study_file_sql(
        "s.db",
        "PRAGMA foreign_keys = OFF; ATTACH 'now.db' AS now; INSERT INTO protocol SELECT * FROM now.protocol;"
        "INSERT INTO participant SELECT * FROM now.participant; INSERT INTO session SELECT * FROM "
        "now.session; INSERT INTO segment SELECT * FROM now.segment; INSERT INTO condition SELECT * FROM "
        "now.condition; INSERT INTO trial SELECT * FROM now.trial; INSERT INTO choice SELECT * FROM "
        "now.choice; INSERT INTO exposure SELECT * FROM now.exposure; INSERT INTO gaze SELECT * FROM "
        "now.gaze; INSERT INTO frame SELECT id, session_id, segment_id, trial_id, attempt, number, option,"
        " condition_id, phase, fade_level, start_ns, cpu_us, gpu_us, present_ns, present_estimated, late,"
        " gaze_id, gaze_age_us, fovea, fovea_source, effective, target_x_deg, target_y_deg, head_pose,"
        " shaded_px, triangles FROM now.frame");
}

// A file of version 1 is read as it is, as if its frames had no distance; only what writes wants it anew.
static void an_older_file_is_read(void **state)
{
    (void)state;
    gaze_said_make("2", "8", "250", "90");
    study_file_sql("s.db", "UPDATE frame SET target_m = NULL; UPDATE gaze SET eye = 'left' WHERE id < 3000");
    struct program_result now = gaze_said("--json");
    make_older();
    struct program_result then = gaze_said("--json");
    assert_string_equal(now.out, then.out);
    program_free(&now);
    program_free(&then);
    static const char *const reading[][2] = {{"frames", NULL}, {"report", "s.html"}, {"export", "exported"}};
    for (size_t i = 0; i < sizeof reading / sizeof reading[0]; i++) {
        struct program_result r = run(reading[i][0], reading[i][1]);
        if (r.code != 0)
            fail_msg("%s: exit %d: %s", reading[i][0], r.code, r.err);
        program_free(&r);
    }
}

// Joined with a copy of ours, it is the same session; its frames without a distance are all there.
static void an_older_file_is_joined(void **state)
{
    (void)state;
    gaze_said_make("2", "8", "250", "90");
    study_file_sql("s.db", "UPDATE frame SET target_m = NULL");
    struct program_result now = gaze_said("--json");
    make_older();
    const char *merge[] = {FOVSTATS, "merge", "s.db", "now.db", "-o", "joined.db", NULL};
    struct program_result r = program_run(merge, NULL);
    if (r.code != 0)
        fail_msg("exit %d: %s", r.code, r.err);
    assert_non_null(strstr(r.out, "2 files, 1 participant, 1 session; 1 was in several files"));
    program_free(&r);
    assert_int_equal(rename("joined.db", "s.db"), 0);
    struct program_result joined = gaze_said("--json");
    assert_string_equal(now.out, joined.out);
    program_free(&now);
    program_free(&joined);
}

// 8 s of 90 Hz twice: a seventh of the frames is of a condition that is not there.
static void a_damaged_older_file_is_refused(void **state)
{
    (void)state;
    gaze_said_make("2", "8", "250", "90");
    make_older();
    study_file_sql("s.db", "UPDATE frame SET condition_id = 999 WHERE id % 7 = 0");
    static const char *const of[][2] = {{"export", "refused"}, {"merge", "refused.db"}};
    for (size_t i = 0; i < 2; i++) {
        struct program_result r = run(of[i][0], of[i][1]);
        if (r.code != 1 || !strstr(r.err, "s.db: the study file is damaged (table frame"))
            fail_msg("%s: exit %d: %s", of[i][0], r.code, r.err);
        program_free(&r);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_eye_sees_a_near_target_inwards),
        cmocka_unit_test(without_depth_an_eye_has_no_accuracy),
        cmocka_unit_test(an_older_file_is_read),
        cmocka_unit_test(an_older_file_is_joined),
        cmocka_unit_test(a_damaged_older_file_is_refused),
    };
    return cmocka_run_group_tests(tests, program_enter_folder, program_leave_folder);
}
