// Ratings at their edges: who is in which order where a trial was repeated, ties over several sittings, small p
// in words, effects without an F; against tests/reference/ratings.R.
#include "program.h"
#include "reference.h"
#include "said.h"
#include "study_file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const char fovstats[] = BUILD_DIR "/bin/fovstats";

#define FOVSTATS(...) program_run((const char *const[]){fovstats, __VA_ARGS__, NULL}, NULL)

// A table `rated` of session, ordinal, order, condition, value and status as trials with their ratings.
#define TRIALS                                                                                                 \
    "INSERT INTO trial SELECT 1000 + 10 * s + o, s, s, o, 'rates', 'rate', 'town', '{}', "                     \
    "json_object('order', "                                                                                    \
    "w), c, NULL, NULL, NULL, NULL, 1, NULL, status, 1, 0, 1 FROM rated;"                                      \
    "INSERT INTO rating SELECT NULL, 1000 + 10 * s + o, NULL, s, 'q', 'scene', c, v, 1, 10, 5 FROM rated "     \
    "WHERE "                                                                                                   \
    "v IS NOT NULL;"

// Odd people see time_warped (condition 2) first, even ones regular (1). Person 1's first trial was flagged and
// came again at the end; so did person 2's second one, which changes no order. Both trials of persons 7 and 8
// were flagged, 7's by the experimenter before a rating, 8's by a rule after it, and came again in their order:
// nothing that counts of them was rated before both options had been seen.
static const char repeated[] =
    "CREATE TABLE rated(s, o, w, c, v, status);"
    "INSERT INTO rated VALUES(1, 1, 'first', 2, NULL, 'invalid'), (1, 2, 'second', 1, 7, 'done'), (1, 3, "
    "'first', "
    "2, 5, 'done'),"
    "(2, 1, 'first', 1, 6, 'done'), (2, 2, 'second', 2, 3, 'invalid'), (2, 3, 'second', 2, 7, 'done'),"
    "(3, 1, 'first', 2, 7, 'done'), (3, 2, 'second', 1, 8, 'done'), (4, 1, 'first', 1, 5, 'done'),"
    "(4, 2, 'second', 2, 8, 'done'), (5, 1, 'first', 2, 6, 'done'), (5, 2, 'second', 1, 9, 'done'),"
    "(6, 1, 'first', 1, 7, 'done'), (6, 2, 'second', 2, 9, 'done'), (7, 1, 'first', 2, NULL, 'invalid'),"
    "(7, 2, 'second', 1, NULL, 'invalid'), (7, 3, 'first', 2, 4, 'done'), (7, 4, 'second', 1, 9, 'done'),"
    "(8, 1, 'first', 1, 9, 'done'), (8, 2, 'second', 2, 2, 'done'), (8, 3, 'first', 1, 6, 'done'),"
    "(8, 4, 'second', 2, 6, 'done');" TRIALS
    "UPDATE trial SET repeat_of = id - 2 WHERE id IN (1013, 1073, 1074, 1083, 1084);"
    "INSERT INTO exclusion VALUES(NULL, 1081, NULL, NULL, 'gaze_loss', 'planned', 'lost', 'fovstudy', '2026'),"
    "(NULL, 1082, NULL, NULL, 'gaze_loss', 'planned', 'lost', 'fovstudy', '2026');";

static void expect_number(const char *json, const char *mark, const char *part, const char *key,
                          const char *name)
{
    const char *at = strstr(json, mark);
    assert_non_null(at);
    double got = said_after(at, part, key), want = reference_value("ratings.csv", name);
    if (!reference_close(got, want, 1e-10))
        fail_msg("%s: %.17g, R %.17g", name, got, want);
}

static char *page_of(const char *db)
{
    struct program_result r = FOVSTATS("report", db, "-o", "r.html");
    if (r.code != 0)
        fail_msg("exit %d: %s", r.code, r.err);
    program_free(&r);
    char *text = calloc(1, 4 << 20);
    FILE *file = fopen("r.html", "r");
    assert_true(text && file && fread(text, 1, (4 << 20) - 1, file) > 0);
    fclose(file);
    return text;
}

// The line of a table's row that begins with these words.
static void expect_row(const char *page, const char *words, const char *cells)
{
    char mark[256];
    snprintf(mark, sizeof mark, ">%s</th>%s", words, cells);
    if (!strstr(page, mark))
        fail_msg("no row \"%s\"", mark);
}

