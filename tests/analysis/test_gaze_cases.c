// Studies in which fovstats gaze must tell a resting target from a moving one, a lost tracker from a short one,
// and a slow tracker from a fast one. Expectations are what was written.
#include "gaze_said.h"
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

#include <cmocka.h>

#define FOVSTATS BUILD_DIR "/bin/fovstats"

// --- which samples count ---

// Half the samples 0.2 degrees off, half 15 degrees, outside of Weier's region: accuracy is 7.6, distance 0.2.
static void accuracy_has_no_region(void **state)
{
    (void)state;
    gaze_said_make("1", "8", "250", "90");
    study_file_sql("s.db", "UPDATE gaze SET valid = 1, y_deg = 0, x_deg = iif(id <= 1000, 0.2, 15);"
                           "UPDATE frame SET target_x_deg = 0, target_y_deg = 0, gaze_id = NULL;"
                           "DELETE FROM gaze WHERE id < 11 OR id > 1990;"); // the frames' light is 11 ms late
    struct program_result r = gaze_said("--json");
    gaze_said_close(gaze_said_number(&r, "accuracy_deg"), 7.6, 1e-9);
    gaze_said_close(gaze_said_number(&r, "offset_x_deg"), 7.6, 1e-9);
    gaze_said_close(gaze_said_number(&r, "distance_mean_deg"), 0.2, 1e-9);
    gaze_said_close(gaze_said_number(&r, "outside_region"), 990, 0);
    program_free(&r);
}

// Following a target at 2 deg/s is no lack of precision.
static void pursuit_has_no_precision(void **state)
{
    (void)state;
    gaze_said_make("2", "8", "250", "90");
    study_file_sql("s.db",
                   "UPDATE gaze SET valid = 1, y_deg = 0.05 * (id % 2), x_deg = 0.05 * (id / 2 % 2) +"
                   " iif(trial_id = 1, 2 * id / 250.0, 0); UPDATE trial SET fixation = 'moving' WHERE id "
                   "= 1;");
    struct program_result r = gaze_said("--json");
    gaze_said_close(gaze_said_after(strstr(r.out, "\"people\":"), "\"sd_deg\":", "horizontal"), 0.025, 1e-4);
    program_free(&r);
    study_file_sql("s.db", "UPDATE trial SET fixation = 'moving'");
    r = gaze_said("--json");
    assert_true(isnan(gaze_said_after(strstr(r.out, "\"people\":"), "\"sd_deg\":", "horizontal")));
    assert_true(isnan(gaze_said_number(&r, "bcea_deg2")));
    assert_true(gaze_said_after(strstr(r.out, "\"fixations\":"), "", "count") >= 2);
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
        gaze_said_make("2", "8", "250", "0");
        move_to_second_session(2);
        study_file_sql("s.db", deaths[i]);
        struct program_result r = gaze_said("--json");
        gaze_said_close(gaze_said_number(&r, "samples"), 2000, 0);
        gaze_said_close(gaze_said_number(&r, "samples_missing"), 2000, 1);
        gaze_said_close(gaze_said_number(&r, "samples_due"), 4000, 1);
        program_free(&r);
        gaze_said_part("--simulated",
                       "Session 2 had a tracker and no sample in any trial: all its samples are missing.");
    }
}

// Sittings of two rates are not of one rate, and each one's missing samples are counted at its own: every
// fourth sample of the second trial is left.
static void two_rates_are_not_one(void **state)
{
    (void)state;
    gaze_said_make("2", "8", "250", "0");
    move_to_second_session(2);
    study_file_sql("s.db", "DELETE FROM gaze WHERE trial_id = 2 AND id % 4");
    struct program_result r = gaze_said("--json");
    assert_true(isnan(gaze_said_number(&r, "rate_hz")));
    gaze_said_close(gaze_said_number(&r, "slowest_hz"), 62.5, 1e-6);
    gaze_said_close(gaze_said_number(&r, "fastest_hz"), 250, 1e-6);
    gaze_said_close(gaze_said_number(&r, "samples_missing"), 0, 1);
    program_free(&r);
    gaze_said_part("--simulated", "62.5 to 250.0");
}

