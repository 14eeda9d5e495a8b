// Ratings from a study file to text, JSON and report: analysis of variance over factors and both options of a
// trial against R (tests/reference/ratings.R), and what is said where there is nothing to analyse.
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

// "Rates over region x epsilon", as ratings.R says it; `follows` and `constant` are no factors of their own.
static const char rates[] =
    "CREATE TABLE made AS WITH n(k) AS (SELECT 0 UNION ALL SELECT k + 1 FROM n WHERE k < 95) SELECT k / 12 + 1 "
    "AS "
    "i, k / 4 % 3 AS r, k / 2 % 2 AS f, k % 2 AS rep, 1000 + k AS id FROM n;"
    "DELETE FROM made WHERE (i = 7 AND r = 0 AND f = 0 AND rep = 1) OR (i = 8 AND r = 2 AND f = 1);"
    "INSERT INTO trial SELECT id, i, i, 100 + id % 12, 'flights', 'rate', 'town', '{}', json_object('region', "
    "CASE r WHEN 0 THEN 'small' WHEN 1 THEN 'large' ELSE 'full' END, 'follows', CASE r WHEN 0 THEN 'x' ELSE "
    "'y' END, "
    "'epsilon', CASE f WHEN 0 THEN 0.1 ELSE 0.2 END, 'constant', 'c'), 2, NULL, 'a', NULL, NULL, 1, NULL, "
    "'done', 1, 0, 1 FROM made;"
    "INSERT INTO rating SELECT NULL, id, NULL, i, 'artefacts', 'scene', 2, 1 + (i * 7 + r * 5 + f * 3 + i * r "
    "* f "
    "+ rep * 2) % 7 + r, 1, 10, 5 FROM made;";

// "Both options of a trial": sides alternate, the test option is condition 2.
static const char both[] = "CREATE TABLE made AS SELECT i.value AS i, c.value AS c, 2000 + 10 * i.value + "
                           "c.value AS id, 1 + (i.value * 5 + "
                           "c.value * 2) % 7 AS test, 3 + (i.value * 3 + c.value * 4) % 6 AS reference FROM "
                           "json_each('[1,2,3,4,5,6]') i, "
                           "json_each('[1,2]') c UNION ALL SELECT 6, 2, 2063, 9, 2;"
                           "INSERT INTO trial SELECT id, i, i, id - 1900, 'main', 'toggle', 'town', '{}', "
                           "json_object('test', CASE c WHEN "
                           "1 THEN 'I' ELSE 'II' END), CASE i % 2 WHEN 1 THEN 2 ELSE 1 END, CASE i % 2 WHEN 1 "
                           "THEN 1 ELSE 2 END, CASE i % "
                           "2 WHEN 1 THEN 'a' ELSE 'b' END, 'a', NULL, 1, NULL, 'done', 1, 0, 1 FROM made;"
                           "INSERT INTO rating SELECT NULL, id, NULL, i, 'quality', 'a', CASE i % 2 WHEN 1 "
                           "THEN 2 ELSE 1 END, CASE i % 2 "
                           "WHEN 1 THEN test ELSE reference END, 1, 10, 5 FROM made;"
                           "INSERT INTO rating SELECT NULL, id, NULL, i, 'quality', 'b', CASE i % 2 WHEN 1 "
                           "THEN 1 ELSE 2 END, CASE i % 2 "
                           "WHEN 1 THEN reference ELSE test END, 1, 10, 6 FROM made WHERE id <> 2051;";

#define FOVSTATS(...) program_run((const char *const[]){fovstats, __VA_ARGS__, NULL}, NULL)

static void expect_number(const char *json, const char *first, const char *second, const char *key,
                          const char *name)
{
    double got = said_after(SAID_PLACE(json, first), second, key), want = reference_value("ratings.csv", name);
    if (!reference_close(got, want, 1e-10))
        fail_msg("%s: %.17g, R %.17g", name, got, want);
}

static char *json_of(const char *db)
{
    struct program_result r = FOVSTATS("ratings", db, "--json");
    if (r.code != 0 || r.err[0])
        fail_msg("exit %d: %s", r.code, r.err);
    free(r.err);
    return r.out;
}

