// What does not count as an answer (practice, catch, null, invalid, excluded), and what the report says of it.
#include "program.h"
#include "study_file.h"

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

// To the file of study_file.h, with person 22 out as planned and person 1 by a stricter rule:
// - ten null trials, nine answered with slot a; five catch trials, missed by persons 3 and 22
// - in practice everybody chose the test option, and person 21 rated a second time
// - person 2's answer in the first cell (for the test option) is out by a late rule
// - a rule on rating pairs takes person 3's two ratings, and takes no choice of person 4 though the trial is
// named
static const char more[] =
    "WITH n(i) AS (SELECT id FROM session WHERE id <= 10) INSERT INTO trial SELECT 1000 + i, i, i, 50, 'main', "
    "'null',"
    " 'atrium', '{}', '{\"epsilon\":0.2}', 1, 1, 'a', 'b', NULL, 1, NULL, 'done', 1, 0, 1 FROM n;"
    "INSERT INTO choice SELECT NULL, id, segment_id, iif(id = 1001, 'b', 'a'), NULL, 1, 1, 0 FROM trial WHERE "
    "kind = "
    "'null';"
    "WITH n(i) AS (SELECT id FROM session WHERE id <= 4 OR id = 22) INSERT INTO trial SELECT 2000 + i, i, i, "
    "51, 'main',"
    " 'catch', 'atrium', '{}', '{\"epsilon\":0.2}', 2, 1, 'a', 'b', NULL, 1, NULL, 'done', 1, 0, 1 FROM n;"
    "INSERT INTO choice SELECT NULL, id, segment_id, iif(id IN (2003, 2022), 'a', 'b'), iif(id = 2022, 0, "
    "NULL), 1, 1, 0"
    " FROM trial WHERE kind = 'catch';"
    "INSERT INTO trial SELECT 3000 + id, id, id, 52, 'learn', 'practice', 'atrium', '{}', '{\"epsilon\":0.2}', "
    "2, 1, 'a',"
    " 'a', NULL, 1, NULL, 'done', 1, 0, 1 FROM session;"
    "INSERT INTO choice SELECT NULL, id, segment_id, 'a', NULL, 1, 1, 0 FROM trial WHERE kind = 'practice';"
    "INSERT INTO trial VALUES(4021, 21, 21, 53, 'learn', 'practice', 'town', '{}', '{}', 1, NULL, NULL, NULL, "
    "NULL, 1,"
    " NULL, 'done', 1, 0, 1);"
    "INSERT INTO rating VALUES(NULL, 4021, NULL, 21, 'How good does it look?', 'a', 1, 5, 1, 10, 5);"
    "INSERT INTO exclusion VALUES(NULL, 21, NULL, NULL, 'reaction', 'late', 'thought of too late', 'fovstudy', "
    "'2026'),"
    "(NULL, 33, NULL, NULL, 'gaze_loss:rating_pair', 'planned', 'r', 'fovstudy', '2026'),"
    "(NULL, 34, NULL, NULL, 'gaze_loss:rating_pair', 'planned', 'its pair', 'fovstudy', '2026'),"
    "(NULL, 41, NULL, NULL, 'gaze_loss:rating_pair', 'planned', 'r', 'fovstudy', '2026')";

static int enter_folder(void **state)
{
    if (program_enter_folder(state) != 0)
        return -1;
    study_file_make("s.db", &(struct study_desc){.excluded = true});
    study_file_sql("s.db", more);
    study_file_make("plain.db", &(struct study_desc){.pooled = false});
    return 0;
}

static char *tool(const char *name, const char *db)
{
    const char *argv[] = {fovstats, name, db, "--json", NULL};
    struct program_result r = program_run(argv, NULL);
    assert_int_equal(r.code, 0);
    free(r.err);
    return r.out;
}

static char *page_of(const char *db)
{
    const char *argv[] = {fovstats, "report", db, "-o", "r.html", NULL};
    struct program_result r = program_run(argv, NULL);
    if (r.code != 0)
        fail_msg("%s", r.err);
    program_free(&r);
    FILE *file = fopen("r.html", "r");
    char *text = calloc(1, 4 << 20);
    assert_non_null(file);
    assert_non_null(text);
    assert_true(fread(text, 1, (4 << 20) - 1, file) > 0);
    fclose(file);
    return text;
}

static void expect(const char *page, const char *part)
{
    if (!strstr(page, part))
        fail_msg("\"%s\" is not there", part);
}

static void only_answers_count(void **state)
{
    (void)state;
    char *json = tool("choices", "s.db");
    const char *cell = strstr(json, "\"epsilon\":0.2}");
    assert_non_null(cell);
    expect(cell,
           "\"k\":5,\"n\":20,"); // of 6 in 22 without person 22 and the late one; nothing of practice and null
    expect(json, "\"k\":4,\"n\":19,");
    free(json);
    json = tool("ratings", "s.db");
    expect(json, "\"n\":10,"); // person 3's pair is out, person 21 has none
    assert_null(strstr(json, "\"n\":11,"));
    free(json);
}

static void what_was_left_out_is_said(void **state)
{
    (void)state;
    char *page = page_of("s.db");
    expect(page, "<li>excluded sessions: 1</li>");
    expect(page, "<li>answers to excluded trials: 1</li>");
    expect(page, "<li>ratings in excluded trials: 2</li>");
    expect(page, "<li>ratings in practice, catch and null trials: 1</li>");
    free(page);
}

