// A rehearsal: the simulated observer takes part in a study with every kind of trial (kinds.yaml), through the
// whole program, with and without frames, and is interrupted anywhere; what the tables must hold stands in
// kinds.sql.
#include "studies/engine/plan.h"
#include "studies/engine/staircase.h"
#include "tests/app/command.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#ifdef __SANITIZE_ADDRESS__
enum { POINTS = 15 };
#else
enum { POINTS = 60 };
#endif

static char folder[512];

#define STUDY "'" SOURCE_DIR "/tests/app/kinds.yaml' --db '%s/%s.db' "
#define LATE "--observer sim:late=0.15,equal_band=1.5,threshold=0.3,errors=%s/errors.csv"

static const char *ask(const char *name, const char *query)
{
    static char answer[COMMAND_TEXT];
    const struct command_result *result = command("sqlite3 '%s/%s.db' \"%s\"", folder, name, query);
    if (result->err[0])
        print_error("%s\n%s\n", query, result->err);
    assert_int_equal(result->status, 0);
    strcpy(answer, result->out);
    answer[strcspn(answer, "\n")] = '\0';
    return answer;
}

#define expect(name, query, answer) assert_string_equal(ask(name, query), answer)

static void expect_done(const struct command_result *result)
{
    if (result->status != 0)
        fail_msg("%d: %s", result->status, result->err);
}

static void expect_rules(const char *name)
{
    const struct command_result *result = command(
        "sqlite3 -bail '%s/%s.db' < '" SOURCE_DIR "/tests/app/kinds.sql' | grep -v '|0$'", folder, name);
    if (strcmp(result->out, "ok\n") != 0 || result->err[0])
        fail_msg("%s: %s%s", name, result->out, result->err);
}

// The staircases of kinds.yaml.
static struct staircase *make_staircase(const char *block)
{
    struct staircase_desc desc = {.larger = STAIRCASE_LARGER_EASIER};
    if (strcmp(block, "stairs") == 0) {
        desc.method = staircase_find_method("1up2down");
        desc.level = (struct quest_plus_grid){.min = 0.05, .max = 1};
        desc.start = 0.5;
        desc.steps[0] = 0.2;
        desc.steps[1] = 0.1;
        desc.step_count = 2;
        desc.trials = 12;
        desc.reversals = 3;
    } else {
        const struct quest_plus_grid grid = {.min = 0.05, .max = 0.8, .count = 9, .spacing = QUEST_PLUS_LOG};
        desc.method = staircase_find_method("quest_plus");
        desc.level = desc.model.threshold = grid;
        desc.trials = 4;
        desc.model.family = quest_plus_find_family("logistic");
        desc.model.outcomes = 3;
        desc.model.slope = (struct quest_plus_grid){.min = 1, .max = 8, .count = 4};
        desc.model.lapse = (struct quest_plus_grid){.min = 0.02, .max = 0.02, .count = 1};
    }
    struct staircase *made = staircase_create(&desc);
    assert_non_null(made);
    return made;
}

// The outcomes in the file, one after the other, give the levels and estimates in the file.
static void expect_staircase(const char *name, const char *block, const char *session)
{
    char query[512], *rows = NULL;
    snprintf(
        query, sizeof query,
        "SELECT group_concat(outcome || ' ' || level || ' ' || coalesce(estimate, -1) || ' ' || reversal, "
        "';') FROM (SELECT s.* FROM staircase_step s JOIN trial t ON t.id = trial_id WHERE block = '%s' AND "
        "session_id = %s ORDER BY ordinal)",
        block, session);
    rows = strdup(ask(name, query));
    struct staircase *staircase = make_staircase(block);
    for (char *row = strtok(rows, ";"); row; row = strtok(NULL, ";")) {
        struct staircase_step step;
        char *end = row;
        uint32_t outcome = (uint32_t)strtoul(end, &end, 10);
        assert_false(staircase_done(staircase));
        assert_true(staircase_outcome(staircase, outcome, &step));
        assert_true(plan_level(step.level) == strtod(end, &end)); // stored as it was shown
        double estimate = strtod(end, &end);
        assert_true(isnan(step.estimate) ? estimate == -1 : fabs(step.estimate - estimate) < 1e-9);
        assert_int_equal(step.reversal, strtol(end, &end, 10));
    }
    if (strcmp(ask(name, "SELECT count(*) FROM trial WHERE status = 'invalid' AND kind = 'staircase'"), "0") ==
        0)
        assert_true(staircase_done(staircase));
    staircase_destroy(staircase);
    free(rows);
}

