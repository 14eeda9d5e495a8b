// fovstats merge, seen as a whole: killed at any moment it leaves no half file, and the report of what it
// joined is the report of the files given together.
#include "program.h"
#include "said.h"
#include "study_file.h"

#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <sqlite3.h>

#include <cmocka.h>

static const char fovstats[] = BUILD_DIR "/bin/fovstats";

#define RUN(...) program_run((const char *const[]){__VA_ARGS__, NULL}, NULL)

static int64_t now_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (int64_t)t.tv_sec * 1000000000 + t.tv_nsec;
}

// Whole and of all sessions, by SQLite itself.
static void expect_whole(const char *path)
{
    sqlite3 *db = NULL;
    sqlite3_stmt *s = NULL;
    static const char sql[] = "SELECT (SELECT integrity_check FROM pragma_integrity_check) = 'ok' AND (SELECT "
                              "count(*) FROM session) = 24 AND (SELECT count(*) FROM gaze) > 10000";
    assert_int_equal(sqlite3_open_v2(path, &db, SQLITE_OPEN_READONLY, NULL), SQLITE_OK);
    assert_int_equal(sqlite3_prepare_v2(db, sql, -1, &s, NULL), SQLITE_OK);
    assert_int_equal(sqlite3_step(s), SQLITE_ROW);
    assert_int_equal(sqlite3_column_int(s, 0), 1);
    sqlite3_finalize(s);
    sqlite3_close(db);
}

// Starts a merge and kills it after that time; whether the kill came before its end.
static bool kill_after(int64_t ns)
{
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        if (freopen("/dev/null", "w", stdout) && freopen("/dev/null", "w", stderr))
            execl(fovstats, fovstats, "merge", "g.db", "h.db", "-o", "m.db", (char *)NULL);
        _exit(127);
    }
    struct timespec wait = {ns / 1000000000, ns % 1000000000};
    nanosleep(&wait, NULL);
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    assert_true(WIFSIGNALED(status) || WEXITSTATUS(status) == 0);
    return WIFSIGNALED(status);
}

static void a_killed_merge_leaves_nothing_half(void **state)
{
    (void)state;
    said_done(RUN(BUILD_DIR "/tests/gaze_study", "g.db", "12", "4", "3", "120", "0"), "");
    said_done(RUN(BUILD_DIR "/tests/gaze_study", "h.db", "12", "4", "3", "120", "0"), "");
    study_file_sql("h.db", "UPDATE participant SET code = 'H' || code");
    study_file_sql("h.db", "UPDATE session SET started_at = replace(started_at, '2026-', '2025-')");
    int64_t begin = now_ns();
    said_done(RUN(fovstats, "merge", "g.db", "h.db", "-o", "m.db"), "24 participants, 24 sessions");
    int64_t whole = now_ns() - begin;
    expect_whole("m.db");
    uint64_t random = 20261125; // seed
    int killed = 0;
    for (int i = 0; i < 40; i++) {
        unlink("m.db");
        random = random * 6364136223846793005u + 1442695040888963407u; // Knuth, MMIX
        killed += kill_after((int64_t)((double)(random >> 11) * 0x1p-53 * 1.1 * (double)whole));
        if (access("m.db", F_OK) == 0)
            expect_whole("m.db");
    }
    assert_true(killed >= 10);
    unlink("m.db");
    said_done(RUN(fovstats, "merge", "g.db", "h.db", "-o", "m.db"), "24 participants, 24 sessions");
    expect_whole("m.db"); // what was left of the killed ones is in nobody's way
    assert_int_not_equal(access("m.db.part", F_OK), 0);
}

static char *report(const char *out, const char *a, const char *b)
{
    struct program_result r = RUN(fovstats, "report", "-o", out, a, b);
    if (r.code != 0)
        fail_msg("%s", r.err);
    program_free(&r);
    r = RUN("/bin/cat", out);
    free(r.err);
    // A trial's number is its row's in its file, and other in the joined one; its place in the session stays.
    for (char *at = r.out; (at = strstr(at, ", trial ")); at++)
        for (char *c = at + 8; *c >= '0' && *c <= '9'; c++)
            *c = ' ';
    for (char *from = r.out, *to = from; (*to = *from); from++)
        to += *to != ' ';
    return r.out;
}

static void the_report_is_that_of_the_files_together(void **state)
{
    (void)state;
    study_file_make("a.db", &(struct study_desc){.excluded = true});
    study_file_make("b.db", &(struct study_desc){.several = true});
    study_file_sql("b.db", "UPDATE session SET started_at = replace(started_at, '2026-02', '2026-03')");
    study_file_sql("b.db", "UPDATE participant SET code = 'Q' || code");
    said_done(RUN(fovstats, "merge", "a.db", "b.db", "-o", "j.db"), "44 participants, 44 sessions");
    char *together = report("t.html", "a.db", "b.db"), *joined = report("j.html", "j.db", NULL);
    assert_true(strlen(joined) > 20000);
    said_same(joined, together);
    free(together);
    free(joined);
}

static void one_is_one(void **state)
{
    (void)state;
    said_done(RUN(BUILD_DIR "/tests/gaze_study", "o.db", "1", "1", "1", "60", "0"), "");
    said_done(RUN("/bin/cp", "o.db", "p.db"), "");
    said_done(RUN(fovstats, "merge", "o.db", "p.db", "-o", "q.db"),
              "2 files, 1 participant, 1 session; 1 was in several files and is counted once.\n");
    said_done(RUN(fovstats, "merge", "o.db", "-o", "r.db"), "1 file, 1 participant, 1 session; 0 were");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_killed_merge_leaves_nothing_half),
        cmocka_unit_test(the_report_is_that_of_the_files_together),
        cmocka_unit_test(one_is_one),
    };
    return cmocka_run_group_tests_name("merge_whole", tests, program_enter_folder, program_leave_folder);
}
