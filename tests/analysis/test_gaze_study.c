// fovstats gaze on studies whose answers are known: by plain sums over what was written, not by our code.
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
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#define FOVSTATS BUILD_DIR "/bin/fovstats"
#define MAKER BUILD_DIR "/tests/gaze_study"
#define FILE_PATH "gaze_study_test.db"

static struct program_result fovstats(const char *first, const char *second, const char *third)
{
    const char *argv[] = {FOVSTATS, "gaze", FILE_PATH, first, second, third, NULL};
    return program_run(argv, NULL);
}

static void make(const char *people, const char *trials, const char *frame_hz)
{
    const char *argv[] = {MAKER, FILE_PATH, people, trials, "8", "250", frame_hz, NULL};
    struct program_result made = program_run(argv, NULL);
    assert_int_equal(made.code, 0);
    program_free(&made);
}

// The number after the n-th `"key":` of a text; NaN for null.
static double json_value(const char *text, const char *key, int n)
{
    char quoted[64];
    snprintf(quoted, sizeof quoted, "\"%s\":", key);
    for (int i = 0; text && i < n; i++)
        text = strstr(text, quoted) ? strstr(text, quoted) + strlen(quoted) : NULL;
    if (!text)
        fail_msg("no %s", key);
    return strncmp(text, "null", 4) == 0 ? (double)NAN : strtod(text, NULL);
}

static void close_to(double value, double expected, double within)
{
    if (!(fabs(value - expected) <= within))
        fail_msg("%.9g is not within %g of %g", value, within, expected);
}

// Two people, four trials of 8 s at 250 Hz; 5 % not valid; a cross half a degree right of the eyes in trials 1
// and 3.
static void known_study(void **state)
{
    (void)state;
    make("2", "4", "90");
    struct program_result r = fovstats("--simulated", "--json", NULL);
    assert_int_equal(r.code, 0);
    assert_int_equal(json_value(r.out, "samples", 1), 8000);
    assert_int_equal(json_value(r.out, "samples_not_valid", 1), 400);
    close_to(json_value(r.out, "samples_missing", 1), 0, 0);
    close_to(json_value(r.out, "rate_hz", 1), 250, 1e-6);
    // the target is that of the last frame on the display, which a saccade has left; at rest it is half a
    // degree away
    close_to(json_value(r.out, "distance_median_deg", 1), 0.5, 0.03);
    // noise is uniform, 0.05 wide, in each direction: SD 0.05 / sqrt(12), a step's RMS sqrt(2) times that
    close_to(json_value(r.out, "horizontal", 1), 0.05 / sqrt(6), 0.002);
    // 2 ms as written for the age, and 11 ms from the frame's start to its light, to 0.1 ms
    close_to(json_value(r.out, "median", 1), 2, 0.11);
    close_to(json_value(strstr(r.out, "to_light_ms"), "median", 1), 13, 0.11);
    // 8 s at 90 Hz, four trials; all of them estimated, as written
    close_to(json_value(r.out, "light_estimated", 1), 4 * 720, 8);
    program_free(&r);
    // people alone are analysed otherwise
    r = fovstats("--json", NULL, NULL);
    assert_int_equal(r.code, 1);
    assert_non_null(strstr(r.err, "simulated"));
    program_free(&r);
}

// Samples taken out are missing, by their number: within a trial, at its ends, and all of a trial.
static void missing_samples(void **state)
{
    (void)state;
    make("1", "4", "0");
    study_file_sql(FILE_PATH, "DELETE FROM gaze WHERE trial_id = 1 AND id BETWEEN 500 AND 519;"
                              "DELETE FROM gaze WHERE trial_id = 2 AND id < 2000 + 101;"
                              "DELETE FROM gaze WHERE trial_id = 3 AND id > 6000 - 50;"
                              "DELETE FROM gaze WHERE trial_id = 4;");
    struct program_result r = fovstats("--simulated", "--json", NULL);
    assert_int_equal(r.code, 0);
    assert_int_equal(json_value(r.out, "samples", 1), 6000 - 20 - 100 - 50);
    close_to(json_value(r.out, "samples_missing", 1), 20 + 100 + 50 + 2000, 4); // one at a trial's end
    program_free(&r);
    study_file_sql(FILE_PATH, "DELETE FROM gaze");
    r = fovstats("--simulated", NULL, NULL);
    assert_int_equal(r.code, 1);
    assert_non_null(strstr(r.err, "no gaze sample was recorded"));
    program_free(&r);
}

