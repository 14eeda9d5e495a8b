// The report's words: methods that were used and no others, numbers that agree, one and many.
#include "program.h"
#include "said.h"
#include "staircase_file.h"
#include "study_file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static const char fovstats[] = BUILD_DIR "/bin/fovstats";

enum { PAGE_SIZE = 4 << 20 };

#define FOVSTATS(...) program_run((const char *const[]){fovstats, __VA_ARGS__, NULL}, NULL)

static char *page(void)
{
    unlink("r.html");
    struct program_result r = FOVSTATS("report", "s.db", "-o", "r.html");
    if (r.code != 0 || r.err[0])
        fail_msg("exit %d: %s", r.code, r.err);
    program_free(&r);
    char *text = calloc(1, PAGE_SIZE);
    FILE *file = fopen("r.html", "r");
    assert_non_null(text);
    assert_non_null(file);
    assert_true(fread(text, 1, PAGE_SIZE - 1, file) > 0);
    fclose(file);
    return text;
}

// Of the report of s.db, of its section "Methods" alone where `methods`.
static void expect_in(bool methods, const char *const *has, const char *const *lacks)
{
    char *whole = page(), *text = whole;
    if (methods) {
        text = strstr(whole, "<h2>Methods</h2>");
        assert_non_null(text);
        char *end = strstr(text + 1, "<h2>");
        assert_non_null(end);
        *end = '\0';
    }
    for (size_t i = 0; has[i]; i++)
        if (!strstr(text, has[i]))
            fail_msg("\"%s\" is missing in: %s", has[i], methods ? text : "the page");
    for (size_t i = 0; lacks[i]; i++)
        if (strstr(text, lacks[i]))
            fail_msg("\"%s\" should not stand in: %s", lacks[i], methods ? text : "the page");
    free(whole);
}

static void expect(const char *const *has, const char *const *lacks)
{
    expect_in(true, has, lacks);
}

static const char *const scales[] = {"Psychometric", "staircase",       "QUEST+",
                                     "Sch\u00fctt",  "set a parameter", NULL};

static void one_answer_each(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    expect((const char *const[]){"exact two-sided binomial test", "McNemar", "Fay and Lumbard", "Welch",
                                 "Wilcoxon", "Thurstone", "Each cell was tested by itself", "Cohen", NULL},
           (const char *const[]){"Fisher", "Cochran", "exchanging", "Newcombe", "variance", "Ratings of both",
                                 "mixed model", "null trials", "joined", "join cells", "per person and cell",
                                 NULL});
    expect((const char *const[]){NULL}, scales);
}

static void without_ratings(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    study_file_sql("s.db", "DELETE FROM rating");
    expect((const char *const[]){"McNemar", NULL},
           (const char *const[]){"Welch", "Wilcoxon", "Cohen", "atings", NULL});
}

// Two ratings are too few for any t-test.
static void what_was_recorded_but_not_analysed(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    study_file_sql("s.db", "DELETE FROM rating WHERE segment_id > 1");
    expect((const char *const[]){"McNemar", NULL},
           (const char *const[]){"Welch", "Wilcoxon", "Cohen", "atings", NULL});
}

// Nobody answers both cells: nothing within people, and a test between them.
static void a_factor_between_people(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    study_file_sql("s.db",
                   "DELETE FROM choice WHERE trial_id IN (SELECT id FROM trial WHERE kind = 'toggle' AND "
                   "(id % 10 = 1) = (session_id % 2 = 0)); "
                   "DELETE FROM trial WHERE kind = 'toggle' AND id NOT IN (SELECT trial_id FROM choice)");
    expect((const char *const[]){"Fisher", "Newcombe", NULL},
           (const char *const[]){"McNemar", "Fay", "Cochran", NULL});
}

static void cells_that_the_plan_joins(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    study_file_sql("s.db", "UPDATE session SET settings = json_set(settings, '$.planned', json('["
                           "{\"method\":\"binomial\",\"of\":\"choice\",\"per\":\"study\"},"
                           "{\"method\":\"binomial\",\"of\":\"choice\",\"per\":\"scene\"}]'))");
    expect((const char *const[]){"Planned analyses per scene and per study join cells", NULL},
           (const char *const[]){"never joined", "per factor", NULL});
}

