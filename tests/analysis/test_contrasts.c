// Levels compared within people, against R (tests/reference/contrasts.R).
#include "analysis/report/choice_factors.h"
#include "reference.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { PEOPLE = 6, CELLS = 6 };

static size_t persons[PEOPLE] = {1, 2, 3, 4, 5, 6};
static const char *const a_names[] = {"3", "2", "1"}, *const scene_names[] = {"x", "y"};

// The study of contrasts.R, in the order of its levels. Cells of one answer each where `several` is false.
static void make(struct choices *out, struct choice_cell *cells, struct stat_person counts[][PEOPLE],
                 bool several)
{
    for (int i = 0; i < CELLS; i++) {
        int a = 3 - i / 2, scene = i % 2;
        for (int p = 1; p <= PEOPLE; p++)
            counts[i][p - 1] = (struct stat_person){(7 * p + 3 * a + 5 * scene) % 10, 10};
        if (a == 1 && scene == 1)
            counts[i][PEOPLE - 1] = (struct stat_person){0, 0};
        cells[i] =
            (struct choice_cell){.block = "main",
                                 .levels = {{"a", a_names[i / 2], a}, {"scene", scene_names[scene], NAN}},
                                 .level_count = 2,
                                 .several = several,
                                 .people = PEOPLE,
                                 .person = persons,
                                 .counts = counts[i]};
    }
    *out = (struct choices){.conf = 0.95, .cell_count = CELLS, .cells = cells};
}

static const struct choice_contrast *find(const struct choices *c, const char *factor, const char *a,
                                          const char *b)
{
    for (size_t i = 0; i < c->contrast_count; i++)
        if (strcmp(c->contrasts[i].factor, factor) == 0 && strcmp(c->contrasts[i].a, a) == 0 &&
            strcmp(c->contrasts[i].b, b) == 0)
            return &c->contrasts[i];
    fail_msg("no contrast of %s %s and %s", factor, a, b);
    return NULL;
}

// The rows of contrasts.csv of factor b, or of the others.
static void agree(const struct choices *c, bool of_b, size_t expected_rows)
{
    FILE *file = reference_open("contrasts.csv");
    char line[512];
    assert_non_null(fgets(line, sizeof line, file));
    size_t rows = 0;
    while (fgets(line, sizeof line, file)) {
        line[strcspn(line, "\n")] = '\0';
        char *rest = line;
        const char *factor = reference_field(&rest, ','), *a = reference_field(&rest, ','),
                   *b = reference_field(&rest, ',');
        if ((strcmp(factor, "b") == 0) != of_b)
            continue;
        const struct choice_contrast *x = find(c, factor, a, b);
        const double values[] = {(double)x->people, x->t.estimate, x->t.ci_low, x->t.ci_high, x->t.t,
                                 x->t.p_value,      x->holm};
        for (int i = 0; i < 7; i++) {
            double known = reference_number(reference_field(&rest, ','));
            if (!(fabs(values[i] - known) <= 1e-12))
                fail_msg("%s %s - %s, value %d: %.17g, R %.17g", factor, a, b, i, values[i], known);
        }
        rows++;
    }
    fclose(file);
    assert_int_equal(rows, expected_rows);
    assert_int_equal(c->contrast_count, expected_rows);
}

static void agrees_with_r(void **state)
{
    (void)state;
    struct choices c;
    struct choice_cell cells[CELLS];
    struct stat_person counts[CELLS][PEOPLE];
    make(&c, cells, counts, true);
    assert_true(choices_contrast(&c));
    agree(&c, false, 4); // three pairs of a, one of scenes
    for (size_t i = 0; i < c.contrast_count; i++)
        assert_int_equal(c.contrasts[i].cell_pairs, strcmp(c.contrasts[i].factor, "a") == 0 ? 2 : 3);
    free(c.contrasts);
}

// One answer each at four levels, and a second one of one person at one of them: all six pairs are compared.
static void one_second_answer_loses_no_pair(void **state)
{
    (void)state;
    enum { MANY = 20, LEVELS = 4 };
    static const char *const levels[] = {"4", "3", "2", "1"};
    size_t people[MANY];
    struct choice_cell cells[LEVELS];
    struct stat_person counts[LEVELS][MANY];
    for (int i = 0; i < LEVELS; i++) {
        int b = LEVELS - i;
        for (int p = 1; p <= MANY; p++) {
            people[p - 1] = (size_t)p;
            counts[i][p - 1] = (struct stat_person){(5 * p + 3 * b + p * b) % 7 < b + 1, 1};
        }
        cells[i] = (struct choice_cell){.block = "main",
                                        .levels = {{"b", levels[i], b}},
                                        .level_count = 1,
                                        .n = MANY,
                                        .people = MANY,
                                        .person = people,
                                        .counts = counts[i]};
    }
    struct choices c = {.conf = 0.95, .cell_count = LEVELS, .cells = cells};
    struct choice_factors factors;
    assert_true(choices_contrast(&c));
    assert_int_equal(c.contrast_count, 0);
    assert_true(choice_factors_load(&factors, &c));
    assert_int_equal(factors.count, 7); // Cochran's Q and six pairs
    choice_factors_free(&factors);
    counts[0][0].n++;
    cells[0].n++;
    cells[0].several = true;
    assert_true(choices_contrast(&c));
    agree(&c, true, 6);
    assert_true(choice_factors_load(&factors, &c));
    assert_int_equal(factors.count, 0); // all of it is in the contrasts
    choice_factors_free(&factors);
    free(c.contrasts);
}

// Cells of one answer each, other blocks and other references are never compared.
static void only_what_is_otherwise_the_same(void **state)
{
    (void)state;
    struct choices c;
    struct choice_cell cells[CELLS];
    struct stat_person counts[CELLS][PEOPLE];
    make(&c, cells, counts, false);
    assert_true(choices_contrast(&c));
    assert_int_equal(c.contrast_count, 0);
    make(&c, cells, counts, true);
    for (size_t i = 0; i < CELLS; i++)
        cells[i].reference = i;
    assert_true(choices_contrast(&c));
    assert_int_equal(c.contrast_count, 0);
    make(&c, cells, counts, true);
    for (size_t i = 0; i < CELLS; i += 2) // scene x in a block of its own: pairs of a within each block
        cells[i].block = "other";
    assert_true(choices_contrast(&c));
    assert_int_equal(c.contrast_count, 6);
    for (size_t i = 0; i < c.contrast_count; i++)
        assert_true(c.contrasts[i].cell_pairs == 1 && strcmp(c.contrasts[i].factor, "a") == 0);
    free(c.contrasts);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_r),
        cmocka_unit_test(one_second_answer_loses_no_pair),
        cmocka_unit_test(only_what_is_otherwise_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
