// Equality of cells in fovstats choices and in the report: one claim, one p and one verdict, by the family that
// it belongs to. Numbers against R (tests/reference/planned.R).
#include "analysis/report/choice_equivalence.h"

#include "planned_study.h"
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

static const char shown[] = "equality within the margin is shown", neither[] = "neither is shown";
static const char *const epsilons[] = {"0.2", "0.05"};

// The study is s.db. A cell's entry against the lines "NAME cell EPSILON" and "NAME equality EPSILON" of R.
static void expect_cell(const char *json, int cell, const char *name, const char *family, const char *verdict)
{
    char line[64], label[64];
    double difference[5], equality[5];
    snprintf(line, sizeof line, "%s cell %s", name, epsilons[cell]);
    planned_study_known(line, difference);
    snprintf(line, sizeof line, "%s equality %s", name, epsilons[cell]);
    planned_study_known(line, equality);
    snprintf(label, sizeof label, "\"cell\":\"epsilon %s\"", epsilons[cell]);
    const char *at = SAID_PLACE(json, "\"equivalence\":[", label);
    const struct {
        const char *key;
        double want;
    } numbers[] = {{"p_value", equality[3]},
                   {"p_holm", equality[4]},
                   {"p_holm_of_difference", difference[4]},
                   {"ci_low", equality[1]},
                   {"ci_high", equality[2]}};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++)
        if (!reference_close(said_after(at, "", numbers[i].key), numbers[i].want, 1e-9))
            fail_msg("%s, %s: R %.17g in %s", line, numbers[i].key, numbers[i].want, at);
    char mark[128];
    snprintf(mark, sizeof mark, "\"family\":\"%s\"", family);
    const char *end = strchr(at, '}'), *found = strstr(at, mark);
    if (!found || found > end)
        fail_msg("%s: no %s in %s", line, mark, at);
    snprintf(mark, sizeof mark, "\"shown\":\"%s\"", verdict);
    found = strstr(at, mark);
    if (!found || found > end)
        fail_msg("%s: no %s in %s", line, mark, at);
}

static void expect_cells(struct program_result r, const char *name, const char *family, const char *first,
                         const char *second)
{
    if (r.code != 0)
        fail_msg("exit %d: %s", r.code, r.err);
    expect_cell(r.out, 0, name, family, first);
    expect_cell(r.out, 1, name, family, second);
    program_free(&r);
}

static void make_even(const char *plans)
{
    study_file_make("s.db", &(struct study_desc){0});
    study_file_even("s.db");
    planned_study_plan(plans);
}

// 11 of 22 and 9 of 19: equality within 25 to 75 % has p 0.0100 and 0.0287. Holm's over these two alone would
// show both, beside tests of a difference that have a family of their own.
static void tests_of_cells_are_one_family(void **state)
{
    (void)state;
    make_even("");
    expect_cells(FOVSTATS("choices", "s.db", "--margin", "0.25", "--json"), "even 0.25", "cells", shown,
                 neither);
    expect_cells(FOVSTATS("choices", "s.db", "--margin", "0.2", "--json"), "even 0.2", "cells", neither,
                 neither);
    expect_cells(FOVSTATS("choices", "s.db", "--margin", "0.3", "--json"), "even 0.3", "cells", shown, shown);
}

// "At least one half" and "30 % at most" can both be true, so that each test counts.
static void one_sided_tests_do_not_exclude_each_other(void **state)
{
    (void)state;
    make_even("");
    expect_cells(FOVSTATS("choices", "s.db", "--margin", "0.25", "--alternative", "less", "--json"),
                 "less 0.25", "cells", shown, neither);
}

static void a_planned_claim_is_that_of_the_planned_analyses(void **state)
{
    (void)state;
    make_even(
        PLAN("binomial", "choice", "cell", ",\"margin\":0.25") "," PLAN("paired_t", "rating", "order", ""));
    expect_cells(FOVSTATS("choices", "s.db", "--json"), "rated 0.25", "planned", shown, neither);
    expect_cells(FOVSTATS("choices", "s.db", "--margin", "0.25", "--json"), "rated 0.25", "planned", shown,
                 neither);
    struct program_result r = FOVSTATS("planned", "s.db", "--json"), text = FOVSTATS("choices", "s.db");
    static const char *const words[] = {"\u03b5 0.2: equality", "\u03b5 0.05: equality"};
    for (int cell = 0; cell < 2; cell++) {
        char name[64];
        double of_r[5];
        snprintf(name, sizeof name, "rated 0.25 equality %s", epsilons[cell]);
        planned_study_known(name, of_r);
        assert_true(reference_close(said_after(r.out, words[cell], "p_holm"), of_r[4], 1e-9));
    }
    SAID_PLACE(r.out, words[0], "\"verdict\":\"equal\"");
    SAID_PLACE(r.out, words[1], "\"verdict\":\"undecided\"");
    SAID_PLACE(text.out, "Family planned: both are those of the planned analyses (fovstats planned)");
    assert_null(strstr(text.out, "Family cells"));
    program_free(&r);
    program_free(&text);
}

static void each_margin_has_its_own_rows(void **state)
{
    (void)state;
    make_even(PLAN("binomial", "choice", "cell", ",\"margin\":0.3") "," PLAN("binomial", "choice", "cell",
                                                                             ",\"margin\":0.25"));
    expect_cells(FOVSTATS("choices", "s.db", "--margin", "0.25", "--json"), "both 0.25", "planned", shown,
                 neither);
    expect_cells(FOVSTATS("choices", "s.db", "--margin", "0.3", "--json"), "both 0.3", "planned", shown, shown);
}

