// Results of planned analyses against R (tests/reference/planned.R), and what is said where there is none.
#include "analysis/report/planned.h"
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

struct loaded {
    struct sample sample;
    struct plans plans;
    struct ratings ratings;
    struct thresholds thresholds;
    struct adjusted adjusted;
    struct planned planned;
};

static const char fovstats[] = BUILD_DIR "/bin/fovstats";

#define FOVSTATS(...) program_run((const char *const[]){fovstats, __VA_ARGS__, NULL}, NULL)

// A plan as JSON's members: "binomial", "choice", "cell", then further members.
#define PLAN(method, of, per, more) "{\"method\":\"" method "\",\"of\":\"" of "\",\"per\":\"" per "\"" more "}"

static void plan(const char *plans)
{
    char sql[4096];
    snprintf(sql, sizeof sql, "UPDATE session SET settings = json_set(settings, '$.planned', json('[%s]'))",
             plans);
    study_file_sql("s.db", sql);
}

static void load(struct loaded *l)
{
    char error[SAMPLE_ERROR_SIZE] = "";
    const char *paths[] = {"s.db"};
    *l = (struct loaded){0};
    assert_true(sample_load(&l->sample, paths, 1, false, NULL, error, sizeof error));
    assert_true(plans_load(&l->plans, &l->sample));
    assert_true(ratings_load(&l->ratings, &l->sample, 0.95, false, error, sizeof error));
    assert_true(thresholds_load(&l->thresholds, &l->sample, &(struct threshold_options){.conf = 0.95}, error,
                                sizeof error));
    assert_true(adjusted_load(&l->adjusted, &l->sample, 0.95, error, sizeof error));
    const struct planned_sources sources = {&l->ratings, &l->thresholds, &l->adjusted};
    if (!planned_load(&l->planned, &l->sample, &l->plans, &sources, 0.95, error, sizeof error))
        fail_msg("%s", error);
}

static void unload(struct loaded *l)
{
    planned_free(&l->planned);
    adjusted_free(&l->adjusted);
    thresholds_free(&l->thresholds);
    ratings_free(&l->ratings);
    plans_free(&l->plans);
    sample_free(&l->sample);
}

// The numbers of R's line of that name: estimate, low, high, p, Holm's p.
static void known(const char *name, double out[5])
{
    char line[256], *rest = NULL;
    FILE *file = reference_open("planned.csv");
    while (!rest && fgets(line, sizeof line, file))
        if (strncmp(line, name, strlen(name)) == 0 && line[strlen(name)] == ',')
            rest = line + strlen(name) + 1;
    fclose(file);
    assert_non_null(rest);
    rest[strcspn(rest, "\n")] = '\0';
    for (int i = 0; i < 5; i++)
        out[i] = reference_number(reference_field(&rest, ','));
}

// The largest relative difference so far goes up.
static void compare(const struct planned_row *row, const char *name, double *io_worst)
{
    const double got[] = {row->estimate, row->low, row->high, row->p_value, row->holm};
    double r[5];
    known(name, r);
    for (int i = 0; i < 5; i++) {
        *io_worst = fmax(*io_worst, reference_distance(got[i], r[i]));
        if (!reference_close(got[i], r[i], 1e-9))
            fail_msg("%s, number %d: %.17g, R %.17g (%s)", name, i + 1, got[i], r[i], row->words);
    }
}

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
    struct loaded l;
    double worst = 0;
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    plan(everything);
    load(&l);
    assert_int_equal(l.planned.row_count, 13);
    assert_int_equal(l.planned.tested, 10);
    assert_int_equal(planned_equality(&l.planned), 2);
    for (size_t i = 0; i < 13; i++)
        compare(&l.planned.rows[i], names[i], &worst);
    assert_true(fabs(l.planned.rows[1].conf - 0.9) < 1e-12 && l.planned.rows[0].conf == 0.95);
    assert_int_equal(l.planned.rows[5].people, 22);
    assert_int_equal(l.planned.rows[4].partial, 3); // whose trials in one cell are invalid
    print_message("largest relative difference from R %.2g\n", worst);
    unload(&l);
}

