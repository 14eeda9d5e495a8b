// fovstats thresholds and jod on files with known answers: numbers against R, text against a golden file.
#include "program.h"
#include "said.h"
#include "staircase_file.h"
#include "study_file.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

static const char fovstats[] = BUILD_DIR "/bin/fovstats";

#define FOVSTATS(...) program_run((const char *const[]){fovstats, __VA_ARGS__, NULL}, NULL)

static void expect(const char *value, double expected, double within)
{
    double got = strtod(value, NULL);
    if (!(fabs(got - expected) <= within))
        fail_msg("%.12g, expected %.12g, at %.60s", got, expected, value);
}

static void expect_text(const char *at, const char *text)
{
    if (strncmp(at, text, strlen(text)) != 0)
        fail_msg("expected %s at %.100s", text, at);
}

static void staircases_and_fits(void **state)
{
    (void)state;
    staircase_file_make("s.db");
    struct program_result r = FOVSTATS("thresholds", "s.db", "--json");
    if (r.code != 0)
        fail_msg("exit %d: %s", r.code, r.err);
    const char *cell = SAID_PLACE(r.out, "\"block\":\"stairs\"");
    expect_text(SAID_PLACE(cell, "\"parameter\":"), "\"fovea_deg\"");
    expect_text(SAID_PLACE(cell, "\"method\":"), "\"up_down\"");
    expect_text(SAID_PLACE(cell, "\"larger\":"), "\"easier\"");
    // R: t.test(c(3.5, 6, 4))
    const char *mean = SAID_PLACE(cell, "\"over_people_staircase\":{");
    expect(SAID_PLACE(mean, "\"n\":"), 3, 0);
    expect(SAID_PLACE(mean, "\"mean\":"), 4.5, 1e-12);
    expect(SAID_PLACE(mean, "\"sd\":"), 1.3228756555322954, 1e-12);
    expect(SAID_PLACE(mean, "\"median\":"), 4, 1e-12);
    expect(SAID_PLACE(mean, "\"ci_low\":"), 1.2137946961357857, 1e-10);
    expect(SAID_PLACE(mean, "\"ci_high\":"), 7.7862053038642136, 1e-10);
    // tests/reference/psychometric.csv, "lapses at the top"
    const char *first = SAID_PLACE(cell, "\"participant\":\"P01\"");
    expect(SAID_PLACE(first, "\"steps\":"), 140, 0);
    expect(SAID_PLACE(first, "\"reversals\":"), 32, 0);
    expect_text(SAID_PLACE(first, "\"estimable\":"), "true");
    expect(SAID_PLACE(first, "\"threshold\":"), 3.1375598260723097, 6e-4);
    expect(SAID_PLACE(first, "\"threshold_profile\":["), 2.2418407666067672, 6e-4);
    expect(SAID_PLACE(first, "\"threshold_profile\":[", ","), 4.1432527555263485, 6e-4);
    expect(SAID_PLACE(first, "\"deviance\":"), 0.69066182612955629, 1e-6);
    expect(SAID_PLACE(first, "\"bootstrap\":{", "\"replicates\":"), 199, 0);
    const char *second = SAID_PLACE(cell, "\"participant\":\"P02\""),
               *third = SAID_PLACE(cell, "\"participant\":\"P03\"");
    expect_text(SAID_PLACE(second, "\"estimable\":"), "false,\"reason\":\"every answer is a yes");
    expect_text(SAID_PLACE(second, "\"threshold\":"), "null");
    expect_text(SAID_PLACE(third, "\"reason\":"), "\"one level only\"");
    expect_text(SAID_PLACE(third, "\"bayes\":{", "\"mean\":"), "null");
    expect(SAID_PLACE(cell, "\"participant\":\"P04\"", "\"steps\":"), 4, 0);
    assert_null(strstr(r.out, "\"participant\":\"P05\""));
    assert_null(strstr(r.out, "practice"));
    expect(SAID_PLACE(r.out, "\"left_out\":{", "\"excluded\":"), 1, 0);
    expect(SAID_PLACE(r.out, "\"left_out\":{", "\"not_done\":"), 2, 0);
    const char *graded = SAID_PLACE(r.out, "\"block\":\"graded\"");
    expect_text(SAID_PLACE(graded, "\"graded\":"), "true");
    expect_text(SAID_PLACE(graded, "\"reason\":"), "\"no answers\"");
    expect(SAID_PLACE(graded, "\"staircase_estimate\":"), 1.5, 0);
    program_free(&r);
}

