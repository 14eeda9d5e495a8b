// Choices of several answers per person against R (tests/reference/people.R), and by law.
#include "analysis/stats/binomial.h"
#include "analysis/stats/mixed_logit.h"
#include "analysis/stats/multiple.h"
#include "analysis/stats/people.h"
#include "analysis/stats/people_equivalence.h"
#include "analysis/stats/signflip.h"
#include "reference.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { MOST = 64, VALUES = 17 };

enum value {
    FLIP_TWO,
    FLIP_LESS,
    FLIP_GREATER,
    SHARE,
    T_LOW,
    T_HIGH,
    T_P,
    T_P6,
    DISPERSION,
    GLMER_INTERCEPT,
    GLMER_ERROR,
    GLMER_SD,
    INTERCEPT,
    ERROR,
    SD,
    LOGLIK,
    POPULATION
};

struct row {
    char name[64];
    struct stat_person people[MOST];
    size_t count;
    double value[VALUES];
};

static bool read_row(FILE *file, struct row *row)
{
    char line[4096];
    double k[MOST], n[MOST];
    if (!fgets(line, sizeof line, file))
        return false;
    line[strcspn(line, "\n")] = '\0';
    char *rest = line;
    snprintf(row->name, sizeof row->name, "%s", reference_field(&rest, ','));
    row->count = reference_numbers(reference_field(&rest, ','), k, MOST);
    assert_int_equal(reference_numbers(reference_field(&rest, ','), n, MOST), row->count);
    for (size_t i = 0; i < row->count; i++)
        row->people[i] = (struct stat_person){(int64_t)k[i], (int64_t)n[i]};
    for (int i = 0; i < VALUES; i++)
        row->value[i] = reference_number(reference_field(&rest, ','));
    return true;
}

// Fails where a value is further off than `most`; returns the distance. NaN must meet NaN.
static double within(const struct row *row, enum value which, double value, double most, bool relative)
{
    double expected = row->value[which], off = fabs(value - expected);
    if (isnan(value) && isnan(expected))
        return 0;
    if (relative && expected != 0)
        off /= fabs(expected);
    if (!(off <= most))
        fail_msg("%s, value %d: %.17g, R %.17g", row->name, which, value, expected);
    return off;
}

static size_t each_row(void (*check)(const struct row *row))
{
    FILE *file = reference_open("people.csv");
    char line[1024];
    struct row row;
    size_t rows = 0;
    assert_non_null(fgets(line, sizeof line, file));
    for (; read_row(file, &row); rows++)
        check(&row);
    fclose(file);
    assert_true(rows >= 80);
    return rows;
}

static double worst_flip, worst_t, worst_dispersion;

static void check_tests(const struct row *row)
{
    static const enum stat_alternative alternatives[] = {STAT_TWO_SIDED, STAT_LESS, STAT_GREATER};
    for (int i = 0; i < 3; i++) {
        struct stat_signflip flip = stat_signflip(row->people, row->count, alternatives[i]);
        if (isnan(row->value[FLIP_TWO]) && flip.people > 0) // too many signs to list
            continue;
        worst_flip = fmax(worst_flip, within(row, FLIP_TWO + (enum value)i, flip.p_value, 1e-13, true));
        assert_true(flip.people == 0 || flip.least_p <= flip.p_value);
    }
    struct stat_ttest t = stat_people_t(row->people, row->count, &(struct stat_ttest_options){.mean = 0.5}),
                      t6 =
                          stat_people_t(row->people, row->count,
                                        &(struct stat_ttest_options){.mean = 0.6, .alternative = STAT_GREATER});
    worst_t = fmax(worst_t, within(row, SHARE, stat_people_share(row->people, row->count), 1e-14, true));
    worst_t = fmax(worst_t, within(row, T_LOW, t.ci_low, 1e-10, true));
    worst_t = fmax(worst_t, within(row, T_HIGH, t.ci_high, 1e-10, true));
    worst_t = fmax(worst_t, within(row, T_P, t.p_value, 1e-10, true));
    worst_t = fmax(worst_t, within(row, T_P6, t6.p_value, 1e-10, true));
    worst_dispersion = fmax(worst_dispersion,
                            within(row, DISPERSION, stat_overdispersion(row->people, row->count), 1e-10, true));
}

