// The calibration study as the demo runs it: one participant rendered (at a tiny size), twenty more answering
// from the errors measured in that session. Exit 77 where no device can draw.
#include "tests/app/command.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

enum { PARTICIPANTS = 21 };

static char folder[512];

#define RUN                                                                                                    \
    "fovstudy run '" SOURCE_DIR "/studies/protocols/calibration.yaml' --db '%s/study.db' --observer sim "      \
    "--scene atrium=town:triangles=20000 --scene town=town:triangles=20000,seed=2 "

static void expect(const char *query, const char *answer)
{
    const struct command_result *result = command("sqlite3 '%s/study.db' \"%s\"", folder, query);
    char expected[256];
    snprintf(expected, sizeof expected, "%s\n", answer);
    if (strcmp(result->out, expected) != 0)
        print_error("%s\n%s\n", query, result->err);
    assert_string_equal(result->out, expected);
}

static void a_whole_study_is_recorded(void **state)
{
    (void)state;
    expect("PRAGMA integrity_check", "ok");
    expect("SELECT count(*) FROM pragma_foreign_key_check", "0");
    expect("SELECT count(*), min(number), max(number) FROM participant WHERE kind = 'simulated'", "21|1|21");
    expect("SELECT count(*), sum(status = 'complete') FROM session", "21|21");
    expect("SELECT count(*) FROM choice WHERE reaction_ns > 0", "189");
    expect("SELECT count(*) FROM rating", "42");
    expect("SELECT count(DISTINCT session_id) FROM frame", "1"); // only one was rendered
    expect("SELECT count(*) > 1000 FROM frame", "1");
    expect("SELECT count(*) > 1000 FROM gaze", "1");
    expect("SELECT count(*) FROM event WHERE kind LIKE 'log_%'", "0");
}

// Each participant's cells lie on one of the scenes; those after the first need them on the other one too.
static void every_option_is_measured_on_every_scene(void **state)
{
    (void)state;
    expect("SELECT count(*) FROM measured_error", "20"); // nine cells and the reference, on two scenes
    expect("SELECT count(*) FROM measured_error e JOIN condition c ON c.id = condition_id WHERE (c.mode = "
           "'regular') <> "
           "(value = 0)",
           "0");
}

static void the_design_is_balanced(void **state)
{
    (void)state;
    expect(
        "SELECT min(n), max(n) FROM (SELECT count(*) AS n FROM trial WHERE kind = 'toggle' GROUP BY factors)",
        "21|21");
    expect("SELECT min(a), max(a) FROM (SELECT sum(test_slot = 'a') AS a FROM trial WHERE kind = 'toggle' "
           "GROUP BY "
           "session_id)",
           "4|5");
    expect("SELECT count(*) FROM (SELECT count(DISTINCT scene) AS n FROM trial WHERE kind = 'rate' GROUP BY "
           "session_id) "
           "WHERE n <> 1",
           "0");
}

static int set_up(void **state)
{
    (void)state;
    command_folder("study", folder, sizeof folder);
    int failed = command(RUN "--participant p1 --display headless --size 24x27 --refresh 15", folder)->status;
    for (int i = 2; i <= PARTICIPANTS && !failed; i++)
        failed = command(RUN "--participant p%d --display none", folder, i)->status;
    return failed;
}

int main(void)
{
    if (command("fovstudy devices")->status != 0)
        return 77;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_whole_study_is_recorded),
        cmocka_unit_test(every_option_is_measured_on_every_scene),
        cmocka_unit_test(the_design_is_balanced),
    };
    return cmocka_run_group_tests(tests, set_up, NULL);
}