// Right answers only, at constant levels: nothing tells what larger levels do, unless the user does.
static void no_direction_no_bayes(void **state)
{
    (void)state;
    staircase_file_make("s.db");
    study_file_sql("s.db", "UPDATE choice SET correct = 1 WHERE correct = 0");
    struct program_result r = FOVSTATS("thresholds", "s.db", "--json", "--bootstrap", "0");
    assert_int_equal(r.code, 0);
    const char *again = SAID_PLACE(r.out, "\"block\":\"again\"");
    expect_text(SAID_PLACE(again, "\"reason\":"), "\"every answer is a yes");
    expect_text(SAID_PLACE(again, "\"bayes\":{", "\"mean\":"), "null");
    program_free(&r);
    r = FOVSTATS("thresholds", "s.db", "--json", "--bootstrap", "0", "--larger", "harder");
    again = SAID_PLACE(r.out, "\"block\":\"again\"");
    assert_true(strtod(SAID_PLACE(again, "\"bayes\":{", "\"mean\":"), NULL) > 7);
    program_free(&r);
}

// Nobody was ever wrong, and the level rose after right answers: larger is harder.
static void direction_without_wrong_answers(void **state)
{
    (void)state;
    staircase_file_make("s.db");
    study_file_sql("s.db",
                   "UPDATE staircase_step SET outcome = 1; UPDATE choice SET correct = 1 WHERE correct = 0");
    struct program_result r = FOVSTATS("thresholds", "s.db", "--json", "--bootstrap", "0");
    assert_int_equal(r.code, 0);
    const char *cell = SAID_PLACE(r.out, "\"block\":\"stairs\"");
    expect_text(SAID_PLACE(cell, "\"larger\":"), "\"harder\"");
    const char *first = SAID_PLACE(cell, "\"participant\":\"P01\"");
    expect_text(SAID_PLACE(first, "\"reason\":"), "\"every answer is a yes");
    assert_true(strtod(SAID_PLACE(first, "\"bayes\":{", "\"mean\":"), NULL) >
                7); // beyond the hardest level shown
    program_free(&r);
}

static void constant_levels(void **state)
{
    (void)state;
    staircase_file_make("s.db");
    struct program_result r = FOVSTATS("thresholds", "s.db", "--json", "--bootstrap", "0");
    assert_int_equal(r.code, 0);
    // tests/reference/psychometric.csv, "lapses at the top" and "preference"
    const char *again = SAID_PLACE(r.out, "\"block\":\"again\""),
               *liked = SAID_PLACE(r.out, "\"block\":\"liked\"");
    expect_text(SAID_PLACE(again, "\"parameter\":"), "\"dose\"");
    expect_text(SAID_PLACE(again, "\"preference\":"), "false");
    expect(SAID_PLACE(again, "\"people_together\":"), 0, 0);
    expect(SAID_PLACE(again, "\"threshold\":"), 3.1375598260723097, 6e-4);
    expect(SAID_PLACE(again, "\"guess\":"), 0.5, 0);
    expect_text(SAID_PLACE(liked, "\"preference\":"), "true");
    expect_text(SAID_PLACE(liked, "\"larger\":"), "\"easier\"");
    expect(SAID_PLACE(liked, "\"people_together\":"), 20, 0);
    expect(SAID_PLACE(liked, "\"participant\":\"all\"", "\"steps\":"), 140, 0);
    expect(SAID_PLACE(liked, "\"threshold\":"), 3.4097276570650115, 6e-4);
    expect(SAID_PLACE(liked, "\"lapse\":"), 0.21797053054181484, 1e-3);
    program_free(&r);
    // Four levels are too few for a preference's four numbers; three are enough for right answers.
    study_file_sql("s.db",
                   "DELETE FROM choice WHERE trial_id IN (SELECT id FROM trial WHERE block IN ('liked', "
                   "'again') AND factors ->> '$.dose' > 4)");
    r = FOVSTATS("thresholds", "s.db", "--json", "--bootstrap", "0");
    assert_non_null(strstr(r.out, "\"again\""));
    assert_null(strstr(r.out, "\"liked\""));
    program_free(&r);
}

