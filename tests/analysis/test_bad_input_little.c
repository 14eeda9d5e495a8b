// Studies with too little in them, or with what is no number: what can be said is said, what is missing has a
// sentence, and nothing that cannot be estimated has a number.
#include "said.h"
#include "study_file.h"
#include "subcommand.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#define countof(array) (sizeof(array) / sizeof(array)[0])

static void sessions_without_a_trial(void **state)
{
    (void)state;
    study_file_make("bare.db", &(struct study_desc){.bare = true});
    subcommand_expect(
        "bare.db", (const char *const[SUBCOMMANDS]){[CHOICES] = "bare.db: no choice was recorded",
                                                    [RATINGS] = "bare.db: no rating of an option was recorded",
                                                    [ANOVA] = "bare.db: no ratings over factors were recorded",
                                                    [THRESHOLDS] = "bare.db: no staircase, no constant levels",
                                                    [JOD] = "bare.db: no preference between two options",
                                                    [FRAMES] = "bare.db: no frame was recorded",
                                                    [GAZE] = "bare.db: no gaze sample was recorded",
                                                    [EVENTS] = "bare.db: no gaze sample was recorded",
                                                    [PLANNED] = "bare.db: the protocol planned no analysis",
                                                    [POWER] = "bare.db: no choice was recorded"});
}

// Of study_file.h's people the first alone; every row of the others goes.
static void make_one_person(const char *path)
{
    study_file_make(path, &(struct study_desc){0});
    study_file_sql(
        path, "DELETE FROM choice WHERE trial_id NOT IN (SELECT id FROM trial WHERE session_id = 1);"
              "DELETE FROM rating WHERE trial_id NOT IN (SELECT id FROM trial WHERE session_id = 1);"
              "DELETE FROM trial WHERE session_id <> 1; DELETE FROM segment WHERE session_id <> 1;"
              "DELETE FROM session WHERE id <> 1; DELETE FROM participant WHERE id <> 1;"
              "UPDATE session SET settings = json_set(settings, '$.planned', json('[{\"method\":\"binomial\","
              "\"of\":\"choice\",\"per\":\"cell\"}]'))");
}

static void expect_null(const char *json, const char *after, const char *key)
{
    char quoted[64];
    snprintf(quoted, sizeof quoted, "\"%s\":", key);
    const char *at = strstr(json, after);
    at = at ? strstr(at, quoted) : NULL;
    if (!at || strncmp(at + strlen(quoted), "null", 4) != 0)
        fail_msg("%s after %s is not null: %.60s", key, after, at ? at : json);
}

static void one_participant(void **state)
{
    (void)state;
    static const char *const nothing_between_people[] = {"first_sd", "t", "p_value", "ci_low"};
    make_one_person("one.db");
    subcommand_expect(
        "one.db",
        (const char *const[SUBCOMMANDS]){
            [ANOVA] = "one.db: no ratings over factors were recorded", [THRESHOLDS] = "one.db: no staircase"});
    struct program_result r = FOVSTATS("ratings", "one.db", "--json");
    assert_true(said_after(r.out, "second_minus_first", "estimate") == 1); // rated 6, then 7
    for (size_t i = 0; i < countof(nothing_between_people); i++)
        expect_null(r.out, "first_mean", nothing_between_people[i]);
    program_free(&r);
    r = FOVSTATS("frames", "one.db", "--json");
    expect_null(strstr(r.out, "\"pairs\":"), "difference_ms", "ci_low");
    program_free(&r);
}

// Clopper and Pearson's interval of 1 of 1: p^1 = 0.025 at its lower end, no upper one below 1.
static void one_trial(void **state)
{
    (void)state;
    make_one_person("trial.db");
    study_file_sql("trial.db",
                   "DELETE FROM frame; DELETE FROM gaze; DELETE FROM rating; DELETE FROM gaze_check; "
                   "DELETE FROM choice WHERE trial_id <> 11; DELETE FROM trial WHERE id <> 11");
    subcommand_expect("trial.db",
                      (const char *const[SUBCOMMANDS]){[RATINGS] = "trial.db: no rating of an option",
                                                       [ANOVA] = "trial.db: no ratings over factors",
                                                       [THRESHOLDS] = "trial.db: no staircase",
                                                       [FRAMES] = "trial.db: no frame was recorded",
                                                       [GAZE] = "trial.db: no gaze sample was recorded",
                                                       [EVENTS] = "trial.db: no gaze sample was recorded"});
    struct program_result r = FOVSTATS("choices", "trial.db", "--json");
    assert_true(said_after(r.out, "\"cells\"", "k") == 1 && said_after(r.out, "\"cells\"", "n") == 1);
    assert_true(said_after(r.out, "\"cells\"", "p_value") == 1);
    assert_true(fabs(said_after(r.out, "\"cells\"", "ci_low") - 0.025) < 1e-15);
    assert_true(said_after(r.out, "\"cells\"", "ci_high") == 1);
    expect_null(r.out, "\"cells\"", "overdispersion");
    expect_null(r.out, "\"cells\"", "toggles_sd");
    program_free(&r);
}

