#include "factor_study.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const char *const names[FACTOR_STUDY_LEVELS] = {"1", "2", "3"};

void factor_study_answer(struct factor_study *s, int person, int level, int64_t k, int64_t n)
{
    struct choice_cell *cell = &s->cells[level - 1];
    cell->person[cell->people] = (size_t)person;
    cell->counts[cell->people++] = (struct stat_person){k, n};
    cell->chosen += k;
    cell->n += n;
}

void factor_study_plan(struct factor_study *s, int person, int level)
{
    struct choice_cell *cell = &s->cells[level - 1];
    cell->planned[cell->planned_count++] = (size_t)person;
}

static int yes(int p, int l)
{
    return (7 * p + 4 * l + p * l) % 5 < 2 + l % 2;
}

void factor_study_make(struct factor_study *s, const char *name)
{
    bool within = strncmp(name, "within", 6) == 0, several = strcmp(name, "several2") == 0;
    int levels = name[strlen(name) - 1] - '0';
    int people = !within ? (several ? 9 : 17) : levels == 2 ? 18 : 8;
    *s = (struct factor_study){.choices = {.conf = 0.95, .cell_count = (size_t)levels, .cells = s->cells}};
    for (int l = 0; l < FACTOR_STUDY_LEVELS; l++)
        s->cells[l] = (struct choice_cell){.block = "main",
                                           .levels = {{"a", names[l], l + 1}},
                                           .level_count = 1,
                                           .person = s->persons[l],
                                           .counts = s->counts[l],
                                           .planned = s->planned[l]};
    for (int p = 1; p <= people; p++)
        for (int l = 1; l <= levels; l++) {
            if (!within && l != (levels == 3 ? p % 3 + 1 : p % 2 ? 1 : 2))
                continue;
            factor_study_plan(s, p, l);
            if (several)
                factor_study_answer(s, p, l, (3 * p + 4 * (p % 2) + 1) % 11, 10);
            else if (!within || p < 18 || l == 1)
                factor_study_answer(s, p, l, yes(p, l), 1);
        }
}

void factor_study_stray(struct factor_study *s, int person, int64_t n)
{
    for (int l = 1; l <= (int)s->choices.cell_count; l++) {
        factor_study_plan(s, person, l);
        factor_study_answer(s, person, l, l == 1 ? n : 0, n);
    }
}

struct choice_factors factor_study_load(const struct factor_study *s, size_t tests)
{
    struct choice_factors f;
    assert_true(choice_factors_load(&f, &s->choices));
    assert_int_equal(f.count, tests);
    return f;
}

const struct choice_factor_test *factor_study_find(const struct choice_factors *f, const char *a, const char *b)
{
    for (size_t i = 0; i < f->count; i++) {
        const struct choice_factor_test *x = &f->tests[i];
        if (x->levels == 2 ? strcmp(x->level[0], a) == 0 && strcmp(x->level[1], b) == 0 : a[0] == '0')
            return x;
    }
    fail_msg("no test of %s and %s", a, b);
    return NULL;
}

size_t factor_study_tests(const char *name)
{
    return name[strlen(name) - 1] == '3' ? 4 : 1;
}
