// A person is erased: rows, and the bytes of the code, the answers' texts and the gaze, from the file and its
// log.
#include "fixture.h"
#include "studies/store/forget.h"

#include <sqlite3.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CODE "QQ-secret-code"
#define NOTE "QQ-secret-note"
#define SECRET_DEG 17.123456789012345 // of a gaze sample: its eight bytes are found nowhere else

// How often the bytes are in the file and in its log.
static int found(const char *path, const void *bytes, size_t size)
{
    static const char *const suffixes[] = {"", "-wal", "-journal"};
    int count = 0;
    for (size_t i = 0; i < sizeof suffixes / sizeof *suffixes; i++) {
        char name[160];
        snprintf(name, sizeof name, "%s%s", path, suffixes[i]);
        FILE *file = fopen(name, "rb");
        if (!file)
            continue;
        fseek(file, 0, SEEK_END);
        size_t length = (size_t)ftell(file);
        rewind(file);
        char *text = malloc(length + 1);
        assert_int_equal(fread(text, 1, length, file), length);
        for (size_t at = 0; at + size <= length; at++)
            count += memcmp(text + at, bytes, size) == 0;
        free(text);
        fclose(file);
    }
    return count;
}

static int found_gaze(const char *path)
{
    double value = SECRET_DEG;
    unsigned char bytes[8], swapped[8];
    memcpy(bytes, &value, sizeof bytes);
    for (int i = 0; i < 8; i++)
        swapped[i] = bytes[7 - i]; // SQLite's order is big endian
    return found(path, swapped, sizeof swapped);
}

// One person with everything that a person can have, over many pages.
static void add_person(struct store *store, const char *code, int64_t number, double x_deg, const char *note)
{
    struct store_error error;
    struct fixture_session session;
    struct fixture_parts parts;
    struct store_session desc = fixture_session(&parts, code, number);
    char attributes[64];
    int64_t id = 0, attempt = 0;
    snprintf(attributes, sizeof attributes, "{\"remark\":\"%s\"}", note);
    desc.participant.attributes = attributes;
    session = (struct fixture_session){0};
    session.ids.condition_ids = session.condition_ids;
    session.ids.trial_ids = session.trial_ids;
    expect_result(store_create_session(store, &desc, &session.ids, &error), STORE_OK, &error);
    for (int trial = 0; trial < FIXTURE_TRIALS; trial++) {
        expect_result(
            store_start_trial(store, session.trial_ids[trial], session.ids.segment_id, 0, &attempt, &error),
            STORE_OK, &error);
        for (int i = 0; i < 300; i++) {
            struct store_gaze gaze = fixture_gaze(&session, i);
            gaze.sample.x_deg = x_deg;
            int64_t gaze_id = store_push_gaze(store, &gaze);
            struct store_frame frame = fixture_frame(&session, (uint64_t)(300 * trial + i), gaze_id);
            assert_true(store_push_frame(store, &frame));
        }
        store_push_event(store, &(struct store_event){session.ids.session_id, session.ids.segment_id,
                                                      session.trial_ids[trial], 5, "remark", note});
        struct store_choice choice = fixture_choice(&session, trial);
        expect_result(store_answer_choice(store, &choice, &id, &error), STORE_OK, &error);
    }
    struct store_rating rating = {.session_id = session.ids.session_id,
                                  .segment_id = session.ids.segment_id,
                                  .question = note,
                                  .subject = "scene",
                                  .value = 3,
                                  .scale_min = 1,
                                  .scale_max = 10};
    expect_result(store_answer_rating(store, &rating, &id, &error), STORE_OK, &error);
    struct store_exclusion exclusion = {.session_id = session.ids.session_id,
                                        .rule = "late",
                                        .rule_set = "late",
                                        .reason = note,
                                        .by = "x",
                                        .applied_at = "2026-01-02T03:04:05Z"};
    expect_result(store_add_exclusion(store, &exclusion, &id, &error), STORE_OK, &error);
}