// 15 sessions of one protocol and 7 of another: the larger part is analysed and the other one is said.
static void two_protocols(void **state)
{
    (void)state;
    study_file_make("two.db", &(struct study_desc){0});
    study_file_sql("two.db", "INSERT INTO protocol VALUES(2, 'other', printf('%064d', 2), 'study: other');"
                             "UPDATE session SET protocol_id = 2 WHERE id > 15");
    subcommand_expect("two.db",
                      (const char *const[SUBCOMMANDS]){[ANOVA] = "two.db: no ratings over factors",
                                                       [THRESHOLDS] = "two.db: no staircase",
                                                       [PLANNED] = "two.db: the protocol planned no analysis"});
    static const enum subcommand tables[] = {CHOICES, RATINGS, JOD, FRAMES, AUDIT, GAZE};
    for (size_t i = 0; i < countof(tables); i++) {
        struct program_result r = subcommand_run(tables[i], "two.db", "--json", NULL);
        assert_true(said_after(r.out, "{", "participants") == 15);
        assert_true(said_after(r.out, "{", "sessions_left_out_protocol") == 7);
        program_free(&r);
        r = subcommand_run(tables[i], "two.db", NULL, NULL);
        assert_non_null(strstr(r.out, "Left out, sessions of another protocol than 'small'"));
        program_free(&r);
        said_sentence(FOVSTATS(subcommand_name(tables[i]), "two.db", "--protocol", "third"), 1, "third");
    }
    struct program_result r = FOVSTATS("choices", "two.db", "--json", "--protocol", "other");
    assert_true(said_after(r.out, "{", "participants") == 7);
    program_free(&r);
}

// A scale that ends at infinity lets an infinite rating in. Without persons 1 and 2 the first group's changes
// (study_file.h) are 1 five times, -1 twice and 0 twice: sum 3, sum of squares 7 - 9 / 9 = 6 about the mean, so
// t = (1 / 3) / sqrt(6 / 8 / 9).
static void infinite_ratings(void **state)
{
    (void)state;
    study_file_make("inf.db", &(struct study_desc){0});
    study_file_sql("inf.db", "UPDATE rating SET value = 9e999, scale_max = 9e999 WHERE trial_id = 13;"
                             "UPDATE rating SET value = -9e999, scale_min = -9e999 WHERE trial_id = 24");
    subcommand_works(RATINGS, "inf.db");
    subcommand_works(REPORT, "inf.db");
    struct program_result r = FOVSTATS("ratings", "inf.db", "--json");
    assert_true(said_after(r.out, "left_out", "not_finite") == 2);
    const char *group = strstr(r.out, "\"first\":\"time_warped");
    assert_non_null(group);
    assert_true(said_after(group, "first", "n") == 9);
    assert_true(fabs(said_after(group, "second_minus_first", "estimate") - 1.0 / 3) < 1e-14);
    assert_true(fabs(said_after(group, "second_minus_first", "t") - 1.0 / 3 / sqrt(6.0 / 8 / 9)) < 1e-13);
    program_free(&r);
    study_file_sql("inf.db", "UPDATE rating SET value = 9e999, scale_max = 9e999");
    subcommand_fails(RATINGS, "inf.db", "inf.db: no rating of an option was recorded that counts");
    subcommand_works(REPORT, "inf.db");
}

// What no program of ours writes is not known.
static void infinite_measurements(void **state)
{
    (void)state;
    study_file_make("inf.db", &(struct study_desc){0});
    study_file_sql(
        "inf.db",
        "UPDATE frame SET gpu_us = 9e999 WHERE id % 5 = 0; UPDATE frame SET cpu_us = -9e999, "
        "gaze_age_us = 9e999; UPDATE session SET refresh_hz = 9e999; UPDATE gaze SET x_deg = "
        "9e999; INSERT INTO gaze_check VALUES(NULL, 1, 1, 0, 'main', 9e999, 5, 'both', 9e999, -9e999, "
        "9e999, 1, 0)");
    static const enum subcommand these[] = {CHOICES, RATINGS, FRAMES, AUDIT, GAZE, REPORT, EXPORT};
    for (size_t i = 0; i < countof(these); i++)
        subcommand_works(these[i], "inf.db");
    struct program_result r = FOVSTATS("frames", "inf.db", "--json");
    assert_true(said_after(r.out, "gpu_ms", "frames") == 80); // of 100, every fifth is not known
    assert_true(said_after(r.out, "cpu_ms", "frames") == 0);
    expect_null(r.out, "cpu_ms", "median");
    program_free(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sessions_without_a_trial),
        cmocka_unit_test(one_participant),
        cmocka_unit_test(one_trial),
        cmocka_unit_test(two_protocols),
        cmocka_unit_test(infinite_ratings),
        cmocka_unit_test(infinite_measurements),
    };
    return cmocka_run_group_tests_name("bad_input_little", tests, program_enter_folder, program_leave_folder);
}
