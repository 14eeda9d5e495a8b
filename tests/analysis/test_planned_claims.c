// What rows of the planned table claim: equality by the adjusted p alone, differences of what from what; and
// the same from the command. Numbers against R (tests/reference/planned.R).
#include "planned_study.h"
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
#include <string.h>

#include <cmocka.h>

static const char fovstats[] = BUILD_DIR "/bin/fovstats";

#define FOVSTATS(...) program_run((const char *const[]){fovstats, __VA_ARGS__, NULL}, NULL)

// 11 of 22 and 9 of 19: equality within 30 to 70 % has p 0.039 in one cell, which two cells do not let pass.
static void equality_is_shown_by_the_adjusted_p_alone(void **state)
{
    (void)state;
    static const struct {
        const char *plan, *of[4];
        enum stat_verdict verdict;
        const char *says;
    } cases[] = {
        {PLAN("binomial", "choice", "cell", ",\"margin\":0.2"),
         {"even 0.2 cell 0.2", "even 0.2 equality 0.2", "even 0.2 cell 0.05", "even 0.2 equality 0.05"},
         STAT_UNDECIDED,
         "neither equality nor a difference is shown"},
        {PLAN("binomial", "choice", "cell", ",\"margin\":0.3"),
         {"even 0.3 cell 0.2", "even 0.3 equality 0.2", "even 0.3 cell 0.05", "even 0.3 equality 0.05"},
         STAT_WITHIN,
         "equality is shown"}};
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    study_file_even("s.db");
    for (size_t i = 0; i < 2; i++) {
        struct planned_study l;
        double worst = 0;
        planned_study_plan(cases[i].plan);
        planned_study_load(&l);
        assert_int_equal(l.planned.row_count, 4);
        for (size_t k = 0; k < 4; k++)
            planned_study_compare(&l.planned.rows[k], cases[i].of[k], &worst);
        assert_true(l.planned.rows[1].p_value <= 0.05); // alone it would always be shown
        for (size_t k = 1; k < 4; k += 2) {
            assert_int_equal(l.planned.rows[k].verdict, cases[i].verdict);
            assert_string_equal(l.planned.rows[k].note, cases[i].says);
            assert_non_null(strstr(l.planned.rows[k].words, ": equality within "));
        }
        planned_study_free(&l);
    }
}

// Where somebody chose several times people are tested, for a difference and for equality.
static void people_are_tested_for_equality_too(void **state)
{
    (void)state;
    static const char *const names[] = {"several cell 0.2", "several equality 0.2", "several cell 0.05",
                                        "several equality 0.05"};
    struct planned_study l;
    double worst = 0;
    study_file_make("s.db", &(struct study_desc){.several = true});
    planned_study_plan(PLAN("binomial", "choice", "cell", ",\"margin\":0.1"));
    planned_study_load(&l);
    assert_int_equal(l.planned.row_count, 4);
    for (size_t i = 0; i < 4; i++)
        planned_study_compare(&l.planned.rows[i], names[i], &worst);
    assert_string_equal(l.planned.rows[1].test, "two one-sided t of the people\u2019s shares");
    planned_study_free(&l);
}

// Without spread there is no t-test; but what everybody chose the same way is not called open.
static void shares_that_are_all_the_same(void **state)
{
    (void)state;
    static const struct {
        const char *chosen, *note; // by the trial's slot of the test option
    } cases[] = {{"iif(test_slot = 'a', 'b', 'a')", "equality is not shown: all people have the same share"},
                 {"test_slot", "equality is not shown: all people have the same share"},
                 {"iif((ordinal % 2 = 0) = (test_slot = 'a'), 'a', 'b')",
                  "equality is not estimable: all people have the same share"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct planned_study l;
        char sql[512];
        study_file_make("s.db", &(struct study_desc){.several = true});
        study_file_sql("s.db", "DELETE FROM choice WHERE trial_id < 1000; DELETE FROM rating; "
                               "DELETE FROM frame; DELETE FROM trial WHERE id < 1000");
        snprintf(sql, sizeof sql, "UPDATE choice SET chosen = (SELECT %s FROM trial WHERE trial.id = trial_id)",
                 cases[i].chosen);
        study_file_sql("s.db", sql);
        planned_study_plan(PLAN("binomial", "choice", "cell", ",\"margin\":0.1"));
        planned_study_load(&l);
        assert_int_equal(l.planned.row_count, 2);
        assert_int_equal(l.planned.rows[1].people, 22);
        assert_true(isnan(l.planned.rows[1].p_value));
        if (strncmp(l.planned.rows[1].note, cases[i].note, strlen(cases[i].note)) != 0)
            fail_msg("case %zu: %s", i, l.planned.rows[1].note);
        planned_study_free(&l);
    }
    study_file_sql("s.db", "DELETE FROM choice WHERE trial_id > 1018; DELETE FROM trial WHERE id > 1018");
    struct planned_study l;
    planned_study_load(&l);
    assert_string_equal(l.planned.rows[1].note, "equality is not estimable: one person alone");
    planned_study_free(&l);
}

// Differences of ratings: second minus first, test minus reference, however the plan joins them.
static void differences_say_what_is_subtracted_from_what(void **state)
{
    (void)state;
    static const struct {
        const char *per, *words;
        double estimate;
    } cases[] = {
        {"study", "How good does it look?, second minus first: time_warped \u03b5 0.2 \u2212 regular",
         -8.0 / 9},
        {"order", "How good does it look?, second minus first: time_warped \u03b5 0.2 \u2212 regular",
         -8.0 / 9},
        {"cell", "How good does it look?, second minus first: regular \u2212 time_warped \u03b5 0.2", 5.0 / 11},
        {"scene",
         "How good does it look?, second minus first: regular \u2212 time_warped \u03b5 0.2: scene town",
         5.0 / 11},
    };
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct planned_study l;
        char text[256];
        bool found = false;
        snprintf(text, sizeof text, "{\"method\":\"paired_t\",\"of\":\"rating\",\"per\":\"%s\"}", cases[i].per);
        planned_study_plan(text);
        planned_study_load(&l);
        assert_int_equal(l.planned.row_count, 2);
        for (size_t k = 0; k < 2; k++)
            if (strcmp(l.planned.rows[k].words, cases[i].words) == 0)
                found = l.planned.rows[k].difference &&
                        fabs(l.planned.rows[k].estimate - cases[i].estimate) < 1e-12;
        if (!found)
            fail_msg("per %s: \"%s\" %g, \"%s\" %g; expected \"%s\" %g", cases[i].per, l.planned.rows[0].words,
                     l.planned.rows[0].estimate, l.planned.rows[1].words, l.planned.rows[1].estimate,
                     cases[i].words, cases[i].estimate);
        planned_study_free(&l);
    }
}

