// Every frame accounted for: a clean headless session has no finding; faults planted into copies of its file
// are reported in exactly their numbers, with their trials named. Exit 77 where no device can draw.
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

static const char *sql(const char *db, const char *text)
{
    static char answer[COMMAND_TEXT];
    const struct command_result *result = command("sqlite3 '%s/%s.db' \"%s\"", folder, db, text);
    if (result->status != 0)
        fail_msg("%s\n%s", text, result->err);
    strcpy(answer, result->out);
    answer[strcspn(answer, "\n")] = '\0';
    return answer;
}

static int64_t number(const char *db, const char *text)
{
    return strtoll(sql(db, text), NULL, 10);
}

static void copy(const char *name)
{
    assert_int_equal(command("cp '%s/a.db' '%s/%s.db'", folder, folder, name)->status, 0);
}

static const char *audit(const char *db, const char *format)
{
    static char answer[COMMAND_TEXT];
    const struct command_result *result =
        command("'%s/bin/fovstats' frames --audit '%s/%s.db' --simulated %s", BUILD_DIR, folder, db, format);
    if (result->status != 0)
        fail_msg("%s", result->err);
    strcpy(answer, result->out);
    return answer;
}

// A number of the (only) session.
static int64_t of(const char *json, const char *key)
{
    char quoted[64];
    snprintf(quoted, sizeof quoted, "\"%s\":", key);
    const char *session = strstr(json, "\"sessions_audited\":");
    const char *found = session ? strstr(session, quoted) : NULL;
    if (!found)
        fail_msg("no %s in %s", key, json);
    return strtoll(found + strlen(quoted), NULL, 10);
}

static void expect_findings(const char *json, int64_t findings)
{
    const char *found = strstr(json, "\"findings\":");
    assert_non_null(found);
    if (strtoll(found + 11, NULL, 10) != findings)
        fail_msg("not %d findings: %s", (int)findings, json);
}

static void expect_said(const char *db, const char *part)
{
    const char *text = audit(db, "");
    if (!strstr(text, part))
        fail_msg("\"%s\" is not in\n%s", part, text);
}

static void a_clean_session_has_no_finding(void **state)
{
    (void)state;
    const char *json = audit("a", "--json");
    expect_findings(json, 0);
    assert_int_equal(of(json, "frames"), number("a", "SELECT count(*) FROM frame"));
    assert_int_equal(of(json, "frames"), of(json, "submitted"));
    assert_int_equal(of(json, "segments_uncounted"), 0);
    int64_t toggles = number("a", "SELECT count(*) FROM event WHERE kind = 'toggle'");
    assert_true(toggles > 4);
    assert_int_equal(of(json, "switches"), toggles);
    assert_int_equal(of(json, "fades_judged"), toggles);
    expect_said("a", "No finding.");
}

// A fade of 40 ms more: 2.4 frames at 60 Hz, in the exposures and in the frames.
#define LONG_EXPOSURE                                                                                          \
    "UPDATE exposure SET full_start_ns = full_start_ns + 40000000 WHERE id = (SELECT id FROM exposure WHERE "  \
    "trial_id = 2 ORDER BY id LIMIT 1 OFFSET 1);"
#define LONG_FRAMES                                                                                            \
    "UPDATE frame SET fade_level = 0.02, phase = 'fade' WHERE trial_id = 2 AND start_ns >= (SELECT "           \
    "full_start_ns FROM exposure WHERE trial_id = 2 ORDER BY id LIMIT 1 OFFSET 1) AND start_ns < 40000000 + "  \
    "(SELECT full_start_ns FROM exposure WHERE trial_id = 2 ORDER BY id LIMIT 1 OFFSET 1);"
#define SEEN(slots) "phase = 'stimulus' AND condition_id IS NOT NULL " slots
#define FOVEATED "AND condition_id IN (SELECT id FROM condition WHERE mode = 'time_warped') "

