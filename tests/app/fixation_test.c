// A session whose fovea follows a target, with a simulated participant: every frame's row says where the target
// was and that the fovea was there. Exit 77 where no device can draw.
#include "tests/app/command.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static char folder[512];

static const char protocol[] =
    "fovstudy: 1\n"
    "name: targets\n"
    "title: Targets\n"
    "seed: 3\n"
    "scenes: [atrium]\n"
    "options:\n"
    "  warped: {mode: time_warped}\n"
    "  regular: {mode: regular}\n"
    "reference: regular\n"
    "settings: {advance: auto, rest_s: 0.2, question: prefer, moving_objects: off}\n"
    "questions:\n"
    "  prefer: {text: \"Which is the original?\", correct: reference}\n"
    "  seen: {text: How many?, count: [0, 20]}\n"
    "  good: {text: How good?, scale: [1, 10], labels: [bad, good]}\n"
    "instructions: Choose.\n"
    "consent: {version: \"1\", text: Yes?}\n"
    "blocks:\n"
    "  - name: one\n"
    "    kind: sequential\n"
    "    options: [warped, regular]\n"
    "    repetitions: 2\n"
    "    settings: {fixation: moving, foveate: target, view_s: 1.5, gap_s: 0.5}\n"
    "  - {name: two, kind: toggle, options: [warped, regular], settings: {fixation: cross, foveate: target}}\n"
    "  - {name: three, kind: toggle, options: [warped, regular], settings: {fixation: moving}}\n"
    "  - name: four\n"
    "    kind: staircase\n"
    "    options: [warped, regular]\n"
    "    staircase: {parameter: epsilon, method: 1up2down, larger: easier, level: {min: 0.1, max: 1}, start: "
    "0.6,\n"
    "                steps: [0.1], trials: 2}\n"
    "  - name: five\n"
    "    kind: adjust\n"
    "    options: [warped, regular]\n"
    "    adjust: {epsilon: {start: [0.5, 0.5], step: 0.05}}\n"
    "  - name: six\n"
    "    kind: task\n"
    "    options: [warped]\n"
    "    settings: {question: good, spheres: [7, 7], count: seen, view_s: 2}\n";

static const char *ask(const char *query)
{
    static char answer[COMMAND_TEXT];
    const struct command_result *result = command("sqlite3 '%s/a.db' \"%s\"", folder, query);
    if (result->err[0])
        print_error("%s\n%s\n", query, result->err);
    assert_int_equal(result->status, 0);
    strcpy(answer, result->out);
    answer[strcspn(answer, "\n")] = '\0';
    return answer;
}

#define expect(query, answer) assert_string_equal(ask(query), answer)
#define SEEN " FROM frame f JOIN trial t ON t.id = f.trial_id WHERE f.condition_id IS NOT NULL AND block "
#define SEEN_IN                                                                                                \
    " FROM frame f JOIN trial t ON t.id = f.trial_id JOIN session s ON s.id = f.session_id WHERE "             \
    "f.condition_id IS NOT NULL AND block "

static void the_fovea_is_on_the_target(void **state)
{
    (void)state;
    expect("SELECT count(*) > 60, group_concat(DISTINCT fovea_source)" SEEN "IN ('one', 'two')", "1|target");
    expect("SELECT group_concat(DISTINCT fovea_source)" SEEN "= 'three'", "gaze");
    expect("SELECT count(*)" SEEN
           "IN ('one', 'two', 'three') AND (target_x_deg IS NULL OR target_y_deg IS NULL)",
           "0");
    expect("SELECT count(*)" SEEN "= 'four' AND target_x_deg IS NOT NULL", "0");
    expect("SELECT count(*)" SEEN "= 'two' AND (target_x_deg <> 0 OR target_y_deg <> 0)", "0");
    // Each eye's fovea is where that eye sees the target: from the row's direction and distance, half an
    // interpupillary distance beside the middle.
    expect(
        "WITH p AS (SELECT json_extract(fovea, '$.left[0]') AS lx, json_extract(fovea, '$.left[1]') AS ly, "
        "json_extract(fovea, '$.right[0]') AS rx, json_extract(fovea, '$.right[1]') AS ry, target_m * "
        "sin(radians(target_x_deg)) * cos(radians(target_y_deg)) AS x, target_m * sin(radians(target_y_deg)) "
        "AS y, target_m * cos(radians(target_x_deg)) * cos(radians(target_y_deg)) AS ahead, "
        "json_extract(s.settings, '$.ipd_m') / 2 AS h, target_m" SEEN_IN
        "IN ('one', 'two') AND fovea IS NOT NULL), d AS (SELECT target_m, lx - rx AS apart, "
        "abs(lx - degrees(atan2(x + h, ahead))) + abs(rx - degrees(atan2(x - h, ahead))) + "
        "abs(ly - degrees(atan2(y, sqrt((x + h) * (x + h) + ahead * ahead)))) + "
        "abs(ry - degrees(atan2(y, sqrt((x - h) * (x - h) + ahead * ahead)))) AS off FROM p) "
        "SELECT count(*) > 60, count(off) = count(*), max(off) < 1e-9, min(apart) > 0, "
        "min(target_m) >= 0.5, max(target_m) < 100.001 FROM d",
        "1|1|1|1|1|1");
    expect("SELECT count(*)" SEEN "= 'three' AND target_m IS NULL", "0");
    expect("SELECT count(*)" SEEN "= 'four' AND target_m IS NOT NULL", "0");
    expect("SELECT count(*)" SEEN
           "IN ('one', 'two', 'three') AND (abs(target_x_deg) > 10.3 OR abs(target_y_deg) > "
           "11.68)",
           "0");
}

