// What the file itself refuses, and others who get in the way.
#include "fixture.h"

#include <sqlite3.h>
#include <stdio.h>

static struct store *begin(const char *path, struct fixture_session *session)
{
    struct store *store = fixture_open(path, STORE_CREATE);
    struct store_error error;
    expect_result(fixture_create(store, "s1", 1, session, &error), STORE_OK, &error);
    return store;
}

// Words of closed sets are refused by the file itself, whoever writes.
static void test_closed_sets(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    struct fixture_session session;
    fixture_close(begin(path, &session));
    assert_int_equal(outsider(path,
                              "INSERT INTO frame (session_id, segment_id, number, phase, fade_level, start_ns, "
                              "present_estimated, late) VALUES (1, 1, 1, 'fade', 0.5, 0, 0, 0);"
                              "INSERT INTO exclusion (trial_id, rule, rule_set, reason, \"by\", applied_at) "
                              "VALUES (1, 'r', 'late', '', '', '')"),
                     SQLITE_OK);
    static const char *const refused[] = {
        "UPDATE participant SET kind = 'robot'",
        "UPDATE session SET status = 'paused'",
        "UPDATE segment SET clock = 'wall'",
        "UPDATE trial SET kind = 'other'",
        "UPDATE trial SET status = 'lost'",
        "UPDATE trial SET test_slot = 'equal'",
        "UPDATE trial SET first_shown = 'c'",
        "UPDATE trial SET ordinal = 'first'",
        "INSERT INTO choice VALUES (NULL, 1, 1, 'c', NULL, 1, 1, 1)",
        "INSERT INTO exposure VALUES (NULL, 1, 1, 1, 'a', 5, 4, NULL, NULL)",
        "INSERT INTO exposure VALUES (NULL, 1, 1, 1, 'a', 5, 9, 4, 8)",
        "INSERT INTO exposure VALUES (NULL, 1, 1, 1, 'a', 5, 9, 6, NULL)",
        "INSERT INTO gaze VALUES (NULL, 1, 1, NULL, 0, 0, 'third', 0, 0, 0, 1, 1)",
        "INSERT INTO gaze VALUES (NULL, 1, 1, NULL, 0, 0, 'left', 0, 0, 0, 2, 1)",
        "UPDATE frame SET phase = 'dream'",
        "UPDATE frame SET fade_level = 1.5",
        "UPDATE frame SET effective = '{'",
        "UPDATE exclusion SET rule_set = 'whim'",
        "INSERT INTO exclusion (rule, rule_set, reason, \"by\", applied_at) VALUES ('r', 'late', '', '', '')",
        "DELETE FROM session",
        "DELETE FROM condition",
    };
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        int code = outsider(path, refused[i]);
        if (code != SQLITE_CONSTRAINT)
            fail_msg("SQLite says %d to: %s", code, refused[i]);
    }
}

static void test_locked(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    struct fixture_session session;
    struct store_error error;
    fixture_close(begin(path, &session));
    struct store *store =
        store_open(&(struct store_desc){.path = path, .busy_ms = 50, .access = STORE_WRITE}, &error);
    assert_non_null(store);
    sqlite3 *other = NULL;
    assert_int_equal(sqlite3_open(path, &other), 0);
    struct store_choice choice = fixture_choice(&session, 0);
    int64_t id = 0;
    // A reader does not get in the way, however long it reads.
    assert_int_equal(sqlite3_exec(other, "BEGIN; SELECT * FROM trial", NULL, NULL, NULL), 0);
    expect_result(store_answer_choice(store, &choice, &id, &error), STORE_OK, &error);
    assert_int_equal(sqlite3_exec(other, "COMMIT; BEGIN IMMEDIATE", NULL, NULL, NULL), 0);
    choice = fixture_choice(&session, 1);
    assert_int_not_equal(store_push_gaze(store, &(struct store_gaze){0}), 0); // waits, and will be refused
    expect_result(store_answer_choice(store, &choice, &id, &error), STORE_FAILED, &error);
    expect_sentence(&error, "another program keeps the database locked (waited 50 ms)");
    struct store_status status;
    store_status(store, &status);
    assert_true(status.failing);
    expect_sentence(&status.error, "locked");
    assert_int_equal(sqlite3_exec(other, "COMMIT", NULL, NULL, NULL), 0);
    sqlite3_close(other);
    expect_result(store_answer_choice(store, &choice, &id, &error), STORE_OK, &error);
    store_status(store, &status);
    assert_false(status.failing);
    fixture_close(store);
}

static void test_removed(void **state)
{
    struct fixture *fixture = *state;
    struct fixture_session session;
    struct store_error error;
    struct store *store = begin(fixture->path, &session);
    struct store_choice choice = fixture_choice(&session, 0);
    int64_t id = 0;
    char aside[128];
    snprintf(aside, sizeof aside, "%s/aside", fixture->folder);
    assert_int_equal(rename(fixture->path, aside), 0);
    expect_result(store_answer_choice(store, &choice, &id, &error), STORE_FAILED, &error);
    expect_sentence(&error, "removed or replaced");
    assert_int_equal(rename(aside, fixture->path), 0);
    expect_result(store_answer_choice(store, &choice, &id, &error), STORE_OK, &error);
    fixture_close(store);
    expect_sound(fixture->path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_closed_sets, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_locked, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_removed, fixture_setup, fixture_teardown),
    };
    return cmocka_run_group_tests_name("studies/store rules", tests, NULL, NULL);
}
