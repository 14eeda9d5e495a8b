// Simulated power against R's own simulation and exact sums (tests/reference/power_simulation.R), and as a
// command.
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
#include <unistd.h>

#include <cmocka.h>

static const char fovstats[] = BUILD_DIR "/bin/fovstats";

#define FOVSTATS(...) program_run((const char *const[]){fovstats, __VA_ARGS__, NULL}, NULL)

enum { STUDIES = 20000 };

// Both simulate: 4 standard errors of the difference are passed once in 16,000 honest comparisons.
static void agrees_with_r(void **state)
{
    (void)state;
    char line[512];
    size_t rows = 0;
    FILE *file = reference_open("power_simulation.csv");
    assert_non_null(fgets(line, sizeof line, file));
    for (; fgets(line, sizeof line, file); rows++) {
        double v[8];
        char *rest = line;
        for (int i = 0; i < 8; i++)
            v[i] = strtod(reference_field(&rest, ','), NULL);
        int64_t choices = (int64_t)v[1];
        const struct stat_simulation s = {&choices, 1, (size_t)v[0], v[2], v[3], v[4], STUDIES, 11, 0};
        struct stat_simulated_power power = stat_simulate_power(&s);
        double error = sqrt(v[7] * v[7] + v[6] * (1 - v[6]) / STUDIES);
        if (!(fabs(power.intercept - v[5]) < 1e-8) || !(fabs(power.power - v[6]) <= 4 * error))
            fail_msg("%g people, %g choices, share %g: %.4f, R %.4f +- %.4f; intercept %.12g, R %.12g", v[0],
                     v[1], v[2], power.power, v[6], error, power.intercept, v[5]);
        assert_true(power.ci.low <= power.power && power.power <= power.ci.high);
    }
    fclose(file);
    assert_int_equal(rows, 10);
}

static void bad_input(void **state)
{
    (void)state;
    int64_t one = 1, none = 0, negative = -1;
    const struct stat_simulation good = {&one, 1, 10, 0.7, 0, 0.05, 100, 1, 0};
    assert_true(stat_simulate_power(&good).power > 0);
    struct stat_simulation bad[11];
    for (int i = 0; i < 11; i++)
        bad[i] = good;
    bad[0].share = 1;
    bad[1].share = (double)NAN;
    bad[2].sd = -1;
    bad[3].alpha = 0;
    bad[4].people = 0;
    bad[5].choices = &none;
    bad[6].choices = &negative;
    bad[7].studies = 0;
    bad[8].choices_count = 0;
    bad[9].margin = -0.1;
    bad[10].margin = (double)NAN;
    for (int i = 0; i < 11; i++)
        assert_true(isnan(stat_simulate_power(&bad[i]).power));
}

static void command_plans(void **state)
{
    (void)state;
    struct program_result r = FOVSTATS("power", "--share", "0.75", "--participants", "22", "--json");
    assert_int_equal(r.code, 0);
    // R: tests/reference/power_simulation.csv; 30 and 35 are counts.R's
    assert_true(fabs(said_after(r.out, "sizes", "power") - 0.516797834436943) < 1e-12);
    assert_true(said_after(r.out, "sizes", "people_first") == 30 &&
                said_after(r.out, "sizes", "people_stays") == 35);
    program_free(&r);
    r = FOVSTATS("power", "--share", "0.9", "--sd", "0.5", "--choices", "20", "--participants", "5..7",
                 "--json");
    assert_int_equal(r.code, 0);
    assert_true(said_after(r.out, "\"people\":5", "power") == 0);  // 2 / 2^5 cannot reach 0.05
    assert_true(said_after(r.out, "\"people\":6", "power") > 0.9); // 2 / 2^6 can
    assert_true(said_after(r.out, "{", "people_in_range") == 6);
    program_free(&r);
    struct program_result again =
        FOVSTATS("power", "--share", "0.6", "--choices", "8", "--participants", "12", "--json");
    r = FOVSTATS("power", "--share", "0.6", "--choices", "8", "--participants", "12", "--json");
    assert_string_equal(r.out, again.out);
    program_free(&r);
    program_free(&again);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_r),
        cmocka_unit_test(bad_input),
        cmocka_unit_test(command_plans),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
