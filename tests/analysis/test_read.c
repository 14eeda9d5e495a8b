// Reading study files: slots become test and reference, unknown values stay unknown, a file that is being
// written is read as it was.
#include "staircase_file.h"
#include "studies/store/read.h"
#include "study_file.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <sqlite3.h>

#include <cmocka.h>

static int enter_folder(void **state)
{
    static char folder[] = "/tmp/fovstats-test-XXXXXX";
    *state = mkdtemp(folder);
    return *state && chdir(folder) == 0 ? 0 : -1;
}

static int leave_folder(void **state)
{
    static const char *const names[] = {"s.db", "s.db-wal", "s.db-shm", "s.db-owner"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        unlink(names[i]);
    return chdir("/") == 0 && rmdir(*state) == 0 ? 0 : -1;
}

static struct store_reader *open_study(void)
{
    char error[512] = "";
    struct store_reader *reader = store_reader_open("s.db", error, sizeof error);
    if (!reader)
        fail_msg("%s", error);
    return reader;
}

struct counted {
    int64_t rows, tests, references;
    bool stop;
    const char *sql; // run at the first row
};

static bool count_trial(void *user, const struct store_trial_row *row)
{
    struct counted *c = user;
    if (c->rows++ == 0 && c->sql)
        study_file_sql("s.db", c->sql);
    c->tests += row->chosen == 't';
    c->references += row->chosen == 'r';
    if (row->choice_id && row->test_id) {
        assert_int_equal(row->reference_id, 1);
        assert_true(row->test_id == 2 || row->test_id == 3);
    }
    if (!row->choice_id)
        assert_true(row->chosen == 0 && isnan(row->reaction_s));
    return !c->stop;
}

static void slots_are_resolved(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){0});
    struct store_reader *reader = open_study();
    struct counted c = {0};
    assert_true(store_read_trials(reader, count_trial, &c));
    assert_int_equal(c.rows, 22 * 4 - 2);
    assert_int_equal(c.tests, 6 + 4);
    assert_int_equal(c.references, 16 + 18);
    c = (struct counted){.stop = true};
    assert_false(store_read_trials(reader, count_trial, &c));
    assert_int_equal(c.rows, 1);
    assert_string_equal(store_reader_error(reader), "");
    store_reader_close(reader);
    store_reader_close(NULL);
}

static bool check_session(void *user, const struct store_session_row *row)
{
    ++*(int *)user;
    assert_true(isnan(row->refresh_hz) && isnan(row->width_px));
    assert_string_equal(row->device, "");
    assert_true(row->seed == UINT64_MAX); // stored with the same bits as -1
    return true;
}

static void unknown_stays_unknown(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){.bare = true});
    study_file_sql("s.db", "UPDATE session SET device = NULL, refresh_hz = NULL, width_px = NULL, seed = -1");
    struct store_reader *reader = open_study();
    int sessions = 0;
    assert_true(store_read_sessions(reader, check_session, &sessions));
    assert_int_equal(sessions, 22);
    store_reader_close(reader);
}

// A session that is being recorded: what is committed is seen, what comes later is not, and nothing is locked.
static void a_file_in_use(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){0});
    sqlite3 *writer = NULL;
    assert_int_equal(sqlite3_open("s.db", &writer), SQLITE_OK);
    assert_int_equal(
        sqlite3_exec(writer,
                     "PRAGMA journal_mode = WAL; PRAGMA wal_autocheckpoint = 0; DELETE FROM choice WHERE "
                     "trial_id = 11",
                     NULL, NULL, NULL),
        SQLITE_OK);
    struct store_reader *reader = open_study();
    struct counted c = {.sql = "DELETE FROM choice WHERE trial_id = 21"};
    assert_true(store_read_trials(reader, count_trial, &c));
    assert_int_equal(c.tests, 9);
    c = (struct counted){0};
    assert_true(store_read_trials(reader, count_trial, &c));
    assert_int_equal(c.tests, 9); // one view for all calls
    store_reader_close(reader);
    reader = open_study();
    c = (struct counted){0};
    assert_true(store_read_trials(reader, count_trial, &c));
    assert_int_equal(c.tests, 8);
    store_reader_close(reader);
    sqlite3_close(writer);
}

