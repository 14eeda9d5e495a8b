// Study files that cannot be used, disks that are full and computers without a GPU: one sentence, exit 1, and
// what was acknowledged stays.
#include "tests/app/command.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static char folder[512];

#define RUN(participant, options)                                                                              \
    "fovstudy run '" SOURCE_DIR "/studies/protocols/short.yaml' --participant " participant " --display none " \
    "--observer sim:errors='%s/errors.csv' " options " --db '%s/%s'"

static void expect(const struct command_result *result, const char *about)
{
    // What was said while there was hope comes before the sentence.
    const char *said = result->err, *newline;
    while (strncmp(said, "fovstudy: please wait: ", 23) == 0 && (newline = strchr(said, '\n')))
        said = newline + 1;
    newline = strchr(said, '\n');
    if (result->status != 1 || !strstr(result->err, about) || !newline || newline[1])
        print_error("status %d\nstderr: %s\nexpected about: %s\n", result->status, result->err, about);
    assert_int_equal(result->status, 1);
    assert_int_equal(strncmp(said, "fovstudy: ", 10), 0);
    assert_non_null(strstr(said, about));
    assert_true(newline && !newline[1]);
}

static void other_files_are_refused_untouched(void **state)
{
    (void)state;
    static const struct {
        const char *make, *about;
    } cases[] = {
        {"printf 'this is a letter, no study' > '%s/f.db'", "f.db"},
        {"sqlite3 '%s/f.db' 'CREATE TABLE contact (name TEXT); PRAGMA application_id = 1234'", "f.db"},
        {"sqlite3 '%s/f.db' 'PRAGMA user_version = 99; PRAGMA application_id = 1180062548; CREATE TABLE t (x)'",
         "f.db"},
        {"mkdir '%s/f.db'", "f.db"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char before[COMMAND_TEXT];
        command("rm -rf '%s'/f.db*", folder);
        assert_int_equal(command(cases[i].make, folder)->status, 0);
        strcpy(before, command("sha256sum '%s/f.db'", folder)->out);
        expect(command(RUN("p", ""), folder, folder, "f.db"), cases[i].about);
        assert_string_equal(command("sha256sum '%s/f.db'", folder)->out, before);
    }
    expect(command(RUN("p", ""), folder, folder, "no/such/folder/f.db"), "f.db");
}

static void a_read_only_file_is_refused(void **state)
{
    (void)state;
    assert_int_equal(command(RUN("first", ""), folder, folder, "ro.db")->status, 0);
    if (geteuid() != 0) {
        command("chmod 444 '%s/ro.db'", folder);
        expect(command(RUN("p", ""), folder, folder, "ro.db"), "ro.db");
        return;
    }
    // Permissions do not bind root; an immutable file or a read-only mount does, where they are allowed.
    if (command("chattr +i '%s/ro.db'", folder)->status != 0)
        skip();
    expect(command(RUN("p", ""), folder, folder, "ro.db"), "ro.db");
    command("chattr -i '%s/ro.db'", folder);
}

// A protocol of several sittings takes a code again, unless the last one is unfinished.
static void a_protocol_may_have_several_sessions(void **state)
{
    (void)state;
    const char *run = "fovstudy run '%s/several.yaml' --participant p --display none --observer "
                      "sim:errors='%s/errors.csv' --db '%s/several.db'";
    assert_int_equal(command("sed 's/^seed: 1$/seed: 1\\nsessions: several/' '" SOURCE_DIR
                             "/studies/protocols/short.yaml' > '%s/several.yaml'",
                             folder)
                         ->status,
                     0);
    assert_int_equal(command(run, folder, folder, folder)->status, 0);
    assert_int_equal(command(run, folder, folder, folder)->status, 0);
    assert_string_equal(
        command("sqlite3 '%s/several.db' 'SELECT count(*), count(DISTINCT participant_id) FROM session'",
                folder)
            ->out,
        "2|1\n");
    command("sqlite3 '%s/several.db' \"UPDATE session SET status = 'running' WHERE id = 2\"", folder);
    expect(command(run, folder, folder, folder), "session 2 is unfinished: fovstudy resume");
}

static void a_code_has_one_session(void **state)
{
    (void)state;
    assert_int_equal(command(RUN("p", ""), folder, folder, "code.db")->status, 0);
    expect(command(RUN("p", ""), folder, folder, "code.db"),
           "participant p has a session already; give another code");
    assert_string_equal(command("sqlite3 '%s/code.db' 'SELECT count(*) FROM session'", folder)->out, "1\n");
    assert_int_equal(command(RUN("p", "--again"), folder, folder, "code.db")->status, 0);
    assert_string_equal(command("sqlite3 '%s/code.db' 'SELECT count(*), count(DISTINCT participant_id) FROM "
                                "session'",
                                folder)
                            ->out,
                        "2|1\n");
    // An unfinished one is to be gone on with.
    command("sqlite3 '%s/code.db' \"UPDATE session SET status = 'running' WHERE id = 2\"", folder);
    expect(command(RUN("p", ""), folder, folder, "code.db"), "session 2 is unfinished: fovstudy resume --db");
}

static void people_and_simulated_observers_never_share_a_file(void **state)
{
    (void)state;
    assert_int_equal(command(RUN("p", ""), folder, folder, "kinds.db")->status, 0);
    command("sqlite3 '%s/kinds.db' \"UPDATE participant SET kind = 'person'\"", folder);
    expect(command(RUN("q", ""), folder, folder, "kinds.db"),
           "simulated observers and people never share a study");
    expect(command(RUN("p", "--again"), folder, folder, "kinds.db"), "participant p is not of kind simulated");
    assert_string_equal(command("sqlite3 '%s/kinds.db' 'SELECT count(*) FROM session'", folder)->out, "1\n");
}

static void a_newer_study_is_refused(void **state)
{
    (void)state;
    assert_int_equal(command(RUN("p", ""), folder, folder, "new.db")->status, 0);
    command("sqlite3 '%s/new.db' 'PRAGMA user_version = 99'", folder);
    expect(command(RUN("q", ""), folder, folder, "new.db"), "version 99, newer than this program knows");
    expect(command("fovstudy resume --db '%s/new.db'", folder), "version 99, newer than this program knows");
    expect(command("fovstudy forget --db '%s/new.db' p", folder), "version 99, newer than this program knows");
}

// The owner is known by its lock, whatever the session's status says.
static void two_programs_never_share_a_study(void **state)
{
    (void)state;
    assert_int_equal(command(RUN("p", ""), folder, folder, "two.db")->status, 0);
    const char *held = "cd '%s'; rm -f two.db-owner; flock two.db-owner sh -c 'echo $$ > two.db-owner; exec "
                       "sleep 20' & o=$!; until [ -s "
                       "two.db-owner ]; do sleep 0.01; done; %s; s=$?; kill $(cat two.db-owner) $o; (exit $s)";
    char run[2048];
    snprintf(run, sizeof run, RUN("q", ""), folder, folder, "two.db");
    expect(command(held, folder, run), "two.db: in use by another program (process ");
    snprintf(run, sizeof run, "fovstudy resume --db '%s/two.db'", folder);
    expect(command(held, folder, run), "two.db: in use by another program (process ");
    // One that is left behind by a crash is nobody's.
    command("echo 1 > '%s/two.db-owner'; sqlite3 '%s/two.db' \"UPDATE session SET status = 'running'\"", folder,
            folder);
    assert_int_equal(command("fovstudy resume --db '%s/two.db'", folder)->status, 0);
}

static void a_person_is_forgotten(void **state)
{
    (void)state;
    assert_int_equal(command(RUN("p-secret", ""), folder, folder, "forget.db")->status, 0);
    assert_int_equal(command(RUN("q", ""), folder, folder, "forget.db")->status, 0);
    const struct command_result *result = command("fovstudy forget --db '%s/forget.db' p-secret", folder);
    assert_string_equal(result->err, "");
    assert_int_equal(result->status, 0);
    assert_non_null(strstr(result->out, "erased participant p-secret: 1 session, 3 trials, 3 answers"));
    assert_int_equal(command("grep -c p-secret '%s/forget.db'", folder)->status, 1);
    assert_string_equal(command("ls '%s' | grep -c forget.db", folder)->out, "1\n"); // no log is left beside it
    assert_string_equal(
        command("sqlite3 '%s/forget.db' 'SELECT code, number FROM participant; SELECT count(*) FROM "
                "session; PRAGMA integrity_check'",
                folder)
            ->out,
        "forgotten-1|1\nq|2\n1\nok\n");
    expect(command("fovstudy forget --db '%s/forget.db' p-secret", folder), "there is no participant p-secret");
    assert_int_equal(command("fovstudy forget p-secret")->status, 2);
    assert_int_equal(command("fovstudy forget --db '%s/forget.db'", folder)->status, 2);
    // The study goes on: the number is free, the tools read it.
    assert_int_equal(command(RUN("r", ""), folder, folder, "forget.db")->status, 0);
    assert_string_equal(
        command("sqlite3 '%s/forget.db' \"SELECT number FROM participant WHERE code = 'r'\"", folder)->out,
        "1\n");
}

static void resume_refuses_what_differs(void **state)
{
    (void)state;
    command("cp '" SOURCE_DIR "/studies/protocols/short.yaml' '%s/mine.yaml'", folder);
    assert_int_equal(
        command("fovstudy run '%s/mine.yaml' --db '%s/r.db' --participant p --display none --gaze sim "
                "--observer sim:errors='%s/errors.csv'",
                folder, folder, folder)
            ->status,
        0);
    // A complete session: a sentence and 0; none: 1; an aborted one: 1.
    const struct command_result *result = command("fovstudy resume --db '%s/r.db'", folder);
    assert_int_equal(result->status, 0);
    assert_non_null(strstr(result->out, "session 1 of participant p is complete"));
    assert_int_equal(command("fovstudy resume --db '%s/r.db' 1", folder)->status, 0);
    expect(command("fovstudy resume --db '%s/r.db' 9", folder), "no session 9");
    assert_int_equal(command("fovstudy resume --db '%s/r.db' one", folder)->status, 2);
    assert_int_equal(command("fovstudy resume")->status, 2);
    expect(command("fovstudy resume --db '%s/nowhere.db'", folder), "nowhere.db");
    command("sqlite3 '%s/r.db' \"UPDATE session SET status = 'aborted'\"", folder);
    expect(command("fovstudy resume --db '%s/r.db'", folder), "the participant ended session 1");
    command("sqlite3 '%s/r.db' \"UPDATE session SET status = 'running'; DELETE FROM rating; UPDATE trial SET "
            "status = "
            "'running' WHERE ordinal = 3\"",
            folder);
    static const struct {
        const char *option, *about;
    } cases[] = {
        {"--display headless", "--display none, not headless"},
        {"--gaze mouse", "--gaze sim, not mouse"},
        {"--scene atrium=town", "--scene atrium=atrium, not atrium=town"},
        {"--refresh 60", "--refresh 90, not 60"},
        {"--participant q", "--participant p, not q"},
        {"--seed 9", "--seed 1, not 9"},
        {"--number 4", "--number 1, not 4"},
        {"--observer sim:lapse=0.5", "not sim:lapse=0.5"},
        {"--attribute age=3", "asks for no attribute 'age'"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        expect(command("fovstudy resume --db '%s/r.db' %s", folder, cases[i].option), cases[i].about);
    // A changed protocol, here and named; the lines that differ are shown.
    command("sed -i 's/rest_s: 0.5/rest_s: 0.7/' '%s/mine.yaml'", folder);
    result = command("fovstudy resume --db '%s/r.db'", folder);
    assert_int_equal(result->status, 1);
    // the sentence first, then what it is about
    assert_int_equal(strncmp(result->err, "fovstudy: ", 10), 0);
    const char *sentence_end = strstr(result->err, "the text in the study file\n--- session 1 line ");
    assert_non_null(sentence_end);
    assert_non_null(strstr(sentence_end, "\n-  rest_s: 0.5\n+  rest_s: 0.7\n"));
    result = command("fovstudy resume --db '%s/r.db' --protocol '%s/mine.yaml'", folder, folder);
    assert_non_null(strstr(result->err, "was changed since session 1 began"));
    // A trial that would now be another one.
    command("sqlite3 '%s/r.db' \"UPDATE trial SET first_shown = CASE first_shown WHEN 'a' THEN 'b' ELSE 'a' "
            "END WHERE "
            "ordinal = 2\"",
            folder);
    expect(command("fovstudy resume --db '%s/r.db' --protocol -", folder),
           "the option that is shown first of trial 2");
    command("sqlite3 '%s/r.db' \"UPDATE trial SET first_shown = CASE first_shown WHEN 'a' THEN 'b' ELSE 'a' "
            "END WHERE "
            "ordinal = 2\"",
            folder);
    assert_string_equal(command("sqlite3 '%s/r.db' 'SELECT count(*) FROM segment'", folder)->out, "1\n");
    assert_int_equal(
        command("fovstudy resume --db '%s/r.db' --protocol - --display none --gaze sim --refresh 90 --seed 1",
                folder)
            ->status,
        0);
    assert_string_equal(
        command("sqlite3 '%s/r.db' 'SELECT group_concat(status || attempt) FROM trial'", folder)->out,
        "done1,done1,done2\n");
}

// A file-size limit acts as a full disk. Whatever the limit, each answer that an event line acknowledged is in
// the file.
static void a_full_disk_loses_no_acknowledged_answer(void **state)
{
    (void)state;
    int failed = 0;
    for (int blocks = 64; blocks <= 1024; blocks += 64) {
        command("rm -f '%s'/full.*", folder);
        const struct command_result *result = command(
            "trap '' XFSZ; ulimit -f %d; " RUN("p", "--patience 0.3 --gaze sim --events '%s/full.jsonl'"),
            blocks, folder, folder, folder, "full.db");
        if (result->status == 0)
            continue;
        failed++;
        expect(result, "");
        result = command(
            "test -f '%s/full.jsonl' || exit 0; sqlite3 '%s/full.db' 'PRAGMA integrity_check' && for k in "
            "choice rating; do n=$(grep -c \"\\\"table\\\":\\\"$k\\\"\" '%s/full.jsonl'); "
            "test $n = 0 || test \"$(sqlite3 '%s/full.db' \"SELECT count(*) >= $n FROM $k\")\" = 1 || echo "
            "lost $k; done",
            folder, folder, folder, folder);
        if (strcmp(result->out, "ok\n") != 0 && result->out[0])
            print_error("%d blocks: %s %s\n", blocks, result->out, result->err);
        assert_true(strcmp(result->out, "ok\n") == 0 || !result->out[0]);
    }
    assert_true(failed >= 3); // the limits did bite
}

static void events_on_a_full_disk_are_named(void **state)
{
    (void)state;
    expect(command(RUN("p", "--patience 0.3 --events /dev/full"), folder, folder, "events.db"), "events");
    assert_string_equal(command("sqlite3 '%s/events.db' 'PRAGMA integrity_check'", folder)->out, "ok\n");
    expect(command(RUN("q", "--events /no/such/folder/e"), folder, folder, "events2.db"), "/no/such/folder/e");
    char path[600];
    snprintf(path, sizeof path, "%s/events2.db", folder);
    assert_int_not_equal(access(path, F_OK), 0);
}

static void no_vulkan_driver_is_named(void **state)
{
    (void)state;
    char path[600];
    const char *blind =
        "VK_DRIVER_FILES=/nonexistent VK_ICD_FILENAMES=/nonexistent; export VK_DRIVER_FILES VK_ICD_FILENAMES; ";
    expect(command("%s fovstudy run '%s/studies/protocols/short.yaml' --participant p --display headless "
                   "--observer sim "
                   "--db '%s/blind.db'",
                   blind, SOURCE_DIR, folder),
           "Vulkan");
    snprintf(path, sizeof path, "%s/blind.db", folder);
    assert_int_not_equal(access(path, F_OK), 0);
    assert_int_equal(command("%s fovstudy devices", blind)->status, 1);
    assert_int_equal(command("%s fovstudy check '%s/studies/protocols/short.yaml'", blind, SOURCE_DIR)->status,
                     0);
}

static void no_window_system_is_named(void **state)
{
    (void)state;
    expect(command("unset DISPLAY WAYLAND_DISPLAY; fovstudy run '%s/studies/protocols/short.yaml' "
                   "--participant p --db "
                   "'%s/w.db'",
                   SOURCE_DIR, folder),
           "window");
    expect(command("unset DISPLAY WAYLAND_DISPLAY; fovstudy run '%s/studies/protocols/short.yaml' "
                   "--participant p --db "
                   "'%s/w.db' --display monitor:7",
                   SOURCE_DIR, folder),
           "");
}

static int set_up(void **state)
{
    (void)state;
    command_folder("bad_store", folder, sizeof folder);
    return command("printf 'atrium,0.03,time_warped:epsilon=0.2\\natrium,0.02,time_warped:epsilon=0.05\\n' > "
                   "'%s/errors.csv'",
                   folder)
        ->status;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(other_files_are_refused_untouched),
        cmocka_unit_test(a_read_only_file_is_refused),
        cmocka_unit_test(a_code_has_one_session),
        cmocka_unit_test(a_protocol_may_have_several_sessions),
        cmocka_unit_test(people_and_simulated_observers_never_share_a_file),
        cmocka_unit_test(a_newer_study_is_refused),
        cmocka_unit_test(two_programs_never_share_a_study),
        cmocka_unit_test(a_person_is_forgotten),
        cmocka_unit_test(resume_refuses_what_differs),
        cmocka_unit_test(a_full_disk_loses_no_acknowledged_answer),
        cmocka_unit_test(events_on_a_full_disk_are_named),
        cmocka_unit_test(no_vulkan_driver_is_named),
        cmocka_unit_test(no_window_system_is_named),
    };
    return cmocka_run_group_tests(tests, set_up, NULL);
}
