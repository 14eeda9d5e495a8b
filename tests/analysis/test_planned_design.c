// Planned tests between and within people: the trials that sessions planned decide, not who happened to answer.
// Numbers against R (tests/reference/planned.R).
#include "planned_study.h"
#include "program.h"
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

#define FACTOR PLAN("unpaired_t", "toggles", "factor", "") "," PLAN("paired_t", "toggles", "factor", "") ","

// The study of planned.R whose first `single` people were to see one of the two cells, by turns.
static void make(int single)
{
    char sql[512];
    study_file_make("s.db", &(struct study_desc){0});
    snprintf(sql, sizeof sql,
             "UPDATE choice SET toggles = trial_id * 7 %% 11; CREATE TEMP TABLE gone AS SELECT id FROM trial "
             "WHERE block = 'main' AND id / 10 <= %d AND id %% 10 = 1 + id / 10 %% 2; DELETE FROM frame WHERE "
             "trial_id IN gone; DELETE FROM exposure WHERE trial_id IN gone; DELETE FROM choice WHERE trial_id "
             "IN gone; DELETE FROM trial WHERE id IN gone",
             single);
    study_file_sql("s.db", sql);
}

static void expect_refused(const struct planned_row *row, const char *note)
{
    assert_string_equal(row->note, note);
    assert_true(isnan(row->p_value) && isnan(row->estimate) && isnan(row->low) && row->test[0] == '\0');
}

// Eight people at both levels, five with values of both, are no study within people.
static void strays_are_left_out_and_said(void **state)
{
    (void)state;
    struct planned_study l;
    double worst = 0;
    make(14);
    planned_study_plan(
        FACTOR PLAN("anova", "toggles", "factor", "") "," PLAN("unpaired_t", "toggles", "cell", ""));
    planned_study_load(&l);
    assert_int_equal(l.planned.row_count, 4);
    l.planned.rows[0].holm = l.planned.rows[3].holm = l.planned.rows[0].p_value; // one test twice
    planned_study_compare(&l.planned.rows[0], "strays unpaired_t toggles", &worst);
    planned_study_compare(&l.planned.rows[3], "strays unpaired_t toggles", &worst); // its cells
    for (size_t i = 0; i < 4; i += 3) {
        assert_true(l.planned.rows[i].people == 17 && l.planned.rows[i].left_out == 5);
        assert_string_equal(l.planned.rows[i].note, "left out, people with values at several levels: 5");
    }
    expect_refused(
        &l.planned.rows[1],
        "not computed: 14 people were to answer at one level and 8 at several, so that it lies between "
        "people; an unpaired test is theirs");
    expect_refused(&l.planned.rows[2],
                   "not computed: epsilon lies between people (14 were to answer at one of its levels, 8 at "
                   "several), and factors between people are not analysed");
    planned_study_free(&l);
}

// Most people stopped before the second level, which all of them were to see.
static void dropouts_are_left_out_and_said(void **state)
{
    (void)state;
    struct planned_study l;
    double worst = 0;
    make(0);
    study_file_sql(
        "s.db", "CREATE TEMP TABLE gone AS SELECT id FROM trial WHERE block = 'main' AND id / 10 > 8 AND id % "
                "10 = 2; DELETE FROM choice WHERE trial_id IN gone; UPDATE trial SET status = 'planned', "
                "segment_id = NULL, started_ns = NULL, ended_ns = NULL, attempt = 0 WHERE id IN gone");
    planned_study_plan(FACTOR PLAN("anova", "toggles", "factor", ""));
    planned_study_load(&l);
    assert_int_equal(l.planned.row_count, 3);
    expect_refused(
        &l.planned.rows[0],
        "not computed: 0 people were to answer at one level and 22 at several, so that it lies within "
        "people; a paired test is theirs");
    planned_study_compare(&l.planned.rows[1], "dropouts paired_t toggles", &worst);
    planned_study_compare(&l.planned.rows[2], "dropouts anova toggles", &worst);
    for (size_t i = 1; i < 3; i++)
        assert_true(l.planned.rows[i].people == 8 && l.planned.rows[i].left_out == 14);
    assert_string_equal(l.planned.rows[1].note, "left out, people without values of both: 14");
    assert_string_equal(l.planned.rows[2].note, "left out, people without a value in every cell: 14");
    planned_study_free(&l);
    struct program_result r =
        program_run((const char *const[]){fovstats, "planned", "s.db", "--json", NULL}, NULL);
    assert_int_equal(r.code, 0);
    assert_true(said_after(r.out, "\"paired_t\"", "people_left_out") == 14);
    program_free(&r);
}

// As many people at both levels as at one are enough.
static void half_of_the_people_decide(void **state)
{
    (void)state;
    for (int single = 10; single <= 12; single++) {
        struct planned_study l;
        make(single);
        planned_study_plan(FACTOR PLAN("anova", "toggles", "factor", ""));
        planned_study_load(&l);
        const bool within = single <= 11;
        assert_int_equal(l.planned.row_count, 3);
        assert_int_equal(isnan(l.planned.rows[0].p_value), within);
        assert_int_equal(isnan(l.planned.rows[1].p_value), !within);
        assert_int_equal(isnan(l.planned.rows[2].p_value), !within);
        planned_study_free(&l);
    }
}

// Cells of a factor between people and one within: two cells lie between people as soon as they differ in the
// first, and nobody is a stray for having seen both levels of the second.
static void cells_follow_the_factors_in_which_they_differ(void **state)
{
    (void)state;
    struct planned_study l;
    make(0);
    study_file_sql("s.db", "UPDATE trial SET factors = json_set(factors, '$.hand', iif(session_id % 2, 'left', "
                           "'right')) WHERE block = 'main'");
    planned_study_plan(PLAN("unpaired_t", "toggles", "cell", "") "," PLAN("paired_t", "toggles", "cell", ""));
    planned_study_load(&l);
    assert_int_equal(l.planned.row_count, 12); // six pairs each
    size_t unpaired = 0, paired = 0;
    for (size_t i = 0; i < 12; i++) {
        const struct planned_row *row = &l.planned.rows[i];
        bool hands_differ = strstr(row->words, "left") && strstr(row->words, "right");
        assert_int_equal(isnan(row->p_value), hands_differ != (i < 6));
        unpaired += i < 6 && !isnan(row->p_value) && row->left_out == 0;
        paired += i >= 6 && !isnan(row->p_value);
    }
    assert_true(unpaired == 4 && paired == 2);
    planned_study_free(&l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(strays_are_left_out_and_said),
        cmocka_unit_test(dropouts_are_left_out_and_said),
        cmocka_unit_test(half_of_the_people_decide),
        cmocka_unit_test(cells_follow_the_factors_in_which_they_differ),
    };
    return cmocka_run_group_tests(tests, program_enter_folder, program_leave_folder);
}