static void tests_agree_with_r(void **state)
{
    (void)state;
    size_t rows = each_row(check_tests);
    print_message(
        "%zu data sets: sign-flip within %.1e, t within %.1e, overdispersion within %.1e (relative)\n", rows,
        worst_flip, worst_t, worst_dispersion);
}

static double worst_glmer, worst_direct, worst_likelihood;
static size_t fitted, held_to_glmer;

// Whether R's two ways agree: 25 Gauss-Hermite points do not always suffice.
static bool glmer_is_exact(const struct row *row)
{
    for (int i = 0; i < 3; i++)
        if (!(fabs(row->value[GLMER_INTERCEPT + i] - row->value[INTERCEPT + i]) <= 5e-4))
            return false;
    return true;
}

static void check_model(const struct row *row)
{
    struct stat_mixed_logit fit = stat_mixed_logit(row->people, row->count, NULL);
    bool exists = fit.state == STAT_MIXED_FITTED || fit.state == STAT_MIXED_SD_ZERO;
    assert_true(exists == !isnan(row->value[INTERCEPT]));
    assert_true(exists == (stat_mixed_words(fit.state)[0] == '\0' || fit.sd == 0));
    if (!exists) {
        assert_true(isnan(fit.intercept) && isnan(fit.p_value) && isnan(fit.population) && isnan(fit.sd));
        return;
    }
    fitted++;
    worst_likelihood = fmax(worst_likelihood, within(row, LOGLIK, fit.log_likelihood, 1e-6, false));
    worst_direct = fmax(worst_direct, within(row, INTERCEPT, fit.intercept, 2e-5, false));
    worst_direct = fmax(worst_direct, within(row, ERROR, fit.std_error, 2e-5, false));
    worst_direct = fmax(worst_direct, within(row, SD, fit.sd, 2e-5, false));
    worst_direct = fmax(worst_direct, within(row, POPULATION, fit.population, 2e-5, false));
    if (!glmer_is_exact(row))
        return;
    held_to_glmer++;
    worst_glmer = fmax(worst_glmer, within(row, GLMER_INTERCEPT, fit.intercept, 1e-3, false));
    worst_glmer = fmax(worst_glmer, within(row, GLMER_ERROR, fit.std_error, 1e-3, false));
    worst_glmer = fmax(worst_glmer, within(row, GLMER_SD, fit.sd, 1e-3, false));
}

static void model_agrees_with_r(void **state)
{
    (void)state;
    each_row(check_model);
    print_message(
        "%zu fits: within %.1e of direct integration, log-likelihood within %.1e; %zu within %.1e of glmer "
        "(absolute)\n",
        fitted, worst_direct, worst_likelihood, held_to_glmer, worst_glmer);
    assert_true(fitted >= 60 && held_to_glmer >= 50);
}