// One person who answered once at each level: the answers are that person's, with intervals, and not pooled.
static void one_person_is_not_pooled(void **state)
{
    (void)state;
    staircase_file_make("s.db");
    study_file_sql("s.db",
                   "DELETE FROM choice WHERE trial_id IN (SELECT t.id FROM trial t JOIN session s ON s.id = "
                   "t.session_id WHERE t.block = 'liked' AND s.participant_id != (SELECT "
                   "min(s.participant_id) FROM trial t JOIN session s ON s.id = t.session_id JOIN choice c "
                   "ON c.trial_id = t.id WHERE t.block = 'liked'))");
    struct program_result r =
        FOVSTATS("thresholds", "s.db", "--json", "--bootstrap", "0", "--larger", "easier");
    const char *liked = SAID_PLACE(r.out, "\"block\":\"liked\"");
    expect(SAID_PLACE(liked, "\"people_together\":"), 0, 0);
    assert_null(strstr(liked, "\"participant\":\"all\""));
    const char *credible = SAID_PLACE(liked, "\"bayes\":{", "\"credible\":[");
    assert_true(strtod(credible, NULL) < strtod(SAID_PLACE(credible, ","), NULL));
    program_free(&r);
    r = FOVSTATS("thresholds", "s.db", "--bootstrap", "0");
    assert_null(strstr(r.out, "people share one function"));
    program_free(&r);
}

// What the fits were allowed is said of the kinds that were fitted only.
static void bounds_are_those_of_what_was_fitted(void **state)
{
    (void)state;
    staircase_file_make("s.db");
    study_file_sql("s.db", "DELETE FROM staircase_step; DELETE FROM choice WHERE correct IS NOT NULL");
    struct program_result r = FOVSTATS("thresholds", "s.db", "--bootstrap", "0");
    assert_int_equal(r.code, 0);
    assert_non_null(strstr(r.out, "logistic; ML: guess and lapse between 0 and 0.5.\n"));
    assert_null(strstr(r.out, "0.06"));
    program_free(&r);
}

static void adjusted_values(void **state)
{
    (void)state;
    staircase_file_make("s.db");
    struct program_result r = FOVSTATS("thresholds", "s.db", "--json", "--bootstrap", "0");
    assert_int_equal(r.code, 0);
    const char *cell = SAID_PLACE(r.out, "\"adjusted\":[");
    // R: t.test(c(0.2, 0.4, 0.8)), the means of the people
    expect(SAID_PLACE(cell, "\"n\":"), 3, 0);
    expect(SAID_PLACE(cell, "\"mean\":"), 0.46666666666666667, 1e-14);
    expect(SAID_PLACE(cell, "\"sd\":"), 0.30550504633038933, 1e-14);
    expect(SAID_PLACE(cell, "\"median\":"), 0.4, 1e-14);
    expect(SAID_PLACE(cell, "\"ci_low\":"), -0.29224994005268523, 1e-12);
    expect(SAID_PLACE(cell, "\"ci_high\":"), 1.2255832733860186, 1e-12);
    expect(SAID_PLACE(cell, "\"P03\",\"values\":"), 3, 0);
    expect(SAID_PLACE(cell, "\"P03\"", "\"least\":"), 0.6, 1e-15);
    program_free(&r);
}

// A staircase with a trial to come has no estimate yet; a level that is no number is named.
static void only_ended_staircases_have_estimates(void **state)
{
    (void)state;
    staircase_file_make("s.db");
    study_file_sql(
        "s.db",
        "UPDATE trial SET status = 'running' WHERE id = (SELECT max(t.id) FROM trial t JOIN session s ON "
        "s.id = t.session_id JOIN participant p ON p.id = s.participant_id WHERE p.code = 'P03' AND "
        "t.block = 'stairs')");
    study_file_sql("s.db",
                   "UPDATE staircase_step SET level = 9e999 WHERE id = (SELECT max(c.id) FROM staircase_step c "
                   "JOIN trial t "
                   "ON t.id = c.trial_id JOIN session s ON s.id = t.session_id JOIN participant p ON p.id = "
                   "s.participant_id WHERE p.code = 'P01' AND t.block = 'stairs')");
    struct program_result r = FOVSTATS("thresholds", "s.db", "--json", "--bootstrap", "0");
    const char *cell = SAID_PLACE(r.out, "\"block\":\"stairs\"");
    expect_text(SAID_PLACE(cell, "\"participant\":\"P03\"", "\"staircase_estimate\":"), "null");
    expect(SAID_PLACE(cell, "\"participant\":\"P02\"", "\"staircase_estimate\":"), 6, 0);
    expect(SAID_PLACE(cell, "\"participant\":\"P01\"", "\"steps\":"), 139, 0);
    expect(SAID_PLACE(r.out, "\"not_finite\":"), 1, 0);
    program_free(&r);
}

