// The checks of effects.h through fovstats, against R (tests/reference/effects.R); and signflip_values.h by its
// laws.
#include "analysis/stats/signflip.h"
#include "analysis/stats/signflip_values.h"
#include "program.h"
#include "reference.h"
#include "said.h"
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

static const char fovstats[] = BUILD_DIR "/bin/fovstats";

enum { ANSWER_FIELDS = 11 };

// One choice of effects_answers.csv as a trial of session p, or of p + 100 for the person's second sitting.
static void add_answer(char **fields, char *sql, size_t size)
{
    long p = strtol(fields[1], NULL, 10), i = strtol(fields[2], NULL, 10), id = 1000 * p + 100 + i;
    long session = fields[10][0] == '2' ? p + 100 : p;
    bool test_a = fields[3][0] == 'a';
    size_t used = strlen(sql);
    snprintf(
        sql + used, size - used,
        "INSERT INTO trial VALUES(%ld, %ld, %ld, %ld, 'main', 'toggle', 'atrium', '{}', '{}', %d, %d, '%s', "
        "'%s', NULL, 1, NULL, 'done', 1, 0, 1);"
        "INSERT INTO choice VALUES(NULL, %ld, %ld, '%s', NULL, 1, 5, %s);"
        "INSERT INTO exposure VALUES(NULL, %ld, %ld, 1, '%c', 0, 9000000000, 0, %s000000);"
        "INSERT INTO exposure VALUES(NULL, %ld, %ld, 1, '%s', 9000000000, 18000000000, 9000000000, 9000000000 "
        "+ %s000000);",
        id, session, session, i + 100, test_a ? 2 : 1, test_a ? 1 : 2, fields[3], fields[4], id, session,
        fields[6], fields[7], id, session, fields[5][0] == 'a' ? 'b' : 'a',
        fields[5][0] == 'a' ? fields[9] : fields[8], id, session, fields[5],
        fields[5][0] == 'a' ? fields[8] : fields[9]);
}

// A session like the first person's.
static void add_session(char *sql, size_t size, int session, int person)
{
    size_t used = strlen(sql);
    snprintf(
        sql + used, size - used,
        "INSERT INTO session SELECT %d, protocol_id, %d, seed, status, started_at, ended_at, consent_at, "
        "consent_version, device, driver, display, refresh_hz, width_px, height_px, fov_deg, settings FROM "
        "session WHERE id = 1;INSERT INTO segment SELECT %d, %d, started_at, 0, clock, NULL, app_version, "
        "reason FROM segment WHERE id = 1;",
        session, person, session, session);
}

static void make_study(const char *study)
{
    char line[256], *fields[ANSWER_FIELDS];
    static char sql[1 << 20];
    FILE *file = reference_open("effects_answers.csv");
    study_file_make("e.db", &(struct study_desc){.bare = true});
    strcpy(sql, "BEGIN;");
    for (int p = 23; p <= 64; p++) { // study_file.h has 22 people
        snprintf(sql + strlen(sql), sizeof sql - strlen(sql),
                 "INSERT INTO participant VALUES(%d, %d, 'P%d', 'person', '{}');", p, p, p);
        add_session(sql, sizeof sql, p, p);
    }
    for (int p = 1; p <= 9; p++)
        add_session(sql, sizeof sql, p + 100, p);
    assert_non_null(fgets(line, sizeof line, file));
    while (fgets(line, sizeof line, file)) {
        char *rest = line;
        line[strcspn(line, "\n")] = '\0';
        for (int i = 0; i < ANSWER_FIELDS; i++)
            fields[i] = reference_field(&rest, ',');
        if (strcmp(fields[0], study) == 0)
            add_answer(fields, sql, sizeof sql);
    }
    fclose(file);
    strcat(sql, "COMMIT;");
    study_file_sql("e.db", sql);
}

static char *choices(void)
{
    const char *argv[] = {fovstats, "choices", "e.db", "--json", NULL};
    struct program_result r = program_run(argv, NULL);
    if (r.code != 0)
        fail_msg("%s", r.err);
    free(r.err);
    return r.out;
}

static void check_close(const char *study, const char *check, const char *key, double seen, double expected)
{
    bool same = isnan(expected) ? isnan(seen) : fabs(seen - expected) <= 1e-9 * fmax(1, fabs(expected));
    if (!same)
        fail_msg("%s, %s, %s: %.17g but R says %.17g", study, check, key, seen, expected);
}

