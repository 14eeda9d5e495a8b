// `fovstudy run` is killed at seeded points, in the middle of writes, between commits and in event lines, and
// resumed; some resumes are killed as well. In the end the trials are those of a session that nobody disturbed,
// byte for byte, and every answer that an event line told is in the file.
//
// FOVSTUDY_SOAK=N: N points instead of the few that fit every run of the tests.
#include "tests/app/command.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#ifdef __SANITIZE_ADDRESS__
enum { POINTS = 12 };
#else
enum { POINTS = 40 };
#endif
enum { TRIALS = 9, LONG_TRIALS = 4096, READY_MS = 2000 };

static char folder[512];

#define OBSERVER "--display none --observer sim:errors=%s/errors.csv"
#define TRIAL_LIST                                                                                             \
    "SELECT t.ordinal, t.block, t.kind, t.scene, t.settings, t.factors, a.mode, a.parameters, b.mode, "        \
    "b.parameters, t.test_slot, t.first_shown, t.fixation, t.seed, t.repeat_of, t.status FROM trial t "        \
    "LEFT JOIN condition a ON a.id = t.option_a LEFT JOIN condition b ON b.id = t.option_b ORDER BY t.id"

static int64_t now_ms(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (int64_t)time.tv_sec * 1000 + time.tv_nsec / 1000000;
}

static int points(void)
{
    const char *text = getenv("FOVSTUDY_SOAK");
    return text ? atoi(text) : POINTS;
}

// Which calls are the last ones: Numerical Recipes' generator only spreads them.
static uint32_t draw(uint32_t *random, uint32_t below)
{
    *random = *random * 1664525u + 1013904223u;
    return (uint32_t)(((uint64_t)*random * below) >> 32);
}

static const struct command_result *go(const char *name, const char *verb, uint32_t kill_at)
{
    char line[4096];
    bool run = strcmp(verb, "run") == 0;
    snprintf(
        line, sizeof line,
        "ASAN_OPTIONS=verify_asan_link_order=0 LD_PRELOAD=%s/tests/kill_at.so KILL_AT=%u KILL_COUNT=%s/count "
        "'%s/bin/fovstudy' %s --db %s/%s.db --events %s/%s.jsonl %s%s%s",
        BUILD_DIR, kill_at, folder, BUILD_DIR, verb, folder, name, folder, name, run ? folder : "",
        run ? "/s.yaml --participant p --display none --gaze sim --observer sim:errors=" : "",
        run ? folder : "");
    if (run)
        strcat(line, "/errors.csv");
    return command("( %s ); s=$?; (exit $s)", line); // the shell's own word on it goes with its errors
}

static uint32_t counted(void)
{
    return (uint32_t)strtoul(command("cat %s/count", folder)->out, NULL, 10);
}

// The whole of it in one look: whether the file is sound, and lines against rows.
static void expect_nothing_lost(const char *name, const char *trials)
{
    const struct command_result *result =
        command("sqlite3 -bail %s/%s.db <<'END'\n"
                ".mode list\n"
                "PRAGMA integrity_check;\n"
                "SELECT count(*) FROM pragma_foreign_key_check;\n"
                "CREATE TEMP TABLE line (x TEXT);\n"
                ".mode ascii\n.separator \"\\037\" \"\\n\"\n.import %s/%s.jsonl line\n.mode list\n"
                "SELECT count(*) FROM line WHERE NOT json_valid(x) OR x ->> '$.seq' <> rowid;\n"
                "SELECT count(*) FROM line WHERE x ->> '$.event' = 'answer' AND NOT EXISTS (SELECT 1 FROM "
                "choice c JOIN "
                "trial t ON t.id = c.trial_id WHERE x ->> '$.table' = 'choice' AND c.id = x ->> '$.row' AND "
                "t.ordinal = x "
                "->> '$.trial' AND c.chosen = x ->> '$.value') AND NOT EXISTS (SELECT 1 FROM rating r JOIN "
                "trial t ON t.id "
                "= r.trial_id WHERE x ->> '$.table' = 'rating' AND r.id = x ->> '$.row' AND t.ordinal = x ->> "
                "'$.trial' AND "
                "r.value = x ->> '$.value');\n"
                "SELECT count(*) FROM line WHERE x ->> '$.event' = 'answer' GROUP BY x ->> '$.trial' HAVING "
                "count(*) > 1;\n"
                "SELECT status FROM session;\n"
                "SELECT (SELECT count(*) FROM choice) + (SELECT count(*) FROM rating);\n"
                "SELECT count(*) = count(DISTINCT trial_id) FROM choice;\n"
                "SELECT (SELECT count(*) FROM segment WHERE reason = 'resume') - (SELECT count(*) FROM event "
                "WHERE kind = "
                "'gap');\nEND\ntrue",
                folder, name, folder, name);
    if (strcmp(result->out, "ok\n0\n0\n0\ncomplete\n9\n1\n0\n") != 0)
        fail_msg("%s: %s%s", name, result->out, result->err);
    result = command("sqlite3 %s/%s.db \"%s\"", folder, name, TRIAL_LIST);
    assert_string_equal(result->out, trials);
}

