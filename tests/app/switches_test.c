// What a switch costs: in the second after it no shown frame does more than half as much again as that option's
// usual one. A whole session with long looks, drawn at a tiny size, judged from the study file by what was
// done, which is the same on every machine, and by time only so far as a busy machine allows. Of triangles, and
// of time, the usual frame is the median. Of pixels it is the largest outside those seconds: boxes of moving
// objects take turns, so that every sixth frame may shade half as much again as the median, whenever it comes.
#include "tests/app/command.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static char folder[512];

static const char protocol[] =
    "fovstudy: 1\n"
    "name: switches\n"
    "title: Long looks at every mode\n"
    "seed: 2\n"
    "scenes: [atrium]\n"
    "options:\n"
    "  warped: {mode: time_warped}\n"
    "  coarse: {mode: vrs}\n"
    "  regular: {mode: regular}\n"
    "reference: regular\n"
    "settings: {advance: auto, rest_s: 0.2, question: prefer, camera: still}\n"
    "questions:\n"
    "  prefer: {text: \"A or B?\"}\n"
    "instructions: Choose.\n"
    "consent: {version: \"1\", text: Yes?}\n"
    "blocks:\n"
    "  - {name: one, kind: toggle, options: [warped, regular]}\n"
    "  - {name: two, kind: toggle, options: [coarse, warped], settings: {moving_objects: on, ssao: on, taa: "
    "on}}\n"
    "  - {name: path, kind: toggle, options: [warped, coarse], settings: {camera: path}}\n";

#define STILL "t.block <> 'path'"
#define PATH "t.block = 'path'"
#define MEDIAN "(count + 1) / 2"
#define LARGEST "count"

// Frames of phase 'stimulus' in the chosen trials, and whether they come in the second after an exposure of
// theirs became free of fade; one of the others is what the option usually does.
#define FRAMES(column, trials, rank)                                                                           \
    "WITH shown AS (SELECT f.trial_id AS trial, f.option AS slot, " column                                     \
    " AS value, (SELECT e.id FROM exposure e WHERE e.trial_id = f.trial_id AND e.option = f.option AND "       \
    "f.start_ns >= e.full_start_ns AND f.start_ns < e.full_start_ns + 1000000000) AS switch FROM frame f "     \
    "JOIN trial t ON t.id = f.trial_id WHERE f.phase = 'stimulus' AND " trials "), "                           \
    "ranked AS (SELECT trial, slot, value, row_number() OVER (PARTITION BY trial, slot ORDER BY value) AS n, " \
    "count(*) OVER (PARTITION BY trial, slot) AS count FROM shown WHERE switch IS NULL), "                     \
    "usual AS (SELECT trial, slot, value, count FROM ranked WHERE n = " rank ") "
#define WORST                                                                                                  \
    "SELECT max(1.0 * s.value / u.value) FROM shown s JOIN usual u USING (trial, slot) WHERE switch IS NOT "   \
    "NULL"

static double number(const char *query)
{
    const struct command_result *result = command("sqlite3 '%s/a.db' \"%s\"", folder, query);
    if (result->status != 0 || !result->out[0])
        fail_msg("%s\n%s", query, result->err);
    return strtod(result->out, NULL);
}

static void there_is_enough_to_judge(void **state)
{
    (void)state;
    assert_true(number("SELECT count(*) FROM exposure WHERE full_start_ns IS NOT NULL") >= 12);
    assert_true(number(FRAMES("f.shaded_px", "1", MEDIAN) "SELECT count(*) FROM usual") == 6);
    assert_true(number(FRAMES("f.shaded_px", "1", MEDIAN) "SELECT min(count) FROM usual") >= 20);
    assert_true(number(FRAMES("f.shaded_px", "1", MEDIAN) "SELECT min(n) FROM (SELECT count(*) AS n FROM shown "
                                                          "WHERE switch IS NOT NULL GROUP BY switch)") >= 15);
}

static void the_work_stays_within_half_as_much_again(void **state)
{
    (void)state;
    static const char *const queries[] = {FRAMES("f.shaded_px", STILL, LARGEST) WORST,
                                          FRAMES("f.triangles", STILL, MEDIAN) WORST,
                                          FRAMES("f.shaded_px", PATH, LARGEST) WORST};
    static const char *const names[] = {"most pixels", "triangles", "most pixels on a path"};
    for (int i = 0; i < 3; i++) {
        const double ratio = number(queries[i]);
        print_message("after a switch at most %.2f times the usual %s\n", ratio, names[i]);
        assert_true(ratio > 0 && ratio <= 1.5);
    }
}

// A busy machine makes single frames long, wherever they are; so of each switch's second the middle frame, and
// of the switches the middle one.
static void the_time_stays_near_the_usual(void **state)
{
    (void)state;
    const double ratio = number(FRAMES(
        "f.gpu_us", STILL, MEDIAN) ", early AS (SELECT trial, slot, switch, value, row_number() OVER "
                                   "(PARTITION BY switch ORDER BY value) AS n, count(*) OVER (PARTITION BY "
                                   "switch) AS count FROM shown WHERE switch IS NOT NULL), ratio AS (SELECT "
                                   "e.value / u.value AS r FROM early e JOIN usual u USING (trial, slot) "
                                   "WHERE n = (e.count + 1) / 2) SELECT r FROM ratio ORDER BY r LIMIT 1 "
                                   "OFFSET (SELECT count(*) / 2 FROM ratio)");
    print_message("after a switch %.2f times the usual time\n", ratio);
    assert_true(ratio > 0 && ratio <= 2);
}

static int set_up(void **state)
{
    (void)state;
    char path[600];
    command_folder("switches", folder, sizeof folder);
    snprintf(path, sizeof path, "%s/protocol.yaml", folder);
    FILE *out = fopen(path, "w");
    if (!out || fputs(protocol, out) < 0 || fclose(out) != 0)
        return -1;
    const struct command_result *result =
        command("fovstudy run '%s' --db '%s/a.db' --participant p1 --observer "
                "sim:dwell_s=3,dwell_spread=0.1,toggles_mean=5 --display headless --size 64x72 --refresh 30 "
                "--scene atrium=town:triangles=20000",
                path, folder);
    if (result->status != 0)
        print_error("%s\n", result->err);
    return result->status != 0;
}

int main(void)
{
    if (command("fovstudy devices")->status != 0)
        return 77;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(there_is_enough_to_judge),
        cmocka_unit_test(the_work_stays_within_half_as_much_again),
        cmocka_unit_test(the_time_stays_near_the_usual),
    };
    return cmocka_run_group_tests(tests, set_up, NULL);
}
