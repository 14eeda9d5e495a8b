// Studies in which fovstats gaze must tell one eye from the other, a resting target from a moving one, a lost
// tracker from a short one, and a slow tracker from a fast one. Expectations are what was written.
#include "program.h"
#include "study_file.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#define FOVSTATS BUILD_DIR "/bin/fovstats"
#define MAKER BUILD_DIR "/tests/gaze_study"

static void make(const char *trials, const char *seconds, const char *gaze_hz, const char *frame_hz)
{
    const char *argv[] = {MAKER, "s.db", "1", trials, seconds, gaze_hz, frame_hz, NULL};
    struct program_result made = program_run(argv, NULL);
    assert_int_equal(made.code, 0);
    program_free(&made);
}

static struct program_result gaze(const char *option)
{
    const char *argv[] = {FOVSTATS, "gaze", "s.db", "--simulated", option, NULL};
    struct program_result r = program_run(argv, NULL);
    if (r.code != 0)
        fail_msg("exit %d: %s", r.code, r.err);
    return r;
}

static void close_to(double value, double expected, double within)
{
    if (!(fabs(value - expected) <= within))
        fail_msg("%.9g is not within %g of %g", value, within, expected);
}

// The number after the first "key": that follows the first `after`; NaN for null.
static double value_after(const char *json, const char *after, const char *key)
{
    char quoted[64];
    snprintf(quoted, sizeof quoted, "\"%s\":", key);
    const char *at = json ? strstr(json, after) : NULL;
    at = at ? strstr(at + strlen(after), quoted) : NULL;
    if (!at)
        fail_msg("no %s after %s in %s", key, after, json);
    at += strlen(quoted);
    return strncmp(at, "null", 4) == 0 ? (double)NAN : strtod(at, NULL);
}

// The number of the first person's (or session's) first record.
static double number(const struct program_result *r, const char *key)
{
    return value_after(r->out, "\"people\":", key);
}

static void says(const char *option, const char *part)
{
    struct program_result r = gaze(option);
    if (!strstr(r.out, part))
        fail_msg("does not say \"%s\":\n%s", part, r.out);
    program_free(&r);
}

// --- one eye ---

// Both eyes exactly on a cross that stands a metre away straight ahead, 63 mm between them: each looks
// atan(0.0315) degrees inwards.
static void look_at_a_near_cross(const char *target_m)
{
    char sql[640];
    make("1", "8", "250", "90");
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
    struct program_result r = gaze("--json");
    const char *right = strstr(r.out, "\"eye\":\"right\"");
    assert_non_null(right);
    close_to(number(&r, "accuracy_deg"), 0, 1e-9);
    close_to(value_after(right, "", "accuracy_deg"), 0, 1e-9);
    close_to(value_after(right, "", "distance_mean_deg"), 0, 1e-9);
    close_to(value_after(right, "", "offset_x_deg"), 0, 1e-9);
    close_to(number(&r, "target_distance_not_known"), 0, 0);
    program_free(&r);
    // twice as far away each eye's direction is half as far inwards: the eyes are 0.902 degrees off
    study_file_sql("s.db", "UPDATE frame SET target_m = 2");
    r = gaze("--json");
    close_to(number(&r, "accuracy_deg"), 1.804199 - 0.902322, 1e-5);
    close_to(number(&r, "offset_x_deg"), 1.804199 - 0.902322, 1e-5);
    program_free(&r);
}

// A file of an older version does not tell how far away the target was; one direction for both eyes needs not
// know.
static void without_depth_an_eye_has_no_accuracy(void **state)
{
    (void)state;
    look_at_a_near_cross("NULL");
    struct program_result r = gaze("--json");
    assert_true(isnan(number(&r, "accuracy_deg")) && isnan(number(&r, "offset_x_deg")) &&
                isnan(number(&r, "distance_mean_deg")));
    assert_true(number(&r, "target_distance_not_known") > 950);
    program_free(&r);
    says("--simulated", "does not tell how far away it was: 1");
    look_at_a_near_cross("1");
    study_file_sql("s.db", "UPDATE session SET settings = '{\"gaze\":\"sim\"}'");
    r = gaze("--json");
    assert_true(isnan(number(&r, "accuracy_deg")));
    program_free(&r);
    study_file_sql("s.db", "UPDATE gaze SET eye = 'both', x_deg = 0.25; UPDATE frame SET target_m = NULL");
    r = gaze("--json");
    close_to(number(&r, "accuracy_deg"), 0.25, 1e-9);
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
    make("2", "8", "250", "90");
    study_file_sql("s.db", "UPDATE frame SET target_m = NULL; UPDATE gaze SET eye = 'left' WHERE id < 3000");
    struct program_result now = gaze("--json");
    make_older();
    struct program_result then = gaze("--json");
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
    struct program_result r = run("merge", "m.db");
    assert_int_equal(r.code, 1);
    assert_non_null(
        strstr(r.err, "s.db: is of an older version (1, now 2); open it once with fovstudy resume"));
    program_free(&r);
}

