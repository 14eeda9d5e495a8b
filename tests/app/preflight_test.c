// Sessions that are drawn beforehand: a software driver at 90 Hz is refused, or paced where the protocol says
// so; prerendered options come from the program as the protocol promises. Exit 77 where no device can draw.
#include "tests/app/command.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static char folder[512];

static const char format[] = "fovstudy: 1\n"
                             "name: flown\n"
                             "title: Flown before\n"
                             "seed: 3\n"
                             "scenes: [town]\n"
                             "options:\n"
                             "  warped: {mode: time_warped}\n"
                             "  regular: {mode: regular}\n"
                             "  kept: {mode: regular, playback: prerendered}\n"
                             "reference: regular\n"
                             "questions: {better: {text: \"Which?\", equal: yes}}\n"
                             "instructions: Look.\n"
                             "consent: {version: \"1\", text: Yes?}\n"
                             "settings: {advance: auto, question: better, view_s: 1, gap_s: 0.2, pace: %s}\n"
                             "blocks: [{name: one, kind: sequential, options: [warped, %s], repetitions: 2}]\n";

static void write_protocol(const char *pace, const char *second)
{
    char path[600];
    snprintf(path, sizeof path, "%s/protocol.yaml", folder);
    FILE *out = fopen(path, "w");
    assert_true(out && fprintf(out, format, pace, second) > 0 && fclose(out) == 0);
}

static const struct command_result *run(const char *name, const char *options)
{
    return command(
        "fovstudy run '%s/protocol.yaml' --db '%s/%s.db' --participant p --observer sim --display headless "
        "--scene town=town:triangles=20000 %s",
        folder, folder, name, options);
}

static const char *ask(const char *name, const char *query)
{
    static char answer[COMMAND_TEXT];
    const struct command_result *result = command("sqlite3 '%s/%s.db' \"%s\"", folder, name, query);
    assert_int_equal(result->status, 0);
    strcpy(answer, result->out);
    answer[strcspn(answer, "\n")] = '\0';
    return answer;
}

static bool has_gpu(void)
{
    return strstr(command("fovstudy devices")->out, ", software") == NULL;
}

static void a_software_driver_at_90_hz_is_refused(void **state)
{
    (void)state;
    if (has_gpu())
        skip();
    write_protocol("refuse", "regular");
    const struct command_result *result = run("refused", "--size 480x540 --refresh 90 --preflight 30");
    print_message("%s", result->err);
    assert_int_not_equal(result->status, 0);
    assert_non_null(strstr(result->err, "block 'one' is not shown, since frames would come late at 90 Hz: "));
    assert_non_null(strstr(result->err, "regular (condition 2) on 'town' "));
    assert_non_null(strstr(result->err, "set 'pace: common', make --size smaller, or play back"));
    assert_string_equal(ask("refused",
                            "SELECT count(*) FROM event WHERE kind = 'preflight' AND "
                            "detail ->> 'p99_ms' >= detail ->> 'p50_ms' AND detail ->> 'frames' = 30 AND "
                            "detail ->> 'hz' < 90"),
                        "2");
    assert_string_equal(ask("refused", "SELECT count(*) FROM trial WHERE status <> 'planned'"), "0");
    // Whoever wants to see it anyway can, and it is written down.
    result = run("tried", "--size 48x54 --refresh 10 --no-preflight");
    assert_int_equal(result->status, 0);
    assert_string_equal(ask("tried", "SELECT count(*) FROM event WHERE kind = 'no_preflight'"), "1");
    assert_string_equal(ask("tried", "SELECT count(*) FROM event WHERE kind = 'preflight'"), "0");
}

