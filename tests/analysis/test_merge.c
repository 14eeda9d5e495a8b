// fovstats merge: what is joined, what is counted once, what is refused, and that nothing else is changed.
#include "program.h"
#include "said.h"
#include "study_file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <sqlite3.h>

#include <cmocka.h>

static const char fovstats[] = BUILD_DIR "/bin/fovstats";

#define RUN(...) program_run((const char *const[]){__VA_ARGS__, NULL}, NULL)
#define MERGE(...) RUN(fovstats, "merge", __VA_ARGS__)

static void copy(const char *from, const char *to)
{
    struct program_result r = RUN("/bin/cp", from, to);
    assert_int_equal(r.code, 0);
    program_free(&r);
}

static void expect_same(const char *a, const char *b)
{
    struct program_result r = RUN("/usr/bin/cmp", a, b);
    if (r.code != 0)
        fail_msg("%s", r.out);
    program_free(&r);
}

static void expect_fails(struct program_result r, int code, const char *part, const char *output)
{
    if (r.code != code || !strstr(r.err, part))
        fail_msg("exit %d: %s", r.code, r.err);
    assert_string_equal(r.out, "");
    assert_int_not_equal(access(output, F_OK), 0);
    char half[64];
    snprintf(half, sizeof half, "%s.part", output);
    assert_int_not_equal(access(half, F_OK), 0);
    program_free(&r);
}

static char *choices(const char *a, const char *b)
{
    struct program_result r = RUN(fovstats, "choices", "--json", a, b);
    if (r.code != 0)
        fail_msg("%s", r.err);
    free(r.err);
    return r.out;
}

// The second laboratory: the same protocol and codes, other people on other days.
static void make_labs(void)
{
    study_file_make("a.db", &(struct study_desc){.excluded = true});
    study_file_make("b.db", &(struct study_desc){.several = true});
    study_file_sql("b.db", "UPDATE session SET started_at = replace(started_at, '2026-02', '2026-03')");
}

static void laboratories_are_joined(void **state)
{
    (void)state;
    make_labs();
    copy("a.db", "a0.db");
    copy("b.db", "b0.db");
    expect_fails(MERGE("a.db", "b.db", "-o", "m.db"), 1, "participant P01 is also in another file", "m.db");
    said_done(MERGE("a.db", "--lab", "Ulm=b.db", "-o", "m.db"), "44 participants, 44 sessions; 0 were");
    expect_same("a.db", "a0.db");
    expect_same("b.db", "b0.db");
    assert_string_equal(study_file_ask("m.db", "SELECT integrity_check FROM pragma_integrity_check"), "ok");
    assert_string_equal(study_file_ask("m.db", "SELECT count(*) FROM pragma_foreign_key_check"), "0");
    assert_string_equal(study_file_ask("m.db", "SELECT code FROM participant WHERE code LIKE 'U%' ORDER BY id"),
                        "Ulm-P01");
    assert_string_equal(
        study_file_ask("m.db", "SELECT group_concat(number) FROM participant WHERE code LIKE '%P07'"), "7,7");
    assert_string_equal(
        study_file_ask("m.db", "SELECT count(DISTINCT detail ->> '$.sha256') FROM event WHERE kind = 'merged'"),
        "2");
    assert_string_equal(study_file_ask("m.db", "SELECT count(*) FROM sqlite_schema WHERE type = 'trigger'"),
                        "2");
    assert_string_equal(study_file_ask("m.db", "SELECT count(*) FROM exclusion"), "2");
    char *together = choices("a.db", "b.db"), *merged = choices("m.db", NULL);
    said_same(merged, together);
    free(together);
    free(merged);
}

static void copies_are_counted_once(void **state)
{
    (void)state;
    make_labs();
    copy("a.db", "c.db");
    unlink("m.db");
    struct program_result r = MERGE("a.db", "c.db", "-o", "m.db", "--json");
    assert_int_equal(r.code, 0);
    assert_string_equal(r.out,
                        "{\"files\":2,\"participants\":22,\"sessions\":22,\"sessions_counted_once\":22}\n");
    assert_non_null(strstr(r.err, "session 22 of participant P22 is in several files; counted once"));
    program_free(&r);
    char *alone = choices("a.db", NULL), *once = choices("m.db", NULL);
    assert_string_equal(once, alone); // with the hash
    free(alone);
    free(once);
    // What a merge made may be merged again, also under a laboratory's name.
    unlink("n.db");
    said_done(MERGE("--lab", "Ulm=m.db", "a.db", "-o", "n.db"), "22 participants, 22 sessions; 22 were");
    unlink("o.db");
    said_done(MERGE("n.db", "m.db", "a.db", "-o", "o.db"), "22 participants, 22 sessions; 44 were");
    char *first = choices("a.db", NULL), *merged = choices("o.db", NULL);
    said_same(merged, first);
    free(first);
    free(merged);
}