// The command of its own says what `ratings` says of the same factors, whose numbers are R's.
static void anova_is_a_command(void **state)
{
    (void)state;
    study_file_make("f.db", &(struct study_desc){.bare = true});
    study_file_sql("f.db", rates);
    char *whole = json_of("f.db");
    struct program_result json = FOVSTATS("anova", "f.db", "--json"), text = FOVSTATS("anova", "f.db"),
                          help = FOVSTATS("anova", "--help"), typo = FOVSTATS("anova", "f.db", "--pratt");
    assert_int_equal(json.code, 0);
    const char *part = strstr(json.out, "\"factorial\":"), *of = strstr(whole, "\"factorial\":");
    assert_true(part && of);
    size_t length = strlen(part) - 2; // without the object's end and the newline
    assert_true(length > 500 && strncmp(part, of, length) == 0);
    assert_true(text.code == 0 && strstr(text.out, "region x epsilon") && !strstr(text.out, "second-first"));
    assert_true(help.code == 0 && strstr(help.out, "usage: fovstats anova"));
    assert_true(typo.code == 2 && strstr(typo.err, "--pratt"));
    study_file_make("n.db", &(struct study_desc){.bare = true});
    struct program_result none = FOVSTATS("anova", "n.db");
    assert_true(none.code == 1 && strstr(none.err, "no ratings over factors"));
    struct program_result *all[] = {&json, &text, &help, &typo, &none};
    for (size_t i = 0; i < 5; i++)
        program_free(all[i]);
    free(whole);
}

static void factors_agree_with_r(void **state)
{
    (void)state;
    study_file_make("f.db", &(struct study_desc){.bare = true});
    study_file_sql("f.db", rates);
    char *json = json_of("f.db");
    const char *effects[] = {"region", "epsilon", "region x epsilon"},
               *names[] = {"region", "epsilon", "region_x_epsilon"};
    const char *keys[] = {"f",    "p_value", "epsilon_gg",   "epsilon_hf",
                          "p_gg", "p_hf",    "eta2_partial", "eta2_generalised"};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 8; k++) {
            char mark[64], name[64];
            snprintf(mark, sizeof mark, "\"effect\":\"%s\"", effects[i]);
            snprintf(name, sizeof name, "%s.%s", names[i], keys[k]);
            expect_number(json, "\"effects\"", mark, keys[k], name);
        }
    const char *levels[] = {"full", "large", "small"};
    for (int i = 0; i < 3; i++) {
        char mark[64], name[64];
        snprintf(mark, sizeof mark, "\"level\":\"%s\"", levels[i]);
        snprintf(name, sizeof name, "%s.mean", levels[i]);
        expect_number(json, "\"factor\":\"region\"", mark, "mean", name);
        snprintf(name, sizeof name, "%s.within_half_width", levels[i]);
        expect_number(json, "\"factor\":\"region\"", mark, "within_half_width", name);
    }
    const char *pairs[][2] = {{"full", "large"}, {"full", "small"}, {"large", "small"}};
    const char *pair_keys[] = {"estimate", "t", "p_value", "p_holm"};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 4; k++) {
            char mark[64], name[64];
            snprintf(mark, sizeof mark, "\"a\":\"%s\",\"b\":\"%s\"", pairs[i][0], pairs[i][1]);
            snprintf(name, sizeof name, "%s_%s.%s", pairs[i][0], pairs[i][1], pair_keys[k]);
            expect_number(json, "\"pairs\"", mark, pair_keys[k], name);
        }
    assert_true(said_after(json, "\"factorial\"", "participants") == 7);
    assert_non_null(strstr(json, "\"incomplete\":[{\"participant\":\"P08\",\"cells_missing\":1}]"));
    assert_non_null(
        strstr(json, "\"factors_left_out\":\"constant (one level only), follows (follows from region)\""));
    free(json);
}

