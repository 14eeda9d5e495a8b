// Whether a factor lies between or within people, from cells in memory and from study files.
#include "factor_study.h"
#include "program.h"
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

static void strays_are_said(void **state)
{
    (void)state;
    struct factor_study s;
    factor_study_make(&s, "between2");
    factor_study_stray(&s, 20, 3); // several answers, of nobody who is tested: still one answer each
    struct choice_factors f = factor_study_load(&s, 1);
    assert_int_equal(f.tests[0].method, FACTOR_FISHER);
    assert_true(f.tests[0].design.one == 17 && f.tests[0].design.several == 1);
    char note[CHOICE_FACTOR_NOTE], words[CHOICE_FACTOR_WORDS];
    choice_factor_words(&f.tests[0], words);
    choice_factor_note(&f.tests[0], note);
    assert_string_equal(words, "a 1 and 2");
    assert_string_equal(note,
                        "17 people were to answer at one level and 1 at several, so it is compared between "
                        "people; left out, people with answers at several levels: 1");
    choice_factors_free(&f);
    factor_study_make(&s, "several2"); // nor do they make a contrast of two people
    factor_study_stray(&s, 20, 10);
    factor_study_stray(&s, 21, 10);
    for (int l = 0; l < 2; l++)
        s.cells[l].several = true;
    assert_true(choices_contrast(&s.choices));
    assert_int_equal(s.choices.contrast_count, 0);
    free(s.choices.contrasts);
}

// Many who stopped after the first level do not make a factor one between people.
static void dropouts_change_nothing(void **state)
{
    (void)state;
    struct factor_study s, all;
    factor_study_make(&all, "within2");
    factor_study_make(&s, "within2");
    for (int p = 19; p < FACTOR_STUDY_PEOPLE; p++) {
        factor_study_plan(&s, p, 1);
        factor_study_plan(&s, p, 2);
        factor_study_answer(&s, p, 1, 1, 1);
    }
    struct choice_factors f = factor_study_load(&s, 1), g = factor_study_load(&all, 1);
    assert_int_equal(f.tests[0].method, FACTOR_MCNEMAR);
    assert_true(f.tests[0].people == 17 && f.tests[0].left_out == 12 && g.tests[0].left_out == 1);
    assert_true(f.tests[0].p_value == g.tests[0].p_value && f.tests[0].ci.low == g.tests[0].ci.low);
    assert_true(f.tests[0].design.one == 0 && f.tests[0].design.within);
    choice_factors_free(&f);
    choice_factors_free(&g);
}

// Half of the people decide: as many at several levels as at one make it a factor within people.
static void most_people_decide(void **state)
{
    (void)state;
    for (size_t strays = 8; strays <= 10; strays++) {
        struct factor_study s;
        factor_study_make(&s, "several2"); // nine people at one level
        for (int l = 0; l < 2; l++)
            for (size_t i = 0; i < s.cells[l].people; i++)
                s.counts[l][i] = (struct stat_person){(int64_t)i % 2, 1};
        for (int i = 0; i < (int)strays; i++)
            factor_study_stray(&s, 12 + i, 1);
        const bool within = strays >= 9;
        struct choice_factors f = factor_study_load(&s, 1);
        assert_true(f.tests[0].design.one == 9 && f.tests[0].design.several == strays);
        assert_int_equal(f.tests[0].method, within ? FACTOR_MCNEMAR : FACTOR_FISHER);
        assert_int_equal(f.tests[0].people, within ? strays : 9);
        assert_int_equal(f.tests[0].left_out, within ? 9 : strays);
        choice_factors_free(&f);
    }
}

static struct program_result choices_of(const char *path, bool json)
{
    struct program_result r =
        program_run((const char *const[]){fovstats, "choices", path, json ? "--json" : NULL, NULL}, NULL);
    assert_int_equal(r.code, 0);
    return r;
}

// A file in which people were to answer at one of two levels, three of them at both, and one in which all were
// to answer at both and most stopped after the first: the plan decides, though no answers tell one from the
// other.
static void the_plan_in_the_file_decides(void **state)
{
    (void)state;
    study_file_make("between.db", &(struct study_desc){0});
    study_file_sql("between.db",
                   "CREATE TEMP TABLE gone AS SELECT id FROM trial WHERE block = 'main' AND id / 10 > 3 AND"
                   " id % 10 = 1 + id / 10 % 2; DELETE FROM exposure WHERE trial_id IN gone;"
                   " DELETE FROM frame WHERE trial_id IN gone; DELETE FROM choice WHERE trial_id IN gone;"
                   " DELETE FROM trial WHERE id IN gone");
    struct program_result r = choices_of("between.db", true);
    assert_non_null(strstr(r.out, "\"method\":\"Fisher\""));
    assert_non_null(strstr(r.out, "\"within_people\":false,\"people_planned_at_one_level\":19,"
                                  "\"people_planned_at_several_levels\":3"));
    assert_true(said_after(r.out, "factor_tests", "people_left_out") == 3);
    program_free(&r);
    r = choices_of("between.db", false);
    assert_non_null(
        strstr(r.out, "\nepsilon 0.2 and 0.05: 19 people were to answer at one level and 3 at several, so it "
                      "is compared between people; left out, people with answers at several levels: 3.\n"));
    program_free(&r);

    study_file_make("within.db", &(struct study_desc){0});
    study_file_sql("within.db",
                   "CREATE TEMP TABLE gone AS SELECT id FROM trial WHERE block = 'main' AND id / 10 > 3 AND"
                   " id % 10 = 2; DELETE FROM choice WHERE trial_id IN gone;"
                   " UPDATE trial SET status = 'planned', segment_id = NULL, started_ns = NULL,"
                   " ended_ns = NULL, attempt = 0 WHERE id IN gone");
    r = choices_of("within.db", true);
    assert_non_null(strstr(r.out, "\"method\":\"McNemar\""));
    assert_true(said_after(r.out, "factor_tests", "people") == 3);
    assert_true(said_after(r.out, "factor_tests", "people_left_out") == 19);
    assert_non_null(strstr(r.out, "\"within_people\":true,\"people_planned_at_one_level\":0,"
                                  "\"people_planned_at_several_levels\":22"));
    program_free(&r);

    study_file_sql("within.db",
                   "DELETE FROM choice WHERE trial_id IN (SELECT id FROM trial WHERE id / 10 < 4 AND id % 10 "
                   "= 1)"); // now nobody answered at both
    r = choices_of("within.db", false);
    assert_non_null(strstr(r.out, "\nepsilon 0.2 and 0.05: no test; nobody answered at both levels.\n"));
    program_free(&r);
    r = program_run((const char *const[]){fovstats, "report", "within.db", "-o", "within.html", NULL}, NULL);
    assert_int_equal(r.code, 0);
    static char page[1 << 20];
    FILE *file = fopen("within.html", "r");
    assert_non_null(file);
    page[fread(page, 1, sizeof page - 1, file)] = '\0';
    fclose(file);
    assert_non_null(
        strstr(page, "epsilon: 0.2 \u2212 0.05</th><td>0</td><td class=\"word\">McNemar</td><td class=\"word\" "
                     "colspan=\"6\">no test: nobody answered at both levels</td>"));
    assert_non_null(
        strstr(page, "<li>epsilon 0.2 and 0.05: left out, people without an answer at every level: 22.</li>"));
    program_free(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(strays_are_said),
        cmocka_unit_test(dropouts_change_nothing),
        cmocka_unit_test(most_people_decide),
        cmocka_unit_test(the_plan_in_the_file_decides),
    };
    return cmocka_run_group_tests(tests, program_enter_folder, program_leave_folder);
}