static void lost_frames_are_told(void **state)
{
    (void)state;
    gaze_said_make("1", "8", "250", "90");
    study_file_sql("s.db", "UPDATE frame SET fovea_source = 'lost', gaze_age_us = NULL WHERE id > 101");
    struct program_result r = gaze_said("--json");
    gaze_said_close(gaze_said_after(r.out, "\"frames\":[", "gaze_lost"), 619, 0);
    gaze_said_close(gaze_said_after(r.out, "\"frames\":[", "frames"), 101, 0);
    program_free(&r);
    gaze_said_part("--simulated", "Stimulus frames that should follow the gaze and had none: 619 of 720.");
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
        gaze_said_make("12", rates[i].seconds, rates[i].hz, "0");
        struct program_result r = gaze_said("--json");
        double vmax = gaze_said_after(r.out, "\"vmax_deg_s\":", "value"),
               c = gaze_said_after(r.out, "\"c_deg\":", "value");
        double b = gaze_said_after(r.out, "\"power_b\":", "value");
        double peak = gaze_said_after(strstr(r.out, "\"peak_deg_s\":"), "", "mean");
        assert_true(isnan(vmax) == !rates[i].vmax && isnan(peak) == !rates[i].vmax);
        assert_true(isnan(c) == !rates[i].c && isnan(b) == !rates[i].c);
        assert_true(!rates[i].vmax || fabs(vmax / 600 - 1) < 0.1);
        assert_true(!rates[i].c || fabs(c / 6 - 1) < 0.16);
        assert_true(!strstr(r.out, "power_not_estimable") == rates[i].c);
        program_free(&r);
        gaze_said_part("--simulated", rates[i].remark);
    }
    // the window can be too long as well
    const char *argv[] = {FOVSTATS, "gaze", "s.db", "--simulated", "--peak-ms", "40", NULL};
    struct program_result r = program_run(argv, NULL);
    assert_int_equal(r.code, 0);
    assert_non_null(strstr(r.out, "not estimable: at 1000 Hz a peak is taken over 40 ms"));
    program_free(&r);
}

// Samples lost one by one at random, of Vmax 600 and c 6. A peak is known where of the fastest sample and the
// two before and after it none is lost: in (1 - loss)^5 of the saccades.
static void lost_samples_bend_no_curve(void **state)
{
    static const struct {
        const char *hz;
        double loss;
        bool c;
    } cases[] = {{"250", 0.1, true}, {"250", 0.3, true}, {"250", 0.5, true}, {"120", 0.4, false}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char sql[160];
        gaze_said_make("12", "80", cases[i].hz, "0");
        snprintf(
            sql, sizeof sql,
            "DELETE FROM gaze WHERE sin(id * 12.9898) * 43758.5453 - floor(sin(id * 12.9898) * 43758.5453) "
            "< %g",
            cases[i].loss);
        study_file_sql("s.db", sql);
        struct program_result r = gaze_said("--json");
        double vmax = gaze_said_after(r.out, "\"vmax_deg_s\":", "value"),
               c = gaze_said_after(r.out, "\"c_deg\":", "value");
        double kept = gaze_said_after(r.out, "\"main_sequence\":", "saccades") /
                      gaze_said_after(r.out, "\"main_sequence\":", "saccades_complete");
        if (!(fabs(vmax / 600 - 1) < 0.1) || !(cases[i].c ? fabs(c / 6 - 1) < 0.16 : isnan(c)))
            fail_msg("%s Hz, loss %g: Vmax %g, c %g", cases[i].hz, cases[i].loss, vmax, c);
        gaze_said_close(kept, pow(1 - cases[i].loss, 5), 0.06);
        program_free(&r);
    }
    gaze_said_make("2", "20", "250", "0");
    study_file_sql("s.db", "DELETE FROM gaze WHERE id % 3 = 0"); // one of any five
    gaze_said_part("--simulated", "k, b not estimable: samples are missing at the peaks of all but 0 of ");
}

// No peak at a rate that does not tell it, in the list as in the tables.
static void the_list_has_no_peak_either(void **state)
{
    static const struct {
        const char *hz;
        bool known;
    } rates[] = {{"90", false}, {"120", true}};
    (void)state;
    for (size_t i = 0; i < 2; i++) {
        gaze_said_make("1", "20", rates[i].hz, "0");
        struct program_result r = gaze_said("--events");
        const char *saccade = strstr(r.out, ",saccade,");
        assert_non_null(saccade);
        for (int field = 0; field < 7; field++) {
            saccade = strchr(saccade, ',');
            assert_non_null(saccade++);
        }
        assert_true((*saccade != ',') == rates[i].known);
        program_free(&r);
    }
    gaze_said_make("2", "20", "90", "0");
    gaze_said_part("--simulated", "at 90 Hz a peak is taken over 22 ms");
    struct program_result r = gaze_said("--json");
    assert_true(gaze_said_after(r.out, "\"main_sequence\":", "saccades") == 0);
    assert_true(gaze_said_after(r.out, "\"main_sequence\":", "saccades_complete") > 50);
    program_free(&r);
}

static void the_page_says_it(void **state)
{
    (void)state;
    gaze_said_make("6", "20", "60", "90");
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
        cmocka_unit_test(accuracy_has_no_region),     cmocka_unit_test(pursuit_has_no_precision),
        cmocka_unit_test(dead_sittings_are_missing),  cmocka_unit_test(two_rates_are_not_one),
        cmocka_unit_test(lost_frames_are_told),       cmocka_unit_test(a_main_sequence_needs_its_rate),
        cmocka_unit_test(lost_samples_bend_no_curve), cmocka_unit_test(the_list_has_no_peak_either),
        cmocka_unit_test(the_page_says_it),
    };
    return cmocka_run_group_tests(tests, program_enter_folder, program_leave_folder);
}