static void options_agree_with_r(void **state)
{
    (void)state;
    study_file_make("o.db", &(struct study_desc){.bare = true});
    study_file_sql("o.db", both);
    char *json = json_of("o.db");
    const char *cells[] = {"I", "II"};
    const char *keys[][2] = {{"test_mean", "test_mean"}, {"reference_sd", "reference_sd"},
                             {"estimate", "estimate"},   {"t", "t"},
                             {"ci_low", "ci_low"},       {"d", "d"},
                             {"p_holm", "p_holm"}};
    for (int i = 0; i < 2; i++) {
        char mark[64], name[64];
        snprintf(mark, sizeof mark, "\"cell\":\"test %s\"", cells[i]);
        for (size_t k = 0; k < sizeof keys / sizeof keys[0]; k++) {
            snprintf(name, sizeof name, "%s.%s", cells[i], keys[k][1]);
            expect_number(json, mark, "", keys[k][0], name);
        }
        snprintf(name, sizeof name, "%s.rank_p", cells[i]);
        expect_number(strstr(json, mark), "\"wilcoxon\"", "", "p_value", name);
    }
    assert_true(said_after(json, "\"cell\":\"test II\"", "participants") == 6);
    assert_true(said_after(json, "\"cell\":\"test II\"", "trials") == 7);
    assert_true(said_after(json, "left_out", "one_option_only") == 1);
    free(json);
}

static void before_and_after_by_ranks(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){0});
    char *json = json_of("s.db");
    const char *marks[] = {"\"first\":\"regular\"", "\"first\":\"time_warped"},
               *names[] = {"regular_first", "test_first"};
    for (int i = 0; i < 2; i++) {
        char name[64];
        snprintf(name, sizeof name, "%s.rank_p", names[i]);
        expect_number(json, marks[i], "\"wilcoxon\"", "p_value", name);
        snprintf(name, sizeof name, "%s.d", names[i]);
        expect_number(json, marks[i], "\"d_z\"", "d", name);
    }
    expect_number(json, marks[1], "\"d_av\"", "d", "test_first.d_av");
    free(json);
    study_file_sql("s.db",
                   "UPDATE rating SET value = 10 WHERE trial_id = 24; UPDATE rating SET value = 5 WHERE "
                   "trial_id = 84");
    json = json_of("s.db");
    expect_number(json, marks[1], "\"wilcoxon\"", "p_value", "changed.rank_p");
    free(json);
    struct program_result r = FOVSTATS("ratings", "--pratt", "s.db", "--json");
    assert_int_equal(r.code, 0);
    expect_number(r.out, marks[1], "\"wilcoxon\"", "p_value", "changed.pratt_p");
    program_free(&r);
}

static char *slurp(const char *path)
{
    char *text = calloc(1, 4 << 20);
    FILE *file = fopen(path, "r");
    assert_non_null(text);
    assert_non_null(file);
    assert_true(fread(text, 1, (4 << 20) - 1, file) > 0);
    fclose(file);
    return text;
}

static void expect_in_report(const char *db, const char *const *parts)
{
    struct program_result r = FOVSTATS("report", db, "-o", "r.html");
    if (r.code != 0)
        fail_msg("exit %d: %s", r.code, r.err);
    program_free(&r);
    char *page = slurp("r.html");
    for (; *parts; parts++)
        if (!strstr(page, *parts))
            fail_msg("the report of %s lacks \"%s\"", db, *parts);
    assert_non_null(strstr(page, "</html>"));
    free(page);
}

static void expect_in_text(const char *db, const char *part)
{
    said_done(FOVSTATS("ratings", db), part);
}