// Once along the path in each showing, the same path in both and in a repetition.
static void the_path_is_taken_once_a_showing(void **state)
{
    (void)state;
    expect("SELECT count(*), count(DISTINCT a), count(DISTINCT b) FROM (SELECT printf('%.6f', "
           "first_value(target_x_deg) "
           "OVER w) AS a, printf('%.6f', last_value(target_x_deg) OVER (PARTITION BY t.id, option ORDER BY "
           "number ROWS "
           "BETWEEN UNBOUNDED PRECEDING AND UNBOUNDED FOLLOWING)) AS b, row_number() OVER w AS n" SEEN
           "= 'one' WINDOW w AS (PARTITION BY t.id, option ORDER BY number)) WHERE n = 1",
           "4|1|1");
}

#define WHERE_TESTED                                                                                           \
    " FROM frame f JOIN trial t ON t.id = f.trial_id JOIN condition c ON c.id = f.condition_id WHERE option "  \
    "= "                                                                                                       \
    "test_slot AND block "

// The level is in the condition of the frame, so nothing differs from it.
static void a_staircase_s_level_is_the_condition(void **state)
{
    (void)state;
    expect("SELECT json_extract(parameters, '$.epsilon')" WHERE_TESTED "= 'four' ORDER BY f.id LIMIT 1", "0.6");
    expect("SELECT count(*) > 10, count(effective)" WHERE_TESTED "= 'four'", "1|0");
    expect("SELECT count(*)" SEEN "IN ('one', 'two', 'three') AND effective IS NOT NULL", "0");
}

// Each frame of an adjusted option says the values in force: those of the last step before it.
static void adjusted_values_are_what_was_drawn(void **state)
{
    (void)state;
    expect("SELECT count(*) >= 2 FROM adjust_step", "1");
    expect("SELECT count(*) > 10, count(DISTINCT effective) > 1" WHERE_TESTED "= 'five'", "1|1");
    expect("SELECT count(*)" WHERE_TESTED
           "= 'five' AND abs(coalesce(json_extract(effective, '$.epsilon'), 0.2) - coalesce((SELECT value FROM "
           "adjust_step s WHERE s.trial_id = t.id AND s.at_ns <= f.start_ns ORDER BY s.at_ns DESC, s.rowid "
           "DESC LIMIT "
           "1), 0.5)) > 1e-9",
           "0");
    expect("SELECT count(*)" SEEN "= 'five' AND option <> test_slot AND effective IS NOT NULL", "0");
}

// What a participant adjusts is what was asked for: no frame of it is a finding.
static void the_audit_has_nothing_to_say(void **state)
{
    (void)state;
    const struct command_result *result =
        command("'%s/bin/fovstats' frames --audit --simulated '%s/a.db'", BUILD_DIR, folder);
    assert_int_equal(result->status, 0);
    assert_non_null(strstr(result->out, "\nNo finding.\n"));
}

// The spheres' rows say as many as the expected answer does, for each showing.
static void spheres_are_there_and_told(void **state)
{
    (void)state;
    expect("SELECT count(*), min(expected) FROM response WHERE question = 'seen'", "1|7.0");
    expect("SELECT count(*), count(DISTINCT json_extract(detail, '$.at')) FROM event WHERE kind = 'sphere'",
           "7|7");
    expect("SELECT count(*) FROM event e JOIN trial t ON t.id = e.trial_id WHERE e.kind = 'sphere' AND (block "
           "<> 'six' "
           "OR at_ns <> started_ns OR json_extract(detail, '$.of') <> 7)",
           "0");
    expect("SELECT count(*) FROM event WHERE kind LIKE 'log_%'", "0");
}

static int set_up(void **state)
{
    char file[600];
    (void)state;
    command_folder("fixation", folder, sizeof folder);
    snprintf(file, sizeof file, "%s/protocol.yaml", folder);
    FILE *out = fopen(file, "w");
    if (!out || fputs(protocol, out) < 0 || fclose(out) != 0)
        return -1;
    const struct command_result *run = command(
        "fovstudy run '%s' --db '%s/a.db' --participant p1 --observer sim --display headless --size 48x54 "
        "--refresh 20 --scene atrium=town:triangles=20000",
        file, folder);
    if (run->status != 0)
        print_error("%s\n", run->err);
    return run->status;
}

int main(void)
{
    if (command("fovstudy devices")->status != 0)
        return 77;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_fovea_is_on_the_target),
        cmocka_unit_test(the_path_is_taken_once_a_showing),
        cmocka_unit_test(a_staircase_s_level_is_the_condition),
        cmocka_unit_test(adjusted_values_are_what_was_drawn),
        cmocka_unit_test(the_audit_has_nothing_to_say),
        cmocka_unit_test(spheres_are_there_and_told),
    };
    return cmocka_run_group_tests(tests, set_up, NULL);
}