static void expect_staircases(const char *name, const char *session)
{
    expect_staircase(name, "stairs", session);
    expect_staircase(name, "unequal", session);
    expect_staircase(name, "visible", session);
}

static void every_kind_without_frames(void **state)
{
    (void)state;
    for (int i = 1; i <= 16; i++) { // so many that every block has a deadline missed
        char session[16];
        snprintf(session, sizeof session, "%d", i);
        expect_done(
            command("fovstudy run " STUDY "--participant p%d --display none " LATE, folder, "none", i, folder));
        expect_staircases("none", session);
    }
    expect_rules("none");
    // All that can happen did.
    expect("none", "SELECT count(DISTINCT kind), count(DISTINCT block) FROM trial WHERE status = 'done'",
           "9|10");
    expect("none", "SELECT count(DISTINCT block) FROM trial WHERE repeat_of IS NOT NULL", "3");
    expect("none", "SELECT count(*) > 0 FROM trial WHERE status = 'skipped'", "1");
    expect("none",
           "SELECT count(DISTINCT t.block) FROM choice JOIN trial t ON t.id = trial_id WHERE chosen = "
           "'equal'",
           "2");
    expect("none", "SELECT count(*) > 0 FROM trial WHERE kind = 'staircase' AND status = 'invalid'", "1");
    // Where no deadline is missed on purpose none is missed.
    expect_done(command("fovstudy run " STUDY
                        "--participant p --display none --observer sim:errors=%s/errors.csv",
                        folder, "punctual", folder));
    expect("punctual", "SELECT count(*) FROM trial WHERE status = 'invalid'", "0");
    // An adjustment ends where the difference cannot be told: at the end of the scale without error.
    expect("punctual", "SELECT count(*), max(value) <= 0.1 FROM response WHERE question = 'epsilon'", "2|1");
}

// A deadline shorter than its usual look: it answers in time. Two parameters to set: it sets both.
static void it_minds_deadlines_and_every_parameter(void **state)
{
    (void)state;
    expect_done(command(
        "sed -e 's/deadline_s: 20/deadline_s: 4/; s/step: 0.05, max: 1}}/step: 0.05, max: 1}, fovea_deg: "
        "{start: [6, 8], step: 1, min: 5, max: 20}}/' '" SOURCE_DIR "/tests/app/kinds.yaml' > "
        "'%s/hurry.yaml'; for s in atrium town; do for f in 5 20; do echo "
        "$s,0.$f,time_warped:fovea_deg=$f; done; done | sed 's/0.5,/0.3,/; s/0.20,/0.1,/' | cat - "
        "'%s/errors.csv' > '%s/two.csv'; fovstudy run '%s/hurry.yaml' --db '%s/hurry.db' "
        "--participant p --display none --observer sim:errors='%s/two.csv',toggles_mean=9",
        folder, folder, folder, folder, folder, folder));
    expect("hurry", "SELECT count(*) FROM trial WHERE status = 'invalid'", "0");
    expect("hurry",
           "SELECT max(reaction_ns) BETWEEN 3e9 AND 4e9 FROM choice JOIN trial t ON t.id = trial_id WHERE "
           "block IN ('pairs', 'stairs')",
           "1");
    expect("hurry",
           "SELECT count(*), count(DISTINCT parameter) FROM response r JOIN adjust_step s ON s.trial_id = "
           "r.trial_id AND s.parameter = r.question WHERE s.value = r.value AND s.id = (SELECT max(id) "
           "FROM adjust_step m WHERE m.trial_id = r.trial_id AND m.parameter = r.question)",
           "4|2");
    // Ends that contradict the mode are found before anybody sits down.
    const struct command_result *result =
        command("sed -i 's/min: 5, max: 20/min: 5, max: 60/' '%s/hurry.yaml'; fovstudy check '%s/hurry.yaml'",
                folder, folder);
    assert_int_equal(result->status, 1);
    assert_non_null(strstr(result->err, "block 'setting' may come to that"));
    result =
        command("sed 's/min_exposure_s: 0.4, deadline_s: 20/min_exposure_s: 0.4, deadline_s: 1.2/' '" SOURCE_DIR
                "/tests/app/kinds.yaml' > '%s/short.yaml'; fovstudy check '%s/short.yaml'",
                folder, folder);
    assert_int_equal(result->status, 1);
    assert_non_null(strstr(result->err, "with the fade 1.3 s"));
}