static void who_saw_both_has_no_first_rating(void **state)
{
    (void)state;
    study_file_make("o.db", &(struct study_desc){.bare = true});
    study_file_sql("o.db", repeated);
    struct program_result r = FOVSTATS("ratings", "o.db", "--json");
    assert_int_equal(r.code, 0);
    const char *const marks[] = {"\"first\":\"time_warped", "\"first\":\"regular"}, *const names[] = {
                                                                                        "test", "regular"};
    for (int i = 0; i < 2; i++) {
        char name[64];
        assert_true(said_after(strstr(r.out, marks[i]), "", "n") == (i == 0 ? 2 : 3));
        snprintf(name, sizeof name, "order.%s.estimate", names[i]);
        expect_number(r.out, marks[i], "\"second_minus_first\"", "estimate", name);
        snprintf(name, sizeof name, "order.%s.p_value", names[i]);
        expect_number(r.out, marks[i], "\"second_minus_first\"", "p_value", name);
    }
    expect_number(r.out, "\"first_between_groups\"", "", "estimate", "order.between.estimate");
    expect_number(r.out, "\"first_between_groups\"", "", "p_value", "order.between.p_value");
    assert_true(said_after(r.out, "", "first_rated_last_sessions") == 3);
    program_free(&r);
    r = FOVSTATS("ratings", "o.db");
    assert_non_null(strstr(r.out, "given when both options had been seen: 3.\n"));
    program_free(&r);
}

// One report says one thing: the planned tests of orders have the same people as the section on ratings.
static void planned_tests_have_the_same_people(void **state)
{
    (void)state;
    study_file_make("o.db", &(struct study_desc){.bare = true});
    study_file_sql("o.db", repeated);
    study_file_sql("o.db", "UPDATE session SET settings = json_set(settings, '$.planned', json('["
                           "{\"method\":\"paired_t\",\"of\":\"rating\",\"per\":\"order\"},"
                           "{\"method\":\"unpaired_t\",\"of\":\"rating\",\"per\":\"order\"},"
                           "{\"method\":\"mean\",\"of\":\"rating\",\"per\":\"cell\"}]'))");
    char *page = page_of("o.db");
    expect_row(page, "q, second minus first: time_warped \u03b5 0.2 \u2212 regular", "<td>3</td><td>2.00</td>");
    expect_row(page, "q, second minus first: regular \u2212 time_warped \u03b5 0.2", "<td>2</td><td>2.00</td>");
    expect_row(page, "q, first ratings: regular \u2212 time_warped \u03b5 0.2", "<td>5</td><td>-0.50</td>");
    expect_row(page, "regular", "<td class=\"word\">time_warped \u03b5 0.2</td><td>3</td>");
    // Persons 1 and 7 rated time_warped 5 and 4 when regular had been seen: (5 + 7 + 8 + 9 + 4 + 6) / 6.
    expect_row(page, "q: time_warped \u03b5 0.2, rated first", "<td>2</td><td>6.50</td>");
    expect_row(page, "q: time_warped \u03b5 0.2, rated second", "<td>6</td><td>6.50</td>");
    assert_non_null(strstr(page, " 3 sessions are left out, here and where orders are compared as planned"));
    free(page);
}

// Changes of 1 as 3 of three sittings and of one are the same change, and tie.
static void sittings_do_not_break_ties(void **state)
{
    (void)state;
    study_file_make("t.db", &(struct study_desc){.bare = true});
    study_file_sql(
        "t.db",
        "CREATE TABLE rated(s, o, w, c, v, status); CREATE TABLE sat(p, x, y);"
        "INSERT INTO sat VALUES(1, 1, 2), (1, 1, 2), (1, 2, 3), (2, 4, 3), (3, 3, 4), (3, 2, 3), (3, 2, 3), "
        "(4, 5, 4), (5, 2, 3), (5, 4, 5), (5, 4, 5), (6, 5, 6), (7, 5, 7);"
        "UPDATE session SET participant_id = (SELECT p FROM sat WHERE sat.rowid = session.id) WHERE id <= 13;"
        "INSERT INTO rated SELECT rowid, 1, 'first', 2, x, 'done' FROM sat UNION ALL SELECT rowid, 2, "
        "'second', 1, "
        "y, 'done' FROM sat;" TRIALS);
    struct program_result r = FOVSTATS("ratings", "t.db", "--json");
    assert_int_equal(r.code, 0);
    assert_true(said_after(r.out, "\"groups\"", "n") == 7);
    expect_number(r.out, "\"wilcoxon\"", "", "statistic", "sittings.rank_v");
    expect_number(r.out, "\"wilcoxon\"", "", "p_value", "sittings.rank_p");
    program_free(&r);
}

