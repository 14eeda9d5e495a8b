// fovstats export: the dataset keeps the published rules, holds every bit, and is the same twice.
#include "program.h"
#include "study_file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static const char fovstats[] = BUILD_DIR "/bin/fovstats";

#define RUN(...) program_run((const char *const[]){__VA_ARGS__, NULL}, NULL)
#define EXPORT(...) RUN(fovstats, "export", __VA_ARGS__)

static void expect_done(struct program_result r)
{
    if (r.code != 0)
        fail_msg("exit %d: %s%s", r.code, r.out, r.err);
    program_free(&r);
}

static void expect_fails(struct program_result r, int code, const char *part, const char *folder)
{
    if (r.code != code || !strstr(r.err, part))
        fail_msg("exit %d: %s", r.code, r.err);
    program_free(&r);
    char half[64];
    snprintf(half, sizeof half, "%s.part", folder);
    assert_int_not_equal(access(folder, F_OK), 0);
    assert_int_not_equal(access(half, F_OK), 0);
}

static void keeps_the_rules(void **state)
{
    (void)state;
    static const char *const gaze =
        "INSERT INTO gaze (session_id, segment_id, device_ns, host_ns, eye, x_deg, y_deg, pupil_mm, valid, "
        "confidence) "
        "VALUES (2, 2, 9007199254740993, 5, 'left', 0.1, 1.0 / 3, 1e-300, 1, 0.7), (2, 2, 7, 6, 'right', "
        "-123456.78901234567, 5e-324, 3.14159265358979, 1, 1)";
    const struct study_desc descs[] = {
        {.excluded = true, .equal = true}, {.simulated = true}, {.hostile = true}, {.bare = true}};
    for (size_t i = 0; i < sizeof descs / sizeof descs[0]; i++) {
        study_file_make("s.db", &descs[i]);
        study_file_sql("s.db", gaze);
        study_file_sql("s.db", "UPDATE participant SET code = 'P,\"\r\n\xc3\xa4' WHERE id = 2");
        expect_done(descs[i].simulated ? EXPORT("s.db", "-o", "d", "--simulated") : EXPORT("s.db", "-o", "d"));
        expect_done(RUN("/usr/bin/env", "python3", SOURCE_DIR "/tests/analysis/psych_ds_rules.py", "d/psych-ds",
                        "s.db"));
        expect_done(
            RUN("/usr/bin/env", "python3", SOURCE_DIR "/tests/analysis/bids_rules.py", "d/bids", "s.db"));
        expect_done(descs[i].simulated ? EXPORT("s.db", "-o", "e", "--simulated") : EXPORT("s.db", "-o", "e"));
        expect_done(RUN("/usr/bin/diff", "-r", "d", "e"));
        expect_done(RUN("/bin/rm", "-r", "d", "e"));
    }
}

static void bad_input_has_a_sentence(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){.simulated = true});
    expect_fails(EXPORT("s.db", "-o", "d"), 1, "only simulated sessions are in it; add --simulated", "d");
    study_file_make("e.db", &(struct study_desc){.empty = true});
    expect_fails(EXPORT("e.db", "-o", "d"), 1, "the study is empty", "d");
    study_file_make("a.db", &(struct study_desc){.several = true});
    expect_fails(EXPORT("a.db", "-o", "d", "--simulated"), 1, "no simulated session", "d");
    expect_fails(EXPORT("a.db", "s.db", "-o", "d"), 1, "people", "d");
    expect_fails(EXPORT("-o", "d"), 2, "needs at least one study file", "d");
    expect_fails(EXPORT("a.db", "-o", "d", "--format", "xml"), 2, "must be both, psych-ds or bids", "d");
    expect_fails(EXPORT("a.db"), 2, "needs -o DIR", "d");
    expect_fails(EXPORT("a.db", "-o", "nofolder/d"), 1, "cannot be made", "nofolder/d");
    study_file_sql("a.db", "PRAGMA user_version = 0");
    expect_fails(EXPORT("a.db", "-o", "d"), 1, "its version is 0", "d");
    study_file_sql("a.db", "PRAGMA user_version = 2");
    assert_int_equal(truncate("a.db", 61440), 0);
    expect_fails(EXPORT("a.db", "-o", "d"), 1, "damaged", "d");
    study_file_make("a.db", &(struct study_desc){.pooled = false});
    expect_done(EXPORT("a.db", "-o", "d"));
    struct program_result r = EXPORT("a.db", "-o", "d");
    assert_int_equal(r.code, 1);
    assert_non_null(strstr(r.err, "d: exists already"));
    program_free(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(keeps_the_rules),
        cmocka_unit_test(bad_input_has_a_sentence),
    };
    return cmocka_run_group_tests_name("export", tests, program_enter_folder, program_leave_folder);
}