static void the_same_session_comes_again(void **state)
{
    (void)state;
    const char *const tables[] = {"trial",    "choice",      "rating",         "response",
                                  "exposure", "adjust_step", "staircase_step", "condition"};
    expect_done(
        command("fovstudy run " STUDY "--participant p1 --display none " LATE, folder, "again", folder));
    for (size_t i = 0; i < sizeof tables / sizeof tables[0]; i++)
        expect_done(command("sqlite3 '%s/again.db' 'SELECT * FROM %s' > '%s/again.txt'; sqlite3 '%s/none.db' "
                            "'SELECT * FROM %s' | head -n $(wc -l < '%s/again.txt') | cmp - '%s/again.txt'",
                            folder, tables[i], folder, folder, tables[i], folder, folder));
}

// What is fixed before anybody answers.
#define PLANNED                                                                                                \
    "SELECT ordinal, block, kind, scene, settings, factors, test_slot, first_shown, fixation, seed FROM "      \
    "trial "                                                                                                   \
    "WHERE repeat_of IS NULL ORDER BY ordinal"
// What was acknowledged; trials are named by their ids, which stay.
#define ANSWERED                                                                                               \
    "SELECT 'c', id, trial_id, chosen, correct, reaction_ns, answered_ns FROM choice; SELECT 'r', id, "        \
    "trial_id, question, subject, value, condition_id FROM rating; SELECT 'n', id, trial_id, question, "       \
    "value, "                                                                                                  \
    "expected FROM response; SELECT 's', trial_id, level, outcome, reversal, estimate FROM staircase_step; "   \
    "SELECT 't', id, status FROM trial WHERE status IN ('done', 'skipped', 'invalid')"

static void kill_and_resume(long at)
{
    command("rm -f '%s'/k.*", folder);
    int status =
        command("( KILL_AT=%ld ASAN_OPTIONS=verify_asan_link_order=0 LD_PRELOAD='%s/tests/kill_at.so' "
                "'%s/bin/fovstudy' run " STUDY "--participant p1 --display none " LATE " ); s=$?; (exit $s)",
                at, BUILD_DIR, BUILD_DIR, folder, "k", folder)
            ->status;
    assert_true(status == 137 || status == 0);
    command(
        "sqlite3 '%s/k.db' \"SELECT block FROM trial WHERE status = 'running'\" >> '%s/running.txt'; sqlite3 "
        "'%s/k.db' \"" ANSWERED "\" > '%s/before.txt'",
        folder, folder, folder, folder);
    const struct command_result *result = command("fovstudy resume --db '%s/k.db'", folder);
    if (result->status != 0 && (strstr(result->err, "no session") || strstr(result->err, "empty")))
        return; // before there was one
    expect_done(result);
    expect_rules("k");
    expect_staircases("k", "1");
    expect_done(command("sqlite3 '%s/k.db' \"" ANSWERED
                        "\" | sort > '%s/after.txt'; sort '%s/before.txt' | comm "
                        "-23 - '%s/after.txt' | (! grep .)",
                        folder, folder, folder, folder));
    expect_done(command("sqlite3 '%s/k.db' \"" PLANNED "\" | cmp - '%s/planned.txt'", folder, folder));
    // An adjustment begins anew where it began: the first steps of both attempts lie a step about the start.
    expect("k",
           "SELECT count(*) FROM (SELECT trial_id, segment_id, min(id), value AS first FROM adjust_step "
           "GROUP BY trial_id, segment_id) a JOIN (SELECT trial_id, segment_id, min(id), value AS first "
           "FROM adjust_step GROUP BY trial_id, segment_id) b USING (trial_id) WHERE abs(a.first - b.first) > "
           "1e-9 AND abs(abs(a.first - b.first) - 0.1) > 1e-9",
           "0");
}