// The real time of drawing decides, so a machine under load may refuse even this; it is asked a few times.
static void a_slow_option_is_paced(void **state)
{
    (void)state;
    const struct command_result *result = NULL;
    write_protocol("common", "regular");
    for (int i = 0; i < 5 && (!result || result->status != 0); i++) {
        command("rm -f '%s/paced.db'*", folder);
        result = run("paced", "--size 128x144 --refresh 120 --preflight 30");
    }
    print_message("%s", result->err);
    if (result->status != 0)
        skip();
    print_message("%s\n", ask("paced", "SELECT group_concat(detail) FROM event WHERE kind = 'pace'"));
    assert_string_equal(ask("paced", "SELECT count(*) FROM event WHERE kind = 'pace' AND trial_id IS NOT NULL"),
                        "2");
    assert_string_equal(ask("paced", "SELECT count(DISTINCT detail) FROM event WHERE kind = 'pace'"), "1");
    // Between two drawn frames of an option lie divisor - 1 that repeat it.
    assert_string_equal(ask("paced",
                            "WITH f AS (SELECT *, row_number() OVER (PARTITION BY trial_id, option ORDER BY "
                            "number) - 1 AS n FROM frame WHERE condition_id IS NOT NULL), d AS (SELECT detail "
                            "->> 'divisor' AS divisor FROM event WHERE kind = 'pace' LIMIT 1) SELECT "
                            "count(*) FROM f, d WHERE (n % divisor = 0) <> (effective IS NULL) OR (effective "
                            "IS NULL) <> (gpu_us IS NOT NULL)"),
                        "0");
    assert_string_equal(ask("paced", "SELECT count(*) > 100 FROM frame WHERE condition_id IS NOT NULL"), "1");
}

// One option live, the other from memory, in one session.
static void a_prerendered_option_is_played(void **state)
{
    (void)state;
    write_protocol("refuse", "kept");
    const struct command_result *result = run("played", "--size 48x54 --refresh 20");
    print_message("%s", result->err);
    assert_int_equal(result->status, 0);
    assert_string_equal(ask("played", "SELECT count(*) FROM event WHERE kind = 'prerendered'"), "2");
    assert_string_equal(
        ask("played", "SELECT count(*) > 40, count(shaded_px), count(gpu_us) FROM frame WHERE effective "
                      "->> 'playback' = 'prerendered' AND condition_id IS NOT NULL"),
        ask("played", "SELECT 1, count(*), 0 FROM frame f JOIN condition c ON c.id = condition_id WHERE "
                      "mode = 'regular'"));
    // Frame n is shown n refreshes after the showing's first, and each once.
    assert_string_equal(ask("played",
                            "SELECT count(*) FROM (SELECT (effective ->> 'frame') - lag(effective ->> 'frame') "
                            "OVER w AS step, number - lag(number) OVER w AS frames FROM frame WHERE effective "
                            "IS NOT NULL WINDOW w AS (PARTITION BY trial_id, option ORDER BY number)) WHERE "
                            "step <> 1 OR frames <> 1"),
                        "0");
}

static void what_depends_on_the_gaze_is_refused(void **state)
{
    (void)state;
    char path[600];
    snprintf(path, sizeof path, "%s/gaze.yaml", folder);
    write_protocol("refuse", "kept");
    assert_int_equal(
        command("sed 's/time_warped}/time_warped, playback: prerendered}/' '%s/protocol.yaml' >'%s'", folder,
                path)
            ->status,
        0);
    const struct command_result *result = command("fovstudy check '%s'", path);
    assert_int_not_equal(result->status, 0);
    assert_non_null(
        strstr(result->err, "whose mode 'time_warped' follows the gaze, which is not known beforehand"));
    result = command("fovstudy run '%s' --db '%s/gaze.db' --participant p --display headless --observer sim",
                     path, folder);
    assert_int_not_equal(result->status, 0);
    assert_non_null(strstr(result->err, "follows the gaze"));
    assert_int_not_equal(command("test -e '%s/gaze.db'", folder)->status, 0);
}

int main(void)
{
    if (command("fovstudy devices")->status != 0)
        return 77;
    command_folder("preflight", folder, sizeof folder);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_software_driver_at_90_hz_is_refused),
        cmocka_unit_test(a_slow_option_is_paced),
        cmocka_unit_test(a_prerendered_option_is_played),
        cmocka_unit_test(what_depends_on_the_gaze_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
