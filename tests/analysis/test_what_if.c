// The table "What if" of the report: each row is one thing under three sets of rules, and says which.
#include "program.h"
#include "reference.h"
#include "staircase_file.h"
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

#define DASH "<td>\u2013</td>"

// The table's part of the report, freed by the caller.
static char *table_of(const char *db)
{
    const char *argv[] = {fovstats, "report", db, "-o", "r.html", NULL};
    struct program_result r = program_run(argv, NULL);
    if (r.code != 0)
        fail_msg("exit %d: %s", r.code, r.err);
    program_free(&r);
    char *page = calloc(1, 4 << 20);
    FILE *file = fopen("r.html", "r");
    assert_true(page && file && fread(page, 1, (4 << 20) - 1, file) > 0);
    fclose(file);
    const char *table = strstr(page, "<h3>What if</h3>");
    assert_non_null(table);
    const char *end = strstr(table, "<caption>Sessions");
    char *copy = end ? strndup(table, (size_t)(end - table)) : strdup(table);
    free(page);
    return copy;
}

static void expect_row(const char *table, const char *words, const char *cells)
{
    char mark[512];
    snprintf(mark, sizeof mark, ">%s</th>%s</tr>", words, cells);
    if (!strstr(table, mark))
        fail_msg("no row \"%s\" in %s", mark, table);
}

// staircase_file.h, whose block "liked" has its trials a second time with fovea = 10 dose for the factor: R's
// threshold of "preference" in psychometric.csv is 3.4097 of dose, and ten times that of fovea.
static void each_threshold_is_its_own(void **state)
{
    (void)state;
    staircase_file_make("s.db");
    study_file_sql(
        "s.db",
        "INSERT INTO trial SELECT id + 10000, session_id, segment_id, ordinal + 10000, block, kind, scene, "
        "settings, json_object('fovea', 10 * (factors ->> '$.dose')), option_a, option_b, test_slot, "
        "first_shown, fixation, seed, repeat_of, status, attempt, started_ns, ended_ns FROM trial WHERE "
        "block = 'liked'; INSERT INTO choice SELECT NULL, trial_id + 10000, segment_id, chosen, correct, "
        "reaction_ns, answered_ns, toggles FROM choice WHERE trial_id IN (SELECT id FROM trial WHERE block "
        "= 'liked')");
    char *table = table_of("s.db");
    const char *dose = "<td>3.41 (20 together)</td>" DASH, *fovea = "<td>34.1 (20 together)</td>" DASH;
    char cells[256];
    snprintf(cells, sizeof cells, "%s%s%s", dose, dose, dose);
    expect_row(table, "threshold of dose, liked: all, one function of all people", cells);
    snprintf(cells, sizeof cells, "%s%s%s", fovea, fovea, fovea);
    expect_row(table, "threshold of fovea, liked: all, one function of all people", cells);
    free(table);
}

// Estimates 3.5, 6, 4 and 9, the last one of person 5, whom a late rule takes out; person 4 has none.
static void staircases_have_their_own_estimates(void **state)
{
    (void)state;
    staircase_file_make("s.db");
    char *table = table_of("s.db");
    expect_row(table, "threshold of fovea (\u00b0), stairs: scene town, mean of people by the staircase",
               "<td>5.62 (4 of 5)</td>" DASH "<td>4.5 (3 of 4)</td>" DASH "<td>4.5 (3 of 4)</td>" DASH);
    assert_non_null(strstr(table, "A staircase\u2019s own estimate has seen each of its trials"));
    // On a scale there are no right answers to fit anything to.
    expect_row(table, "threshold of fovea (\u00b0), graded: all, mean of people by the staircase",
               "<td>1.5 (1 of 1)</td>" DASH "<td>1.5 (1 of 1)</td>" DASH "<td>1.5 (1 of 1)</td>" DASH);
    assert_null(strstr(table, "graded: all, mean of people by the fit"));
    free(table);
}

