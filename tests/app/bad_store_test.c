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
    const char *newline = strchr(result->err, '\n');
    if (result->status != 1 || !strstr(result->err, about) || !newline || newline[1])
        print_error("status %d\nstderr: %s\nexpected about: %s\n", result->status, result->err, about);
    assert_int_equal(result->status, 1);
    assert_int_equal(strncmp(result->err, "fovstudy: ", 10), 0);
    assert_non_null(strstr(result->err, about));
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

// A file-size limit acts as a full disk. Whatever the limit, each answer that an event line acknowledged is in
// the file.
static void a_full_disk_loses_no_acknowledged_answer(void **state)
{
    (void)state;
    int failed = 0;
    for (int blocks = 64; blocks <= 1024; blocks += 64) {
        command("rm -f '%s'/full.*", folder);
        const struct command_result *result =
            command("trap '' XFSZ; ulimit -f %d; " RUN("p", "--gaze sim --events '%s/full.jsonl'"), blocks,
                    folder, folder, folder, "full.db");
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
    expect(command(RUN("p", "--events /dev/full"), folder, folder, "events.db"), "events");
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
        cmocka_unit_test(a_full_disk_loses_no_acknowledged_answer),
        cmocka_unit_test(events_on_a_full_disk_are_named),
        cmocka_unit_test(no_vulkan_driver_is_named),
        cmocka_unit_test(no_window_system_is_named),
    };
    return cmocka_run_group_tests(tests, set_up, NULL);
}