static void text_is_as_it_was(void **state)
{
    (void)state;
    staircase_file_make("s.db");
    struct program_result r = FOVSTATS("thresholds", "s.db", "--bootstrap", "0");
    assert_int_equal(r.code, 0);
    said_golden(r.out, "thresholds.txt");
    program_free(&r);
}

static void options_are_heeded(void **state)
{
    (void)state;
    staircase_file_make("s.db");
    struct program_result r = FOVSTATS("thresholds", "s.db", "--json", "--family", "weibull", "--larger",
                                       "harder", "--bootstrap", "0");
    assert_int_equal(r.code, 0);
    expect_text(SAID_PLACE(r.out, "\"family\":"), "\"weibull\"");
    const char *cell = SAID_PLACE(r.out, "\"block\":\"stairs\"");
    expect_text(SAID_PLACE(cell, "\"larger\":"), "\"harder\"");
    // answers that get better with larger levels have no threshold of that kind
    expect_text(SAID_PLACE(cell, "\"participant\":\"P01\"", "\"reason\":"), "\"the level has no effect");
    program_free(&r);
    static const char *const wrong[][2] = {{"--family", "probit"},
                                           {"--larger", "smaller"},
                                           {"--bootstrap", "-1"},
                                           {"--bootstrap", "x"},
                                           {"--bootstrap", "1000000"}};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        r = FOVSTATS("thresholds", "s.db", wrong[i][0], wrong[i][1]);
        if (r.code != 2 || !strstr(r.err, wrong[i][0]))
            fail_msg("exit %d: %s", r.code, r.err);
        program_free(&r);
    }
    study_file_make("n.db", &(struct study_desc){0});
    r = FOVSTATS("thresholds", "n.db");
    assert_int_equal(r.code, 1);
    assert_non_null(
        strstr(r.err, "n.db: no staircase, no constant levels and no adjusted value were recorded that count"));
    program_free(&r);
}