static void null_and_catch_trials_have_a_table(void **state)
{
    (void)state;
    char *page = page_of("s.db");
    // 9 of 10: 2 (10 + 1) / 1024, Clopper and Pearson 1934: 0.555 to 0.997
    expect(page, "Slot a was chosen in 9 of 10 (90.0\u00a0%, 95\u00a0% interval 55.5 to 99.7\u00a0%, exact p = "
                 "0.0215, with Holm\u2019s correction for these two checks 0.0430)");
    expect(page, "The option shown first was chosen in 1 of 10");
    expect(page, "Of 5 catch trials with an obvious difference 2 were missed.");
    expect(page, "<th scope=\"row\" class=\"word\">P03</th><td>1 of 1</td><td>1 of 1</td>");
    expect(page, "<th scope=\"row\" class=\"word\">P04</th><td>1 of 1</td><td>0 of 1</td>");
    expect(page, "<th scope=\"row\" class=\"word\">P22 (excluded)</th><td>\u2013</td><td>1 of 1</td>");
    const char *table = strstr(page, "Null and catch trials per person");
    assert_non_null(table);
    assert_true(strstr(table, ">P12</th>") > strstr(table, "</table>")); // who had none is in later tables only
    free(page);
    page = page_of("plain.db");
    assert_null(strstr(page, "Null and catch trials"));
    assert_null(strstr(page, "What if"));
    free(page);
}

// What the schema permits and no program of ours writes: such trials say nothing, and are counted.
static void what_is_not_known_is_left_out(void **state)
{
    (void)state;
    study_file_make("u.db", &(struct study_desc){.excluded = true});
    study_file_sql("u.db", more);
    study_file_sql("u.db", "UPDATE trial SET first_shown = NULL WHERE id BETWEEN 1001 AND 1004;"
                           "UPDATE trial SET test_slot = NULL WHERE id BETWEEN 2001 AND 2003;"
                           "UPDATE choice SET chosen = 'equal' WHERE trial_id = 2001");
    char *page = page_of("u.db");
    // 0 of 6: 2 / 64 = 0.03125, and 1 - 0.025^(1/6); slot a as before, 0.0215 twice
    expect(page,
           "The option shown first was chosen in 0 of 6 (0.0\u00a0%, 95\u00a0% interval 0.0 to 45.9\u00a0%, "
           "exact p = 0.0313, with Holm\u2019s correction for these two checks 0.0430)");
    expect(page, "Choices in null trials were held against one half by the exact ");
    expect(page, "In 4 of 10 null trials it is not recorded which option was shown first");
    expect(page, "Of 3 catch trials with an obvious difference 2 were missed. Catch trials left out, since the "
                 "file does not tell which answer was right: 2.");
    free(page);
    study_file_sql("u.db", "UPDATE trial SET first_shown = NULL WHERE kind = 'null'");
    page = page_of("u.db");
    expect(page, "exact p = 0.0215). A large p");
    expect(page, "In 10 of 10 null trials it is not recorded which option was shown first");
    assert_null(strstr(page, "The option shown first was chosen"));
    free(page);
    // Persons 1 to 10 answered 20 trials, 5 of each cell for slot a, which was shown first.
    study_file_make("u.db", &(struct study_desc){.pooled = false});
    study_file_sql("u.db", "UPDATE trial SET first_shown = NULL WHERE session_id > 10");
    page = page_of("u.db");
    expect(page, "Of all 41 answers for an option, counted as they are: the one shown first was chosen in 10 "
                 "(50\u00a0%), ");
    expect(page, " Of 21 it is not known which was shown first.");
    free(page);
    char *json = tool("choices", "u.db");
    expect(json, "\"chosen_first_shown\":10,\"first_shown_known\":20,");
    free(json);
}

// Each test under all data, these rules, and stricter ones.
static void what_if(void **state)
{
    (void)state;
    char *page = page_of("s.db");
    const char *table = strstr(page, "<h3>What if</h3>");
    assert_non_null(table);
    const char *row = strstr(table, "\u03b5 0.2</th>");
    assert_non_null(row);
    char *line = strndup(row, strcspn(row, "\n"));
    expect(line,
           "<td>6 of 22</td><td>0.0525</td><td>5 of 20</td><td>0.0414</td><td>4 of 19</td><td>0.0192</td>");
    free(line);
    row = strstr(table, "\u03b5 0.05</th>");
    assert_non_null(row);
    line = strndup(row, strcspn(row, "\n"));
    expect(line, "<td>4 of 19</td>");
    expect(line, "<td>3 of 18</td>");
    free(line);
    // Thurstone's case V, 1 JOD at 75 %: qnorm(k / n) / qnorm(3 / 4) of 6 of 22, 5 of 20 and 4 of 19 in R
    expect(table, "<td>-0.90 JOD</td><td>\u2013</td><td>-1.00 JOD</td><td>\u2013</td><td>-1.19 JOD</td>");
    expect(table, ">scale, main: ");
    expect(table, ": first ratings, regular minus ");
    expect(table, "(n 20)"); // all data: 11 and 9
    expect(table, "(n 19)"); // these rules: without person 3
    expect(table, "(n 18)"); // and stricter, without person 1
    free(page);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(only_answers_count),
        cmocka_unit_test(what_was_left_out_is_said),
        cmocka_unit_test(null_and_catch_trials_have_a_table),
        cmocka_unit_test(what_is_not_known_is_left_out),
        cmocka_unit_test(what_if),
    };
    return cmocka_run_group_tests_name("exclusions", tests, enter_folder, program_leave_folder);
}