static void the_report_shows_them(void **state)
{
    (void)state;
    study_file_make("f.db", &(struct study_desc){.bare = true});
    study_file_sql("f.db", rates);
    expect_in_text("f.db", "Left out: participant P08, who has no rating in 1 of 6 cells; nothing is filled.");
    expect_in_text("f.db", "7 participants, 6 cells, 1 to 2 in each");
    expect_in_report("f.db", (const char *const[]){"region \u00d7 epsilon", "<td>2, 12</td><td>48.129</td>",
                                                   "P08 (no rating in 1 of 6 cells)", "full \u2212 small",
                                                   "id=\"factorial-0-w-title\"", "Cousineau",
                                                   "id=\"likert-0-n-title\"", NULL});
    char below[32], above[32]; // the ends of the bars
    snprintf(below, sizeof below, "%.0f %%</text>", reference_value("ratings.csv", "small.percent_below"));
    snprintf(above, sizeof above, "%.0f %%</text>", reference_value("ratings.csv", "full.percent_above"));
    expect_in_report("f.db", (const char *const[]){below, above, NULL});
    // Words of a study stay words, in the table, in the figure and in the terminal.
    study_file_sql(
        "f.db", "UPDATE trial SET factors = replace(factors, 'small', '<b>`touch hacked`\\u001b') WHERE block "
                "= 'flights'");
    expect_in_report("f.db", (const char *const[]){"&lt;b&gt;`touch hacked`", NULL});
    assert_int_not_equal(access("hacked", F_OK), 0);
    study_file_make("o.db", &(struct study_desc){.bare = true});
    study_file_sql("o.db", both);
    expect_in_report("o.db",
                     (const char *const[]){"of both options of a trial", "-2.20", "t(4) = -2.557", "test II",
                                           "ratings of one option of a trial only: 1", NULL});
}

static void other_rules_change_them(void **state)
{
    (void)state;
    study_file_make("x.db", &(struct study_desc){.bare = true});
    study_file_sql("x.db", rates);
    study_file_sql("x.db",
                   "INSERT INTO exclusion VALUES(NULL, NULL, 1, NULL, 'gaze_loss', 'planned', 'why', 'us', "
                   "'2026')");
    expect_in_report("x.db", (const char *const[]){"artefacts, flights: region \u00d7 epsilon",
                                                   "F = 48.13 (n 7)", "(n 6)", NULL});
}

static void what_cannot_be_analysed_is_said(void **state)
{
    (void)state;
    study_file_make("b.db", &(struct study_desc){.bare = true});
    study_file_sql("b.db", rates);
    study_file_sql("b.db", "DELETE FROM rating WHERE trial_id IN (SELECT id FROM made WHERE f <> i % 2)");
    expect_in_text("b.db", "nobody rated two levels of epsilon, though 8 of 8 were to");
    expect_in_report("b.db", (const char *const[]){"nobody rated two levels of epsilon", NULL});
    study_file_sql("b.db", "DELETE FROM rating WHERE trial_id IN (SELECT id FROM made WHERE i > 1 OR r > 0)");
    expect_in_text(
        "b.db",
        "No analysis of 2 ratings of 1 participant, mean 5.00: there is no factor with two levels to compare.");
    study_file_make("c.db", &(struct study_desc){.bare = true});
    study_file_sql("c.db", rates);
    study_file_sql("c.db", "UPDATE rating SET value = 4");
    expect_in_report("c.db", (const char *const[]){"<td>2, 12</td><td>\u2013</td>", NULL});
    study_file_sql("c.db", "DELETE FROM rating WHERE trial_id IN (SELECT id FROM made WHERE i > 1)");
    expect_in_text("c.db", "it takes two participants with a rating in each of the 6 cells, and there is 1");
}

static void not_finite_is_said(void **state)
{
    (void)state;
    study_file_make("n.db", &(struct study_desc){0});
    study_file_sql("n.db",
                   "PRAGMA ignore_check_constraints = ON; UPDATE rating SET value = 9e999 WHERE id = 1");
    expect_in_text("n.db", "ratings that are not finite numbers: 1");
    expect_in_report("n.db",
                     (const char *const[]){"ratings that are not finite numbers, which no program of ours "
                                           "writes: 1",
                                           ">6/22</text>", "t(8) = -3.411", NULL});
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(anova_is_a_command),
                                       cmocka_unit_test(factors_agree_with_r),
                                       cmocka_unit_test(options_agree_with_r),
                                       cmocka_unit_test(before_and_after_by_ranks),
                                       cmocka_unit_test(the_report_shows_them),
                                       cmocka_unit_test(other_rules_change_them),
                                       cmocka_unit_test(what_cannot_be_analysed_is_said),
                                       cmocka_unit_test(not_finite_is_said)};
    return cmocka_run_group_tests(tests, program_enter_folder, program_leave_folder);
}