static void jod_of_a_star(void **state)
{
    (void)state;
    study_file_make("c.db", &(struct study_desc){0});
    struct program_result r = FOVSTATS("jod", "c.db", "--json");
    assert_int_equal(r.code, 0);
    // R: qnorm(6 / 22) / qnorm(0.75), qnorm(4 / 19) / qnorm(0.75)
    expect(SAID_PLACE(r.out, "epsilon 0.2\"", "\"jod\":"), -0.89635957612028561, 1e-9);
    expect(SAID_PLACE(r.out, "epsilon 0.05\"", "\"jod\":"), -1.1928963785237581, 1e-9);
    expect(SAID_PLACE(r.out, "\"option\":\"regular\"", "\"jod\":"), 0, 0);
    expect(SAID_PLACE(r.out, "epsilon 0.2\"", "\"preferred\":"), 6, 0);
    double low = strtod(SAID_PLACE(r.out, "epsilon 0.2\"", "\"ci_low\":"), NULL),
           high = strtod(SAID_PLACE(r.out, "epsilon 0.2\"", "\"ci_high\":"), NULL);
    assert_true(low < -1.3 && low > -2.2 && high > -0.5 && high < 0.1); // delta method: -1.73 to -0.07
    program_free(&r);
    // One of 22 for it: in R, pbinom(0, 22, 1 / 22) = 0.359 of the replicates have none.
    study_file_make("c.db", &(struct study_desc){0});
    study_file_sql(
        "c.db",
        "UPDATE choice SET chosen = CASE (SELECT test_slot FROM trial WHERE id = trial_id) WHEN 'a' THEN 'b' "
        "ELSE 'a' END; UPDATE choice SET chosen = (SELECT test_slot FROM trial WHERE id = trial_id) WHERE id "
        "IN "
        "(SELECT min(c.id) FROM choice c JOIN trial t ON t.id = c.trial_id GROUP BY t.option_a, t.option_b)");
    r = FOVSTATS("jod", "c.db", "--json");
    const char *few = SAID_PLACE(r.out, "epsilon 0.2\"");
    expect_text(SAID_PLACE(few, "\"ci_low\":"), "null");
    expect_text(SAID_PLACE(few, "\"ci_low_open\":"), "true");
    expect_text(SAID_PLACE(few, "\"ci_high_open\":"), "false");
    program_free(&r);
    r = FOVSTATS("jod", "c.db");
    assert_non_null(strstr(r.out, " below -"));
    program_free(&r);
    r = FOVSTATS("report", "c.db", "-o", "c.html");
    assert_int_equal(r.code, 0);
    program_free(&r);
    static char report[1 << 20];
    FILE *file = fopen("c.html", "r");
    report[fread(report, 1, sizeof report - 1, file)] = '\0';
    fclose(file);
    assert_non_null(strstr(report, "<td>below -"));
    assert_non_null(strstr(report, "has no other end"));
    study_file_sql("c.db", "UPDATE choice SET chosen = (SELECT test_slot FROM trial WHERE id = trial_id)");
    r = FOVSTATS("jod", "c.db");
    assert_int_equal(r.code, 0);
    assert_non_null(strstr(r.out, "no chain of answers prefers the reference to it"));
    program_free(&r);
    study_file_make("b.db", &(struct study_desc){.bare = true});
    r = FOVSTATS("jod", "b.db");
    assert_int_equal(r.code, 1);
    assert_non_null(strstr(r.err, "no preference between two options"));
    program_free(&r);
}

static void the_report_has_them(void **state)
{
    (void)state;
    staircase_file_make("s.db");
    struct program_result r = FOVSTATS("report", "s.db", "-o", "s.html");
    if (r.code != 0)
        fail_msg("exit %d: %s", r.code, r.err);
    program_free(&r);
    FILE *file = fopen("s.html", "r");
    static char page[1 << 20];
    page[fread(page, 1, sizeof page - 1, file)] = '\0';
    fclose(file);
    static const char *const parts[] = {
        "<h2>Thresholds</h2>",
        "Block \u201cstairs\u201d, fovea (\u00b0)",
        "1.21 to 7.79",
        "<td>3.14</td>",
        "2.24 to 4.14",
        "not estimable: every answer is a yes",
        "one level only",
        "\u201cliked\u201d, dose: preferences for the test option",
        "20 people</th>",
        "not fitted: answers on a scale",
        "<h2>Adjusted values</h2>",
        "-0.292 to 1.23",
    };
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++)
        if (!strstr(page, parts[i]))
            fail_msg("the report lacks \"%s\"", parts[i]);
}

// Levels whose range is no number: tables and the rest are written, a figure may be a sentence.
static void levels_at_the_end_of_numbers(void **state)
{
    (void)state;
    staircase_file_make("h.db");
    study_file_sql("h.db", "UPDATE staircase_step SET level = CASE WHEN level < 4 THEN -1e308 ELSE 1e308 END");
    struct program_result r = FOVSTATS("report", "h.db", "-o", "h.html");
    if (r.code != 0)
        fail_msg("exit %d: %s", r.code, r.err);
    program_free(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(staircases_and_fits),
        cmocka_unit_test(direction_without_wrong_answers),
        cmocka_unit_test(no_direction_no_bayes),
        cmocka_unit_test(constant_levels),
        cmocka_unit_test(one_person_is_not_pooled),
        cmocka_unit_test(bounds_are_those_of_what_was_fitted),
        cmocka_unit_test(adjusted_values),
        cmocka_unit_test(text_is_as_it_was),
        cmocka_unit_test(only_ended_staircases_have_estimates),
        cmocka_unit_test(options_are_heeded),
        cmocka_unit_test(jod_of_a_star),
        cmocka_unit_test(the_report_has_them),
        cmocka_unit_test(levels_at_the_end_of_numbers),
    };
    return cmocka_run_group_tests(tests, program_enter_folder, program_leave_folder);
}