// A file at rest gets no company, and a change beneath the reader is noticed.
static void a_file_at_rest(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){0});
    study_file_sql("s.db", "PRAGMA journal_mode = WAL");
    struct store_reader *reader = open_study();
    struct counted c = {0};
    assert_true(store_read_trials(reader, count_trial, &c));
    assert_int_not_equal(access("s.db-wal", F_OK), 0);
    assert_int_not_equal(access("s.db-shm", F_OK), 0);
    c = (struct counted){.sql = "DELETE FROM choice"};
    assert_false(store_read_trials(reader, count_trial, &c));
    assert_non_null(strstr(store_reader_error(reader), "s.db: was changed while it was read; run this again"));
    store_reader_close(reader);
}

// Half of a change by another program, whose journal says how the file was before.
static void a_change_that_was_cut_off(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){0});
    sqlite3 *writer = NULL;
    assert_int_equal(sqlite3_open("s.db", &writer), SQLITE_OK);
    assert_int_equal(
        sqlite3_exec(writer,
                     "PRAGMA journal_mode = DELETE; PRAGMA cache_size = 1; BEGIN; UPDATE trial SET "
                     "block = 'x'; UPDATE choice SET chosen = 'equal'; UPDATE frame SET gpu_us = 1",
                     NULL, NULL, NULL),
        SQLITE_OK);
    assert_int_equal(system("cp s.db t.db && cp s.db-journal t.db-journal"), 0); // as after a power cut
    char error[512] = "";
    assert_null(store_reader_open("t.db", error, sizeof error));
    assert_non_null(strstr(error, "t.db: another program was stopped while it wrote"));
    assert_int_equal(sqlite3_exec(writer, "ROLLBACK", NULL, NULL, NULL), SQLITE_OK);
    sqlite3_close(writer);
    unlink("t.db");
    unlink("t.db-journal");
}

static void names_that_look_like_addresses(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){0});
    assert_int_equal(rename("s.db", "a?mode=rwc#%41.db"), 0);
    char error[512] = "";
    struct store_reader *reader = store_reader_open("a?mode=rwc#%41.db", error, sizeof error);
    assert_non_null(reader);
    struct counted c = {0};
    assert_true(store_read_trials(reader, count_trial, &c));
    store_reader_close(reader);
    unlink("a?mode=rwc#%41.db");
}

struct seen {
    int64_t rows, graded, right, reversals, invalid;
    double last; // estimate of the last step that had one
};

static bool see_step(void *user, const struct store_step_row *row)
{
    struct seen *s = user;
    s->rows++;
    s->graded += row->graded;
    s->right += row->outcome == 1;
    s->reversals += row->reversal;
    s->invalid += strcmp(row->status, "done") != 0;
    s->last = isnan(row->estimate) ? s->last : row->estimate;
    assert_string_not_equal(row->block, "practice");
    assert_true(row->test_id == 100 + (int64_t)row->level); // through the slot
    return true;
}

static bool see_adjusted(void *user, const struct store_adjusted_row *row)
{
    struct seen *s = user;
    s->rows++;
    s->invalid += strcmp(row->status, "done") != 0;
    s->last = row->value;
    assert_string_equal(row->parameter, "epsilon");
    assert_int_equal(row->test_id, 2);
    return true;
}

static void staircases_and_adjustments(void **state)
{
    (void)state;
    staircase_file_make("s.db");
    struct store_reader *reader = open_study();
    struct seen s = {0};
    assert_true(store_read_staircase_steps(reader, see_step, &s));
    assert_int_equal(s.rows, 140 + 12 + 12 + 6 + 6 + 2);
    assert_int_equal(s.graded, 2);
    assert_int_equal(s.right, 108 + 12 + 6 + 3 + 3);
    assert_int_equal(s.reversals, 32 + 6 + 3 + 3);
    assert_int_equal(s.invalid, 1);
    assert_true(s.last == 9);
    s = (struct seen){0};
    assert_true(store_read_adjusted(reader, see_adjusted, &s));
    assert_int_equal(s.rows, 7);
    assert_int_equal(s.invalid, 1);
    assert_true(s.last == 2);
    store_reader_close(reader);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slots_are_resolved),
        cmocka_unit_test(unknown_stays_unknown),
        cmocka_unit_test(a_file_in_use),
        cmocka_unit_test(a_file_at_rest),
        cmocka_unit_test(a_change_that_was_cut_off),
        cmocka_unit_test(names_that_look_like_addresses),
        cmocka_unit_test(staircases_and_adjustments),
    };
    return cmocka_run_group_tests(tests, enter_folder, leave_folder);
}