// What was planned is one margin, about one half: another claim has another family.
static void another_claim_is_not_the_planned_one(void **state)
{
    (void)state;
    make_even(
        PLAN("binomial", "choice", "cell", ",\"margin\":0.25") "," PLAN("paired_t", "rating", "order", ""));
    expect_cells(FOVSTATS("choices", "s.db", "--margin", "0.3", "--json"), "even 0.3", "cells", shown, shown);
    struct program_result r = FOVSTATS("choices", "s.db", "--margin", "0.25", "--p", "0.6");
    SAID_PLACE(r.out, "Equivalence: is the preference within 0.35 to 0.85?", "  cells ", "Family cells");
    assert_null(strstr(r.out, "Family planned"));
    program_free(&r);
    struct planned_study l;
    struct choices c;
    char error[SAMPLE_ERROR_SIZE];
    planned_study_load(&l);
    for (int i = 0; i < 2; i++) {
        const struct choices_desc desc = {.p0 = i ? 0.6 : 0.5};
        assert_true(choices_load_for(&c, &l.sample, &desc, error, sizeof error));
        struct choice_equality *equalities = choice_equalities(&c, &l.planned, 0.25, true);
        assert_true(equalities && equalities[0].planned == (i == 0) && equalities[1].planned == (i == 0));
        free(equalities);
        choices_free(&c);
    }
    planned_study_free(&l);
}

// A level of one cell, and a scene that is the only one, are that cell; a part or a sum of cells is not.
static void a_row_is_a_cell_where_it_has_all_of_it(void **state)
{
    (void)state;
    make_even(PLAN("binomial", "choice", "factor", ",\"margin\":0.25"));
    expect_cells(FOVSTATS("choices", "s.db", "--json"), "even 0.25", "planned", shown, neither);
    planned_study_plan(PLAN("binomial", "choice", "study", ",\"margin\":0.25"));
    expect_cells(FOVSTATS("choices", "s.db", "--json"), "even 0.25", "cells", shown, neither);
    struct program_result r;
    planned_study_plan(PLAN("binomial", "choice", "scene", ",\"margin\":0.25"));
    r = FOVSTATS("choices", "s.db", "--json");
    SAID_PLACE(r.out, "\"equivalence\":[", "\"family\":\"cells\""); // both cells are of the scene
    program_free(&r);
    study_file_sql("s.db", "DELETE FROM choice WHERE trial_id % 10 = 1");
    r = FOVSTATS("choices", "s.db", "--json");
    SAID_PLACE(r.out, "\"equivalence\":[", "\"family\":\"planned\"");
    program_free(&r);
    study_file_sql("s.db", "UPDATE trial SET scene = 'town' WHERE kind = 'toggle' AND id > 100");
    r = FOVSTATS("choices", "s.db", "--json");
    SAID_PLACE(r.out, "\"equivalence\":[", "\"family\":\"cells\"");
    program_free(&r);
}

// Where people chose several times, they are tested in both families.
static void people_have_the_planned_verdict_too(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){.several = true});
    planned_study_plan(PLAN("binomial", "choice", "cell", ",\"margin\":0.1"));
    struct program_result r = FOVSTATS("choices", "s.db", "--json");
    expect_cell(r.out, 0, "several", "planned", neither);
    expect_cell(r.out, 1, "several", "planned", "a difference is shown");
    program_free(&r);
}

static char *page_of_the_study(void)
{
    struct program_result r = FOVSTATS("report", "s.db", "-o", "r.html");
    if (r.code != 0)
        fail_msg("exit %d: %s", r.code, r.err);
    program_free(&r);
    char *text = calloc(1, 4 << 20);
    FILE *file = fopen("r.html", "r");
    assert_true(text && file && fread(text, 1, (4 << 20) - 1, file) > 0);
    fclose(file);
    return text;
}

// The page has the planned table's p and verdict in both places.
static void the_report_has_one_verdict(void **state)
{
    (void)state;
    make_even(
        PLAN("binomial", "choice", "cell", ",\"margin\":0.25") "," PLAN("paired_t", "rating", "order", ""));
    char *page = page_of_the_study();
    SAID_PLACE(page, "aria-label=\"Planned analyses\"", ">\u03b5 0.2: equality within", "equality is shown",
               "<td>0.0368</td>", ">\u03b5 0.05: equality within", "neither equality nor a difference is shown",
               "<td>0.0862</td>");
    SAID_PLACE(page, "aria-label=\"Equivalence\"",
               "<td>0.0100</td><td>0.0368</td><td>1.0000</td><td "
               "class=\"word\">equality within the margin is shown (planned)</td>",
               "<td>0.0287</td><td>0.0862</td><td>1.0000</td><td "
               "class=\"word\">neither is shown (planned)</td>",
               "both p (Holm) are those of the planned analyses");
    assert_null(strstr(page, "Equality of single cells"));
    free(page);
    planned_study_plan(PLAN("binomial", "choice", "study", ",\"margin\":0.25"));
    page = page_of_the_study();
    SAID_PLACE(page, "aria-label=\"Equivalence\"",
               "<td>0.0575</td><td>1.0000</td><td class=\"word\">neither is shown</td>");
    SAID_PLACE(page, ">Methods<", "Equality of single cells that was not planned");
    free(page);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tests_of_cells_are_one_family),
        cmocka_unit_test(one_sided_tests_do_not_exclude_each_other),
        cmocka_unit_test(a_planned_claim_is_that_of_the_planned_analyses),
        cmocka_unit_test(each_margin_has_its_own_rows),
        cmocka_unit_test(another_claim_is_not_the_planned_one),
        cmocka_unit_test(a_row_is_a_cell_where_it_has_all_of_it),
        cmocka_unit_test(people_have_the_planned_verdict_too),
        cmocka_unit_test(the_report_has_one_verdict),
    };
    return cmocka_run_group_tests(tests, program_enter_folder, program_leave_folder);
}
