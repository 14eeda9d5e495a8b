// fovstats merge and the other subcommands on copies of a sitting: under a laboratory's name, with other
// attributes, with trials and sessions that ended otherwise. What holds does not depend on the order of files.
#include "program.h"
#include "study_file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <sqlite3.h>

#include <cmocka.h>

static const char fovstats[] = BUILD_DIR "/bin/fovstats";

enum { HEX = 64 };

#define RUN(...) program_run((const char *const[]){__VA_ARGS__, NULL}, NULL)

static const char *const orders[][2] = {{"a.db", "c.db"}, {"c.db", "a.db"}};

// a.db, and c.db as its copy after `change`.
static void make_copies(const char *change)
{
    study_file_make("a.db", &(struct study_desc){.pooled = false});
    study_file_make("c.db", &(struct study_desc){.pooled = false});
    study_file_sql("c.db", change);
}

static struct program_result merge(int order)
{
    unlink("m.db");
    return RUN(fovstats, "merge", orders[order][0], orders[order][1], "-o", "m.db");
}

static void expect_refused(const char *change, const char *part)
{
    make_copies(change);
    for (int i = 0; i < 2; i++) {
        struct program_result r = merge(i);
        if (r.code != 1 || !strstr(r.err, part))
            fail_msg("after %s, order %d: exit %d: %s%s", change, i, r.code, r.out, r.err);
        assert_int_not_equal(access("m.db", F_OK), 0);
        program_free(&r);
    }
}

// In both orders the merged file answers so, and the sentence is said.
static void expect_merged(const char *change, const char *sql, const char *answer, const char *const said[2])
{
    make_copies(change);
    for (int i = 0; i < 2; i++) {
        struct program_result r = merge(i);
        if (r.code != 0 || !strstr(r.err, said[i]))
            fail_msg("after %s, order %d: exit %d, no \"%s\" in %s%s", change, i, r.code, said[i], r.out,
                     r.err);
        program_free(&r);
        assert_string_equal(study_file_ask("m.db", sql), answer);
        assert_string_equal(study_file_ask("m.db", "SELECT count(*) FROM session"), "22");
    }
}

static void hash_of(const char *path, char out[HEX + 1])
{
    static const char mark[] = "\"data_sha256\":\"";
    struct program_result r = RUN(fovstats, "choices", "--json", path);
    const char *at = strstr(r.out, mark);
    if (r.code != 0 || !at)
        fail_msg("%s%s", r.out, r.err);
    snprintf(out, HEX + 1, "%.*s", HEX, at + strlen(mark));
    program_free(&r);
}

// The same sittings under a laboratory's name are the same data, and are not counted beside themselves.
static void a_laboratorys_copy_is_the_same_sitting(void **state)
{
    (void)state;
    char plain[HEX + 1], named[HEX + 1];
    study_file_make("a.db", &(struct study_desc){.pooled = false});
    struct program_result r = RUN(fovstats, "merge", "--lab", "Ulm=a.db", "-o", "ulm.db");
    assert_int_equal(r.code, 0);
    program_free(&r);
    const char *const pairs[][2] = {{"ulm.db", "a.db"}, {"a.db", "ulm.db"}};
    const char *const said[] = {
        "a.db: the session of participant P01 is also in ulm.db, as participant Ulm-P01;",
        "ulm.db: the session of participant Ulm-P01 is also in a.db, as participant P01;"};
    for (int i = 0; i < 2; i++) {
        r = RUN(fovstats, "choices", pairs[i][0], pairs[i][1]);
        if (r.code != 1 || !strstr(r.err, said[i]))
            fail_msg("exit %d: %s%s", r.code, r.out, r.err);
        program_free(&r);
    }
    hash_of("a.db", plain);
    hash_of("ulm.db", named);
    assert_string_equal(named, plain);
}

static void attributes_are_compared(void **state)
{
    (void)state;
    expect_refused("UPDATE participant SET attributes = json_set(attributes, '$.age', 31) WHERE id = 2",
                   "participant P02 has age ");
    expect_refused("UPDATE participant SET attributes = '{\"age\":22,\"eyes\":\"brown\"}' WHERE id = 2",
                   "participant P02 has an attribute here that another file lacks, and the other way round");
    const char *const fuller[] = {"c.db: participant P02 has more attributes here than in another file",
                                  "a.db: participant P02 has fewer attributes here than in another file"};
    expect_merged("UPDATE participant SET attributes = json_set(attributes, '$.eyes', 'brown') WHERE id = 2",
                  "SELECT attributes FROM participant WHERE code = 'P02'",
                  "{\"age\":22,\"vr\":\"often\",\"eyes\":\"brown\"}", fuller);
}

// Trial 51 is the second of person 5's order.
static void how_trials_ended_is_compared(void **state)
{
    (void)state;
    const char *const flagged[] = {
        "c.db: session 5 of participant P05 is in several files; counted once, as this file has it, which goes "
        "on "
        "further; trial 2 of its order is invalid there and done in the other",
        "a.db: session 5 of participant P05 is in several files; counted once, as the other file has it, which "
        "goes on further; trial 2 of its order is invalid there and done in the other"};
    expect_merged(
        "UPDATE trial SET status = 'invalid' WHERE id = 51",
        "SELECT group_concat(status) FROM (SELECT t.status FROM trial AS t JOIN session AS s ON s.id = "
        "t.session_id JOIN participant AS p ON p.id = s.participant_id WHERE p.code = 'P05' ORDER BY "
        "t.ordinal)",
        "done,invalid,done,done", flagged);
    expect_refused("UPDATE trial SET status = 'skipped' WHERE id = 51", "went on differently (table trial)");
    expect_refused("UPDATE trial SET ended_ns = 2 WHERE id = 51", "went on differently (table trial)");
    expect_refused("UPDATE trial SET attempt = 2, status = 'running' WHERE id = 51",
                   "went on differently (table trial)");
    expect_refused("UPDATE trial SET option_a = 3 WHERE id = 51", "went on differently (table trial)");
    // Flagged in one copy, while the other went on.
    expect_refused("UPDATE trial SET status = 'invalid' WHERE id = 51; DELETE FROM choice WHERE trial_id = 52; "
                   "UPDATE trial SET status = 'planned', attempt = 0 WHERE id = 52",
                   "went on differently");
}

static void how_sessions_ended_is_compared(void **state)
{
    (void)state;
    expect_refused("UPDATE session SET status = 'aborted' WHERE id = 5", "went on differently (table session)");
    expect_refused("UPDATE session SET refresh_hz = 60 WHERE id = 5", "went on differently (table session)");
    expect_refused("UPDATE session SET ended_at = '2027' WHERE id = 5", "went on differently (table session)");
    const char *const consent[] = {
        "c.db: session 5 of participant P05 is in several files; counted once, as this file has it",
        "a.db: session 5 of participant P05 is in several files; counted once, as the other file has it"};
    expect_merged("UPDATE session SET consent_at = '2026-02-05T09:59:00Z', consent_version = '1' WHERE id = 5",
                  "SELECT group_concat(consent_version) FROM session", "1", consent);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_laboratorys_copy_is_the_same_sitting),
        cmocka_unit_test(attributes_are_compared),
        cmocka_unit_test(how_trials_ended_is_compared),
        cmocka_unit_test(how_sessions_ended_is_compared),
    };
    return cmocka_run_group_tests_name("merge_copies", tests, program_enter_folder, program_leave_folder);
}
