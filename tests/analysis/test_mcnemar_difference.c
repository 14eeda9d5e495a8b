// The interval of a difference of shares of the same people, against R and by counting all tables of few
// people.
#include "analysis/stats/mcnemar.h"
#include "reference.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { MOST = 40 };

static int64_t whole(char **rest)
{
    return strtoll(reference_field(rest, ','), NULL, 10);
}

static void agrees_with_r(void **state)
{
    (void)state;
    FILE *file = reference_open("mcnemar_difference.csv");
    char line[256];
    size_t rows = 0;
    while (fgets(line, sizeof line, file)) {
        char *rest = line;
        line[strcspn(line, "\n")] = '\0';
        if (strcmp(reference_field(&rest, ','), "limits") != 0)
            continue;
        int64_t n = whole(&rest), b = whole(&rest), c = whole(&rest);
        double conf = reference_number(reference_field(&rest, ','));
        double low = reference_number(reference_field(&rest, ','));
        double high = reference_number(reference_field(&rest, ','));
        struct stat_interval ci = stat_mcnemar_difference(b, c, n, conf);
        // uniroot stops at 1e-15, integrate at 1e-12 of the tail
        if (!(fabs(ci.low - low) <= 1e-12) || !(fabs(ci.high - high) <= 1e-12))
            fail_msg("b %d c %d n %d: %.17g to %.17g, R %.17g to %.17g", (int)b, (int)c, (int)n, ci.low,
                     ci.high, low, high);
        rows++;
    }
    fclose(file);
    assert_int_equal(rows, 65);
}

struct tables {
    int n;
    struct stat_interval ci[MOST + 1][MOST + 1]; // of b and c
};

static void count(struct tables *t, int n, double conf)
{
    t->n = n;
    for (int b = 0; b <= n; b++)
        for (int c = 0; b + c <= n; c++)
            t->ci[b][c] = stat_mcnemar_difference(b, c, n, conf);
}

static double coverage(const struct tables *t, double x, double y)
{
    double sum = 0, rest = 1 - x - y > 1e-9 ? 1 - x - y : 0;
    for (int b = 0; b <= t->n; b++)
        for (int c = 0; b + c <= t->n; c++) {
            const struct stat_interval *ci = &t->ci[b][c];
            if (ci->low <= x - y + 1e-12 && ci->high >= x - y - 1e-12)
                sum += exp(lgamma(t->n + 1) - lgamma(b + 1) - lgamma(c + 1) - lgamma(t->n - b - c + 1)) *
                       pow(x, b) * pow(y, c) * pow(rest, t->n - b - c);
        }
    return sum;
}

// The row of a method and n in the second part of the reference: least and mean coverage.
static void known_coverage(const char *method, int n, double out[2])
{
    FILE *file = reference_open("mcnemar_difference.csv");
    char line[256];
    bool found = false;
    while (!found && fgets(line, sizeof line, file)) {
        char *rest = line;
        found = strcmp(reference_field(&rest, ','), method) == 0 && whole(&rest) == n;
        for (int i = 0; found && i < 2; i++)
            out[i] = reference_number(reference_field(&rest, ','));
    }
    fclose(file);
    assert_true(found);
}

static void covers_what_it_says(void **state)
{
    (void)state;
    static struct tables t;
    for (int n = 10; n <= MOST; n *= 2) {
        double least = 1, sum = 0, known[2];
        int points = 0;
        count(&t, n, 0.95);
        for (int i = 1; i <= 40; i++)
            for (int j = 0; j <= i && i + j <= 40; j++, points++) {
                double covered = coverage(&t, i / 40.0, j / 40.0);
                least = fmin(least, covered);
                sum += covered;
            }
        known_coverage("melded", n, known); // ten digits there
        assert_true(least >= 0.95);
        assert_true(fabs(least - known[0]) <= 1e-9 && fabs(sum / points - known[1]) <= 1e-9);
    }
}

// Both ways: 0 is outside exactly where the exact test's p is small.
static void never_contradicts_the_test(void **state)
{
    (void)state;
    static const double confs[] = {0.8, 0.95, 0.99};
    static struct tables t;
    size_t outside = 0;
    for (int i = 0; i < 12; i++) {
        const double conf = confs[i % 3];
        count(&t, 1 + 6 * (i / 3), conf);
        for (int b = 0; b <= t.n; b++)
            for (int c = 0; b + c <= t.n; c++) {
                struct stat_interval ci = t.ci[b][c], other = t.ci[c][b];
                double share = (double)(b - c) / t.n;
                bool out = ci.low > 0 || ci.high < 0;
                if (out != (stat_mcnemar_test(b, c, conf).p_exact < 1 - conf))
                    fail_msg("b %d c %d n %d: %g to %g", b, c, t.n, ci.low, ci.high);
                assert_true(ci.low >= -1 && ci.low <= share && share <= ci.high && ci.high <= 1);
                assert_true(ci.low == -other.high && ci.high == -other.low);
                outside += out;
            }
    }
    assert_true(outside > 100);
}

static void many_people_and_bad_input(void **state)
{
    (void)state;
    static const int64_t bad[][3] = {
        {-1, 0, 5}, {0, -1, 5}, {3, 3, 5}, {0, 0, 0}, {1, 1, STAT_BINOMIAL_MAX_N + 1}};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        assert_true(isnan(stat_mcnemar_difference(bad[i][0], bad[i][1], bad[i][2], 0.95).low));
    static const double confs[] = {0, 1, NAN, -0.5};
    for (size_t i = 0; i < 4; i++)
        assert_true(isnan(stat_mcnemar_difference(3, 1, 5, confs[i]).high));
    // With many people it is the normal one: the SD of the difference is sqrt((b + c - (b - c)^2 / n) / n^2).
    const int64_t n = 1000000000, b = 300000000, c = 299000000;
    double sd = sqrt((double)(b + c) - 1e12 / (double)n) / (double)n;
    struct stat_interval ci = stat_mcnemar_difference(b, c, n, 0.95);
    assert_true(fabs((ci.low - 1e-3) / sd + 1.959963984540054) < 1e-3);
    assert_true(fabs((ci.high - 1e-3) / sd - 1.959963984540054) < 1e-3);
    struct stat_interval wide = stat_mcnemar_difference(12, 2, 20, 1 - 1e-12);
    assert_true(wide.low > -1 && wide.low < 0 && wide.high < 1 && wide.high > 0.9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_r),
        cmocka_unit_test(covers_what_it_says),
        cmocka_unit_test(never_contradicts_the_test),
        cmocka_unit_test(many_people_and_bad_input),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
