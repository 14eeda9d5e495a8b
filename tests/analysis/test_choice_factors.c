// Levels of factors of one answer each, and between people, against R (tests/reference/choice_factors.R).
#include "analysis/report/choice_factors.h"
#include "reference.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { PEOPLE = 18, LEVELS = 3 };

struct study {
    struct choices choices;
    struct choice_cell cells[LEVELS];
    struct stat_person counts[LEVELS][PEOPLE];
    size_t persons[LEVELS][PEOPLE];
};

static const char *const names[LEVELS] = {"1", "2", "3"};

static void answer(struct study *s, int person, int level, int64_t k, int64_t n)
{
    struct choice_cell *cell = &s->cells[level - 1];
    cell->person[cell->people] = (size_t)person;
    cell->counts[cell->people++] = (struct stat_person){k, n};
    cell->chosen += k;
    cell->n += n;
}

static int yes(int p, int l)
{
    return (7 * p + 4 * l + p * l) % 5 < 2 + l % 2;
}

// The studies of choice_factors.R.
static void make(struct study *s, const char *name)
{
    *s = (struct study){.choices = {.conf = 0.95, .cells = s->cells}};
    s->choices.cell_count = strcmp(name, "within3") == 0 ? 3 : 2;
    for (int l = 0; l < LEVELS; l++)
        s->cells[l] = (struct choice_cell){.block = "main",
                                           .levels = {{"a", names[l], l + 1}},
                                           .level_count = 1,
                                           .person = s->persons[l],
                                           .counts = s->counts[l]};
    bool within2 = strcmp(name, "within2") == 0, within3 = strcmp(name, "within3") == 0,
         several = strcmp(name, "several2") == 0;
    for (int p = 1; p <= (within2 ? 18 : within3 ? 8 : several ? 9 : 17); p++) {
        int own = p % 2 ? 1 : 2;
        if (several)
            answer(s, p, own, (3 * p + 4 * (p % 2) + 1) % 11, 10);
        else if (!within2 && !within3)
            answer(s, p, own, yes(p, own), 1);
        for (int l = 1; (within2 || within3) && l <= (within2 ? 2 : 3); l++)
            if (p < 18 || l == 1)
                answer(s, p, l, yes(p, l), 1);
    }
}

static const struct choice_factor_test *find(const struct choice_factors *f, const char *a, const char *b)
{
    for (size_t i = 0; i < f->count; i++) {
        const struct choice_factor_test *x = &f->tests[i];
        if (x->a ? strcmp(x->a, a) == 0 && strcmp(x->b, b) == 0 : a[0] == '0')
            return x;
    }
    fail_msg("no test of %s and %s", a, b);
    return NULL;
}

static void agrees_with_r(void **state)
{
    (void)state;
    FILE *file = reference_open("choice_factors.csv");
    char line[1024];
    assert_non_null(fgets(line, sizeof line, file));
    size_t rows = 0;
    for (; fgets(line, sizeof line, file); rows++) {
        line[strcspn(line, "\n")] = '\0';
        char *rest = line;
        const char *name = reference_field(&rest, ','), *a = reference_field(&rest, ','),
                   *b = reference_field(&rest, ',');
        struct study s;
        struct choice_factors f;
        make(&s, name);
        assert_true(choice_factors_load(&f, &s.choices));
        assert_int_equal(f.count, strcmp(name, "within3") == 0 ? 4 : 1);
        const struct choice_factor_test *x = find(&f, a, b);
        const double got[] = {(double)x->people, x->p_value, x->statistic,  x->p_asymptotic, x->difference,
                              x->ci.low,         x->ci.high, x->odds_ratio, x->odds_ci.low,  x->odds_ci.high};
        for (int i = 0; i < 10; i++) {
            double known = reference_number(reference_field(&rest, ','));
            // fisher.test finds the odds ratio and its ends to 1.22e-4 (uniroot)
            double within = strcmp(name, "between2") == 0 && i >= 7 ? 1e-3 : 1e-10;
            if (!(isnan(known) && isnan(got[i])) && !(fabs(got[i] - known) <= within * fmax(1, fabs(known))))
                fail_msg("%s %s %s, value %d: %.17g, R %.17g", name, a, b, i, got[i], known);
        }
        assert_true(x->p_error == 0);
        choice_factors_free(&f);
    }
    fclose(file);
    assert_int_equal(rows, 7);
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
                 {"several2", FACTOR_EXCHANGE, 0}};
    for (size_t i = 0; i < 4; i++) {
        struct study s;
        struct choice_factors f;
        make(&s, cases[i].name);
        assert_true(choice_factors_load(&f, &s.choices));
        assert_int_equal(f.tests[0].method, cases[i].method);
        assert_int_equal(f.tests[0].left_out, cases[i].left_out);
        assert_true(f.tests[0].holm == f.tests[0].p_value); // one set
        for (size_t k = 1; k < f.count; k++)
            assert_true(f.tests[k].pair && f.tests[k].holm >= f.tests[k].p_value);
        choice_factors_free(&f);
    }
}

// Sets that are not of this kind, and such that say nothing, give no number.
static void nothing_is_invented(void **state)
{
    (void)state;
    struct study s;
    struct choice_factors f;
    make(&s, "within2");
    s.counts[0][0] = (struct stat_person){1, 2}; // several answers within people: contrasts
    assert_true(choice_factors_load(&f, &s.choices));
    assert_int_equal(f.count, 0);
    choice_factors_free(&f);
    make(&s, "within2");
    s.cells[1].levels[0].value = "1"; // two cells of one name
    assert_true(choice_factors_load(&f, &s.choices));
    assert_int_equal(f.count, 0);
    choice_factors_free(&f);
    make(&s, "several2");
    for (int l = 0; l < 2; l++)
        for (size_t i = 0; i < s.cells[l].people; i++)
            s.counts[l][i].k = 10;
    assert_true(choice_factors_load(&f, &s.choices));
    assert_true(f.count == 1 && isnan(f.tests[0].p_value) && isnan(f.tests[0].holm));
    choice_factors_free(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_r),
        cmocka_unit_test(method_follows_from_the_data),
        cmocka_unit_test(nothing_is_invented),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