// One person, sittings at 250 Hz and at 62.5 Hz (every fourth sample is left): 10 of 8000 samples are missing
// in the first and 3 of 2000 in the second; at the first's rate three quarters of the second would be.
static void missing_samples_of_two_rates(void **state)
{
    (void)state;
    make("2", "4", "0");
    study_file_sql(FILE_PATH, "UPDATE session SET participant_id = 1; DELETE FROM participant WHERE id = 2;"
                              "DELETE FROM gaze WHERE session_id = 2 AND id % 4 <> 3;"
                              "DELETE FROM gaze WHERE session_id = 1 AND id BETWEEN 500 AND 509;"
                              "DELETE FROM gaze WHERE session_id = 2 AND id BETWEEN 11000 AND 11011;");
    struct program_result r = fovstats("--simulated", "--json", NULL);
    assert_int_equal(r.code, 0);
    const char *people = strstr(r.out, "\"people\":"), *sessions = strstr(r.out, "\"by_session\":");
    assert_true(people && sessions);
    assert_int_equal(json_value(people, "samples", 1), 8000 - 10 + 2000 - 3);
    close_to(json_value(people, "samples_missing", 1), 10 + 3, 0);
    close_to(json_value(sessions, "rate_hz", 1), 250, 1e-6);
    close_to(json_value(sessions, "samples_missing", 1), 10, 0);
    close_to(json_value(sessions, "rate_hz", 2), 62.5, 1e-6);
    close_to(json_value(sessions, "samples_missing", 2), 3, 0);
    program_free(&r);
}

// The file's clock goes back, stands still, and holds what no tracker sends; an attempt is begun anew.
static void hostile_file(void **state)
{
    (void)state;
    make("1", "4", "90");
    study_file_sql(
        FILE_PATH,
        "UPDATE gaze SET device_ns = 5 WHERE id BETWEEN 100 AND 200;"
        "UPDATE gaze SET device_ns = 9223372036854775807 WHERE id = 300;"
        "UPDATE gaze SET device_ns = -9223372036854775807 WHERE id = 301;"
        "UPDATE gaze SET x_deg = 9e999, y_deg = -9e999 WHERE id = 400;"
        "UPDATE gaze SET x_deg = NULL WHERE id = 410;"
        "UPDATE gaze SET eye = 'left' WHERE id BETWEEN 600 AND 700;"
        "UPDATE gaze SET trial_id = NULL WHERE id BETWEEN 800 AND 900;"
        "UPDATE frame SET target_x_deg = 9e999 WHERE id = 40;"
        "INSERT INTO segment VALUES (9, 1, '2026-01-01T10:00:00Z', 0, 'simulated', NULL, 'test', 'resume');"
        "UPDATE trial SET segment_id = 9, started_ns = NULL, ended_ns = NULL WHERE id = 2;"
        "INSERT INTO gaze_check VALUES (NULL, 1, 1, 0, 'main', 5, 5, 'both', 0.7, 0.1, 0.2, 0.01, 0);"
        "INSERT INTO exclusion VALUES (NULL, 3, NULL, NULL, 'gaze_loss', 'planned', 'too much was lost',"
        " 'test', '2026-01-01T10:00:00Z');");
    const char *const methods[] = {"ivt", "idt"};
    for (int i = 0; i < 2; i++) {
        const char *argv[] = {FOVSTATS, "gaze", FILE_PATH, "--simulated", "--method", methods[i], NULL};
        struct program_result r = program_run(argv, NULL);
        assert_int_equal(r.code, 0);
        assert_null(strstr(r.out, "nan"));
        assert_null(strstr(r.out, "inf"));
        assert_non_null(strstr(r.out, "of interrupted attempts: 2000."));
        assert_non_null(strstr(r.out, "samples between trials: 101;"));
        assert_non_null(
            strstr(r.out, "Limit exceeded, S001, trial 3, gaze_loss (planned): too much was lost."));
        assert_non_null(strstr(r.out, "Independent checks"));
        program_free(&r);
    }
    const char *report[] = {FOVSTATS, "report", FILE_PATH, "--simulated", "-o", "gaze_study_test.html", NULL};
    struct program_result r = program_run(report, NULL);
    assert_int_equal(r.code, 0);
    program_free(&r);
    unlink("gaze_study_test.html");
}