static void planted_faults_are_counted_and_named(void **state)
{
    (void)state;
    copy("planted");
    sql("planted", LONG_FRAMES LONG_EXPOSURE
        "UPDATE frame SET late = 1 WHERE id IN (SELECT id FROM frame WHERE trial_id = 1 AND " SEEN(
            "") "ORDER BY id LIMIT 7);"
                "UPDATE frame SET late = 1 WHERE id IN (SELECT id FROM frame WHERE trial_id = 2 AND phase = "
                "'fade' ORDER BY id "
                "LIMIT 3);"
                "UPDATE frame SET late = 1 WHERE id IN (SELECT id FROM frame WHERE phase = 'rest' ORDER BY id "
                "LIMIT 2);"
                "UPDATE frame SET gaze_age_us = 600000 WHERE id IN (SELECT id FROM frame WHERE trial_id = 2 "
                "AND " SEEN("") "ORDER BY id DESC LIMIT 5);"
                                "UPDATE frame SET fovea_source = 'fixed' WHERE id IN (SELECT id FROM frame "
                                "WHERE trial_id = 1 AND " SEEN(
                                    FOVEATED) "ORDER BY id DESC LIMIT 4);"
                                              "UPDATE frame SET fovea_source = 'lost' WHERE id IN (SELECT id "
                                              "FROM frame WHERE trial_id = 3 AND " SEEN(
                                                  FOVEATED) "ORDER BY id DESC LIMIT 6);"
                                                            "DELETE FROM frame WHERE id = (SELECT id FROM "
                                                            "frame WHERE trial_id = 3 AND " SEEN(
                                                                "") "ORDER BY id LIMIT 1 OFFSET "
                                                                    "20);");
    const char *json = audit("planted", "--json");
    assert_int_equal(of(json, "late_stimulus"), 7);
    assert_int_equal(of(json, "late_fade"), 3);
    assert_int_equal(of(json, "late_other"), 2);
    assert_int_equal(of(json, "stale"), 5);
    assert_int_equal(of(json, "fixed"), 4);
    assert_int_equal(of(json, "lost"), 6);
    assert_int_equal(of(json, "missing"), 1);
    assert_int_equal(of(json, "fades_off"), 1);
    assert_int_equal(of(json, "copied_eye"), 0);
    expect_findings(json, 7 + 3 + 2 + 5 + 4 + 6 + 1 + 1);
    expect_said("planted", "trial 1 (place 1): 7 late stimulus frames, 4 frames with fixed foveation\n");
    expect_said("planted",
                "trial 2 (place 2): 3 late frames in fades, 5 frames with stale gaze, 1 fades off the "
                "protocol\n");
    expect_said("planted", "trial 3 (place 3): 1 frames without a row, 6 foveated frames with lost gaze\n");
    expect_said("planted", "between trials: 2 late frames of questions and rest\n");
    expect_said("planted", "trial 2, switch 1: the fade ended 50.0 ms late\n"); // the third frame after
    const struct command_result *result = command("'%s/bin/fovstats' report '%s/planted.db' --simulated -o "
                                                  "'%s/r.html' && grep -c 'the fade ended 50.0 ms "
                                                  "late' '%s/r.html'",
                                                  BUILD_DIR, folder, folder, folder);
    assert_int_equal(result->status, 0);
}

// Each of the two ways to see a fade sees it by itself.
static void a_fade_is_seen_by_frames_and_by_exposures(void **state)
{
    (void)state;
    copy("frames");
    sql("frames", LONG_FRAMES);
    expect_findings(audit("frames", "--json"), 1);
    copy("exposures");
    sql("exposures", LONG_EXPOSURE);
    expect_findings(audit("exposures", "--json"), 1);
    expect_said("exposures", "trial 2, switch 1: the fade ended 40.0 ms late\n");
    // Gray that begins late: the first two gray frames are not quite.
    copy("gray");
    sql("gray",
        "UPDATE frame SET fade_level = 0.99 WHERE id IN (SELECT id FROM frame WHERE trial_id = 1 AND "
        "fade_level = 1 "
        "AND start_ns > (SELECT min(full_end_ns) FROM exposure WHERE trial_id = 1) ORDER BY id LIMIT 3)");
    expect_findings(audit("gray", "--json"), 1);
    expect_said("gray", "trial 1, switch 1: it was gray 5");
    // A row missing at the corner of a fade is a missing row, not a wrong fade.
    copy("corner");
    sql("corner", "DELETE FROM frame WHERE trial_id = 1 AND start_ns = (SELECT full_start_ns FROM exposure "
                  "WHERE trial_id = "
                  "1 ORDER BY id LIMIT 1 OFFSET 1)");
    const char *json = audit("corner", "--json");
    expect_findings(json, 1);
    assert_int_equal(of(json, "missing"), 1);
}