static void test_erased(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    struct store *store = fixture_open(path, STORE_CREATE);
    struct store_error error;
    struct store_forgotten gone;
    add_person(store, "before", 1, 1.25, "kept");
    add_person(store, CODE, 2, SECRET_DEG, NOTE);
    add_person(store, "after", 3, 1.25, "kept");
    assert_true(found(path, CODE, strlen(CODE)) > 0);
    assert_true(found(path, NOTE, strlen(NOTE)) > 0);
    assert_true(found_gaze(path) > 0);
    expect_result(store_forget(store, "nobody", "2026-01-03T00:00:00Z", &gone, &error), STORE_REFUSED, &error);
    expect_sentence(&error, "there is no participant nobody");
    expect_result(store_forget(store, CODE, "2026-01-03T00:00:00Z", &gone, &error), STORE_OK, &error);
    assert_int_equal(gone.number, 2);
    assert_int_equal(gone.sessions, 1);
    assert_int_equal(gone.trials, FIXTURE_TRIALS);
    assert_int_equal(gone.answers, FIXTURE_TRIALS + 1);
    assert_int_equal(gone.frames, 300 * FIXTURE_TRIALS);
    assert_int_equal(gone.gaze, 300 * FIXTURE_TRIALS);
    for (int closed = 0; closed < 2; closed++) {
        assert_int_equal(found(path, CODE, strlen(CODE)), 0);
        assert_int_equal(found(path, NOTE, strlen(NOTE)), 0);
        assert_int_equal(found_gaze(path), 0);
        if (closed == 0)
            fixture_close(store);
    }
    expect_sound(path);
    char *text = query_text(path, "SELECT code || number || attributes FROM participant ORDER BY id");
    assert_string_equal(text, "before1{\"remark\":\"kept\"}\nforgotten-22{}\nafter3{\"remark\":\"kept\"}\n");
    free(text);
    text = query_text(
        path, "SELECT rule || rule_set || reason || applied_at FROM exclusion WHERE participant_id = 2");
    assert_string_equal(text, "forgottenlateerased on request2026-01-03T00:00:00Z\n");
    free(text);
    assert_int_equal(query(path, "SELECT count(*) FROM gaze"), 2 * 300 * FIXTURE_TRIALS);
    assert_int_equal(query(path, "SELECT count(*) FROM session"), 2);
    // The number is free again, and a new session goes on as ever.
    store = fixture_open(path, STORE_WRITE);
    int64_t number = 0;
    expect_result(store_participant_number(store, CODE, 0, &number, &error), STORE_OK, &error);
    assert_int_equal(number, 2);
    add_person(store, CODE, 2, 1.25, "again");
    fixture_close(store);
}

// Somebody reads meanwhile: the rows are gone, the bytes cannot be yet, and the same call finishes it.
static void test_reader_in_the_way(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    struct store *store = fixture_open(path, STORE_CREATE);
    struct store_error error;
    struct store_forgotten gone;
    add_person(store, CODE, 1, SECRET_DEG, NOTE);
    store_set_busy(store, 20);
    sqlite3 *reader = NULL;
    assert_int_equal(sqlite3_open(path, &reader), SQLITE_OK);
    assert_int_equal(sqlite3_exec(reader, "BEGIN; SELECT count(*) FROM gaze", NULL, NULL, NULL), SQLITE_OK);
    expect_result(store_forget(store, CODE, "2026-01-03T00:00:00Z", &gone, &error), STORE_FAILED, &error);
    assert_int_equal(query(path, "SELECT count(*) FROM gaze"), 0);
    sqlite3_exec(reader, "COMMIT", NULL, NULL, NULL);
    sqlite3_close(reader);
    expect_result(store_forget(store, CODE, "2026-01-03T00:00:00Z", &gone, &error), STORE_OK, &error);
    assert_int_equal(found(path, CODE, strlen(CODE)), 0);
    assert_int_equal(found_gaze(path), 0);
    expect_result(store_forget(store, CODE, "2026-01-03T00:00:00Z", &gone, &error), STORE_REFUSED, &error);
    fixture_close(store);
    expect_sound(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_erased, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_reader_in_the_way, fixture_setup, fixture_teardown),
    };
    return cmocka_run_group_tests_name("studies/store forget", tests, NULL, NULL);
}