// A session that went on after it was copied: the later copy holds, whichever is named first.
static void the_later_copy_holds(void **state)
{
    (void)state;
    make_labs();
    copy("a.db", "later.db");
    study_file_sql("a.db",
                   "UPDATE session SET status = 'running', ended_at = NULL WHERE id = 5; DELETE FROM choice "
                   "WHERE trial_id = 52; UPDATE trial SET status = 'planned', attempt = 0 WHERE id = 52");
    const char *const orders[][2] = {{"a.db", "later.db"}, {"later.db", "a.db"}};
    for (int i = 0; i < 2; i++) {
        unlink("m.db");
        said_done(MERGE(orders[i][0], orders[i][1], "-o", "m.db"), "22 participants, 22 sessions; 22 were");
        assert_string_equal(
            study_file_ask("m.db", "SELECT count(*) || ' ' || sum(status = 'running') FROM session"), "22 0");
        char *later = choices("later.db", NULL), *merged = choices("m.db", NULL);
        said_same(merged, later);
        free(later);
        free(merged);
    }
    // A file that lacks people, and one that has more: an unfinished session stays as it is.
    unlink("m.db");
    said_done(MERGE("a.db", "-o", "m.db"), "22 sessions; 0 were");
    assert_string_equal(study_file_ask("m.db", "SELECT status FROM session WHERE id = 5"), "running");
    unlink("m.db");
    study_file_sql("later.db", "UPDATE choice SET chosen = iif(chosen = 'a', 'b', 'a') WHERE trial_id = 51");
    expect_fails(MERGE("a.db", "later.db", "-o", "m.db"), 1, "went on differently (table choice)", "m.db");
}

static void what_does_not_belong_is_refused(void **state)
{
    (void)state;
    make_labs();
    unlink("m.db");
    study_file_make("s.db", &(struct study_desc){.simulated = true});
    expect_fails(MERGE("a.db", "s.db", "-o", "m.db"), 1, "simulated observers and people never share", "m.db");
    study_file_sql("b.db", "UPDATE protocol SET name = 'other', sha256 = printf('%064d', 2)");
    expect_fails(MERGE("a.db", "--lab", "Ulm=b.db", "-o", "m.db"), 1,
                 "b.db: its sessions are of protocol other", "m.db");
    said_done(MERGE("a.db", "--lab", "Ulm=b.db", "--new-protocol", "-o", "m.db"), "44 sessions");
    copy("m.db", "kept.db");
    struct program_result r = MERGE("a.db", "-o", "m.db");
    assert_int_equal(r.code, 1);
    assert_non_null(strstr(r.err, "m.db: exists already"));
    program_free(&r);
    expect_same("m.db", "kept.db");
    unlink("m.db");
    make_labs();
    study_file_sql("b.db", "UPDATE session SET seed = 8");
    expect_fails(MERGE("a.db", "--lab", "Ulm=b.db", "-o", "m.db"), 1, "another seed", "m.db");
}

// Erased people do not come back from an older copy.
static void erased_people_stay_erased(void **state)
{
    (void)state;
    make_labs();
    copy("a.db", "old.db");
    study_file_sql("a.db",
                   "DELETE FROM exclusion; DELETE FROM choice WHERE trial_id BETWEEN 31 AND 34; DELETE FROM "
                   "rating WHERE trial_id BETWEEN 31 AND 34; DELETE FROM trial WHERE session_id = 3; DELETE "
                   "FROM segment WHERE session_id = 3; DELETE FROM session WHERE id = 3; UPDATE participant "
                   "SET code = 'forgotten-3', attributes = '{}' WHERE id = 3; INSERT INTO exclusion VALUES "
                   "(NULL, NULL, NULL, 3, 'forgotten', 'late', 'erased on request', 'fovstudy forget', "
                   "'2026-04-01T00:00:00Z')");
    unlink("m.db");
    expect_fails(MERGE("a.db", "old.db", "-o", "m.db"), 1, "number 3 was erased", "m.db");
    expect_fails(MERGE("old.db", "a.db", "-o", "m.db"), 1, "number 3 was erased", "m.db");
    copy("a.db", "c.db");
    said_done(MERGE("a.db", "c.db", "-o", "m.db"), "22 participants, 21 sessions; 21 were");
}

static void bad_files_have_a_sentence(void **state)
{
    (void)state;
    make_labs();
    unlink("m.db");
    expect_fails(MERGE("a.db", "nowhere.db", "-o", "m.db"), 1, "nowhere.db: there is no such file", "m.db");
    study_file_sql("b.db", "PRAGMA user_version = 0");
    expect_fails(MERGE("a.db", "b.db", "-o", "m.db"), 1, "b.db: the study file is damaged (its version is 0",
                 "m.db");
    study_file_sql("b.db", "PRAGMA user_version = 99");
    expect_fails(MERGE("a.db", "b.db", "-o", "m.db"), 1, "b.db: was written by a newer program", "m.db");
    // Half of a copy that was interrupted.
    copy("a.db", "half.db");
    assert_int_equal(truncate("half.db", 40960), 0);
    expect_fails(MERGE("half.db", "-o", "m.db"), 1, "half.db: the study file is damaged", "m.db");
    expect_fails(MERGE("a.db", "half.db", "-o", "m.db"), 1, "half.db: the study file is damaged", "m.db");
    expect_fails(MERGE("a.db"), 2, "needs -o", "m.db");
    expect_fails(MERGE("-o", "m.db"), 2, "at least one study file", "m.db");
    expect_fails(MERGE("--lab", "a.db", "-o", "m.db"), 2, "--lab needs NAME=DB", "m.db");
    struct program_result r = MERGE("a.db", "-o", "nofolder/m.db");
    assert_int_equal(r.code, 1);
    program_free(&r);
    study_file_make("empty.db", &(struct study_desc){.empty = true});
    said_done(MERGE("empty.db", "a.db", "-o", "m.db"), "22 participants, 22 sessions");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(laboratories_are_joined),   cmocka_unit_test(copies_are_counted_once),
        cmocka_unit_test(the_later_copy_holds),      cmocka_unit_test(what_does_not_belong_is_refused),
        cmocka_unit_test(erased_people_stay_erased), cmocka_unit_test(bad_files_have_a_sentence),
    };
    return cmocka_run_group_tests_name("merge", tests, program_enter_folder, program_leave_folder);
}
