// Simulated power against R's own simulation and exact sums (tests/reference/power_simulation.R), and as a
// command.
#include "analysis/stats/power_simulation.h"
#include "program.h"
#include "reference.h"
#include "said.h"
#include "study_file.h"

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

// Cells with the choices that people have in a rehearsal: nine in the one, one in the other.
static void command_takes_a_rehearsal(void **state)
{
    (void)state;
    study_file_make("r.db", &(struct study_desc){.several = true, .simulated = true});
    struct program_result r = FOVSTATS("power", "r.db", "--simulated", "--share", "0.75", "--participants",
                                       "22", "--sd", "0.5", "--json");
    assert_int_equal(r.code, 0);
    double several = said_after(r.out, "epsilon 0.2\"", "power"),
           one = said_after(r.out, "epsilon 0.05 (of the participants who get this cell: 19 of 22)\"", "power");
    assert_true(several > 0.99 && fabs(one - 0.516797834436943) < 1e-12);
    assert_non_null(strstr(r.out, "\"data_sha256\":\""));
    program_free(&r);
}

static void wrong_use(void **state)
{
    (void)state;
    const struct {
        const char *argv[8];
        int code;
        const char *says;
    } cases[] = {
        {{fovstats, "power"}, 2, "needs --share P"},
        {{fovstats, "power", "--share", "1"}, 2, "--share is 1 but must lie between 0 and 1"},
        {{fovstats, "power", "--share", "nan"}, 2, "--share is \"nan\" but must be a number"},
        {{fovstats, "power", "--share", "0.7", "--choices", "4"}, 2, "needs --participants"},
        {{fovstats, "power", "--share", "0.7", "--participants", "9..3"}, 2, "--participants is \"9..3\""},
        {{fovstats, "power", "--share", "0.7", "--participants", "1..900"}, 2, "--participants is \"1..900\""},
        {{fovstats, "power", "--share", "0.7", "--sd", "-1"}, 2, "--sd is -1 but must be from 0 to 10"},
        {{fovstats, "power", "--share", "0.7", "--studies", "5"}, 2, "--studies is 5"},
        {{fovstats, "power", "--share", "0.7", "--alpha", "0"}, 2, "--alpha is 0"},
        {{fovstats, "power", "none.db", "--share", "0.7", "--participants", "5"},
         1,
         "none.db: there is no such file"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct program_result r = program_run(cases[i].argv, NULL);
        if (r.code != cases[i].code || !strstr(r.err, cases[i].says) || r.out[0])
            fail_msg("exit %d, \"%s\"; expected exit %d and \"%s\"", r.code, r.err, cases[i].code,
                     cases[i].says);
        program_free(&r);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_r), cmocka_unit_test(bad_input),
        cmocka_unit_test(command_plans), cmocka_unit_test(command_takes_a_rehearsal),
        cmocka_unit_test(wrong_use),
    };
    return cmocka_run_group_tests(tests, program_enter_folder, program_leave_folder);
}
