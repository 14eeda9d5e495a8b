// Levels of factors of one answer each, and between people, against R (tests/reference/choice_factors.R).
#include "factor_study.h"
#include "reference.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// The rows of choice_factors.csv, each of a study to which `strays` people were added who do not fit its
// design.
static void agree(int strays)
{
    FILE *file = reference_open("choice_factors.csv");
    char line[1024];
    assert_non_null(fgets(line, sizeof line, file));
    size_t rows = 0;
    while (fgets(line, sizeof line, file)) {
        line[strcspn(line, "\n")] = '\0';
        char *rest = line;
        const char *name = reference_field(&rest, ','), *a = reference_field(&rest, ','),
                   *b = reference_field(&rest, ',');
        struct factor_study s;
        factor_study_make(&s, name);
        if (strays && strncmp(name, "within", 6) == 0)
            continue;
        for (int i = 0; i < strays; i++)
            factor_study_stray(&s, 20 + i, strcmp(name, "several2") == 0 ? 10 : 1);
        struct choice_factors f = factor_study_load(&s, factor_study_tests(name));
        const struct choice_factor_test *x = factor_study_find(&f, a, b);
        const double got[] = {(double)x->people, x->p_value, x->statistic,  x->p_asymptotic, x->difference,
                              x->ci.low,         x->ci.high, x->odds_ratio, x->odds_ci.low,  x->odds_ci.high};
        for (int i = 0; i < 10; i++) {
            double known = reference_number(reference_field(&rest, ','));
            // fisher.test finds the odds ratio and its ends to 1.22e-4 (uniroot)
            double within = strncmp(name, "between", 7) == 0 && i >= 7 ? 1e-3 : 1e-10;
            if (!(isnan(known) && isnan(got[i])) && !(fabs(got[i] - known) <= within * fmax(1, fabs(known))))
                fail_msg("%s %s %s, value %d: %.17g, R %.17g", name, a, b, i, got[i], known);
        }
        assert_true(x->p_error == 0 && x->none[0] == '\0');
        if (strays)
            assert_int_equal(x->left_out, strays);
        choice_factors_free(&f);
        rows++;
    }
    fclose(file);
    assert_int_equal(rows, strays ? 6 : 11);
}

static void agrees_with_r(void **state)
{
    (void)state;
    agree(0);
}

// One or a few people at several levels of a factor between people change no number: they are left out and
// counted.
static void strays_change_nothing(void **state)
{
    (void)state;
    agree(1);
    agree(8);
}

static void method_follows_from_the_data(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        enum choice_factor_method method;
        size_t left_out;
    } cases[] = {{"within2", FACTOR_MCNEMAR, 1},
                 {"within3", FACTOR_COCHRAN, 0},
                 {"between2", FACTOR_FISHER, 0},
                 {"between3", FACTOR_FISHER, 0},
                 {"several2", FACTOR_EXCHANGE, 0}};
    for (size_t i = 0; i < 5; i++) {
        struct factor_study s;
        factor_study_make(&s, cases[i].name);
        struct choice_factors f = factor_study_load(&s, factor_study_tests(cases[i].name));
        assert_int_equal(f.tests[0].method, cases[i].method);
        assert_int_equal(f.tests[0].left_out, cases[i].left_out);
        assert_true(f.tests[0].holm == f.tests[0].p_value); // one set
        for (size_t k = 1; k < f.count; k++)
            assert_true(f.tests[k].pair && f.tests[k].holm >= f.tests[k].p_value);
        choice_factors_free(&f);
    }
}

// Sets that are not of this kind give no row.
static void other_sets_are_left_alone(void **state)
{
    (void)state;
    struct factor_study s;
    factor_study_make(&s, "within2");
    s.counts[0][0] = (struct stat_person){1, 2}; // several answers within people: contrasts
    struct choice_factors f = factor_study_load(&s, 0);
    choice_factors_free(&f);
    factor_study_make(&s, "within2");
    s.cells[1].levels[0].value = "1"; // two cells of one name
    f = factor_study_load(&s, 0);
    choice_factors_free(&f);
}

static void expect_none(const struct choice_factor_test *x, const char *words, const char *why)
{
    char got[CHOICE_FACTOR_WORDS];
    choice_factor_words(x, got);
    assert_string_equal(got, words);
    assert_string_equal(x->none, why);
    assert_true(isnan(x->p_value) && isnan(x->holm));
}

// Where there is no test, what it is about and why there is none.
static void nothing_is_invented(void **state)
{
    (void)state;
    struct factor_study s;
    factor_study_make(&s, "several2");
    for (int l = 0; l < 2; l++)
        for (size_t i = 0; i < s.cells[l].people; i++)
            s.counts[l][i].k = 10;
    struct choice_factors f = factor_study_load(&s, 1);
    expect_none(&f.tests[0], "a 1 and 2", "all answers are the same");
    choice_factors_free(&f);
    factor_study_make(&s, "within3"); // nobody at levels 1 and 3, four at 1 and 2, four at 2 and 3
    s.cells[0].people = 4;
    s.cells[0].n = 4;
    memmove(s.persons[2], s.persons[2] + 4, 4 * sizeof s.persons[2][0]);
    s.cells[2].people = 4;
    s.cells[2].n = 4;
    for (int l = 0; l < FACTOR_STUDY_LEVELS; l++)
        s.cells[l].levels[1] = (struct choice_level){"b", "x", NAN}, s.cells[l].level_count = 2;
    f = factor_study_load(&s, 4);
    expect_none(&f.tests[0], "a 1, 2 and 3, at b x", "nobody answered at every level");
    expect_none(factor_study_find(&f, "1", "3"), "a 1 and 3, at b x", "nobody answered at both levels");
    assert_true(f.tests[0].left_out == 8 && factor_study_find(&f, "1", "2")->people == 4);
    assert_true(factor_study_find(&f, "1", "2")->none[0] == '\0' &&
                !isnan(factor_study_find(&f, "1", "2")->p_value));
    choice_factors_free(&f);
    factor_study_make(&s, "within3");
    for (int l = 0; l < FACTOR_STUDY_LEVELS; l++)
        for (size_t i = 0; i < s.cells[l].people; i++)
            s.counts[l][i].k = (int64_t)(i % 2);
    f = factor_study_load(&s, 4);
    expect_none(&f.tests[0], "a 1, 2 and 3", "nobody's answers differ between levels");
    choice_factors_free(&f);
    factor_study_make(&s, "between3"); // level 3 has nobody but the stray
    s.cells[2].people = s.cells[2].planned_count = 0;
    factor_study_stray(&s, 20, 1);
    f = factor_study_load(&s, 4);
    expect_none(&f.tests[0], "a 1, 2 and 3",
                "everybody who answered at 3 answered at other levels too and is left out");
    expect_none(factor_study_find(&f, "2", "3"), "a 2 and 3",
                "everybody who answered at 3 answered at other levels too and is left out");
    assert_true(factor_study_find(&f, "1", "2")->people == 11 &&
                !isnan(factor_study_find(&f, "1", "2")->p_value));
    choice_factors_free(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_r),
        cmocka_unit_test(strays_change_nothing),
        cmocka_unit_test(method_follows_from_the_data),
        cmocka_unit_test(other_sets_are_left_alone),
        cmocka_unit_test(nothing_is_invented),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
