// Tests of tables of counts against R (tests/reference/counts.R) and whole numbers (fisher.py), and by law.
#include "analysis/stats/binomial_sample_size.h"
#include "analysis/stats/chi_squared.h"
#include "analysis/stats/cochran.h"
#include "analysis/stats/exchange.h"
#include "analysis/stats/fisher.h"
#include "analysis/stats/mcnemar.h"
#include "analysis/stats/power.h"
#include "reference.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { MOST = 256 };

static struct stat_counts counts_of(const double *input, int64_t *counts)
{
    struct stat_counts table = {counts, (int)input[0], (int)input[1]};
    for (int i = 0; i < table.rows * table.columns; i++)
        counts[i] = (int64_t)input[2 + i];
    return table;
}

static size_t mcnemar(const double *input, double *out)
{
    struct stat_mcnemar t = stat_mcnemar_test((int64_t)input[0], (int64_t)input[1], input[2]);
    const double values[] = {t.p_exact,     t.p_mid,      t.chi_squared, t.p_value, t.chi_squared_corrected,
                             t.p_corrected, t.odds_ratio, t.ci.low,      t.ci.high};
    memcpy(out, values, sizeof values);
    return 9;
}

static size_t chi_squared(const double *input, double *out)
{
    int64_t counts[MOST];
    struct stat_chi_squared t = stat_chi_squared_test(counts_of(input, counts));
    const double values[] = {t.statistic, t.df, t.p_value, t.corrected, t.p_corrected, t.least_expected};
    memcpy(out, values, sizeof values);
    return 6;
}

static size_t fisher(const double *input, double *out)
{
    int64_t counts[MOST];
    out[0] = stat_fisher_p(counts_of(input, counts));
    return 1;
}

static size_t cochran(const double *input, double *out)
{
    size_t people = (size_t)input[0], conditions = (size_t)input[1];
    unsigned char answers[MOST];
    for (size_t i = 0; i < people * conditions; i++)
        answers[i] = (unsigned char)input[2 + i];
    struct stat_cochran t = stat_cochran_q(answers, people, conditions, (struct stat_permuting){0});
    assert_true(t.permutation.exact && t.permutation.standard_error == 0);
    const double values[] = {t.statistic, t.df, t.p_value, t.permutation.p_value};
    memcpy(out, values, sizeof values);
    return 4;
}

// `group` and `counts` have room for what the input holds.
static struct stat_groups_of_people people_of(const double *input, int *group, int64_t *counts)
{
    struct stat_groups_of_people p = {(size_t)input[0], (size_t)input[1], (size_t)input[2], group, counts};
    for (size_t i = 0; i < p.people; i++)
        group[i] = (int)input[3 + i];
    for (size_t i = 0; i < p.people * p.categories; i++)
        counts[i] = (int64_t)input[3 + p.people + i];
    return p;
}

static size_t people(const double *input, double *out)
{
    int group[MOST];
    int64_t counts[MOST];
    struct stat_groups_of_people p = people_of(input, group, counts);
    struct stat_permutation exact = stat_exchange_test(&p, (struct stat_permuting){0}),
                            drawn = stat_exchange_test(&p, (struct stat_permuting){-1, 20000, 7});
    assert_true(exact.exact && exact.standard_error == 0 && !drawn.exact);
    assert_true(drawn.arrangements == 20000 && drawn.statistic == exact.statistic);
    // one seed, so that this holds today and tomorrow: four standard errors of the exact p
    double error = sqrt(exact.p_value * (1 - exact.p_value) / 20000);
    assert_true(fabs(drawn.p_value - exact.p_value) <= 4 * error + 1e-4);
    assert_true(fabs(drawn.standard_error - error) <= 0.2 * error + 1e-4);
    out[0] = exact.statistic;
    out[1] = exact.p_value;
    return 2;
}

static size_t size(const double *input, double *out)
{
    struct stat_sample_size s = stat_binomial_sample_size(input[0], input[1], input[2], input[3]);
    out[0] = (double)s.first;
    out[1] = (double)s.stays;
    return 2;
}

static const struct {
    const char *name;
    size_t (*compute)(const double *input, double *out);
    size_t rows; // at least
} tests_of[] = {{"mcnemar", mcnemar, 20}, {"chi_squared", chi_squared, 20}, {"fisher", fisher, 20},
                {"cochran", cochran, 10}, {"people", people, 10},           {"size", size, 20}};