// --- which samples count ---

// Half the samples 0.2 degrees off, half 15 degrees, outside of Weier's region: accuracy is 7.6, distance 0.2.
static void accuracy_has_no_region(void **state)
{
    (void)state;
    make("1", "8", "250", "90");
    study_file_sql("s.db", "UPDATE gaze SET valid = 1, y_deg = 0, x_deg = iif(id <= 1000, 0.2, 15);"
                           "UPDATE frame SET target_x_deg = 0, target_y_deg = 0;"
                           "DELETE FROM gaze WHERE id < 11 OR id > 1990;"); // the frames' light is 11 ms late
    struct program_result r = gaze("--json");
    close_to(number(&r, "accuracy_deg"), 7.6, 1e-9);
    close_to(number(&r, "offset_x_deg"), 7.6, 1e-9);
    close_to(number(&r, "distance_mean_deg"), 0.2, 1e-9);
    close_to(number(&r, "outside_region"), 990, 0);
    program_free(&r);
}

// Following a target at 2 deg/s is no lack of precision.
static void pursuit_has_no_precision(void **state)
{
    (void)state;
    make("2", "8", "250", "90");
    study_file_sql("s.db",
                   "UPDATE gaze SET valid = 1, y_deg = 0.05 * (id % 2), x_deg = 0.05 * (id / 2 % 2) +"
                   " iif(trial_id = 1, 2 * id / 250.0, 0); UPDATE trial SET fixation = 'moving' WHERE id "
                   "= 1;");
    struct program_result r = gaze("--json");
    close_to(value_after(strstr(r.out, "\"people\":"), "\"sd_deg\":", "horizontal"), 0.025, 1e-4);
    program_free(&r);
    study_file_sql("s.db", "UPDATE trial SET fixation = 'moving'");
    r = gaze("--json");
    assert_true(isnan(value_after(strstr(r.out, "\"people\":"), "\"sd_deg\":", "horizontal")));
    assert_true(isnan(number(&r, "bcea_deg2")));
    assert_true(value_after(strstr(r.out, "\"fixations\":"), "", "count") >= 2);
    program_free(&r);
}

// --- sittings ---

// A second sitting of the same person: all that is of trial `trial` moves there.
static void move_to_second_session(int trial)
{
    char sql[900];
    snprintf(
        sql, sizeof sql,
        "INSERT INTO session SELECT 2, protocol_id, participant_id, seed, status, '2026-01-02T10:00:00Z',"
        " ended_at, NULL, NULL, device, driver, display, refresh_hz, width_px, height_px, fov_deg, settings"
        " FROM session WHERE id = 1;"
        "INSERT INTO segment VALUES (2, 2, '2026-01-02T10:00:00Z', 0, 'simulated', NULL, 'test', 'start');"
        "UPDATE trial SET session_id = 2, segment_id = 2 WHERE id = %d;"
        "UPDATE choice SET segment_id = 2 WHERE trial_id = %d;"
        "UPDATE exposure SET segment_id = 2 WHERE trial_id = %d;"
        "UPDATE gaze SET session_id = 2, segment_id = 2 WHERE trial_id = %d;",
        trial, trial, trial, trial);
    study_file_sql("s.db", sql);
}

// The tracker was dead, or sent samples between trials only, throughout one of two sittings of a trial each.
static void dead_sittings_are_missing(void **state)
{
    static const char *const deaths[] = {"DELETE FROM gaze WHERE session_id = 2",
                                         "UPDATE gaze SET trial_id = NULL WHERE session_id = 2"};
    (void)state;
    for (size_t i = 0; i < 2; i++) {
        make("2", "8", "250", "0");
        move_to_second_session(2);
        study_file_sql("s.db", deaths[i]);
        struct program_result r = gaze("--json");
        close_to(number(&r, "samples"), 2000, 0);
        close_to(number(&r, "samples_missing"), 2000, 1);
        close_to(number(&r, "samples_due"), 4000, 1);
        program_free(&r);
        says("--simulated", "Session 2 had a tracker and no sample in any trial: all its samples are missing.");
    }
}

// Sittings of two rates are not of one rate, and each one's missing samples are counted at its own: every
// fourth sample of the second trial is left.
static void two_rates_are_not_one(void **state)
{
    (void)state;
    make("2", "8", "250", "0");
    move_to_second_session(2);
    study_file_sql("s.db", "DELETE FROM gaze WHERE trial_id = 2 AND id % 4");
    struct program_result r = gaze("--json");
    assert_true(isnan(number(&r, "rate_hz")));
    close_to(number(&r, "slowest_hz"), 62.5, 1e-6);
    close_to(number(&r, "fastest_hz"), 250, 1e-6);
    close_to(number(&r, "samples_missing"), 0, 1);
    program_free(&r);
    says("--simulated", "62.5 to 250.0");
}

