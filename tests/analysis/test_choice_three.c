// Answers of three kinds against R (tests/reference/choice_three.R).
#include "analysis/report/choice_three.h"
#include "reference.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { PEOPLE = 10 };

struct study {
    struct choices choices;
    struct choice_cell cell;
    struct stat_person counts[PEOPLE];
    int64_t equals[PEOPLE];
};

// The study of choice_three.R.
static void make(struct study *s)
{
    *s = (struct study){.choices = {.conf = 0.95, .cell_count = 1, .cells = &s->cell},
                        .cell = {.block = "main", .people = PEOPLE, .counts = s->counts, .equals = s->equals}};
    for (int p = 1; p <= PEOPLE; p++) {
        int n = 2 + p % 4, test = 3 * p % n, equal = 5 * p % (n - test + 1);
        s->counts[p - 1] = (struct stat_person){test, n - equal};
        s->equals[p - 1] = equal;
        s->cell.equal += equal;
    }
}

static void agrees_with_r(void **state)
{
    (void)state;
    struct study s;
    struct choice_three x;
    make(&s);
    assert_true(choice_three_applies(&s.choices, &s.cell));
    assert_true(choice_three_of(&s.choices, &s.cell, &x));
    const double got[] = {
        (double)x.test,     (double)x.equal, (double)x.reference, x.negative,    x.negative_ci.low,
        x.negative_ci.high, x.net,           x.net_ci.low,        x.net_ci.high, x.p_value};
    FILE *file = reference_open("choice_three.csv");
    char line[256];
    size_t row = 0;
    assert_non_null(fgets(line, sizeof line, file));
    for (; fgets(line, sizeof line, file); row++) {
        char *rest = line;
        const char *name = reference_field(&rest, ',');
        double known = strtod(rest, NULL);
        assert_true(row < 10);
        if (!(fabs(got[row] - known) <= 1e-12 * fmax(1, fabs(known))))
            fail_msg("%s: %.17g, R %.17g", name, got[row], known);
    }
    fclose(file);
    assert_int_equal(row, 10);
}

// Who prefers the reference has the negative sign, and exchanging the options changes the sign alone.
static void negative_is_for_the_reference(void **state)
{
    (void)state;
    struct study s;
    struct choice_three x, y;
    make(&s);
    assert_true(choice_three_of(&s.choices, &s.cell, &x));
    for (int i = 0; i < PEOPLE; i++)
        s.counts[i].k = s.counts[i].n - s.counts[i].k;
    assert_true(choice_three_of(&s.choices, &s.cell, &y));
    assert_true(x.reference > x.test && x.net < 0 && fabs(x.net + y.net) < 1e-15 && x.p_value == y.p_value);
    for (int i = 0; i < PEOPLE; i++)
        s.counts[i] = (struct stat_person){0, 0};
    assert_true(choice_three_of(&s.choices, &s.cell, &x)); // everybody said "equal"
    assert_true(x.net == 0 && isnan(x.net_ci.low) && x.negative == 0);
    s.cell.people = 0;
    assert_true(choice_three_of(&s.choices, &s.cell, &x));
    assert_true(isnan(x.net) && isnan(x.negative) && isnan(x.p_value));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_r),
        cmocka_unit_test(negative_is_for_the_reference),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
