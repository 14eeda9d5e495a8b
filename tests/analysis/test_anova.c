// Analysis of variance within participants against R (tests/reference/anova.R), and by law.
#include "analysis/stats/anova.h"
#include "analysis/stats/ttest.h"
#include "reference.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { MOST = 1024, NUMBERS = 12 };

struct set {
    double values[MOST];
    size_t people, cells, factors, levels[STAT_ANOVA_FACTORS];
    struct stat_anova anova;
};

static void read_set(char *rest, struct set *set)
{
    double levels[STAT_ANOVA_FACTORS];
    set->factors = reference_numbers(reference_field(&rest, ','), levels, STAT_ANOVA_FACTORS);
    set->people = (size_t)reference_number(reference_field(&rest, ','));
    set->cells = 1;
    for (size_t j = 0; j < set->factors; j++)
        set->cells *= set->levels[j] = (size_t)levels[j];
    assert_int_equal(reference_numbers(reference_field(&rest, ','), set->values, MOST),
                     set->people * set->cells);
    assert_true(stat_anova_within(set->values, set->people, set->levels, set->factors, &set->anova));
}

static const struct stat_anova_effect *find(const struct stat_anova *anova, unsigned mask)
{
    for (size_t i = 0; i < anova->effect_count; i++)
        if (anova->effects[i].factors == mask)
            return &anova->effects[i];
    return NULL;
}

// aov() subtracts nothing: sums of squares that are small against the values' own carry rounding of about 1e-13
// of them, and so does what is made from those.
static double compare(const double *got, const double *expected, size_t count, double absolute, size_t row)
{
    double worst = 0;
    for (size_t i = 0; i < count; i++) {
        double off = reference_distance(got[i], expected[i]);
        bool tiny = fabs(got[i] - expected[i]) <= absolute;
        if (off > 1e-9 && !tiny)
            fail_msg("number %zu of row %zu: %.17g, R %.17g", i, row, got[i], expected[i]);
        worst = fmax(worst, tiny ? 0 : off);
    }
    return worst;
}

static double check_effect(const struct set *set, char *rest, size_t row)
{
    double expected[NUMBERS];
    unsigned mask = (unsigned)reference_number(reference_field(&rest, ','));
    assert_int_equal(reference_numbers(rest, expected, NUMBERS), NUMBERS);
    const struct stat_anova_effect *e = find(&set->anova, mask);
    assert_non_null(e);
    const double got[] = {e->ss,   e->ss_error, e->df,           e->df_error,
                          e->f,    e->p_value,  e->epsilon_gg,   e->epsilon_hf,
                          e->p_gg, e->p_hf,     e->eta2_partial, e->eta2_generalised};
    return compare(got, expected, NUMBERS, 1e-13, row);
}

static double check_within(const struct set *set, char *rest, size_t row)
{
    double expected[MOST], mean[MOST], half[MOST], conf = reference_number(reference_field(&rest, ','));
    assert_true(stat_within_intervals(set->values, set->people, set->cells, conf, mean, half));
    assert_int_equal(reference_numbers(reference_field(&rest, ','), expected, MOST), set->cells);
    double worst = compare(mean, expected, set->cells, 1e-14, row);
    assert_int_equal(reference_numbers(reference_field(&rest, ','), expected, MOST), set->cells);
    return fmax(worst, compare(half, expected, set->cells, 1e-13, row));
}

static void agrees_with_r(void **state)
{
    (void)state;
    FILE *file = reference_open("anova.csv");
    static char line[32768];
    static struct set set;
    size_t rows = 0, sets = 0, effects = 0;
    double worst = 0;
    for (; fgets(line, sizeof line, file); rows++) {
        line[strcspn(line, "\n")] = '\0';
        char *rest = line;
        const char *what = reference_field(&rest, ',');
        if (strcmp(what, "data") == 0) {
            assert_int_equal(effects, sets ? set.anova.effect_count : 0); // none of the last set is missing
            read_set(rest, &set);
            sets++, effects = 0;
        } else if (strcmp(what, "effect") == 0) {
            worst = fmax(worst, check_effect(&set, rest, rows + 1));
            effects++;
        } else {
            assert_string_equal(what, "within");
            worst = fmax(worst, check_within(&set, rest, rows + 1));
        }
    }
    fclose(file);
    print_message("%zu data sets, %zu rows within %.1e (relative, or 1e-13)\n", sets, rows, worst);
    assert_true(sets >= 60);
}

