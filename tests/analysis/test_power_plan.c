// Power of equivalence, t-tests and the analysis of variance, and how many people they need, against R
// (tests/reference/power_plan.R), and as a command.
#include "analysis/stats/power.h"
#include "analysis/stats/power_anova.h"
#include "analysis/stats/power_equivalence.h"
#include "analysis/stats/power_simulation.h"
#include "power_row.h"
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

// What the command says of the people needed.
static double people_needed(const struct power_row *row)
{
    char x[32], power[32];
    snprintf(x, sizeof x, "%.17g", row->x);
    snprintf(power, sizeof power, "%.17g", row->power);
    bool two = row->cells == 6; // an effect of a design of six cells, else of 24
    const char *cell = row->cells == 0       ? ""
                       : two && row->df == 2 ? "A (3)"
                       : two                 ? "B (2)"
                       : row->df == 6        ? "B (4) x C (3)"
                                             : "A (2)";
    struct program_result r =
        row->cells != 0
            ? FOVSTATS("power", "--levels", two ? "3x2" : "2x4x3", "--f", x, "--power", power, "--json")
        : row->what[0] == 'p' ? FOVSTATS("power", "--d", x, "--power", power, "--json")
                              : FOVSTATS("power", "--d", x, "--unpaired", "--power", power, "--json");
    assert_int_equal(r.code, 0);
    char after[64];
    snprintf(after, sizeof after, "\"cell\":\"%s\"", cell);
    double people = said_after(r.out, after, "people_first");
    program_free(&r);
    return people;
}

static double simulated(const struct power_row *row)
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

static double compute(const struct power_row *row)
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
    if (strcmp(row->what, "anova") == 0 || strcmp(row->what, "anova_aov") == 0)
        return stat_anova_within_power(row->n, row->cells, row->df, row->x, row->alpha);
    return people_needed(row);
}

// Both simulate, or R alone: 4 standard errors are passed once in 16,000 honest comparisons.
static double allowed(const struct power_row *row)
{
    if (row->error == 0)
        return 1e-11;
    double mine = strcmp(row->what, "equivalence_many") == 0 ? row->value * (1 - row->value) / STUDIES : 0;
    return 4 * sqrt(row->error * row->error + mine);
}

static void agrees_with_r(void **state)
{
    (void)state;
    struct power_row row;
    size_t rows = 0, simulations = 0;
    double worst = 0;
    FILE *file = power_rows_open();
    while (power_row_next(file, &row)) {
        if (strncmp(row.what, "none", 4) == 0 || strncmp(row.what, "part", 4) == 0)
            continue; // of a rehearsal: test_power_rehearsal.c
        double mine = compute(&row), off = fabs(mine - row.value);
        if (!(off <= allowed(&row)))
            fail_msg("%s of %d, %d cells, %g: %.15g, R %.15g", row.what, (int)row.n, (int)row.cells, row.x,
                     mine, row.value);
        rows++;
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
    const double nan = (double)NAN, a = power_row_value("anova", 22, 6, 2, 0.25, 0.05, nan),
                 b = power_row_value("anova", 22, 6, 1, 0.25, 0.05, nan);
    assert_true(fabs(said_after(r.out, "A (3)", "power") - a) < 1e-11);
    assert_true(fabs(said_after(r.out, "\"B (2)", "power") - b) < 1e-11);
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
    static const struct said_case cases[] = {
        {{"power"}, "needs --share P"},
        {{"power", "--people", "5"}, "--people is not an option"},
        {{"power", "--share", "0"}, "--share is 0 but must lie between 0 and 1"},
        {{"power", "--share", "1"}, "--share is 1 but must lie between 0 and 1"},
        {{"power", "--share", "nan"}, "--share is \"nan\" but must be a number"},
        {{"power", "--share", "0.7", "--choices", "4"}, "needs --participants"},
        {{"power", "--share", "0.7", "--participants", "0"}, "--participants is \"0\""},
        {{"power", "--share", "0.7", "--participants", "9..3"}, "--participants is \"9..3\""},
        {{"power", "--share", "0.7", "--participants", "1..900"}, "--participants is \"1..900\""},
        {{"power", "--share", "0.7", "--sd", "-1"}, "--sd is -1 but must be from 0 to 10"},
        {{"power", "--share", "0.7", "--studies", "5"}, "--studies is 5"},
        {{"power", "--share", "0.7", "--alpha", "0"}, "--alpha is 0"},
        {{"power", "--d", "0.5", "--participants", "1"}, "a number from 2"},
        {{"power", "--d", "0.5", "--unpaired", "--participants", "3"}, "a number from 4"},
        {{"power", "--d", "0"}, "must not be 0"},
        {{"power", "--d", "11"}, "nor beyond 10"},
        {{"power", "--difference", "1"}, "needs --sd S beside --difference"},
        {{"power", "--difference", "1", "--sd", "0"}, "--sd is 0 but must be above 0"},
        {{"power", "--difference", "1", "--sd", "-2"}, "--sd is -2 but must be above 0"},
        {{"power", "--d", "1", "--sd", "2"}, "--sd goes with"},
        {{"power", "--d", "1", "--share", "0.7"}, "are of choices"},
        {{"power", "--d", "1", "--margin", "0.1"}, "are of choices"},
        {{"power", "--d", "1", "--f", "0.2"}, "not both"},
        {{"power", "--d", "1", "--levels", "3"}, "not both"},
        {{"power", "--f", "0.2", "--share", "0.7"}, "are of choices"},
        {{"power", "--unpaired", "--share", "0.7"}, "--unpaired goes with"},
        {{"power", "x.db", "--d", "1"}, "takes no study file for a difference of ratings"},
        {{"power", "x.db", "--share", "0.7", "--choices", "4", "--participants", "9"},
         "takes --choices or a study file"},
        {{"power", "--margin", "0.6"}, "--margin is 0.6"},
        {{"power", "--margin", "0"}, "--margin is 0"},
        {{"power", "--margin", "0.1", "--alpha", "0.6"}, "--alpha is 0.6"},
        {{"power", "--levels", "3"}, "needs --f F"},
        {{"power", "x.db", "--levels", "3"}, "needs --f F"},
        {{"power", "--f", "0.2"}, "needs --levels"},
        {{"power", "--levels", "3", "--f", "-0.2"}, "--f is -0.2"},
        {{"power", "--levels", "3", "--f", "6"}, "F^2 times the cells 100 at most"},
        {{"power", "x.db", "--f", "0"}, "--f is 0"},
        {{"power", "--levels", "3", "--f", "0.2", "--participants", "1..9"}, "--participants"},
    };
    said_wrong_use(cases, sizeof cases / sizeof cases[0]);
    const char *const levels[] = {"", "x", "1", "3x", "3xx2", "x3", "3x2x2x2x2x2x2", "9x9x9x9x9", "3.5"};
    for (size_t i = 0; i < sizeof levels / sizeof levels[0]; i++)
        said_sentence(FOVSTATS("power", "--levels", levels[i], "--f", "0.2"), 2, "--levels is \"");
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