static void gaze_that_stands_still_or_is_one_eyes(void **state)
{
    (void)state;
    char text[1024];
    copy("stuck"); // thirty frames by one sample, whose age looks fresh
    int64_t first = number("stuck", "SELECT min(id) + 5 FROM frame WHERE trial_id = 3 AND " SEEN(""));
    snprintf(text, sizeof text,
             "UPDATE frame SET gaze_id = (SELECT gaze_id FROM frame WHERE id = %d) WHERE id BETWEEN %d AND %d",
             (int)first, (int)first, (int)first + 29);
    sql("stuck", text);
    snprintf(text, sizeof text,
             "SELECT count(*) FROM frame WHERE id BETWEEN %d AND %d AND start_ns - (SELECT start_ns FROM frame "
             "WHERE id = "
             "%d) > 100000000",
             (int)first, (int)first + 29, (int)first);
    int64_t stale = number("stuck", text);
    assert_true(stale > 20);
    const char *json = audit("stuck", "--json");
    assert_int_equal(of(json, "stale"), stale);
    expect_findings(json, stale);

    copy("copied");
    sql("copied",
        "UPDATE frame SET fovea = json_object('left', fovea -> '$.left', 'right', fovea -> '$.left') WHERE id "
        "IN "
        "(SELECT f.id FROM frame f JOIN gaze g ON g.id = f.gaze_id + 1 WHERE f.trial_id = 3 AND g.valid AND "
        "f.phase = 'stimulus' ORDER BY f.id LIMIT 9)");
    json = audit("copied", "--json");
    assert_int_equal(of(json, "copied_eye"), 9);
    expect_findings(json, 9);
}

static void a_crash_leaves_no_count(void **state)
{
    (void)state;
    copy("end"); // rows that never came
    sql("end", "DELETE FROM frame WHERE id > (SELECT max(id) - 2 FROM frame)");
    const char *json = audit("end", "--json");
    assert_int_equal(of(json, "missing"), 2);
    expect_findings(json, 2);
    copy("crash");
    sql("crash", "DELETE FROM frame WHERE id > (SELECT max(id) - 2 FROM frame); DELETE FROM event WHERE kind = "
                 "'frames_submitted'");
    json = audit("crash", "--json");
    assert_int_equal(of(json, "segments_uncounted"), 1);
    expect_findings(json, 0);
    expect_said("crash", "1 of 1 runs of the program left no count of frames");
    copy("all");
    sql("all", "DELETE FROM frame");
    assert_int_equal(of(audit("all", "--json"), "missing"), number("a", "SELECT count(*) FROM frame"));
    copy("twice");
    sql("twice", "UPDATE frame SET number = number - 1 WHERE id = (SELECT max(id) FROM frame)");
    json = audit("twice", "--json");
    assert_int_equal(of(json, "repeated"), 1);
}

