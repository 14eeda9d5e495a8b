// A short protocol from consent to stored answers with a simulated participant, drawn by whatever Vulkan device
// there is, at a tiny size; checked in the study file. Exit 77 where no device can draw.
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

#define RUN_HEADLESS                                                                                           \
    "fovstudy run '" SOURCE_DIR                                                                                \
    "/studies/protocols/short.yaml' --db '%s/%s.db' --participant p1 --observer sim "                          \
    "--display headless --size 48x54 --refresh 20 --scene atrium=town:triangles=20000 --events '%s/%s.jsonl' " \
    "--unblind"

// What a query gives, without the last newline.
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

#define expect(query, answer) assert_string_equal(ask("a", query), answer)

static void the_file_is_whole(void **state)
{
    (void)state;
    expect("PRAGMA integrity_check", "ok");
    expect("SELECT count(*) FROM pragma_foreign_key_check", "0");
    expect("SELECT status, consent_version, width_px, height_px, refresh_hz, display FROM session",
           "complete|1|48|54|20.0|headless");
    expect("SELECT count(*) FROM event WHERE kind LIKE 'log_%'", "0"); // no row was dropped or refused
    expect("SELECT count(*) FROM event WHERE kind = 'unblind'", "1");
    expect("SELECT kind, number FROM participant", "simulated|1");
}

static void every_trial_is_answered_in_order(void **state)
{
    (void)state;
    expect("SELECT group_concat(status || attempt) FROM trial", "done1,done1,done1");
    expect("SELECT count(*) FROM choice", "2");
    expect("SELECT count(*) FROM rating WHERE value BETWEEN 1 AND 10 AND subject = 'scene'", "1");
    expect("SELECT count(*) FROM trial a JOIN trial b ON b.ordinal = a.ordinal + 1 WHERE b.started_ns <= "
           "a.ended_ns",
           "0");
    expect("SELECT count(*) FROM choice JOIN trial ON trial.id = trial_id WHERE answered_ns <> ended_ns", "0");
}

// A decision comes only after both options were seen without fade; the reaction counts from the first full
// frame.
static void choices_follow_both_options(void **state)
{
    (void)state;
    expect("SELECT count(*) FROM choice WHERE (SELECT count(DISTINCT option) FROM exposure WHERE "
           "exposure.trial_id = "
           "choice.trial_id AND full_start_ns < answered_ns) <> 2",
           "0");
    expect("SELECT count(*) FROM choice WHERE reaction_ns <> answered_ns - (SELECT min(full_start_ns) FROM "
           "exposure "
           "WHERE exposure.trial_id = choice.trial_id)",
           "0");
    expect("SELECT count(*) FROM choice WHERE toggles + 1 <> (SELECT count(*) FROM exposure WHERE "
           "exposure.trial_id = "
           "choice.trial_id)",
           "0");
    expect("SELECT count(*) FROM choice JOIN trial ON trial.id = trial_id WHERE first_shown <> (SELECT option "
           "FROM "
           "exposure WHERE exposure.trial_id = trial.id ORDER BY start_ns LIMIT 1)",
           "0");
}

// Half a second of fade from the last full frame to the first of the other option, to the next frame of 50 ms.
static void switches_take_half_a_second(void **state)
{
    (void)state;
    expect("SELECT count(*) > 2 AND min(gap) >= 500000000 AND max(gap) <= 550000001 FROM (SELECT "
           "lead(full_start_ns) "
           "OVER (PARTITION BY trial_id ORDER BY start_ns) - full_end_ns AS gap FROM exposure) WHERE gap IS "
           "NOT NULL",
           "1");
    // Frames inside an exposure's full stretch have no fade, others of the stretch have some.
    expect(
        "SELECT count(*) FROM frame f JOIN exposure e ON f.trial_id = e.trial_id AND f.option = e.option AND "
        "f.start_ns BETWEEN e.full_start_ns AND e.full_end_ns WHERE f.fade_level <> 0 OR f.phase <> 'stimulus'",
        "0");
    expect(
        "SELECT count(*) FROM frame f JOIN exposure e ON f.trial_id = e.trial_id AND f.option = e.option AND "
        "f.start_ns BETWEEN e.start_ns AND e.end_ns AND NOT (f.start_ns BETWEEN e.full_start_ns AND "
        "e.full_end_ns) "
        "WHERE f.fade_level <= 0 OR f.fade_level >= 1 OR f.phase <> 'fade'",
        "0");
}