// With two levels F is the square of the paired t; the interval of the difference is sqrt(2) times as wide.
static void two_levels_are_a_paired_test(void **state)
{
    (void)state;
    const double x[] = {6, 7, 5, 8, 6, 4}, y[] = {5, 7, 3, 6, 7, 1};
    double both[12], mean[2], half[2];
    for (int i = 0; i < 6; i++)
        both[2 * i] = x[i], both[2 * i + 1] = y[i];
    struct stat_anova a;
    assert_true(stat_anova_within(both, 6, (size_t[]){2}, 1, &a));
    struct stat_ttest t = stat_ttest_paired(x, y, 6, NULL);
    assert_true(reference_close(a.effects[0].f, t.t * t.t, 1e-13));
    assert_true(reference_close(a.effects[0].p_value, t.p_value, 1e-13));
    assert_true(a.effects[0].epsilon_gg == 1 && a.effects[0].p_hf == a.effects[0].p_value);
    assert_true(stat_within_intervals(both, 6, 2, 0.95, mean, half));
    assert_true(reference_close(half[0] * sqrt(2), (t.ci_high - t.ci_low) / 2, 1e-13));
}

// 1e9 in every value, and a person's own level, change nothing but the people's sum of squares.
static void offsets_change_nothing(void **state)
{
    (void)state;
    double near[8 * 12], far[8 * 12];
    const size_t levels[] = {2, 3, 2};
    for (int i = 0; i < 8 * 12; i++) {
        far[i] = 1e9 + (i * i * 7 % 29) * 1e-3;
        near[i] = far[i] - 1e9; // exact
    }
    struct stat_anova a, b;
    assert_true(stat_anova_within(near, 8, levels, 3, &a) && stat_anova_within(far, 8, levels, 3, &b));
    assert_int_equal(a.effect_count, 7);
    for (size_t i = 0; i < 7; i++) {
        assert_true(reference_close(b.effects[i].f, a.effects[i].f, 1e-10));
        assert_true(reference_close(b.effects[i].p_gg, a.effects[i].p_gg, 1e-10));
        assert_true(reference_close(b.effects[i].eta2_generalised, a.effects[i].eta2_generalised, 1e-10));
    }
    for (int i = 0; i < 8 * 12; i++)
        near[i] += i / 12 * 64;
    assert_true(stat_anova_within(near, 8, levels, 3, &b));
    assert_true(reference_close(b.effects[6].f, a.effects[6].f, 1e-9) && b.ss_people > 1000 * a.ss_people);
}

static void bad_input(void **state)
{
    (void)state;
    double flat[12], line[12], missing[12], mean[3], half[3];
    struct stat_anova a;
    for (int i = 0; i < 12; i++) {
        flat[i] = 4;
        line[i] = i % 3 + i / 3; // no error: everybody has the same profile
        missing[i] = i == 5 ? (double)NAN : i * i % 7;
    }
    assert_true(stat_anova_within(flat, 4, (size_t[]){3}, 1, &a));
    assert_true(isnan(a.effects[0].f) && isnan(a.effects[0].p_gg) && isnan(a.effects[0].eta2_generalised));
    assert_true(stat_anova_within(line, 4, (size_t[]){3}, 1, &a));
    assert_true(isnan(a.effects[0].f) && isnan(a.effects[0].epsilon_gg) && a.effects[0].ss > 0);
    assert_true(stat_anova_within(missing, 4, (size_t[]){3}, 1, &a) && isnan(a.effects[0].p_value));
    assert_false(stat_anova_within(flat, 1, (size_t[]){3}, 1, &a));
    assert_false(stat_anova_within(flat, 4, (size_t[]){1}, 1, &a) || a.effect_count);
    assert_false(stat_anova_within(flat, 4, (size_t[]){3}, 0, &a));
    assert_false(stat_anova_within(flat, 4, (size_t[]){SIZE_MAX / 8, 3}, 2, &a));
    assert_true(stat_within_intervals(missing, 4, 3, 0.95, mean, half) && isnan(half[0]));
    assert_true(stat_within_intervals(line, 4, 3, 1, mean, half) && isnan(half[0]) && mean[0] == 1.5);
    assert_false(stat_within_intervals(line, 0, 3, 0.95, mean, half));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(agrees_with_r),
                                       cmocka_unit_test(two_levels_are_a_paired_test),
                                       cmocka_unit_test(offsets_change_nothing), cmocka_unit_test(bad_input)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