static void what_was_asked_is_what_counts(void **state)
{
    (void)state;
    copy("target"); // the trials asked for the target, and got the gaze
    sql("target", "UPDATE trial SET settings = json_set(settings, '$.foveate', 'target')");
    const char *json = audit("target", "--json");
    assert_int_equal(of(json, "wrong_source"),
                     number("target", "SELECT count(*) FROM frame WHERE condition_id IN (SELECT id "
                                      "FROM condition WHERE mode = 'time_warped')"));
    copy("differs");
    sql("differs",
        "UPDATE frame SET effective = '{\\\"mode\\\":\\\"regular\\\"}' WHERE id IN (SELECT id FROM frame WHERE "
        "trial_id = 1 AND " SEEN("") "LIMIT 8)");
    json = audit("differs", "--json");
    assert_int_equal(of(json, "differs"), 8);
    expect_findings(json, 8);
}

static int set_up(void **state)
{
    (void)state;
    command_folder("audit", folder, sizeof folder);
    return command("fovstudy run '" SOURCE_DIR "/studies/protocols/short.yaml' --db '%s/a.db' --participant p1 "
                   "--observer sim --display headless "
                   "--size 32x36 --refresh 60 --gaze sim --scene atrium=town:triangles=20000",
                   folder)
        ->status;
}

static void fades_of_sequential_trials_are_judged(void **state)
{
    (void)state;
    const struct command_result *made = command(
        "sed -e 's/^name: short/name: seq/' -e 's/kind: toggle/kind: sequential/' -e 's/^  advance: auto/  "
        "advance: "
        "auto\\n  view_s: 1\\n  gap_s: 0.5/' '" SOURCE_DIR "/studies/protocols/short.yaml' > '%s/seq.yaml' && "
        "fovstudy run '%s/seq.yaml' --db '%s/seq.db' --participant p1 --observer sim --display headless --size "
        "32x36 "
        "--refresh 60 --gaze sim --scene atrium=town:triangles=20000 && cp '%s/seq.db' '%s/wait.db' && cp "
        "'%s/seq.db' '%s/short.db' && cp '%s/seq.db' '%s/white.db'",
        folder, folder, folder, folder, folder, folder, folder, folder, folder);
    if (made->status != 0)
        fail_msg("%s", made->err);
    const char *json = audit("seq", "--json");
    expect_findings(json, 0);
    assert_int_equal(of(json, "switches"), 2);
    assert_int_equal(of(json, "fades_judged"), 2);
    // Gray for 50 ms longer between the options of the first trial: three frames of 60 Hz.
    sql("wait",
        "UPDATE frame SET start_ns = start_ns + 50000000 WHERE id > (SELECT min(id) + 10 FROM frame WHERE "
        "trial_id = 1 AND option IS NULL AND fade_level = 1)");
    expect_findings(audit("wait", "--json"), 1);
    expect_said("wait", "trial 1, switch 1: it came back from gray 58.3 ms late\n");
    // The second trial's last option fades 100 ms too early.
    sql("short",
        "UPDATE frame SET fade_level = 0.1, phase = 'fade' WHERE id IN (SELECT id FROM frame WHERE trial_id "
        "= 2 AND phase = 'stimulus' AND fade_level = 0 ORDER BY id DESC LIMIT 7)");
    expect_findings(audit("short", "--json"), 1);
    expect_said("short", "trial 2, switch 2: the second option's fade began");
    sql("white",
        "UPDATE frame SET fade_level = 0.5 WHERE trial_id = 1 AND fade_level = 1 AND start_ns < (SELECT "
        "max(full_start_ns) FROM exposure WHERE trial_id = 1)");
    expect_said("white", "trial 1, switch 1: no frame between the options was gray\n");
}

int main(void)
{
    const struct command_result *devices = command("fovstudy devices");
    if (devices->status != 0)
        return 77;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_clean_session_has_no_finding),
        cmocka_unit_test(planted_faults_are_counted_and_named),
        cmocka_unit_test(a_fade_is_seen_by_frames_and_by_exposures),
        cmocka_unit_test(fades_of_sequential_trials_are_judged),
        cmocka_unit_test(gaze_that_stands_still_or_is_one_eyes),
        cmocka_unit_test(a_crash_leaves_no_count),
        cmocka_unit_test(what_was_asked_is_what_counts),
    };
    return cmocka_run_group_tests_name("audit", tests, set_up, NULL);
}
