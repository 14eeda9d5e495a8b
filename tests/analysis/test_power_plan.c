// Power of equivalence, t-tests and the analysis of variance, and how many people they need, against R
// (tests/reference/power_plan.R), and as a command.
#include "analysis/stats/power.h"
#include "analysis/stats/power_anova.h"
#include "analysis/stats/power_equivalence.h"
#include "analysis/stats/power_simulation.h"
#include "program.h"
#include "reference.h"
#include "said.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const char fovstats[] = BUILD_DIR "/bin/fovstats";

#define FOVSTATS(...) program_run((const char *const[]){fovstats, __VA_ARGS__, NULL}, NULL)

enum { STUDIES = 20000 };

struct row {
    const char *what;
    int64_t n, cells, df;
    double x, sd, margin, alpha, power, value, error;
};

// What the command says of the people needed.
static double people_needed(const struct row *row)
{
    char d[32], power[32];
    snprintf(d, sizeof d, "%.17g", row->x);
    snprintf(power, sizeof power, "%.17g", row->power);
    struct program_result r = row->what[0] == 'p'
                                  ? FOVSTATS("power", "--d", d, "--power", power, "--json")
                                  : FOVSTATS("power", "--d", d, "--unpaired", "--power", power, "--json");
    assert_int_equal(r.code, 0);
    double people = said_after(r.out, "cells", "people_first");
    program_free(&r);
    return people;
}

static double simulated(const struct row *row)
{
    const struct stat_simulation s = {.choices = &row->cells,
                                      .choices_count = 1,
                                      .people = (size_t)row->n,
                                      .share = row->x,
                                      .sd = row->sd,
                                      .alpha = row->alpha,
                                      .studies = STUDIES,
                                      .seed = 11,
                                      .margin = row->margin};
    return stat_simulate_power(&s).power;
}

static double compute(const struct row *row)
{
    if (strcmp(row->what, "equivalence") == 0)
        return stat_binomial_equivalence_power(row->n, row->margin, row->x, row->alpha);
    if (strcmp(row->what, "equivalence_first") == 0)
        return (double)stat_binomial_equivalence_size(row->margin, row->x, row->alpha, row->power, row->n)
            .first;
    if (strcmp(row->what, "equivalence_stays") == 0)
        return (double)stat_binomial_equivalence_size(row->margin, row->x, row->alpha, row->power, row->n)
            .stays;
    if (strcmp(row->what, "equivalence_many") == 0)
        return simulated(row);
    if (strncmp(row->what, "anova", 5) == 0)
        return stat_anova_within_power(row->n, row->cells, row->df, row->x, row->alpha);
    return people_needed(row);
}

// Both simulate, or R alone: 4 standard errors are passed once in 16,000 honest comparisons.
static double allowed(const struct row *row)
{
    if (row->error == 0)
        return 1e-11;
    double mine = strcmp(row->what, "equivalence_many") == 0 ? row->value * (1 - row->value) / STUDIES : 0;
    return 4 * sqrt(row->error * row->error + mine);
}

static void agrees_with_r(void **state)
{
    (void)state;
    char line[512];
    size_t rows = 0, simulations = 0;
    double worst = 0;
    FILE *file = reference_open("power_plan.csv");
    assert_non_null(fgets(line, sizeof line, file));
    for (; fgets(line, sizeof line, file); rows++) {
        line[strcspn(line, "\n")] = '\0';
        char *rest = line;
        struct row row = {.what = reference_field(&rest, ',')};
        double v[10];
        for (int i = 0; i < 10; i++)
            v[i] = reference_number(reference_field(&rest, ','));
        row = (struct row){row.what, (int64_t)v[0], (int64_t)v[1], (int64_t)v[2], v[3], v[4],
                           v[5],     v[6],          v[7],          v[8],          v[9]};
        double mine = compute(&row), off = fabs(mine - row.value);
        if (!(off <= allowed(&row)))
            fail_msg("%s of %.0f, %.0f cells, %g: %.15g, R %.15g", row.what, v[0], v[1], row.x, mine,
                     row.value);
        simulations += row.error > 0;
        worst = row.error > 0 ? worst : fmax(worst, off);
    }
    fclose(file);
    print_message("%zu rows, %zu of them simulated: the others within %.1e\n", rows, simulations, worst);
    assert_true(rows > 500 && simulations >= 5);
}

// Where nothing is there, a test finds it as often as its level says.
static void level_without_an_effect(void **state)
{
    (void)state;
    for (int64_t n = 2; n < 60; n += 7) {
        assert_true(fabs(stat_anova_within_power(n, 6, 2, 0, 0.05) - 0.05) < 1e-12);
        assert_true(stat_binomial_equivalence_power(n, 0.2, 0.3, 0.05) <= 0.05);
        assert_true(stat_binomial_equivalence_power(n, 0.2, 0.7, 0.05) <= 0.05);
        // Two cells are a paired t-test: their difference is 2 f, its standard deviation root 2.
        double paired = stat_paired_t_power(n, sqrt(2.0) * 0.6, 0.05);
        assert_true(fabs(stat_anova_within_power(n, 2, 1, 0.6, 0.05) - paired) < 1e-9);
    }
}