static void agrees_with_r(void **state)
{
    (void)state;
    enum { TESTS = sizeof tests_of / sizeof tests_of[0] };
    FILE *file = reference_open("counts.csv");
    char line[8192];
    size_t rows[TESTS] = {0};
    double worst[TESTS] = {0};
    assert_non_null(fgets(line, sizeof line, file));
    while (fgets(line, sizeof line, file)) {
        line[strcspn(line, "\n")] = '\0';
        char *rest = line;
        const char *what = reference_field(&rest, ',');
        double input[MOST], expected[16], got[16];
        reference_numbers(reference_field(&rest, ','), input, MOST);
        size_t count = reference_numbers(reference_field(&rest, ','), expected, 16), which = 0;
        while (which < TESTS && strcmp(tests_of[which].name, what) != 0)
            which++;
        assert_true(which < TESTS);
        assert_int_equal(tests_of[which].compute(input, got), count);
        for (size_t i = 0; i < count; i++) {
            double off = reference_distance(got[i], expected[i]);
            if (!(off <= 1e-10))
                fail_msg("%s row %zu number %zu: %.17g, R %.17g", what, rows[which] + 1, i + 1, got[i],
                         expected[i]);
            worst[which] = fmax(worst[which], off);
        }
        rows[which]++;
    }
    fclose(file);
    for (size_t i = 0; i < TESTS; i++) {
        print_message("%s: %zu rows within %.1e (relative)\n", tests_of[i].name, rows[i], worst[i]);
        assert_true(rows[i] >= tests_of[i].rows);
    }
}

static void fisher_agrees_with_whole_numbers(void **state)
{
    (void)state;
    FILE *file = reference_open("fisher.csv");
    char line[512];
    double worst = 0;
    size_t rows = 0;
    assert_non_null(fgets(line, sizeof line, file));
    for (; fgets(line, sizeof line, file); rows++) {
        line[strcspn(line, "\n")] = '\0';
        char *rest = line;
        int64_t counts[4];
        for (int i = 0; i < 4; i++)
            counts[i] = strtoll(reference_field(&rest, ','), NULL, 10);
        double conf = reference_number(reference_field(&rest, ','));
        const char *word = reference_field(&rest, ',');
        enum stat_alternative alternative = strcmp(word, "less") == 0      ? STAT_LESS
                                            : strcmp(word, "greater") == 0 ? STAT_GREATER
                                                                           : STAT_TWO_SIDED;
        struct stat_fisher t = stat_fisher_2x2(counts, conf, alternative);
        const double got[] = {t.p_value, t.odds_ratio, t.ci.low, t.ci.high};
        for (int i = 0; i < 4; i++) {
            double expected = reference_number(reference_field(&rest, ',')),
                   off = reference_distance(got[i], expected);
            if (!(off <= 1e-10))
                fail_msg("row %zu number %d: %.17g, expected %.17g", rows + 1, i + 1, got[i], expected);
            worst = fmax(worst, off);
        }
    }
    fclose(file);
    print_message("%zu rows within %.1e (relative)\n", rows, worst);
    assert_true(rows >= 30);
}

// The walk over all tables and the hypergeometric sum are one test on a 2 x 2 table.
static void fisher_twice(void **state)
{
    (void)state;
    for (int64_t i = 0; i < 400; i++) {
        const int64_t counts[4] = {i % 7, 3 + i % 5, i / 40, 9 - i % 9};
        double p = stat_fisher_2x2(counts, 0.95, STAT_TWO_SIDED).p_value;
        assert_true(reference_close(stat_fisher_p((struct stat_counts){counts, 2, 2}), p, 1e-10));
    }
    int64_t many[36];
    for (int i = 0; i < 36; i++)
        many[i] = 40 + 7 * i % 23;
    assert_true(isnan(stat_fisher_p((struct stat_counts){many, 6, 6}))); // said, not waited for
}