static void checks_agree_with_r(void **state)
{
    (void)state;
    char line[512], last[64] = "", *fields[9], *json = NULL;
    FILE *file = reference_open("effects.csv");
    int compared = 0;
    assert_non_null(fgets(line, sizeof line, file));
    while (fgets(line, sizeof line, file)) {
        char *rest = line, quoted[64];
        line[strcspn(line, "\n")] = '\0';
        for (int i = 0; i < 9; i++)
            fields[i] = reference_field(&rest, ',');
        if (strcmp(last, fields[0]) != 0) {
            snprintf(last, sizeof last, "%s", fields[0]);
            make_study(last);
            free(json);
            json = choices();
        }
        snprintf(quoted, sizeof quoted, "\"check\":\"%s\"", fields[1]);
        const char *object = strstr(json, quoted);
        assert_non_null(object);
        bool switches = strcmp(fields[1], "toggles") == 0, half = strstr("side first last", fields[1]) != NULL;
        double scale = switches ? 1 : 100, offset = half ? 50 : 0;
        check_close(last, fields[1], "people", said_after(object, "", "people"), reference_number(fields[2]));
        check_close(last, fields[1], "estimate", said_after(object, "", "estimate"),
                    offset + scale * reference_number(fields[3]));
        check_close(last, fields[1], "low", said_after(object, "", "ci_low"),
                    offset + scale * reference_number(fields[4]));
        check_close(last, fields[1], "high", said_after(object, "", "ci_high"),
                    offset + scale * reference_number(fields[5]));
        check_close(last, fields[1], "d", said_after(object, "", "d"), reference_number(fields[6]));
        // 47 people and more are beyond the reference's list of all signs, not beyond ours
        check_close(last, fields[1], "p", said_after(object, "", "p_value"), reference_number(fields[7]));
        check_close(last, fields[1], "holm", said_after(object, "", "p_holm"), reference_number(fields[8]));
        compared++;
    }
    assert_int_equal(compared, 9 * 7);
    fclose(file);
    free(json);
}

static void what_cannot_be_estimated_is_said(void **state)
{
    (void)state;
    make_study("one side");
    const char *text[] = {fovstats, "choices", "e.db", NULL};
    struct program_result r = program_run(text, NULL);
    assert_int_equal(r.code, 0);
    if (!strstr(r.out,
                "Not estimable: slot a chosen (nobody had the test option in both slots, evenly enough)"))
        fail_msg("%s", r.out);
    program_free(&r);
    make_study("one person");
    const char *page[] = {fovstats, "report", "e.db", "-o", "e.html", NULL};
    r = program_run(page, NULL);
    assert_int_equal(r.code, 0);
    program_free(&r);
    const char *grep[] = {"/bin/grep", "-c", "one person only", "e.html", NULL};
    r = program_run(grep, NULL);
    assert_int_equal(strtol(r.out, NULL, 10), 7);
    program_free(&r);
}

// Values that are counts less one half of n: the convolution of signflip.h, which is another way, says the
// same.
static void halves_meet_the_convolution(void **state)
{
    (void)state;
    struct stat_person people[STAT_FLIP_VALUES];
    double values[STAT_FLIP_VALUES + 1];
    for (size_t n = 1; n <= STAT_FLIP_VALUES; n++)
        for (int k = 0; k < 3; k++) {
            for (size_t i = 0; i < n; i++) {
                people[i] = (struct stat_person){(int64_t)((i * 7 + (size_t)k * 5) % 10), 9};
                values[i] = (double)people[i].k - 4.5;
            }
            double seen = stat_signflip_values(values, n).p_value,
                   expected = stat_signflip(people, n, STAT_TWO_SIDED).p_value;
            if (!reference_close(seen, expected, 1e-12))
                fail_msg("n %zu: %.17g and %.17g", n, seen, expected);
        }
    assert_true(isnan(stat_signflip_values(values, 0).p_value));
    assert_true(isnan(stat_signflip_values(values, STAT_FLIP_VALUES + 1).p_value));
    assert_true(isnan(stat_signflip_values((const double[]){1, (double)NAN}, 2).p_value));
    assert_true(stat_signflip_values((const double[]){0, 0}, 2).p_value == 1);
    // Ties that rounding parts: 0.1 + 0.2 - 0.3 is not 0 in doubles; all sums but two of eight reach it.
    assert_true(stat_signflip_values((const double[]){0.1, 0.2, -0.3}, 3).p_value == 1);
}

