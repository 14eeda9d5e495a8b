// The report's methods: what was done with these data, and nothing that was not.
#include "program.h"
#include "staircase_file.h"
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

enum { PAGE_SIZE = 4 << 20 };

// The section "Methods" of the report of s.db.
static char *methods(void)
{
    unlink("r.html");
    struct program_result r =
        program_run((const char *const[]){fovstats, "report", "s.db", "-o", "r.html", NULL}, NULL);
    if (r.code != 0 || r.err[0])
        fail_msg("exit %d: %s", r.code, r.err);
    program_free(&r);
    char *page = calloc(1, PAGE_SIZE);
    FILE *file = fopen("r.html", "r");
    assert_non_null(page);
    assert_non_null(file);
    assert_true(fread(page, 1, PAGE_SIZE - 1, file) > 0);
    fclose(file);
    char *start = strstr(page, "<h2>Methods</h2>");
    assert_non_null(start);
    char *end = strstr(start + 1, "<h2>");
    assert_non_null(end);
    *end = '\0';
    memmove(page, start, (size_t)(end - start) + 1);
    return page;
}

static void expect(const char *const *has, const char *const *lacks)
{
    char *text = methods();
    for (size_t i = 0; has[i]; i++)
        if (!strstr(text, has[i]))
            fail_msg("\"%s\" is missing in: %s", has[i], text);
    for (size_t i = 0; lacks[i]; i++)
        if (strstr(text, lacks[i]))
            fail_msg("\"%s\" was not done, but stands in: %s", lacks[i], text);
    free(text);
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
                                 "mixed model", "joined", "join cells", "per person and cell", NULL});
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_answer_each),
        cmocka_unit_test(without_ratings),
        cmocka_unit_test(what_was_recorded_but_not_analysed),
        cmocka_unit_test(a_factor_between_people),
        cmocka_unit_test(cells_that_the_plan_joins),
        cmocka_unit_test(thresholds_and_scales),
    };
    return cmocka_run_group_tests(tests, program_enter_folder, program_leave_folder);
}