static void bad_input(void **state)
{
    (void)state;
    const double nan = (double)NAN;
    assert_true(isnan(stat_binomial_equivalence_power(0, 0.1, 0.5, 0.05)));
    assert_true(isnan(stat_binomial_equivalence_power(10, 0, 0.5, 0.05)));
    assert_true(isnan(stat_binomial_equivalence_power(10, 0.51, 0.5, 0.05)));
    assert_true(isnan(stat_binomial_equivalence_power(10, 0.1, nan, 0.05)));
    assert_true(isnan(stat_binomial_equivalence_power(10, 0.1, 0.5, 0.5)));
    assert_true(stat_binomial_equivalence_size(nan, 0.5, 0.05, 0.8, 100).first == 0);
    assert_true(stat_binomial_equivalence_size(0.1, 0.5, 0.05, 1, 100).first == 0);
    assert_true(isnan(stat_anova_within_power(1, 4, 1, 0.2, 0.05)));
    assert_true(isnan(stat_anova_within_power(10, 4, 4, 0.2, 0.05)));
    assert_true(isnan(stat_anova_within_power(10, 4, 0, 0.2, 0.05)));
    assert_true(isnan(stat_anova_within_power(10, 4, 1, nan, 0.05)));
    assert_true(isnan(stat_anova_within_power(10, 4, 1, -1, 0.05)));
    assert_true(isnan(stat_anova_within_power(10, 4, 1, 0.2, 1)));
    assert_true(isnan(stat_noncentral_f_upper(1, 2, 10, 2e6)));
}

static void command_plans(void **state)
{
    (void)state;
    struct program_result r =
        FOVSTATS("power", "--levels", "3x2", "--f", "0.25", "--participants", "22", "--json");
    assert_int_equal(r.code, 0);
    assert_non_null(strstr(r.out, "\"cell\":\"A (3) x B (2)\""));
    // R: tests/reference/power_plan.csv has 22 people, 6 cells, 2 degrees of freedom
    assert_true(fabs(said_after(r.out, "A (3)", "power") - stat_anova_within_power(22, 6, 2, 0.25, 0.05)) <
                1e-15);
    assert_true(fabs(said_after(r.out, "\"B (2)", "power") - stat_anova_within_power(22, 6, 1, 0.25, 0.05)) <
                1e-15);
    program_free(&r);
    r = FOVSTATS("power", "--margin", "0.2", "--participants", "40");
    assert_int_equal(r.code, 0);
    assert_non_null(strstr(r.out, "Power to show equality within 0.3 to 0.7"));
    program_free(&r);
    struct program_result d = FOVSTATS("power", "--d", "0.5", "--participants", "20", "--json"),
                          points = FOVSTATS("power", "--difference", "-1", "--sd", "2", "--participants", "20",
                                            "--json");
    assert_true(said_after(d.out, "sizes", "power") == said_after(points.out, "sizes", "power"));
    program_free(&d);
    program_free(&points);
    r = FOVSTATS("power", "--d", "0.001", "--json");
    assert_non_null(strstr(r.out, "\"people_first\":null")); // not 0 people
    program_free(&r);
}

static void wrong_use(void **state)
{
    (void)state;
    said_sentence(FOVSTATS("power", "--people", "5"), 2, "--people is not an option");
    said_sentence(FOVSTATS("power", "--share", "0"), 2, "--share is 0 but must lie between 0 and 1");
    said_sentence(FOVSTATS("power", "--share", "0.7", "--participants", "0"), 2, "--participants is \"0\"");
    said_sentence(FOVSTATS("power", "--d", "0.5", "--participants", "1"), 2, "a number from 2");
    said_sentence(FOVSTATS("power", "--d", "0.5", "--unpaired", "--participants", "3"), 2, "a number from 4");
    said_sentence(FOVSTATS("power", "--d", "0"), 2, "must not be 0");
    said_sentence(FOVSTATS("power", "--d", "11"), 2, "nor beyond 10");
    said_sentence(FOVSTATS("power", "--difference", "1"), 2, "needs --sd S beside --difference");
    said_sentence(FOVSTATS("power", "--difference", "1", "--sd", "0"), 2, "--sd is 0 but must be above 0");
    said_sentence(FOVSTATS("power", "--difference", "1", "--sd", "-2"), 2, "--sd is -2 but must be above 0");
    said_sentence(FOVSTATS("power", "--d", "1", "--sd", "2"), 2, "--sd goes with");
    said_sentence(FOVSTATS("power", "--d", "1", "--share", "0.7"), 2, "are of choices");
    said_sentence(FOVSTATS("power", "--d", "1", "--margin", "0.1"), 2, "are of choices");
    said_sentence(FOVSTATS("power", "--unpaired", "--share", "0.7"), 2, "--unpaired goes with");
    said_sentence(FOVSTATS("power", "x.db", "--d", "1"), 2, "takes no study file for ratings");
    said_sentence(FOVSTATS("power", "--margin", "0.6"), 2, "--margin is 0.6");
    said_sentence(FOVSTATS("power", "--margin", "0"), 2, "--margin is 0");
    said_sentence(FOVSTATS("power", "--margin", "0.1", "--alpha", "0.6"), 2, "--alpha is 0.6");
    said_sentence(FOVSTATS("power", "--levels", "3"), 2, "needs --f F");
    said_sentence(FOVSTATS("power", "--f", "0.2"), 2, "needs --levels");
    const char *const levels[] = {"", "x", "1", "3x", "3xx2", "x3", "3x2x2x2x2x2x2", "9x9x9x9x9", "3.5"};
    for (size_t i = 0; i < sizeof levels / sizeof levels[0]; i++)
        said_sentence(FOVSTATS("power", "--levels", levels[i], "--f", "0.2"), 2, "--levels is \"");
    said_sentence(FOVSTATS("power", "--levels", "3", "--f", "-0.2"), 2, "--f is -0.2");
    said_sentence(FOVSTATS("power", "--levels", "3", "--f", "0.2", "--participants", "1..9"), 2,
                  "--participants");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_r), cmocka_unit_test(level_without_an_effect),
        cmocka_unit_test(bad_input),     cmocka_unit_test(command_plans),
        cmocka_unit_test(wrong_use),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