// Resumes until the end; where nothing was begun yet, begins.
static int64_t bring_to_the_end(const char *name, uint32_t kill_at)
{
    int64_t slowest_ms = 0;
    for (int again = 0;; again++) {
        int64_t start_ms = now_ms();
        const struct command_result *result = go(name, "resume", again == 0 ? kill_at : 0);
        int64_t took_ms = now_ms() - start_ms;
        if (result->status == 1 && !strstr(result->err, "no session") && !strstr(result->err, "empty file") &&
            !strstr(result->err, "No such file"))
            fail_msg("resume: %s", result->err);
        if (result->status == 1) {
            result = go(name, "run", 0);
            if (result->status != 0)
                fail_msg("run: %s", result->err);
            return slowest_ms;
        }
        slowest_ms = took_ms > slowest_ms ? took_ms : slowest_ms;
        if (result->status == 0)
            return slowest_ms;
        assert_int_equal(result->status, 137);
        assert_true(again == 0 && kill_at > 0);
    }
}

static void kills_lose_nothing(void **state)
{
    (void)state;
    static char trials[COMMAND_TEXT];
    uint32_t random = 20261125; // the seed
    int killed = 0, killed_twice = 0, count = points();
    int64_t slowest_ms = 0;
    const struct command_result *result = go("whole", "run", 0);
    if (result->status != 0)
        fail_msg("%s", result->err);
    uint32_t calls = counted();
    assert_true(calls > 50);
    strcpy(trials, command("sqlite3 %s/whole.db \"%s\"", folder, TRIAL_LIST)->out);
    expect_nothing_lost("whole", trials);
    for (int i = 0; i < count; i++) {
        command("rm -f %s/k.*", folder);
        uint32_t at = 1 + draw(&random, calls), second = i % 3 == 0 ? 1 + draw(&random, calls) : 0;
        int status = go("k", "run", at)->status;
        assert_true(status == 137 ||
                    status == 0); // the second thread's calls make the count a little uncertain
        killed += status == 137;
        killed_twice += second > 0;
        int64_t took_ms = bring_to_the_end("k", second);
        slowest_ms = took_ms > slowest_ms ? took_ms : slowest_ms;
        expect_nothing_lost("k", trials);
    }
    printf(
        "%d runs of %d calls killed at %d points, %d of their resumes too; the slowest resume to the end took "
        "%d ms\n",
        count, (int)calls, killed, killed_twice, (int)slowest_ms);
    assert_true(killed >= count * 9 / 10);
}

// Thousands of trials: ready within two seconds. The gap's line is written when all is ready.
static void a_long_session_is_ready_in_two_seconds(void **state)
{
    (void)state;
    assert_int_equal(
        command("( '%s/bin/fovstudy' run %s/long.yaml --participant p --db %s/long.db --events "
                "%s/long.jsonl " OBSERVER " & p=$!; until [ -s %s/long.jsonl ] && [ $(wc -l < "
                "%s/long.jsonl) -gt 500 ]; do sleep 0.05; done; kill -9 $p; wait $p 2>/dev/null; true )",
                BUILD_DIR, folder, folder, folder, folder, folder, folder)
            ->status,
        0);
    int64_t start_ms = now_ms();
    assert_int_equal(
        command("( '%s/bin/fovstudy' resume --db %s/long.db --events %s/long2.jsonl & p=$!; until [ -s "
                "%s/long2.jsonl ]; do sleep 0.01; done; kill -9 $p; wait $p 2>/dev/null; true )",
                BUILD_DIR, folder, folder, folder)
            ->status,
        0);
    int64_t took_ms = now_ms() - start_ms;
    const struct command_result *result = command("sqlite3 %s/long.db \"SELECT count(*), (SELECT count(*) FROM "
                                                  "segment WHERE reason = 'resume') FROM trial\"",
                                                  folder);
    assert_string_equal(result->out, "4096|1\n");
    printf("a session of %d trials is ready after %d ms\n", LONG_TRIALS, (int)took_ms);
#ifndef __SANITIZE_ADDRESS__
    assert_true(took_ms <= READY_MS);
#endif
}

static int set_up(void **state)
{
    (void)state;
    snprintf(folder, sizeof folder, "/dev/shm/fovstudy-resume-%d", (int)getpid());
    if (command("mkdir -p %s", folder)->status != 0)
        command_folder("resume", folder, sizeof folder);
    // Nine trials like those of the calibration study, and 4096.
    return command("head='{fovstudy: 1, seed: 1, title: t, scenes: [atrium, town], options: {foveated: {mode: "
                   "time_warped}, regular: {mode: regular}}, reference: regular, settings: {moving_objects: "
                   "off, advance: "
                   "auto, rest_s: 0.5, question: prefer}, questions: {prefer: {text: Which}, quality: {text: "
                   "How, scale: "
                   "[1, 10]}}, instructions: i, consent: {version: \"1\", text: c}'\n"
                   "two='kind: toggle, options: [foveated, regular]'\n"
                   "echo \"$head, name: small, blocks: [{name: d, $two, factors: {epsilon: [0.2, 0.1, 0.05, "
                   "0.02]}, "
                   "repetitions: 2}, {name: r, kind: rate, options: [foveated], settings: {question: "
                   "quality}}]}\" > "
                   "%s/s.yaml\n"
                   "blocks=$(for i in 1 2 3 4 5 6 7 8; do echo \"{name: b$i, $two, factors: {epsilon: [0.2, "
                   "0.05]}, "
                   "repetitions: 256},\"; done)\n"
                   "echo \"$head, name: long, blocks: [$blocks]}\" > %s/long.yaml\n"
                   "for s in atrium town; do for e in 0.2 0.1 0.05 0.02; do echo $s,$e,time_warped:epsilon=$e; "
                   "done; done "
                   "> %s/errors.csv",
                   folder, folder, folder)
        ->status;
}

static int tear_down(void **state)
{
    (void)state;
    return command("rm -rf %s", folder)->status;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kills_lose_nothing),
        cmocka_unit_test(a_long_session_is_ready_in_two_seconds),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