// Two groups 7 apart, whose values reach over 0.6: no p is 0.
static void a_small_p_is_a_bound(void **state)
{
    (void)state;
    study_file_make("p.db", &(struct study_desc){.bare = true});
    study_file_sql(
        "p.db",
        "CREATE TABLE rated AS SELECT s.id AS s, o.value AS o, iif(o.value = 1, 'first', 'second') AS w, "
        "1 + (s.id + o.value) % 2 AS c, 9 - 7 * ((s.id + o.value) % 2) + s.id % 3 * 0.3 AS v, 'done' AS "
        "status FROM session s, json_each('[1,2]') o;" TRIALS);
    struct program_result r = FOVSTATS("ratings", "p.db");
    if (r.code != 0 || !strstr(r.out, ", p < 0.0001 (Welch), d "))
        fail_msg("exit %d: %s%s", r.code, r.out, r.err);
    assert_null(strstr(r.out, "0.0000"));
    program_free(&r);
}

static void expect_text(const char *db, const char *part)
{
    struct program_result r = FOVSTATS("ratings", db);
    if (r.code != 0 || !strstr(r.out, part))
        fail_msg("exit %d, no \"%s\" in %s%s", r.code, part, r.out, r.err);
    program_free(&r);
}

// Everybody rates y 2 above x, and v a little above or below u: the first effect has no F, which is not none.
static void a_perfect_effect_is_not_called_none(void **state)
{
    (void)state;
    static const char perfect[] =
        "CREATE TABLE made AS WITH n(k) AS (SELECT 0 UNION ALL SELECT k + 1 FROM n WHERE k < 19) SELECT k / 4 "
        "+ 1 "
        "AS i, k / 2 % 2 AS lv, k % 2 AS g, 1000 + k AS id FROM n;"
        "INSERT INTO trial SELECT id, i, i, 100 + id % 4, 'b', 'rate', 'town', '{}', json_object('lv', iif(lv, "
        "'y', "
        "'x'), 'g', iif(g, 'v', 'u')), 2, NULL, 'a', NULL, NULL, 1, NULL, 'done', 1, 0, 1 FROM made;"
        "INSERT INTO rating SELECT NULL, id, NULL, i, 'q', 'scene', 2, 2 + i % 4 + 2 * lv + g * (i % 3 - 1), "
        "1, 10, "
        "5 FROM made;";
    study_file_make("f.db", &(struct study_desc){.bare = true});
    study_file_sql("f.db", perfect);
    expect_text("f.db", "lv cannot be tested: everybody's ratings differ by the same");
    char *page = page_of("f.db");
    assert_non_null(strstr(page, "<p>lv cannot be tested: everybody\u2019s ratings differ"));
    assert_non_null(strstr(page, "No other factor by itself shows an effect"));
    free(page);
    study_file_sql("f.db",
                   "UPDATE rating SET value = 2 + segment_id % 4 + 2 * (SELECT lv FROM made WHERE id = "
                   "trial_id); INSERT INTO exclusion VALUES(NULL, NULL, 5, NULL, 'manual', 'planned', 'r', "
                   "'us', '2026')");
    expect_text("f.db", "lv, g cannot be tested");
    page = page_of("f.db");
    assert_non_null(strstr(page, "<p>lv, g cannot be tested"));
    assert_non_null(strstr(page, "<td>no spread</td>"));
    expect_row(page, "q, b: lv", "<td>no F (n 5)</td><td>\u2013</td><td>no F (n 4)</td><td>\u2013</td>");
    assert_null(strstr(page, "factor by itself shows an effect"));
    free(page);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(who_saw_both_has_no_first_rating),
        cmocka_unit_test(planned_tests_have_the_same_people), cmocka_unit_test(sittings_do_not_break_ties),
        cmocka_unit_test(a_small_p_is_a_bound), cmocka_unit_test(a_perfect_effect_is_not_called_none)};
    return cmocka_run_group_tests(tests, program_enter_folder, program_leave_folder);
}