// An option that comes back draws everything once, in the first frame in which it can be seen at all.
static void full_redraws_hide_in_fades(void **state)
{
    (void)state;
    expect(
        "SELECT count(*) FROM event e WHERE kind = 'full_redraw' AND NOT EXISTS (SELECT 1 FROM frame f WHERE "
        "f.start_ns = e.at_ns AND f.phase = 'fade' AND f.fade_level > 0)",
        "0");
    expect("SELECT count(*) FROM exposure x JOIN trial t ON t.id = x.trial_id JOIN condition c ON c.id = CASE "
           "x.option "
           "WHEN 'a' THEN option_a ELSE option_b END WHERE c.mode = 'time_warped' AND (SELECT count(*) FROM "
           "event e "
           "WHERE e.kind = 'full_redraw' AND e.at_ns BETWEEN x.start_ns AND x.end_ns) <> 1",
           "0");
    expect("SELECT count(*) FROM event WHERE kind = 'full_redraw' AND json_extract(detail, '$.cause') NOT IN "
           "('first', 'cut', 'gap')",
           "0");
}

static void every_frame_has_its_row(void **state)
{
    (void)state;
    expect("SELECT min(number), max(number) - count(*) FROM frame", "0|-1");
    expect("SELECT count(*) FROM frame WHERE start_ns <> number * 50000000",
           "0"); // 20 Hz, time counted in frames
    expect("SELECT count(*) FROM frame WHERE (condition_id IS NULL) <> (option IS NULL OR fade_level >= 1)",
           "0");
    expect("SELECT count(*) FROM frame JOIN trial ON trial.id = trial_id WHERE condition_id <> CASE option "
           "WHEN 'a' THEN "
           "option_a ELSE option_b END",
           "0");
    expect("SELECT count(*) FROM frame WHERE (condition_id IS NULL) <> (shaded_px IS NULL)", "0");
    expect("SELECT count(*) FROM frame JOIN condition c ON c.id = condition_id WHERE mode = 'regular' AND "
           "shaded_px <> "
           "2 * 48 * 54",
           "0");
    expect("SELECT count(*) > 50 FROM frame WHERE phase = 'stimulus'", "1");
    expect(
        "SELECT count(*) FROM frame WHERE condition_id IS NOT NULL AND (head_pose IS NULL OR fovea IS NULL OR "
        "gaze_id IS NULL OR fovea_source <> 'gaze' OR present_ns <> start_ns + 50000000 OR late)",
        "0");
}

static void the_fovea_follows_the_gaze(void **state)
{
    (void)state;
    // 120 Hz, two eyes, from 0 to the last frame.
    expect("SELECT abs(count(*) - (SELECT max(start_ns) FROM frame) * 240 / 1000000000) <= 2 FROM gaze", "1");
    expect("SELECT count(*) FROM gaze WHERE valid <> (x_deg IS NOT NULL)", "0");
    expect("SELECT count(*) FROM frame JOIN gaze ON gaze.id = gaze_id WHERE NOT gaze.valid OR host_ns > "
           "start_ns OR "
           "abs(gaze_age_us - (start_ns - host_ns) / 1000.0) > 0.01",
           "0");
    expect("SELECT count(*) FROM frame JOIN gaze ON gaze.id = gaze_id WHERE abs(json_extract(fovea, '$.' || "
           "eye || "
           "'[0]') - x_deg) > 1e-6",
           "0");
}