// Both options of each toggle trial rated: the test option 2 above the reference in one cell, 1 in the other.
static void options_of_a_trial_are_named(void **state)
{
    (void)state;
    struct planned_study l;
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    study_file_sql(
        "s.db", "DELETE FROM rating; INSERT INTO rating SELECT NULL, t.id, NULL, t.session_id, 'Clear?', 'a', "
                "t.option_a, iif(t.test_slot = 'a', 7 + t.session_id % 2 - (t.id % 10 = 2), 5), 1, 10, 5 FROM "
                "trial t WHERE kind = 'toggle'; INSERT INTO rating SELECT NULL, t.id, NULL, t.session_id, "
                "'Clear?', 'b', t.option_b, iif(t.test_slot = 'b', 7 + t.session_id % 2 - (t.id % 10 = 2), 5), "
                "1, 10, 6 FROM trial t WHERE kind = 'toggle'");
    planned_study_plan(PLAN("paired_t", "rating", "cell", "") "," PLAN("paired_t", "rating", "study", ""));
    planned_study_load(&l);
    assert_int_equal(l.planned.row_count, 3);
    static const char *const words[] = {
        "Clear?, test option minus reference: \u03b5 0.2: time_warped \u03b5 0.2 \u2212 regular",
        "Clear?, test option minus reference: \u03b5 0.05: time_warped \u03b5 0.05 \u2212 regular",
        "Clear?, test option minus reference"}; // two test options
    for (size_t i = 0; i < 3; i++)
        assert_string_equal(l.planned.rows[i].words, words[i]);
    assert_true(l.planned.rows[0].estimate == 2.5); // 11 people each of 2 and 3
    planned_study_free(&l);
}

static void the_command_says_the_same(void **state)
{
    (void)state;
    static const char equality[] = "\u03b5 0.2: equality within 30 to 70\u00a0%";
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    said_sentence(FOVSTATS("planned", "s.db"), 1, "s.db: the protocol planned no analysis");
    study_file_even("s.db");
    planned_study_plan(PLAN("binomial", "choice", "cell", ",\"margin\":0.2"));
    struct program_result r = FOVSTATS("planned", "s.db", "--json");
    assert_int_equal(r.code, 0);
    assert_true(said_after(r.out, "conf", "tests") == 4);
    static const char *const keys[] = {"estimate", "ci_low", "ci_high", "p_value", "p_holm"};
    double of_r[5];
    planned_study_known("even 0.2 equality 0.2", of_r);
    for (int i = 0; i < 5; i++)
        if (!reference_close(said_after(r.out, equality, keys[i]), of_r[i], 1e-9))
            fail_msg("%s in %s", keys[i], r.out);
    assert_true(said_after(r.out, equality, "equality_margin") == 0.2);
    assert_non_null(strstr(strstr(r.out, equality), "\"verdict\":\"undecided\""));
    program_free(&r);
    planned_study_plan(PLAN("paired_t", "rating", "study", ""));
    r = FOVSTATS("planned", "s.db", "--json");
    struct program_result text = FOVSTATS("planned", "s.db");
    static const char row[] =
        "How good does it look?, second minus first: regular \u2212 time_warped \u03b5 0.2";
    assert_true(reference_close(said_after(r.out, row, "estimate"), 5.0 / 11, 1e-12));
    assert_non_null(strstr(strstr(r.out, row), "\"difference\":true"));
    assert_non_null(strstr(text.out, row));
    program_free(&r);
    program_free(&text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equality_is_shown_by_the_adjusted_p_alone),
        cmocka_unit_test(people_are_tested_for_equality_too),
        cmocka_unit_test(shares_that_are_all_the_same),
        cmocka_unit_test(differences_say_what_is_subtracted_from_what),
        cmocka_unit_test(options_of_a_trial_are_named),
        cmocka_unit_test(the_command_says_the_same),
    };
    return cmocka_run_group_tests(tests, program_enter_folder, program_leave_folder);
}