static void lost_frames_are_told(void **state)
{
    (void)state;
    make("1", "8", "250", "90");
    study_file_sql("s.db", "UPDATE frame SET fovea_source = 'lost', gaze_age_us = NULL WHERE id > 101");
    struct program_result r = gaze("--json");
    close_to(value_after(r.out, "\"frames\":[", "gaze_lost"), 619, 0);
    close_to(value_after(r.out, "\"frames\":[", "frames"), 101, 0);
    program_free(&r);
    says("--simulated", "Stimulus frames that should follow the gaze and had none: 619 of 720.");
}

// --- saccades of Vmax 600 and c 6 at several rates ---

static void a_main_sequence_needs_its_rate(void **state)
{
    static const struct {
        const char *hz, *seconds;
        bool vmax, c;
        const char *remark;
    } rates[] = {{"60", "40", false, false, "Vmax, c, k, b not estimable: at 60 Hz a peak is taken over 33 ms"},
                 {"120", "40", true, false, "  c, k, b not estimable: at 120 Hz a peak is taken over 17 ms"},
                 {"250", "40", true, true, "here over 8.0 ms, at 250 Hz"},
                 {"1000", "20", true, true, "here over 8.0 ms, at 1000 Hz"}};
    (void)state;
    for (size_t i = 0; i < sizeof rates / sizeof rates[0]; i++) {
        make("12", rates[i].seconds, rates[i].hz, "0");
        struct program_result r = gaze("--json");
        double vmax = value_after(r.out, "\"vmax_deg_s\":", "value"),
               c = value_after(r.out, "\"c_deg\":", "value");
        double b = value_after(r.out, "\"power_b\":", "value");
        double peak = value_after(strstr(r.out, "\"peak_deg_s\":"), "", "mean");
        assert_true(isnan(vmax) == !rates[i].vmax && isnan(peak) == !rates[i].vmax);
        assert_true(isnan(c) == !rates[i].c && isnan(b) == !rates[i].c);
        assert_true(!rates[i].vmax || fabs(vmax / 600 - 1) < 0.1);
        assert_true(!rates[i].c || fabs(c / 6 - 1) < 0.16);
        assert_true(!strstr(r.out, "power_not_estimable") == rates[i].c);
        program_free(&r);
        says("--simulated", rates[i].remark);
    }
    // the window can be too long as well
    const char *argv[] = {FOVSTATS, "gaze", "s.db", "--simulated", "--peak-ms", "40", NULL};
    struct program_result r = program_run(argv, NULL);
    assert_int_equal(r.code, 0);
    assert_non_null(strstr(r.out, "not estimable: at 1000 Hz a peak is taken over 40 ms"));
    program_free(&r);
}

static void the_page_says_it(void **state)
{
    (void)state;
    make("6", "20", "60", "90");
    const char *argv[] = {FOVSTATS, "report", "s.db", "--simulated", "-o", "s.html", NULL};
    struct program_result r = program_run(argv, NULL);
    assert_int_equal(r.code, 0);
    program_free(&r);
    static char page[1 << 20];
    FILE *file = fopen("s.html", "r");
    assert_non_null(file);
    page[fread(page, 1, sizeof page - 1, file)] = '\0';
    fclose(file);
    const char *frames = strstr(page, "<h2>Frame times</h2>"), *eyes = strstr(page, "<h2>Gaze</h2>");
    assert_true(frames && eyes);
    assert_non_null(strstr(frames, "The data hash does not cover the rows of frames."));
    assert_non_null(strstr(eyes, "The data hash does not cover the rows of gaze and frames."));
    assert_non_null(strstr(eyes, "not estimable: at 60 Hz a peak is taken over 33 ms"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_eye_sees_a_near_target_inwards),
        cmocka_unit_test(without_depth_an_eye_has_no_accuracy),
        cmocka_unit_test(an_older_file_is_read),
        cmocka_unit_test(accuracy_has_no_region),
        cmocka_unit_test(pursuit_has_no_precision),
        cmocka_unit_test(dead_sittings_are_missing),
        cmocka_unit_test(two_rates_are_not_one),
        cmocka_unit_test(lost_frames_are_told),
        cmocka_unit_test(a_main_sequence_needs_its_rate),
        cmocka_unit_test(the_page_says_it),
    };
    return cmocka_run_group_tests(tests, program_enter_folder, program_leave_folder);
}