static void interruptions_lose_nothing(void **state)
{
    (void)state;
    expect_done(command("KILL_COUNT='%s/count' ASAN_OPTIONS=verify_asan_link_order=0 "
                        "LD_PRELOAD='%s/tests/kill_at.so' '%s/bin/fovstudy' run " STUDY
                        "--participant p1 --display none " LATE "; sqlite3 '%s/whole.db' \"" PLANNED
                        "\" > '%s/planned.txt'",
                        folder, BUILD_DIR, BUILD_DIR, folder, "whole", folder, folder, folder));
    long calls = strtol(command("cat '%s/count'", folder)->out, NULL, 10);
    assert_true(calls > 200);
    for (int i = 0; i < POINTS; i++)
        kill_and_resume(1 + (2 * i + 1) * calls / (2 * POINTS));
    const struct command_result *result = command("sort -u '%s/running.txt' | tr '\\n' ' '", folder);
    printf("killed at %d of %ld calls, in %s\n", POINTS, calls, result->out);
    if (POINTS >= 60) // every kind was running at some point; two blocks rate
        assert_true(strtol(command("sort -u '%s/running.txt' | wc -l", folder)->out, NULL, 10) >= 9);
}

// The frames of the same study at a tiny size. Those who come after see what was measured there, levels and
// adjusted values too.
static void every_kind_with_frames(void **state)
{
    (void)state;
#define SCENES "--scene atrium=town:triangles=20000 --scene town=town:triangles=20000,seed=2 "
    if (command("fovstudy devices")->status != 0)
        skip();
    expect_done(command("fovstudy run " STUDY SCENES
                        "--participant p1 --display headless --size 32x36 --refresh 10 "
                        "--observer sim:late=0.1,threshold=0.005",
                        folder, "frames"));
    expect_rules("frames");
    expect_staircases("frames", "1");
    expect("frames",
           "SELECT count(*) FROM frame f JOIN trial t ON t.id = trial_id WHERE t.kind = 'staircase' AND "
           "condition_id <> CASE option WHEN 'a' THEN option_a ELSE option_b END",
           "0");
    // Every level on screen has an error of its own, each setting too.
    expect("frames",
           "SELECT count(*) FROM trial t JOIN condition c ON c.id = iif(test_slot = 'a', option_a, "
           "option_b) WHERE kind = 'staircase' AND status = 'done' AND NOT EXISTS (SELECT 1 FROM "
           "measured_error e WHERE e.condition_id = c.id AND metric = 'wrmse')",
           "0");
    expect("frames", "SELECT group_concat(metric) FROM (SELECT DISTINCT metric FROM measured_error ORDER BY 1)",
           "wrmse,wrmse;ssao=on");
    expect("frames",
           "SELECT count(*) > 8 FROM measured_error e JOIN condition c ON c.id = condition_id WHERE "
           "metric = 'wrmse' AND value > 0 AND scene = 'town:triangles=20000'",
           "1");
    for (int i = 2; i <= 3; i++)
        expect_done(command("fovstudy run " STUDY SCENES
                            "--participant p%d --display none --observer sim:late=0.1",
                            folder, "frames", i));
    expect_rules("frames");
    expect_staircases("frames", "2");
}