static void errors_were_measured_against_the_reference(void **state)
{
    (void)state;
    expect("SELECT count(*) FROM measured_error e JOIN condition r ON r.id = reference_id WHERE r.mode = "
           "'regular' AND "
           "scene = 'town:triangles=20000' AND metric = 'wrmse'",
           "3");
    expect("SELECT count(*) FROM measured_error e JOIN condition c ON c.id = condition_id WHERE c.mode = "
           "'regular' AND "
           "value <> 0",
           "0");
    expect("SELECT count(*) FROM measured_error e JOIN condition c ON c.id = condition_id WHERE c.mode = "
           "'time_warped' "
           "AND value > 0 AND value < 0.5",
           "2");
}

static void event_lines_name_stored_rows(void **state)
{
    (void)state;
    const struct command_result *result = command(
        "python3 -c \"import json,sys\nl=[json.loads(x) for x in open(sys.argv[1])]\n"
        "assert [x['seq'] for x in l]==list(range(1,len(l)+1))\n"
        "assert all(a['t_ns']<=b['t_ns'] for a,b in zip(l,l[1:]))\n"
        "print([(x['table'],x['row']) for x in l if x['event']=='answer'], l[-1]['status'])\" '%s/a.jsonl'",
        folder);
    assert_string_equal(result->out, "[('choice', 1), ('choice', 2), ('rating', 1)] complete\n");
}

// What --events names by mistake is left as it was.
static void events_go_into_no_other_file(void **state)
{
    (void)state;
    static const char *const cases[][3] = {{"a", "a.db", "is the study file"},
                                           {"new", "new.db", "is the study file"},
                                           {"a", "p.yaml", "holds something else"}};
    assert_int_equal(command("cp '" SOURCE_DIR "/studies/protocols/short.yaml' '%s/p.yaml'", folder)->status,
                     0);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const struct command_result *result =
            command("fovstudy run '%s/p.yaml' --db '%s/%s.db' --participant e1 --observer sim:errors='%s/a.db' "
                    "--display none --events '%s/%s'",
                    folder, folder, cases[i][0], folder, folder, cases[i][1]);
        if (result->status != 1 || !strstr(result->err, cases[i][2]))
            fail_msg("exit %d: %s", result->status, result->err);
    }
    assert_int_equal(command("test ! -e '%s/new.db' && cmp '" SOURCE_DIR
                             "/studies/protocols/short.yaml' '%s/p.yaml'",
                             folder, folder)
                         ->status,
                     0);
    expect("PRAGMA integrity_check", "ok");
    expect("SELECT count(*) FROM participant", "1");
}

// Everything but wall time, as text.
enum { DUMP = 8192 };
static void dump(const char *name, char *out)
{
    static const char *const queries[] = {
        "SELECT id, name, sha256 FROM protocol",
        "SELECT * FROM participant",
        "SELECT id, seed, status, consent_version, device, display, refresh_hz, width_px, fov_deg, settings "
        "FROM session",
        "SELECT id, mono_origin_ns, clock, boot_id, app_version, reason FROM segment",
        "SELECT * FROM condition",
        "SELECT * FROM trial",
        "SELECT * FROM choice",
        "SELECT * FROM rating",
        "SELECT * FROM exposure",
        "SELECT * FROM gaze",
        "SELECT * FROM measured_error",
        "SELECT id, trial_id, at_ns, kind, detail FROM event",
        "SELECT id, trial_id, attempt, number, option, condition_id, phase, fade_level, start_ns, present_ns, "
        "late, "
        "gaze_id, gaze_age_us, fovea, fovea_source, effective, head_pose, shaded_px, triangles FROM frame",
    };
    out[0] = '\0';
    for (size_t i = 0; i < sizeof queries / sizeof queries[0]; i++) {
        const struct command_result *result =
            command("sqlite3 '%s/%s.db' '%s' | sha256sum", folder, name, queries[i]);
        assert_int_equal(result->status, 0);
        snprintf(out + strlen(out), DUMP - strlen(out), "%.64s %s\n", result->out, queries[i]);
    }
}