// 11 of 22 and 9 of 19: equality within 30 to 70 % has p 0.039 in one cell, which two cells do not let pass.
static void equality_is_shown_by_the_adjusted_p_alone(void **state)
{
    (void)state;
    static const struct {
        const char *plan, *of[4];
        enum stat_verdict verdict;
        const char *says;
    } cases[] = {
        {PLAN("binomial", "choice", "cell", ",\"margin\":0.2"),
         {"even 0.2 cell 0.2", "even 0.2 equality 0.2", "even 0.2 cell 0.05", "even 0.2 equality 0.05"},
         STAT_UNDECIDED,
         "neither equality nor a difference is shown"},
        {PLAN("binomial", "choice", "cell", ",\"margin\":0.3"),
         {"even 0.3 cell 0.2", "even 0.3 equality 0.2", "even 0.3 cell 0.05", "even 0.3 equality 0.05"},
         STAT_WITHIN,
         "equality is shown"}};
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    study_file_even("s.db");
    for (size_t i = 0; i < 2; i++) {
        struct loaded l;
        double worst = 0;
        plan(cases[i].plan);
        load(&l);
        assert_int_equal(l.planned.row_count, 4);
        for (size_t k = 0; k < 4; k++)
            compare(&l.planned.rows[k], cases[i].of[k], &worst);
        assert_true(l.planned.rows[1].p_value <= 0.05); // alone it would always be shown
        for (size_t k = 1; k < 4; k += 2) {
            assert_int_equal(l.planned.rows[k].verdict, cases[i].verdict);
            assert_string_equal(l.planned.rows[k].note, cases[i].says);
            assert_non_null(strstr(l.planned.rows[k].words, ": equality within "));
        }
        unload(&l);
    }
}

// Where somebody chose several times people are tested, for a difference and for equality.
static void people_are_tested_for_equality_too(void **state)
{
    (void)state;
    static const char *const names[] = {"several cell 0.2", "several equality 0.2", "several cell 0.05",
                                        "several equality 0.05"};
    struct loaded l;
    double worst = 0;
    study_file_make("s.db", &(struct study_desc){.several = true});
    plan(PLAN("binomial", "choice", "cell", ",\"margin\":0.1"));
    load(&l);
    assert_int_equal(l.planned.row_count, 4);
    for (size_t i = 0; i < 4; i++)
        compare(&l.planned.rows[i], names[i], &worst);
    assert_string_equal(l.planned.rows[1].test, "two one-sided t of the people\u2019s shares");
    unload(&l);
}

// Differences of ratings: second minus first, test minus reference, however the plan joins them.
static void differences_say_what_is_subtracted_from_what(void **state)
{
    (void)state;
    static const struct {
        const char *per, *words;
        double estimate;
    } cases[] = {
        {"study", "How good does it look?, second minus first: time_warped \u03b5 0.2 \u2212 regular",
         -8.0 / 9},
        {"order", "How good does it look?, second minus first: time_warped \u03b5 0.2 \u2212 regular",
         -8.0 / 9},
        {"cell", "How good does it look?, second minus first: regular \u2212 time_warped \u03b5 0.2", 5.0 / 11},
        {"scene",
         "How good does it look?, second minus first: regular \u2212 time_warped \u03b5 0.2: scene town",
         5.0 / 11},
    };
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct loaded l;
        char text[256];
        bool found = false;
        snprintf(text, sizeof text, "{\"method\":\"paired_t\",\"of\":\"rating\",\"per\":\"%s\"}", cases[i].per);
        plan(text);
        load(&l);
        assert_int_equal(l.planned.row_count, 2);
        for (size_t k = 0; k < 2; k++)
            if (strcmp(l.planned.rows[k].words, cases[i].words) == 0)
                found = l.planned.rows[k].difference &&
                        fabs(l.planned.rows[k].estimate - cases[i].estimate) < 1e-12;
        if (!found)
            fail_msg("per %s: \"%s\" %g, \"%s\" %g; expected \"%s\" %g", cases[i].per, l.planned.rows[0].words,
                     l.planned.rows[0].estimate, l.planned.rows[1].words, l.planned.rows[1].estimate,
                     cases[i].words, cases[i].estimate);
        unload(&l);
    }
}