static void what_is_not_known_is_refused(void **state)
{
    (void)state;
    const struct command_result *result =
        command("grep -v '^town,.*epsilon=[0-9.]*$' '%s/errors.csv' > '%s/few.csv'; echo "
                "town,0.2,time_warped:epsilon=0.2 >> '%s/few.csv'; fovstudy run " STUDY
                "--participant p1 --display none --observer sim:errors=%s/few.csv",
                folder, folder, folder, folder, "few", folder);
    assert_int_equal(result->status, 1);
    assert_non_null(strstr(result->err, "few.csv nor the study file holds the error of time_warped"));
    assert_non_null(strstr(result->err, "add the line 'town,ERROR,time_warped:epsilon="));
    result = command("sed 's/;ssao=on//' '%s/errors.csv' > '%s/off.csv'; fovstudy run " STUDY
                     "--participant p1 --display none --observer sim:errors=%s/off.csv",
                     folder, folder, folder, "off", folder);
    assert_int_equal(result->status, 1);
    assert_non_null(strstr(result->err, ";ssao=on,ERROR,time_warped'"));
    // One value of the parameter is too little to know others.
    result =
        command("sed -e 's/name: stairs/name: main/' '" SOURCE_DIR "/tests/app/kinds.yaml' > '%s/one.yaml'; "
                "sed -i '/^- name: training/,/^- name: main/{/^- name: main/!d}; /^- name: unequal/,$d' "
                "'%s/one.yaml'; printf 'atrium,0.1,time_warped:epsilon=0.2\\n"
                "town,0.1,time_warped:epsilon=0.2\\n' > '%s/one.csv'; fovstudy run '%s/one.yaml' --db "
                "'%s/one.db' --participant p --display none --observer sim:errors=%s/one.csv",
                folder, folder, folder, folder, folder, folder);
    assert_int_equal(result->status, 1);
    assert_non_null(strstr(result->err, "at two values of 'epsilon' (it has 1)"));
    assert_non_null(strstr(result->err, "add lines like 'atrium,ERROR,time_warped:epsilon=0.2'"));
}

static void a_planned_margin_is_kept(void **state)
{
    (void)state;
    expect_done(command("sed 's/per: cell}/per: cell, margin: 0.15}/' '" SOURCE_DIR
                        "/tests/app/kinds.yaml' > '%s/margin.yaml'; fovstudy run '%s/margin.yaml' --db "
                        "'%s/margin.db' --participant p --display none --observer sim:errors=%s/errors.csv",
                        folder, folder, folder, folder));
    expect(
        "margin",
        "SELECT (settings ->> '$.planned[0].margin') || coalesce(settings ->> '$.planned[1].margin', ', none') "
        "FROM session",
        "0.15, none");
}

static int set_up(void **state)
{
    (void)state;
    command_folder("rehearse", folder, sizeof folder);
    return command(
               "for s in atrium town; do echo $s,0.0,time_warped:epsilon=0; for e in 0.05 0.1 0.2 1; do echo "
               "$s,$e,time_warped:epsilon=$e; done; echo \"$s;ssao=on,0.2,time_warped:epsilon=0.2\"; done > "
               "'%s/errors.csv'",
               folder)
        ->status;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kind_without_frames),
        cmocka_unit_test(the_same_session_comes_again),
        cmocka_unit_test(it_minds_deadlines_and_every_parameter),
        cmocka_unit_test(interruptions_lose_nothing),
        cmocka_unit_test(what_is_not_known_is_refused),
        cmocka_unit_test(a_planned_margin_is_kept),
        cmocka_unit_test(every_kind_with_frames),
    };
    return cmocka_run_group_tests(tests, set_up, NULL);
}
