// What the papers print of their statistics against what our functions make of their other printed numbers: the
// rows of tests/reference/papers.csv, which R computed. Those that follow must round to what is printed; those
// that do not are listed with their difference, and must not begin to follow unnoticed: the README has the same
// list.
#include "analysis/stats/binomial.h"
#include "analysis/stats/power_anova.h"
#include "reference.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

// Weier et al. 2016, section 4.2.2: means and standard deviations of the three fixation modes.
static const double mean[] = {0.43, 0.43, 0.99}, sd[] = {1.89, 1.81, 1.63};

static double variance_within(void)
{
    return (sd[0] * sd[0] + sd[1] * sd[1] + sd[2] * sd[2]) / 3;
}

static double variance_of_means(void)
{
    double middle = (mean[0] + mean[1] + mean[2]) / 3, sum = 0;
    for (int i = 0; i < 3; i++)
        sum += (mean[i] - middle) * (mean[i] - middle);
    return sum / 2;
}

static double f_of_trials(void)
{
    return 480 * variance_of_means() / variance_within();
}

static double answers_for_the_f(void)
{
    return 3.46 * variance_within() / variance_of_means();
}

static double p_of_trials(void)
{
    return stat_noncentral_f_upper(3.46, 2, 1437, 0);
}

static double p_within_people(void)
{
    return stat_noncentral_f_upper(3.46, 2, 28, 0);
}

// The p of 22 choices that lies nearest.
static double nearest(double p)
{
    double best = 2;
    for (int64_t k = 0; k <= 22; k++) {
        double at = stat_binomial_p(k, 22, 0.5, STAT_TWO_SIDED);
        best = fabs(at - p) < fabs(best - p) ? at : best;
    }
    return best;
}

static double scene_type(void)
{
    return nearest(0.091);
}

static double mixed_mode(void)
{
    return nearest(0.012);
}

static double percent(int64_t k, int64_t n)
{
    return 100 * stat_binomial_test(k, n, 0.5, 0.95, STAT_TWO_SIDED).estimate;
}

static double share_7(void)
{
    return percent(7, 22);
}

static double share_15(void)
{
    return percent(15, 22);
}

static double stengel_t1(void)
{
    return percent(42, 48);
}

static double stengel_t2(void)
{
    return percent(43, 48);
}

static double stengel_t3(void)
{
    return percent(4, 16);
}

static double stengel_t4(void)
{
    return percent(6, 48);
}

static double stengel_t5(void)
{
    return percent(3, 48);
}

static double stengel_t6(void)
{
    return percent(10, 48);
}

static double low_19(void)
{
    return (double)stat_null_region(19, 0.5, 0.95, STAT_TWO_SIDED).low;
}

static double high_19(void)
{
    return (double)stat_null_region(19, 0.5, 0.95, STAT_TWO_SIDED).high;
}

static double low_22(void)
{
    return (double)stat_null_region(22, 0.5, 0.95, STAT_TWO_SIDED).low;
}

static double high_22(void)
{
    return (double)stat_null_region(22, 0.5, 0.95, STAT_TWO_SIDED).high;
}

static const struct {
    const char *what; // begins the row's name
    double (*ours)(void);
    double unit; // of the last printed digit
    bool follows;
} rows[] = {
    {"Weier fixation: F of trials", f_of_trials, 0.01, false},
    {"Weier fixation: answers per mode", answers_for_the_f, 1, false},
    {"Weier fixation: p of the printed F with trials", p_of_trials, 0.01, true},
    {"Weier fixation: p of the printed F within", p_within_people, 0.01, false},
    {"Franke 8.3 scene type", scene_type, 0.001, false},
    {"Franke 8.3 mixed mode", mixed_mode, 0.001, false},
    {"Franke 8.3 smallest share", share_7, 1, true},
    {"Franke 8.3 largest share", share_15, 1, true},
    {"Stengel T1", stengel_t1, 0.1, true},
    {"Stengel T2", stengel_t2, 0.1, false},
    {"Stengel T3", stengel_t3, 0.1, false},
    {"Stengel T4", stengel_t4, 0.1, false},
    {"Stengel T5", stengel_t5, 0.1, false},
    {"Stengel T6", stengel_t6, 0.1, false},
    {"Franke 8.2 null region of 19: low", low_19, 1, true},
    {"Franke 8.2 null region of 19: high", high_19, 1, true},
    {"Franke 8.2 null region of 22: low", low_22, 1, true},
    {"Franke 8.2 null region of 22: high", high_22, 1, true},
};

static void printed_numbers_follow_or_are_listed(void **state)
{
    (void)state;
    char line[256];
    size_t count = 0;
    FILE *file = reference_open("papers.csv");
    assert_non_null(fgets(line, sizeof line, file));
    for (; fgets(line, sizeof line, file); count++) {
        assert_true(count < sizeof rows / sizeof rows[0]);
        char *rest = line;
        const char *what = reference_field(&rest, ',');
        double printed = reference_number(reference_field(&rest, ',')),
               by_r = reference_number(reference_field(&rest, ',')), ours = rows[count].ours();
        assert_int_equal(strncmp(what, rows[count].what, strlen(rows[count].what)), 0);
        if (!reference_close(ours, by_r, 1e-10))
            fail_msg("%s: %.15g, R %.15g", what, ours, by_r);
        bool follows = fabs(ours - printed) <= rows[count].unit / 2;
        if (follows != rows[count].follows)
            fail_msg("%s: printed %g, computed %g", what, printed, ours);
        if (!follows)
            print_message("does not follow: %s, printed %g, computed %.6g, apart by %.3g\n", what, printed,
                          ours, ours - printed);
    }
    fclose(file);
    assert_int_equal(count, sizeof rows / sizeof rows[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(printed_numbers_follow_or_are_listed)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