static void states_are_told_apart(void **state)
{
    (void)state;
    const struct {
        struct stat_person people[3];
        size_t count;
        enum stat_mixed_state state;
    } cases[] = {
        {{{0, 9}, {0, 9}, {0, 9}}, 3, STAT_MIXED_ALL_SAME}, {{{9, 9}, {0, 9}, {9, 9}}, 3, STAT_MIXED_SPLIT},
        {{{1, 1}, {0, 1}, {1, 1}}, 3, STAT_MIXED_ONE_EACH}, {{{4, 9}, {0, 0}, {0, 0}}, 3, STAT_MIXED_TOO_FEW},
        {{{4, 9}, {5, 9}, {4, 9}}, 3, STAT_MIXED_SD_ZERO},  {{{4, 9}, {9, 9}, {1, 9}}, 3, STAT_MIXED_FITTED},
        {{{4, 3}, {9, 9}, {1, 9}}, 3, STAT_MIXED_BAD},      {{{-1, 3}, {9, 9}, {1, 9}}, 3, STAT_MIXED_BAD},
        {{{0, 0}, {0, 0}, {0, 0}}, 3, STAT_MIXED_TOO_FEW},  {{{0, 0}, {0, 0}, {0, 0}}, 0, STAT_MIXED_TOO_FEW},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        assert_int_equal(stat_mixed_logit(cases[i].people, cases[i].count, NULL).state, cases[i].state);
}

// What must hold of any data: to swap the options turns estimates around, the order of people is nothing, and
// the mean preference lies between one half and the middle person's.
static void swapping_turns_around(void **state)
{
    (void)state;
    struct stat_person people[] = {{3, 9}, {8, 9}, {9, 9}, {2, 7}, {6, 8}, {7, 7}, {5, 9}}, other[7];
    for (int i = 0; i < 7; i++)
        other[i] = (struct stat_person){people[6 - i].n - people[6 - i].k, people[6 - i].n};
    struct stat_mixed_logit a = stat_mixed_logit(people, 7, NULL), b = stat_mixed_logit(other, 7, NULL);
    assert_true(fabs(a.intercept + b.intercept) < 1e-8 && fabs(a.sd - b.sd) < 1e-8);
    assert_true(fabs(a.population + b.population - 1) < 1e-8 && fabs(a.p_value - b.p_value) < 1e-8);
    assert_true(fabs(a.population_ci.low + b.population_ci.high - 1) < 1e-8);
    assert_true(a.population > 0.5 && a.population < a.conditional);
    assert_true(a.conditional_ci.low < a.conditional && a.conditional < a.conditional_ci.high);
    assert_true(stat_signflip(people, 7, STAT_LESS).p_value == stat_signflip(other, 7, STAT_GREATER).p_value);
    assert_true(stat_signflip(people, 7, STAT_TWO_SIDED).p_value ==
                stat_signflip(other, 7, STAT_TWO_SIDED).p_value);
    assert_true(fabs(stat_overdispersion(people, 7) - stat_overdispersion(other, 7)) < 1e-12);
    struct stat_mixed_logit less = stat_mixed_logit(people, 7,
                                                    &(struct stat_mixed_options){.alternative = STAT_LESS}),
                            greater = stat_mixed_logit(
                                people, 7, &(struct stat_mixed_options){.alternative = STAT_GREATER});
    assert_true(fabs(less.p_value + greater.p_value - 1) < 1e-12);
    assert_true(fabs(2 * greater.p_value - a.p_value) < 1e-12);
    assert_true(less.conditional_ci.low == 0 && greater.population_ci.high == 1);
}

// One answer each: flipping signs is flipping coins, the binomial test. Many people, so that the tail is small.
static void one_answer_each_is_binomial(void **state)
{
    (void)state;
    static struct stat_person people[1000];
    for (int n = 1; n <= 1000; n += n < 40 ? 1 : 137)
        for (int k = 0; k <= n; k += n < 40 ? 1 : 19) {
            for (int i = 0; i < n; i++)
                people[i] = (struct stat_person){i < k, 1};
            for (int a = 0; a < 3; a++) {
                double p = stat_signflip(people, (size_t)n, (enum stat_alternative)a).p_value;
                assert_true(reference_close(p, stat_binomial_p(k, n, 0.5, (enum stat_alternative)a), 1e-10));
            }
            assert_true(isnan(stat_overdispersion(people, (size_t)n)));
        }
}

static void least_p_is_reached(void **state)
{
    (void)state;
    for (size_t n = 1; n <= 30; n++) {
        struct stat_person people[30];
        for (size_t i = 0; i < n; i++)
            people[i] = (struct stat_person){9, 9};
        struct stat_signflip two = stat_signflip(people, n, STAT_TWO_SIDED),
                             one = stat_signflip(people, n, STAT_GREATER);
        assert_true(two.p_value == two.least_p && two.least_p == ldexp(1, 1 - (int)n));
        assert_true(one.p_value == one.least_p && one.least_p == ldexp(1, -(int)n));
        assert_true((two.least_p > 0.05) == (n <= 5)); // five people or fewer cannot reach 0.05
    }
}

static void holm_adjusts(void **state)
{
    (void)state;
    // p.adjust(c(0.01, 0.04, 0.03, NA, 0.005, 0.04, 1), "holm") of R 4.2
    const double p[] = {0.01, 0.04, 0.03, (double)NAN, 0.005, 0.04, 1},
                 expected[] = {0.05, 0.12, 0.12, (double)NAN, 0.03, 0.12, 1};
    double out[7];
    stat_adjust_holm(p, 7, out);
    for (int i = 0; i < 7; i++)
        assert_true(isnan(expected[i]) ? isnan(out[i]) : fabs(out[i] - expected[i]) < 1e-15);
    const double small[] = {1e-200, 3e-200};
    stat_adjust_holm(small, 2, out);
    assert_true(out[0] == 2e-200 && out[1] == 3e-200);
    stat_adjust_holm(NULL, 0, NULL);
}

static void bad_input(void **state)
{
    (void)state;
    const struct stat_person bad[][2] = {
        {{3, 2}, {1, 2}}, {{-1, 2}, {1, 2}}, {{0, -1}, {1, 2}}, {{1, STAT_PEOPLE_MAX_N + 1}, {1, 2}}};
    for (int i = 0; i < 4; i++) {
        assert_true(isnan(stat_signflip(bad[i], 2, STAT_TWO_SIDED).p_value));
        assert_true(isnan(stat_people_t(bad[i], 2, NULL).p_value));
        assert_true(isnan(stat_people_share(bad[i], 2)));
        assert_true(isnan(stat_overdispersion(bad[i], 2)));
        assert_int_equal(stat_mixed_logit(bad[i], 2, NULL).state, STAT_MIXED_BAD);
    }
    const struct stat_person good[] = {{4, 9}, {9, 9}, {1, 9}};
    const double levels[] = {-1, 1, 2, (double)NAN, (double)INFINITY};
    for (int i = 0; i < 5; i++) {
        assert_int_equal(stat_mixed_logit(good, 3, &(struct stat_mixed_options){.p0 = levels[i]}).state,
                         STAT_MIXED_BAD);
        assert_int_equal(stat_mixed_logit(good, 3, &(struct stat_mixed_options){.conf = levels[i]}).state,
                         STAT_MIXED_BAD);
    }
    const struct stat_person huge[] = {{STAT_PEOPLE_MAX_N, STAT_PEOPLE_MAX_N}, {1, STAT_PEOPLE_MAX_N - 1}};
    double p = stat_signflip(huge, 2, STAT_TWO_SIDED).p_value;
    assert_true(isnan(p) || (p >= 0 && p <= 1));
    assert_true(isnan(stat_signflip(NULL, 0, STAT_TWO_SIDED).p_value));
}

static void equivalence_agrees_with_r(void **state)
{
    (void)state;
    FILE *file = reference_open("people_equivalence.csv");
    char line[2048];
    size_t rows = 0;
    assert_non_null(fgets(line, sizeof line, file));
    for (; fgets(line, sizeof line, file); rows++) {
        struct stat_person people[MOST];
        double k[MOST], n[MOST], value[7];
        line[strcspn(line, "\n")] = '\0';
        char *rest = line;
        size_t count = reference_numbers(reference_field(&rest, ','), k, MOST);
        assert_int_equal(reference_numbers(reference_field(&rest, ','), n, MOST), count);
        for (size_t i = 0; i < count; i++)
            people[i] = (struct stat_person){(int64_t)k[i], (int64_t)n[i]};
        for (int i = 0; i < 7; i++)
            value[i] = reference_number(reference_field(&rest, ','));
        struct stat_equivalence e = stat_people_equivalence(people, count, value[0], value[1], value[2]);
        const double got[] = {e.p_low, e.p_high, e.ci.low, e.ci.high};
        for (int i = 0; i < 4; i++)
            if (!(fabs(got[i] - value[3 + i]) <= 1e-10 * fmax(1e-3, fabs(value[3 + i]))))
                fail_msg("row %zu, value %d: %.17g, R %.17g", rows, i, got[i], value[3 + i]);
        bool inside = e.ci.low > value[0] - value[1] && e.ci.high < value[0] + value[1];
        assert_true(inside == (e.p_value <= value[2]));
    }
    fclose(file);
    assert_int_equal(rows, 24);
    const struct stat_person same[] = {{5, 10}, {5, 10}, {5, 10}};
    assert_true(isnan(stat_people_equivalence(same, 3, 0.5, 0.1, 0.05).p_value)); // no spread, no t
    assert_true(isnan(stat_people_equivalence(same, 1, 0.5, 0.1, 0.05).p_value));
    assert_true(isnan(stat_people_equivalence(same, 3, 0.5, 0.6, 0.05).p_value));
    assert_true(isnan(stat_people_equivalence(same, 3, 0.5, 0.1, 0.5).p_value));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equivalence_agrees_with_r),
        cmocka_unit_test(tests_agree_with_r),
        cmocka_unit_test(model_agrees_with_r),
        cmocka_unit_test(states_are_told_apart),
        cmocka_unit_test(swapping_turns_around),
        cmocka_unit_test(one_answer_each_is_binomial),
        cmocka_unit_test(least_p_is_reached),
        cmocka_unit_test(holm_adjusts),
        cmocka_unit_test(bad_input),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