// Both options of each toggle trial rated: the test option 2 above the reference in one cell, 1 in the other.
static void options_of_a_trial_are_named(void **state)
{
    (void)state;
    struct loaded l;
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    study_file_sql(
        "s.db", "DELETE FROM rating; INSERT INTO rating SELECT NULL, t.id, NULL, t.session_id, 'Clear?', 'a', "
                "t.option_a, iif(t.test_slot = 'a', 7 + t.session_id % 2 - (t.id % 10 = 2), 5), 1, 10, 5 FROM "
                "trial t WHERE kind = 'toggle'; INSERT INTO rating SELECT NULL, t.id, NULL, t.session_id, "
                "'Clear?', 'b', t.option_b, iif(t.test_slot = 'b', 7 + t.session_id % 2 - (t.id % 10 = 2), 5), "
                "1, 10, 6 FROM trial t WHERE kind = 'toggle'");
    plan(PLAN("paired_t", "rating", "cell", "") "," PLAN("paired_t", "rating", "study", ""));
    load(&l);
    assert_int_equal(l.planned.row_count, 3);
    static const char *const words[] = {
        "Clear?, test option minus reference: \u03b5 0.2: time_warped \u03b5 0.2 \u2212 regular",
        "Clear?, test option minus reference: \u03b5 0.05: time_warped \u03b5 0.05 \u2212 regular",
        "Clear?, test option minus reference"}; // two test options
    for (size_t i = 0; i < 3; i++)
        assert_string_equal(l.planned.rows[i].words, words[i]);
    assert_true(l.planned.rows[0].estimate == 2.5); // 11 people each of 2 and 3
    unload(&l);
}

static void people_of_two_groups_are_compared_between(void **state)
{
    (void)state;
    struct loaded l;
    double worst = 0;
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    study_file_sql("s.db", "DELETE FROM choice WHERE trial_id % 10 = 2; UPDATE trial SET factors = "
                           "json_object('hand', iif(session_id % 2, 'a', 'b')) WHERE block = 'main'");
    plan(PLAN("unpaired_t", "reaction", "factor", "") "," PLAN("paired_t", "reaction", "factor", ""));
    load(&l);
    assert_int_equal(l.planned.row_count, 2);
    l.planned.rows[0].holm = l.planned.rows[0].p_value; // one test: nothing to adjust
    compare(&l.planned.rows[0], "unpaired_t reaction factor odd", &worst);
    assert_true(isnan(l.planned.rows[1].p_value) && l.planned.rows[1].people == 0);
    assert_non_null(strstr(l.planned.rows[1].note, "nobody has values of both"));
    unload(&l);
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
        {PLAN("unpaired_t", "toggles", "factor", ""), "people have values of both"},
        {PLAN("paired_t", "choice", "scene", ""), "it compares two, and the data have one alone"},
        {PLAN("anova", "toggles", "factor", ""), "no spread within people"},
    };
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct loaded l;
        plan(cases[i].plan);
        load(&l);
        if (l.planned.row_count != 1 || !strstr(l.planned.rows[0].note, cases[i].says))
            fail_msg("%s: %zu rows, \"%s\"", cases[i].plan, l.planned.row_count,
                     l.planned.row_count ? l.planned.rows[0].note : "");
        assert_true(isnan(l.planned.rows[0].p_value));
        unload(&l);
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
            struct loaded l;
            char text[256];
            snprintf(text, sizeof text, "{\"method\":\"%s\",\"of\":\"%s\",\"per\":\"%s\"}", methods[i / 36],
                     ofs[i / 6 % 6], pers[i % 6]);
            plan(text);
            load(&l);
            if (l.planned.row_count == 0)
                fail_msg("%s has no row", text);
            for (size_t k = 0; k < l.planned.row_count; k++) {
                const struct planned_row *row = &l.planned.rows[k];
                if (isnan(row->estimate) && !row->note[0])
                    fail_msg("%s: %s has neither number nor reason", text, row->words);
                if (!isnan(row->p_value) && !(row->p_value >= 0 && row->p_value <= 1 && row->test[0]))
                    fail_msg("%s: %s has p %g by \"%s\"", text, row->words, row->p_value, row->test);
            }
            unload(&l);
        }
    }
}