// The last trial of dose 1 of "again" loses its right answer, so that the cell's answers are of two kinds.
static void each_cell_of_choices_is_named(void **state)
{
    (void)state;
    staircase_file_make("s.db");
    study_file_sql("s.db",
                   "UPDATE choice SET correct = NULL, chosen = 'a' WHERE trial_id = (SELECT max(id) FROM trial "
                   "WHERE block = 'again' AND factors ->> '$.dose' = 1)");
    char *table = table_of("s.db");
    // 10 of 20 in the file, of which that trial was a wrong one; one person has one sign: p is 1
    const char *right = "<td>10 of 19</td><td>1.0000</td>", *one = "<td>1 of 1</td><td>1.0000</td>";
    char cells[256];
    snprintf(cells, sizeof cells, "%s%s%s", right, right, right);
    expect_row(table, "again: dose 1, right answers", cells);
    snprintf(cells, sizeof cells, "%s%s%s", one, one, one);
    expect_row(table, "again: dose 1", cells);
    assert_non_null(strstr(table, ">liked: dose 1</th><td>4 of 20</td>"));
    free(table);
}

// Each option is as often the reference; the rules take out one of the trials that had regular for theirs.
static void a_scale_keeps_its_zero(void **state)
{
    (void)state;
    study_file_make("j.db", &(struct study_desc){.bare = true});
    study_file_sql(
        "j.db",
        "CREATE TABLE made AS WITH n(k) AS (SELECT 0 UNION ALL SELECT k + 1 FROM n WHERE k < 79) SELECT k / "
        "8 + 1 AS s, k % 8 AS o, k % 2 AS turned, k / 2 % 4 < 3 AS liked, 1000 + k AS id FROM n;"
        "INSERT INTO trial SELECT id, s, s, 10 + o, 'b', 'toggle', 'town', '{}', '{}', 2 - turned, 1 + "
        "turned, 'a', 'a', NULL, 1, NULL, 'done', 1, 0, 1 FROM made;"
        "INSERT INTO choice SELECT NULL, id, s, iif(liked <> turned, 'a', 'b'), NULL, 1, 5, 0 FROM made;"
        "INSERT INTO exclusion VALUES(NULL, 1000, NULL, NULL, 'reaction', 'planned', 'r', 'us', '2026')");
    char *table = table_of("j.db"), cells[256];
    double all = reference_value("what_if.csv", "scale.all"),
           rules = reference_value("what_if.csv", "scale.rules");
    snprintf(cells, sizeof cells, "<td>%.2f JOD</td>" DASH "<td>%.2f JOD</td>" DASH "<td>%.2f JOD</td>" DASH,
             all, rules, rules);
    expect_row(table, "scale, b: time_warped \u03b5 0.2 less regular", cells);
    assert_null(strstr(table, ">scale, b: regular"));
    free(table);
    // Nothing is left that had regular for its reference, nor anything that it was compared with in block 'c'.
    study_file_sql("j.db",
                   "UPDATE trial SET block = 'c', option_b = 3 WHERE id >= 1040 AND option_b = 2;"
                   "UPDATE trial SET block = 'c' WHERE id >= 1040;"
                   "INSERT INTO exclusion SELECT NULL, id, NULL, NULL, 'reaction', 'stricter', 'r', 'us', "
                   "'2026' FROM trial WHERE block = 'c' AND option_b = 1");
    table = table_of("j.db");
    const char *row = strstr(table, ">scale, c: time_warped");
    assert_non_null(row);
    char *line = strndup(row, strcspn(row, "\n"));
    assert_non_null(strstr(line, " less regular</th>"));
    free(line);
    free(table);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_threshold_is_its_own), cmocka_unit_test(staircases_have_their_own_estimates),
        cmocka_unit_test(each_cell_of_choices_is_named), cmocka_unit_test(a_scale_keeps_its_zero)};
    return cmocka_run_group_tests(tests, program_enter_folder, program_leave_folder);
}