static void the_same_seed_gives_the_same_rows(void **state)
{
    (void)state;
    char first[DUMP], second[DUMP];
    assert_int_equal(command(RUN_HEADLESS, folder, "b", folder, "b")->status, 0);
    dump("a", first);
    dump("b", second);
    assert_string_equal(first, second);
    assert_int_equal(command("cmp '%s/a.jsonl' '%s/b.jsonl'", folder, folder)->status, 0);
}

// A second participant answers without frames from what the first one measured.
static void others_answer_from_the_measured_errors(void **state)
{
    (void)state;
    const struct command_result *result =
        command("fovstudy run '%s/studies/protocols/short.yaml' --db '%s/a.db' --participant p2 --observer sim "
                "--display none",
                SOURCE_DIR, folder);
    assert_int_equal(result->status, 1); // another scene stands for the name
    assert_non_null(strstr(result->err, "its sessions showed other scenes (atrium: town:triangles=20000)"));
    result =
        command("fovstudy run '%s/studies/protocols/short.yaml' --db '%s/a.db' --participant p2 --observer sim "
                "--display none --new-protocol",
                SOURCE_DIR, folder);
    assert_int_equal(result->status, 1); // and its errors were never measured
    assert_non_null(strstr(result->err, "holds no measured error"));
    result =
        command("fovstudy run '%s/studies/protocols/short.yaml' --db '%s/a.db' --participant p2 --observer sim "
                "--display none --scene atrium=town:triangles=20000 --events '%s/a.jsonl'",
                SOURCE_DIR, folder, folder);
    assert_string_equal(result->err, "");
    assert_int_equal(result->status, 0);
    // The lines are appended and their numbers go on.
    result = command(
        "sed 's/^{\"seq\":\\([0-9]*\\),.*/\\1/' '%s/a.jsonl' > '%s/seen' && seq 1 $(wc -l < '%s/seen') | "
        "cmp - '%s/seen'",
        folder, folder, folder, folder);
    assert_int_equal(result->status, 0);
    // `check` looks the number up in the study file.
    assert_int_equal(
        command("fovstudy check '%s/studies/protocols/short.yaml' --db '%s/a.db' --participant p2 > "
                "'%s/known' && fovstudy check '%s/studies/protocols/short.yaml' --number 2 | cmp - '%s/known'",
                SOURCE_DIR, folder, folder, SOURCE_DIR, folder)
            ->status,
        0);
    expect("SELECT count(*), max(number) FROM participant", "2|2");
    expect("SELECT count(*) FROM choice", "4");
    expect("SELECT count(DISTINCT session_id) FROM frame", "1");
    result =
        command("fovstudy run '%s/studies/protocols/short.yaml' --db '%s/a.db' --participant p3 --observer sim "
                "--display none --scene atrium=town:triangles=20000 --seed 99",
                SOURCE_DIR, folder);
    assert_int_equal(result->status, 1);
    assert_non_null(strstr(result->err, "seed"));
    expect("SELECT count(*) FROM participant", "2");
}

static int set_up(void **state)
{
    (void)state;
    command_folder("session", folder, sizeof folder);
    const struct command_result *result = command(RUN_HEADLESS, folder, "a", folder, "a");
    if (result->status != 0)
        print_error("%s\n", result->err);
    return result->status != 0;
}

int main(void)
{
    if (command("fovstudy devices")->status != 0)
        return 77;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_file_is_whole),
        cmocka_unit_test(every_trial_is_answered_in_order),
        cmocka_unit_test(choices_follow_both_options),
        cmocka_unit_test(switches_take_half_a_second),
        cmocka_unit_test(full_redraws_hide_in_fades),
        cmocka_unit_test(every_frame_has_its_row),
        cmocka_unit_test(the_fovea_follows_the_gaze),
        cmocka_unit_test(errors_were_measured_against_the_reference),
        cmocka_unit_test(event_lines_name_stored_rows),
        cmocka_unit_test(events_go_into_no_other_file),
        cmocka_unit_test(the_same_seed_gives_the_same_rows),
        cmocka_unit_test(others_answer_from_the_measured_errors),
    };
    return cmocka_run_group_tests(tests, set_up, NULL);
}
