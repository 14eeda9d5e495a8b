// Results of planned analyses against R (tests/reference/planned.R), and what is said where there is none.
#include "planned_study.h"
#include "program.h"
#include "study_file.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static const char everything[] =
    PLAN("binomial", "choice", "cell", ",\"margin\":0.2") "," PLAN("binomial", "choice", "study", "") "," PLAN(
        "mean", "toggles", "study",
        "") "," PLAN("mean", "reaction", "cell",
                     "") "," PLAN("paired_t", "choice", "factor",
                                  "") "," PLAN("anova", "choice", "factor",
                                               "") "," PLAN("paired_t", "rating", "order",
                                                            "") "," PLAN("unpaired_t", "rating", "order", "");

static void results_agree_with_r(void **state)
{
    (void)state;
    static const char *const names[] = {
        "binomial choice cell 0.2", "equality cell 0.2",          "binomial choice cell 0.05",
        "equality cell 0.05",       "binomial choice study",      "mean toggles study",
        "mean reaction cell 0.2",   "mean reaction cell 0.05",    "paired_t choice factor",
        "anova choice factor",      "paired_t rating order test", "paired_t rating order regular",
        "unpaired_t rating order"};
    struct planned_study l;
    double worst = 0;
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    planned_study_plan(everything);
    planned_study_load(&l);
    assert_int_equal(l.planned.row_count, 13);
    assert_int_equal(l.planned.tested, 10);
    assert_int_equal(planned_equality(&l.planned), 2);
    for (size_t i = 0; i < 13; i++)
        planned_study_compare(&l.planned.rows[i], names[i], &worst);
    assert_true(fabs(l.planned.rows[1].conf - 0.9) < 1e-12 && l.planned.rows[0].conf == 0.95);
    assert_int_equal(l.planned.rows[5].people, 22);
    assert_int_equal(l.planned.rows[4].partial, 3); // whose trials in one cell are invalid
    print_message("largest relative difference from R %.2g\n", worst);
    planned_study_free(&l);
}

static void people_of_two_groups_are_compared_between(void **state)
{
    (void)state;
    struct planned_study l;
    double worst = 0;
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    study_file_sql("s.db", "DELETE FROM choice WHERE trial_id % 10 = 2; UPDATE trial SET factors = "
                           "json_object('hand', iif(session_id % 2, 'a', 'b')) WHERE block = 'main'");
    planned_study_plan(
        PLAN("unpaired_t", "reaction", "factor", "") "," PLAN("paired_t", "reaction", "factor", ""));
    planned_study_load(&l);
    assert_int_equal(l.planned.row_count, 2);
    l.planned.rows[0].holm = l.planned.rows[0].p_value; // one test: nothing to adjust
    planned_study_compare(&l.planned.rows[0], "unpaired_t reaction factor odd", &worst);
    assert_true(isnan(l.planned.rows[1].p_value) && isnan(l.planned.rows[1].estimate));
    assert_string_equal(l.planned.rows[1].note,
                        "not computed: 22 people were to answer at one level and 0 at several, so that it lies "
                        "between people; an unpaired test is theirs");
    planned_study_free(&l);
}

static void what_cannot_be_computed_says_why(void **state)
{
    (void)state;
    static const struct {
        const char *plan, *says;
    } cases[] = {
        {PLAN("binomial", "rating", "cell", ""), "a binomial test counts choices"},
        {PLAN("mean", "toggles", "order", ""), "only ratings before and after have an order"},
        {PLAN("anova", "rating", "cell", ""), "plan it per factor"},
        {PLAN("unpaired_t", "choice", "study", ""), "all people together are one group"},
        {PLAN("paired_t", "toggles", "-", ""), "one value per person makes no pair"},
        {PLAN("mean", "threshold", "scene", ""), "no such value was recorded that counts"},
        {PLAN("paired_t", "adjusted", "factor", ""), "no such value was recorded that counts"},
        {PLAN("unpaired_t", "toggles", "factor", ""),
         "22 at several, so that it lies within people; a paired test is theirs"},
        {PLAN("paired_t", "choice", "scene", ""), "it compares two, and the data have one alone"},
        {PLAN("anova", "toggles", "factor", ""), "no spread within people"},
    };
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct planned_study l;
        planned_study_plan(cases[i].plan);
        planned_study_load(&l);
        if (l.planned.row_count != 1 || !strstr(l.planned.rows[0].note, cases[i].says))
            fail_msg("%s: %zu rows, \"%s\"", cases[i].plan, l.planned.row_count,
                     l.planned.row_count ? l.planned.rows[0].note : "");
        assert_true(isnan(l.planned.rows[0].p_value));
        planned_study_free(&l);
    }
}

// All that the language permits has a row: a number, or a sentence.
static void nothing_planned_is_left_without_a_row(void **state)
{
    (void)state;
    static const char *const methods[] = {"binomial", "paired_t", "unpaired_t", "mean", "anova"},
                             *const ofs[] = {"choice",   "rating",   "toggles",
                                             "reaction", "adjusted", "threshold"},
                             *const pers[] = {"-", "cell", "factor", "order", "scene", "study"};
    for (int several = 0; several < 2; several++) {
        study_file_make("s.db", &(struct study_desc){.several = several == 1, .equal = true});
        for (int i = 0; i < 5 * 6 * 6; i++) {
            struct planned_study l;
            char text[256];
            snprintf(text, sizeof text, "{\"method\":\"%s\",\"of\":\"%s\",\"per\":\"%s\"}", methods[i / 36],
                     ofs[i / 6 % 6], pers[i % 6]);
            planned_study_plan(text);
            planned_study_load(&l);
            if (l.planned.row_count == 0)
                fail_msg("%s has no row", text);
            for (size_t k = 0; k < l.planned.row_count; k++) {
                const struct planned_row *row = &l.planned.rows[k];
                if (isnan(row->estimate) && !row->note[0])
                    fail_msg("%s: %s has neither number nor reason", text, row->words);
                if (!isnan(row->p_value) && !(row->p_value >= 0 && row->p_value <= 1 && row->test[0]))
                    fail_msg("%s: %s has p %g by \"%s\"", text, row->words, row->p_value, row->test);
            }
            planned_study_free(&l);
        }
    }
}

// Two versions of a protocol with different margins: nobody but people can say which holds.
static void different_margins_are_no_margin(void **state)
{
    (void)state;
    struct planned_study l;
    bool differ;
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    planned_study_plan(PLAN("binomial", "choice", "scene",
                            ",\"margin\":0.3") "," PLAN("binomial", "choice", "cell", ",\"margin\":0.1"));
    planned_study_load(&l);
    assert_true(plans_margin(&l.plans, &differ) == 0.1 && !differ); // the cells'
    planned_study_free(&l);
    study_file_sql("s.db",
                   "UPDATE session SET settings = json_set(settings, '$.planned[1].margin', 0.15) WHERE id "
                   "> 11");
    planned_study_load(&l);
    assert_true(isnan(plans_margin(&l.plans, &differ)) && differ);
    assert_int_equal(l.plans.count, 3);
    planned_study_free(&l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(results_agree_with_r),
        cmocka_unit_test(people_of_two_groups_are_compared_between),
        cmocka_unit_test(what_cannot_be_computed_says_why),
        cmocka_unit_test(nothing_planned_is_left_without_a_row),
        cmocka_unit_test(different_margins_are_no_margin),
    };
    return cmocka_run_group_tests(tests, program_enter_folder, program_leave_folder);
}
