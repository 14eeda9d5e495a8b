// A hundred simulated participants of long studies, without frames, through the real state machine and store:
// well within a minute on two cores. Processor time is what is held, since the machine may be busy with other
// things.
#include "tests/app/command.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

#include <cmocka.h>

#ifdef __SANITIZE_ADDRESS__
enum { PARTICIPANTS = 10 };
#else
enum { PARTICIPANTS = 100 };
#endif
#define CPU_S 20.0 // of two cores' minute: seven times what it takes (2026-11-25), and a sixth of what there is

static char folder[512];

static double cpu_s(void)
{
    struct rusage usage;
    getrusage(RUSAGE_CHILDREN, &usage);
    return (double)usage.ru_utime.tv_sec + (double)usage.ru_stime.tv_sec +
           1e-6 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

static void expect_fast(const char *path, const char *name, int trials)
{
    char wanted[64];
    double cpu = cpu_s();
    struct timespec start, end;
    clock_gettime(CLOCK_MONOTONIC, &start);
    const struct command_result *result =
        command("fovstudy run '%s' --db '%s/%s.db' --participants %d --display none --observer "
                "sim:errors=%s/errors.csv",
                path, folder, name, PARTICIPANTS, folder);
    if (result->status != 0)
        fail_msg("%s", result->err);
    clock_gettime(CLOCK_MONOTONIC, &end);
    cpu = cpu_s() - cpu;
    printf("%s: %d participants, %.1f s, %.1f s of processor time\n", name, PARTICIPANTS,
           (double)(end.tv_sec - start.tv_sec) + 1e-9 * (double)(end.tv_nsec - start.tv_nsec), cpu);
    snprintf(wanted, sizeof wanted, "%d|%d\n", PARTICIPANTS, PARTICIPANTS * trials);
    result = command(
        "sqlite3 '%s/%s.db' \"SELECT (SELECT count(*) FROM session WHERE status = 'complete'), count(*) "
        "FROM trial WHERE status IN ('done', 'skipped')\"",
        folder, name);
    assert_string_equal(result->out, wanted);
    assert_true(cpu < CPU_S);
}

static void timed_ratings(void **state)
{
    (void)state;
    char path[600];
    snprintf(path, sizeof path, "%s/regions.yaml", folder);
    expect_fast(path, "regions", 96);
}

static void every_kind(void **state)
{
    (void)state;
    expect_fast(SOURCE_DIR "/tests/app/kinds.yaml", "kinds", 36);
}

static void the_calibration_study(void **state)
{
    (void)state;
    expect_fast(SOURCE_DIR "/studies/protocols/calibration.yaml", "calibration", 11);
}

// 96 timed looks of 8 s with two questions each.
static int set_up(void **state)
{
    (void)state;
    command_folder("rehearse_speed", folder, sizeof folder);
    return command(
               "echo '{fovstudy: 1, name: regions, title: t, seed: 12, scenes: [atrium, town], options: "
               "{foveated: "
               "{mode: time_warped, epsilon: 0.1}, regular: {mode: regular}}, reference: regular, settings: "
               "{advance: auto, rest_s: 0.5, view_s: 8, question: [artefacts, sure]}, questions: {artefacts: "
               "{text: "
               "Which, scale: [-3, 3]}, sure: {text: How, scale: [1, 10]}}, instructions: i, consent: "
               "{version: "
               "\"1\", text: c}, blocks: [{name: main, kind: rate, options: [foveated], factors: {epsilon: "
               "[0.2, "
               "0.1, 0.05], fovea_deg: [17, 10, 6, 5]}, repetitions: 8, break_every: 24, break_s: 60}]}' > "
               "'%s/regions.yaml'; for s in atrium town; do for e in 0.05 0.1 0.2 1; do for f in 5 6 10 17; do "
               "echo "
               "$s,$e,time_warped:epsilon=$e,fovea_deg=$f; done; done; echo "
               "\"$s;ssao=on,0.2,time_warped:epsilon=0.2\"; done > '%s/errors.csv'",
               folder, folder)
        ->status;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(timed_ratings),
        cmocka_unit_test(every_kind),
        cmocka_unit_test(the_calibration_study),
    };
    return cmocka_run_group_tests(tests, set_up, NULL);
}