static void thresholds_and_scales(void **state)
{
    (void)state;
    staircase_file_make("s.db");
    expect((const char *const[]){"staircase\u2019s threshold is the mean of its last reversals",
                                 "Psychometric functions (logistic, maximum likelihood) were fitted to each "
                                 "person\u2019s answers, and to those of all people together",
                                 "guess fixed at one half", "both asymptotes free", "Sch\u00fctt",
                                 "What people set a parameter to", "QUEST+", NULL},
           (const char *const[]){"Welch", "Fisher", NULL});
}

// The bar is the mean of people's shares, so the count of all answers does not stand beside it, and numbers
// stand where no interval strikes them through.
static void a_mean_share_is_no_pooled_one(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){.several = true, .equal = true});
    study_file_sql("s.db", "UPDATE choice SET chosen = 'equal' WHERE segment_id = 22");
    expect_in(false,
              (const char *const[]){">n 21</text>", ">mean share</th>", "Under the bars: percent",
                                    "<td>189</td><td>21</td>",
                                    "it is not chosen of n where some answered more than others", NULL},
              (const char *const[]){"/189</text>", "<td>189</td><td>22</td>", "In the bars: percent", NULL});
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    expect_in(false, (const char *const[]){">6/22</text>", ">share</th>", "In the bars: percent", NULL},
              (const char *const[]){"mean share", "Under the bars", NULL});
}

static void one_and_none_are_said_as_such(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    study_file_even("s.db");
    expect_in(
        false,
        (const char *const[]){"None of the 2 cells lies outside the 95\u00a0% region of the null hypothesis. "
                              "They show no clear preference",
                              "41 comparisons by 22 people", NULL},
        (const char *const[]){"other cells", "none remains", NULL});
    study_file_sql("s.db", "DELETE FROM choice WHERE id > 1");
    expect_in(false,
              (const char *const[]){"The one cell does not lie outside the 95\u00a0% region of the null "
                                    "hypothesis. It shows no clear preference",
                                    "1 comparison by 1 person<", "Of all 1 answer for an option", NULL},
              (const char *const[]){"other cell", "1 comparisons", "1 people", NULL});
    said_done(FOVSTATS("jod", "s.db"), "main: 1 comparison by 1 person, too few for intervals");
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    expect_in(false,
              (const char *const[]){"Of 2 cells, 1 lies outside", "The other cell shows", "it remains", NULL},
              (const char *const[]){"other cells", NULL});
}

// A title came with the plans: without one nobody knows whether something was planned.
static void why_nothing_was_planned(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    expect_in(false,
              (const char *const[]){"no analysis, or the sessions were recorded by an early build", NULL},
              (const char *const[]){NULL});
    study_file_sql("s.db", "UPDATE session SET settings = json_set(settings, '$.title', 'Small', '$.planned', "
                           "json('[]'))");
    expect_in(false, (const char *const[]){"<p>None: the protocol planned no analysis.</p>", NULL},
              (const char *const[]){"early build", NULL});
    said_sentence(FOVSTATS("planned", "s.db"), 1, "s.db: the protocol planned no analysis\n");
}

// Ratings over factors of which none can be analysed: one sentence that says why, and nothing on stdout.
static void no_analysis_of_variance(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    study_file_sql("s.db", "UPDATE trial SET factors = '{\"scene\":\"town\"}' WHERE kind = 'rate'");
    static const char why[] =
        "How good does it look?, block rate: no analysis of 42 ratings of 22 participants";
    said_sentence(FOVSTATS("anova", "s.db"), 1, why);
    said_sentence(FOVSTATS("anova", "s.db", "--json"), 1, "there is no factor with two levels to compare");
}

static void what_numbers_are_not(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    expect_in(false,
              (const char *const[]){
                  "options that were shown in different scenes are not compared by it, but by "
                  "the last table of this section",
                  "they are not the counts of all answers", "so that percentages there differ", NULL},
              (const char *const[]){NULL});
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_answer_each),
        cmocka_unit_test(without_ratings),
        cmocka_unit_test(what_was_recorded_but_not_analysed),
        cmocka_unit_test(a_factor_between_people),
        cmocka_unit_test(cells_that_the_plan_joins),
        cmocka_unit_test(thresholds_and_scales),
        cmocka_unit_test(a_mean_share_is_no_pooled_one),
        cmocka_unit_test(one_and_none_are_said_as_such),
        cmocka_unit_test(why_nothing_was_planned),
        cmocka_unit_test(no_analysis_of_variance),
        cmocka_unit_test(what_numbers_are_not),
    };
    return cmocka_run_group_tests(tests, program_enter_folder, program_leave_folder);
}