// Frames of the test option against the reference's, by trial and person. Person 2's first trial was begun
// anew: what was drawn before is no part of the trial.
static void make_frames(void)
{
    char line[128], *fields[5];
    static char sql[1 << 18];
    int number = 0;
    FILE *file = reference_open("frames_pairs_times.csv");
    study_file_make("f.db", &(struct study_desc){.bare = true});
    strcpy(sql, "BEGIN;DELETE FROM frame;");
    assert_non_null(fgets(line, sizeof line, file));
    while (fgets(line, sizeof line, file)) {
        char *rest = line;
        line[strcspn(line, "\n")] = '\0';
        for (int i = 0; i < 5; i++)
            fields[i] = reference_field(&rest, ',');
        long p = strtol(fields[0], NULL, 10), trial = strtol(fields[1], NULL, 10), id = 1000 * p + trial;
        snprintf(
            sql + strlen(sql), sizeof sql - strlen(sql),
            "INSERT OR IGNORE INTO trial VALUES(%ld, %ld, %ld, %ld, 'main', 'toggle', 'atrium', '{}', '{}', 2, "
            "1, "
            "'a', 'a', NULL, 1, NULL, 'done', 1, 0, 1);"
            "INSERT INTO frame (session_id, segment_id, trial_id, attempt, number, option, condition_id, "
            "phase, "
            "fade_level, start_ns, cpu_us, gpu_us, present_estimated, late) VALUES(%ld, %ld, %ld, 1, %d, 'a', "
            "%d, 'stimulus', 0, %d, 1, %s, 1, %s);",
            id, p, p, trial + 60, p, p, id, number, fields[2][0] == 't' ? 2 : 1, number * 11000000, fields[3],
            fields[4][0] == 'N' ? "NULL" : fields[4]);
        number++;
    }
    fclose(file);
    strcat(sql,
           "UPDATE trial SET attempt = 2 WHERE id = 2001; UPDATE frame SET attempt = 2 WHERE trial_id = 2001;"
           "INSERT INTO frame (id, session_id, segment_id, trial_id, attempt, number, option, condition_id, "
           "phase, fade_level, start_ns, cpu_us, gpu_us, present_estimated, late) SELECT -id, session_id, "
           "segment_id, trial_id, 1, number - 1000, option, condition_id, phase, fade_level, start_ns - "
           "60000000000, cpu_us, 40000 * condition_id, 1, condition_id = 1 FROM frame WHERE trial_id = 2001;"
           "COMMIT;");
    study_file_sql("f.db", sql);
}

static void frames_of_both_options_agree_with_r(void **state)
{
    (void)state;
    static const char *const keys[] = {"\"difference_ms\":", "\"ratio\":", "\"late_share\":"};
    char line[256], *fields[5];
    make_frames();
    const char *argv[] = {fovstats, "frames", "f.db", "--json", NULL};
    struct program_result r = program_run(argv, NULL);
    assert_int_equal(r.code, 0);
    const char *pairs = strstr(r.out, "\"pairs\":");
    FILE *file = reference_open("frames_pairs.csv");
    assert_non_null(pairs);
    assert_true(said_after(pairs, "", "people") == 5 && said_after(pairs, "", "trials") == 11);
    assert_non_null(fgets(line, sizeof line, file));
    for (int i = 0; i < 3; i++) {
        char *rest = line;
        assert_non_null(fgets(line, sizeof line, file));
        line[strcspn(line, "\n")] = '\0';
        for (int k = 0; k < 5; k++)
            fields[k] = reference_field(&rest, ',');
        const char *object = strstr(pairs, keys[i]);
        const char *const names[] = {"estimate", "ci_low", "ci_high"};
        assert_non_null(object);
        assert_true(said_after(object, "", "people") == reference_number(fields[1]));
        for (int k = 0; k < 3; k++) {
            double expected = reference_number(fields[k + 2]);
            check_close("frames", fields[0], names[k], said_after(object, "", names[k]),
                        i == 1 ? exp(expected) : expected);
        }
    }
    fclose(file);
    program_free(&r);
}

// Percentages are of the frames whose display told its rate; nothing is called on time that nobody knows.
static void late_frames_are_of_those_known(void **state)
{
    (void)state;
    static const struct {
        const char *sql, *text;
    } cases[] = {
        {"UPDATE frame SET late = CASE WHEN id % 2 THEN NULL ELSE 1 END", " 100.00 "},
        {"UPDATE frame SET late = NULL", "Late: 0 of 0 frames"},
    };
    make_frames();
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        study_file_sql("f.db", cases[i].sql);
        const char *argv[] = {fovstats, "frames", "f.db", NULL};
        struct program_result r = program_run(argv, NULL);
        assert_int_equal(r.code, 0);
        if (!strstr(r.out, cases[i].text) || strstr(r.out, " 0.00 "))
            fail_msg("%s", r.out);
        program_free(&r);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(checks_agree_with_r),
        cmocka_unit_test(what_cannot_be_estimated_is_said),
        cmocka_unit_test(halves_meet_the_convolution),
        cmocka_unit_test(frames_of_both_options_agree_with_r),
        cmocka_unit_test(late_frames_are_of_those_known),
    };
    return cmocka_run_group_tests_name("effects", tests, program_enter_folder, program_leave_folder);
}
