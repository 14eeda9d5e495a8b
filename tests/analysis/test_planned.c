// Results of planned analyses against R (tests/reference/planned.R), and what is said where there is none.
#include "analysis/report/planned.h"
#include "reference.h"
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

static int enter_folder(void **state)
{
    static char folder[] = "/tmp/fovstats-planned-XXXXXX";
    *state = mkdtemp(folder);
    return *state && chdir(folder) == 0 ? 0 : -1;
}

static int leave_folder(void **state)
{
    unlink("s.db");
    return chdir("/") == 0 && rmdir(*state) == 0 ? 0 : -1;
}

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

// The numbers of a line of R's; the largest relative difference so far goes up.
static void compare(const struct planned_row *row, const char *line, double *io_worst)
{
    char copy[256], *rest = copy;
    snprintf(copy, sizeof copy, "%s", line);
    const char *name = reference_field(&rest, ',');
    const double got[] = {row->estimate, row->low, row->high, row->p_value, row->holm};
    for (int i = 0; i < 5; i++) {
        double known = reference_number(reference_field(&rest, ','));
        *io_worst = fmax(*io_worst, reference_distance(got[i], known));
        if (!reference_close(got[i], known, 1e-9))
            fail_msg("%s, number %d: %.17g, R %.17g (%s)", name, i + 1, got[i], known, row->words);
    }
}

static void lines_of(char lines[16][256], size_t *count)
{
    FILE *file = reference_open("planned.csv");
    *count = 0;
    assert_non_null(fgets(lines[0], 256, file));
    while (*count < 16 && fgets(lines[*count], 256, file)) {
        lines[*count][strcspn(lines[*count], "\n")] = '\0';
        ++*count;
    }
    fclose(file);
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
    struct loaded l;
    char lines[16][256];
    size_t count;
    double worst = 0;
    lines_of(lines, &count);
    assert_int_equal(count, 14);
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    plan(everything);
    load(&l);
    assert_int_equal(l.planned.row_count, 11);
    assert_int_equal(l.planned.tested, 8);
    for (size_t i = 0; i < 11; i++)
        compare(&l.planned.rows[i], lines[i], &worst);
    for (size_t i = 0; i < 2; i++) { // two one-sided exact tests
        char said[64];
        snprintf(said, sizeof said, "equality within 30 to 70 %%: p = %.3g, not shown",
                 strtod(strchr(lines[12 + i], ',') + 1, NULL));
        assert_non_null(strstr(l.planned.rows[i].note, said));
    }
    assert_int_equal(l.planned.rows[4].people, 22);
    assert_int_equal(l.planned.rows[3].partial, 3); // whose trials in one cell are invalid
    print_message("largest relative difference from R %.2g\n", worst);
    unload(&l);
}

static void people_of_two_groups_are_compared_between(void **state)
{
    (void)state;
    struct loaded l;
    char lines[16][256];
    size_t count;
    double worst = 0;
    lines_of(lines, &count);
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    study_file_sql("s.db", "DELETE FROM choice WHERE trial_id % 10 = 2; UPDATE trial SET factors = "
                           "json_object('hand', iif(session_id % 2, 'a', 'b')) WHERE block = 'main'");
    plan(PLAN("unpaired_t", "reaction", "factor", "") "," PLAN("paired_t", "reaction", "factor", ""));
    load(&l);
    assert_int_equal(l.planned.row_count, 2);
    l.planned.rows[0].holm = l.planned.rows[0].p_value; // one test: nothing to adjust
    compare(&l.planned.rows[0], lines[11], &worst);
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
        cmocka_unit_test(people_of_two_groups_are_compared_between),
        cmocka_unit_test(what_cannot_be_computed_says_why),
        cmocka_unit_test(nothing_planned_is_left_without_a_row),
        cmocka_unit_test(different_margins_are_no_margin),
    };
    return cmocka_run_group_tests(tests, enter_folder, leave_folder);
}