static void events_are_listed(void **state)
{
    (void)state;
    make("1", "2", "0");
    struct program_result table = fovstats("--simulated", "--json", NULL);
    struct program_result r = fovstats("--simulated", "--events", NULL);
    int fixations = 0, saccades = 0;
    assert_int_equal(r.code, 0);
    for (const char *at = r.out; (at = strstr(at, ",fixation,")); at++)
        fixations++;
    for (const char *at = r.out; (at = strstr(at, ",saccade,")); at++)
        saccades++;
    assert_true(fixations > 20 && saccades > 20);
    assert_int_equal(json_value(table.out, "count", 1), fixations);
    assert_int_equal(json_value(table.out, "count", 2), saccades);
    program_free(&r);
    program_free(&table);
    r = fovstats("--simulated", "--events", "--json");
    assert_int_equal(r.code, 0);
    assert_non_null(strstr(r.out, "\"kind\":\"saccade\""));
    program_free(&r);
}

static void wrong_usage(void **state)
{
    static const char *const wrong[][2] = {
        {"--velocity", "0"}, {"--velocity", "fast"}, {"--window-ms", "-1"}, {"--method", "magic"},
        {"--region", "10"},  {"--region", "0,5"},    {"--bcea", "1"},       {"--conf", "1"},
        {"--gap-ms", "0"},   {"--dispersion", "-3"}, {"--rate", "nan"},     {"--unknown", "1"}};
    (void)state;
    make("1", "1", "0");
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        struct program_result r = fovstats("--simulated", wrong[i][0], wrong[i][1]);
        assert_int_equal(r.code, 2);
        assert_true(strlen(r.err) > 20 && strchr(r.err, '\n') == r.err + strlen(r.err) - 1);
        program_free(&r);
    }
    struct program_result r = fovstats("--help", NULL, NULL);
    assert_int_equal(r.code, 0);
    program_free(&r);
    FILE *file = fopen(FILE_PATH, "r+");
    assert_non_null(file);
    fseek(file, 200000, SEEK_SET); // within the rows
    for (int i = 0; i < 20000; i++)
        fputc(0xa5, file);
    fclose(file);
    r = fovstats("--simulated", NULL, NULL);
    assert_int_equal(r.code, 1);
    assert_non_null(strstr(r.err, "damaged"));
    program_free(&r);
}

static double seconds_of(void)
{
    struct timespec from, to;
    clock_gettime(CLOCK_MONOTONIC, &from);
    struct program_result r = fovstats("--simulated", NULL, NULL);
    clock_gettime(CLOCK_MONOTONIC, &to);
    assert_int_equal(r.code, 0);
    program_free(&r);
    return (double)(to.tv_sec - from.tv_sec) + (double)(to.tv_nsec - from.tv_nsec) / 1e9;
}

// Ten times the rows take at most thirty times as long: loose, since the machine may be busy; squares would be
// 100.
static void cost_is_linear(void **state)
{
    (void)state;
    make("2", "10", "0");
    double small = fmin(seconds_of(), seconds_of());
    make("20", "10", "0");
    double large = fmin(seconds_of(), seconds_of());
    print_message("40,000 rows: %.3f s, 400,000 rows: %.3f s\n", small, large);
    assert_true(large < 30 * small);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(known_study),
        cmocka_unit_test(missing_samples),
        cmocka_unit_test(missing_samples_of_two_rates),
        cmocka_unit_test(hostile_file),
        cmocka_unit_test(events_are_listed),
        cmocka_unit_test(wrong_usage),
        cmocka_unit_test(cost_is_linear),
    };
    int code = cmocka_run_group_tests(tests, NULL, NULL);
    unlink(FILE_PATH);
    return code;
}