// McNemar without correction is Cochran's Q of two conditions, and both are blind to people of one answer.
static void mcnemar_is_cochran(void **state)
{
    (void)state;
    for (int b = 0; b <= 12; b++)
        for (int c = b == 0; c <= 9; c++) {
            unsigned char answers[2 * 40];
            for (int i = 0; i < 40; i++) {
                answers[2 * i] = (unsigned char)(i < b || i >= 30);
                answers[2 * i + 1] = (unsigned char)((i >= b && i < b + c) || i >= 30);
            }
            struct stat_cochran q = stat_cochran_q(answers, 40, 2, (struct stat_permuting){4000000, 0, 0});
            struct stat_mcnemar m = stat_mcnemar_test(b, c, 0.95);
            assert_true(reference_close(q.statistic, m.chi_squared, 1e-12));
            assert_true(q.permutation.exact && q.permutation.arrangements == INT64_C(1) << (b + c));
            assert_true(reference_close(q.permutation.p_value, m.p_exact, 1e-12)); // exact tests are the same
            if (b + c > 18)
                break; // a million arrangements are enough
        }
}

// People whose answers repeat: the pooled test sees what is not there, the permutation of people does not.
static void repeats_are_not_people(void **state)
{
    (void)state;
    const int group[] = {0, 0, 0, 1, 1, 1};
    const int64_t once[] = {1, 0, 1, 0, 0, 1, 0, 1, 0, 1, 1, 0};
    int64_t often[12];
    for (int i = 0; i < 12; i++)
        often[i] = 50 * once[i];
    struct stat_groups_of_people p = {6, 2, 2, group, once}, q = {6, 2, 2, group, often};
    struct stat_permutation a = stat_exchange_test(&p, (struct stat_permuting){0}),
                            b = stat_exchange_test(&q, (struct stat_permuting){0});
    assert_true(a.p_value == b.p_value && a.arrangements == 20);
    const int64_t pooled[] = {100, 50, 50, 100};
    assert_true(stat_chi_squared_test((struct stat_counts){pooled, 2, 2}).p_value < 1e-8 && b.p_value > 0.5);
}

// Every n from `stays` to far beyond has the power, the one before it lacks it, and none before `first` has it.
static void sample_size_holds(void **state)
{
    (void)state;
    const double shares[] = {0.6, 0.66, 0.9, 0.2}, nulls[] = {0.5, 0.5, 0.75, 0.1};
    for (int i = 0; i < 4; i++) {
        struct stat_sample_size s = stat_binomial_sample_size(nulls[i], shares[i], 0.05, 0.8);
        assert_true(s.first >= 1 && s.stays >= s.first);
        assert_true(stat_binomial_power(s.stays - 1, nulls[i], shares[i], 0.05) < 0.8);
        for (int64_t n = s.stays; n < 4 * s.stays; n++)
            assert_true(stat_binomial_power(n, nulls[i], shares[i], 0.05) >= 0.8);
        for (int64_t n = 1; n < s.first; n++)
            assert_true(stat_binomial_power(n, nulls[i], shares[i], 0.05) < 0.8);
    }
    assert_int_equal(stat_binomial_sample_size(0.5, 0.5, 0.05, 0.8).stays, 0);
    assert_int_equal(stat_binomial_sample_size(0.5, 0.5001, 0.05, 0.8).first, 0);
    assert_int_equal(stat_binomial_sample_size(0.5, (double)NAN, 0.05, 0.8).first, 0);
    assert_int_equal(stat_binomial_sample_size(0.5, 0.7, 1, 0.8).first, 0);
    assert_int_equal(stat_binomial_sample_size(0.5, 0.7, 0.05, 1).first, 0);
}

static void bad_tables(void **state)
{
    (void)state;
    const int64_t negative[4] = {1, 2, -1, 3}, none[4] = {0}, column[4] = {0, 1, 0, 2},
                  huge[4] = {INT64_MAX, 1, 1, 1};
    const int64_t *bad[] = {negative, none, huge};
    for (int i = 0; i < 3; i++) {
        assert_true(isnan(stat_fisher_2x2(bad[i], 0.95, STAT_TWO_SIDED).p_value));
        assert_true(isnan(stat_fisher_p((struct stat_counts){bad[i], 2, 2})));
        assert_true(isnan(stat_chi_squared_test((struct stat_counts){bad[i], 2, 2}).statistic));
    }
    assert_true(isnan(stat_chi_squared_test((struct stat_counts){column, 2, 2}).p_value)); // as R
    assert_true(stat_fisher_p((struct stat_counts){column, 2, 2}) == 1);
    assert_true(isnan(stat_fisher_p((struct stat_counts){column, 1, 4})));
    assert_true(isnan(stat_chi_squared_test((struct stat_counts){column, 4, 1}).p_value));
    assert_true(isnan(stat_chi_squared_test((struct stat_counts){NULL, 2, 2}).p_value));
    assert_true(isnan(stat_fisher_2x2(column, 1, STAT_TWO_SIDED).p_value));
    assert_true(isnan(stat_mcnemar_test(-1, 2, 0.95).p_exact) && isnan(stat_mcnemar_test(1, 2, 0).p_exact));
    assert_true(isnan(stat_mcnemar_test(STAT_BINOMIAL_MAX_N, 1, 0.95).p_exact));
    struct stat_mcnemar nobody = stat_mcnemar_test(0, 0, 0.95);
    assert_true(nobody.p_exact == 1 && isnan(nobody.p_value) && isnan(nobody.odds_ratio));
}