static void the_command_says_the_same(void **state)
{
    (void)state;
    static const char equality[] = "\u03b5 0.2: equality within 30 to 70\u00a0%";
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    said_sentence(FOVSTATS("planned", "s.db"), 1, "s.db: the protocol planned no analysis");
    study_file_even("s.db");
    plan(PLAN("binomial", "choice", "cell", ",\"margin\":0.2"));
    struct program_result r = FOVSTATS("planned", "s.db", "--json");
    assert_int_equal(r.code, 0);
    assert_true(said_after(r.out, "conf", "tests") == 4);
    static const char *const keys[] = {"estimate", "ci_low", "ci_high", "p_value", "p_holm"};
    double of_r[5];
    known("even 0.2 equality 0.2", of_r);
    for (int i = 0; i < 5; i++)
        if (!reference_close(said_after(r.out, equality, keys[i]), of_r[i], 1e-9))
            fail_msg("%s in %s", keys[i], r.out);
    assert_true(said_after(r.out, equality, "equality_margin") == 0.2);
    assert_non_null(strstr(strstr(r.out, equality), "\"verdict\":\"undecided\""));
    program_free(&r);
    plan(PLAN("paired_t", "rating", "study", ""));
    r = FOVSTATS("planned", "s.db", "--json");
    struct program_result text = FOVSTATS("planned", "s.db");
    static const char row[] =
        "How good does it look?, second minus first: regular \u2212 time_warped \u03b5 0.2";
    assert_true(reference_close(said_after(r.out, row, "estimate"), 5.0 / 11, 1e-12));
    assert_non_null(strstr(strstr(r.out, row), "\"difference\":true"));
    assert_non_null(strstr(text.out, row));
    program_free(&r);
    program_free(&text);
}

// Two versions of a protocol with different margins: nobody but people can say which holds.
static void different_margins_are_no_margin(void **state)
{
    (void)state;
    struct loaded l;
    bool differ;
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    plan(PLAN("binomial", "choice", "scene", ",\"margin\":0.3") "," PLAN("binomial", "choice", "cell",
                                                                         ",\"margin\":0.1"));
    load(&l);
    assert_true(plans_margin(&l.plans, &differ) == 0.1 && !differ); // the cells'
    unload(&l);
    study_file_sql("s.db",
                   "UPDATE session SET settings = json_set(settings, '$.planned[1].margin', 0.15) WHERE id "
                   "> 11");
    load(&l);
    assert_true(isnan(plans_margin(&l.plans, &differ)) && differ);
    assert_int_equal(l.plans.count, 3);
    unload(&l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(results_agree_with_r),
        cmocka_unit_test(equality_is_shown_by_the_adjusted_p_alone),
        cmocka_unit_test(people_are_tested_for_equality_too),
        cmocka_unit_test(differences_say_what_is_subtracted_from_what),
        cmocka_unit_test(options_of_a_trial_are_named),
        cmocka_unit_test(people_of_two_groups_are_compared_between),
        cmocka_unit_test(what_cannot_be_computed_says_why),
        cmocka_unit_test(nothing_planned_is_left_without_a_row),
        cmocka_unit_test(the_command_says_the_same),
        cmocka_unit_test(different_margins_are_no_margin),
    };
    return cmocka_run_group_tests(tests, program_enter_folder, program_leave_folder);
}