static void bad_people(void **state)
{
    (void)state;
    const struct stat_permuting how = {0};
    const unsigned char alike[6] = {1, 1, 1, 0, 0, 0}, two[4] = {0, 2, 1, 0};
    assert_true(isnan(stat_cochran_q(alike, 2, 3, how).statistic));
    assert_true(isnan(stat_cochran_q(two, 2, 2, how).permutation.p_value));
    assert_true(isnan(stat_cochran_q(alike, 0, 3, how).p_value) &&
                isnan(stat_cochran_q(alike, 2, 1, how).p_value));
    assert_true(isnan(stat_cochran_q(two + 2, 1, 2, (struct stat_permuting){-1, -1, 0}).p_value));
    const int group[2] = {0, 1}, wrong[2] = {0, 2}, one[2] = {0, 0};
    const int64_t good[4] = {1, 2, 2, 1}, negative[4] = {1, 2, -1, 2}, empty[4] = {1, 0, 2, 0};
    const struct stat_groups_of_people bad[] = {
        {2, 2, 2, wrong, good}, {2, 2, 2, one, good},   {2, 2, 2, group, negative}, {2, 2, 2, group, empty},
        {1, 2, 2, group, good}, {2, 1, 2, group, good}, {2, 2, 1, group, good},     {2, 2, 2, group, NULL}};
    for (int i = 0; i < 8; i++)
        assert_true(isnan(stat_exchange_test(&bad[i], how).p_value) &&
                    stat_exchange_test(&bad[i], how).arrangements == 0);
}

// People of one answer to all conditions say nothing of their difference: 100,000 of them change no number.
static void cochran_of_many_people(void **state)
{
    (void)state;
    enum { CONDITIONS = 3, MIXED = 8 };
    static unsigned char answers[STAT_COCHRAN_PEOPLE * CONDITIONS];
    static const unsigned char mixed[MIXED * CONDITIONS] = {1, 0, 0, 1, 1, 0, 1, 0, 0, 1, 0, 1,
                                                            0, 1, 0, 1, 0, 0, 1, 1, 0, 1, 0, 0};
    for (size_t i = 0; i < STAT_COCHRAN_PEOPLE; i++)
        memset(answers + i * CONDITIONS, i % 3 == 0, CONDITIONS);
    for (size_t i = 0; i < MIXED; i++)
        memcpy(answers + (i * 12000 + 7) * CONDITIONS, mixed + i * CONDITIONS, CONDITIONS);
    for (int64_t most = -1; most <= 0; most++) {
        struct stat_permuting how = {most, 200, 7};
        struct stat_cochran few = stat_cochran_q(mixed, MIXED, CONDITIONS, how),
                            many = stat_cochran_q(answers, STAT_COCHRAN_PEOPLE, CONDITIONS, how);
        assert_true(fabs(few.statistic - many.statistic) <= 1e-9 * few.statistic);
        assert_int_equal(few.permutation.exact, most == 0);
        assert_int_equal(few.permutation.exact, many.permutation.exact);
        if (most == 0) {
            assert_true(few.permutation.p_value == many.permutation.p_value);
            assert_int_equal(many.permutation.arrangements, 6561); // three ways each
        } else {
            assert_true(fabs(few.permutation.p_value - many.permutation.p_value) < 0.15);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_r),
        cmocka_unit_test(cochran_of_many_people),
        cmocka_unit_test(fisher_agrees_with_whole_numbers),
        cmocka_unit_test(fisher_twice),
        cmocka_unit_test(mcnemar_is_cochran),
        cmocka_unit_test(repeats_are_not_people),
        cmocka_unit_test(sample_size_holds),
        cmocka_unit_test(bad_tables),
        cmocka_unit_test(bad_people),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
