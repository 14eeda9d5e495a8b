// The disk goes wrong at the n-th write, sync, truncation or deletion, for n = 1, 2, 3, ... until the work gets
// through without meeting the fault (the method of SQLite's own out-of-disk tests).
#include "faulty_vfs.h"
#include "fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { LIMIT = 400 }; // more operations than any case has

struct work {
    struct fixture *fixture;
    struct faulty_vfs faulty;
    struct store *store;
    struct fixture_session session;
    int acknowledged; // answers
};

static void open_store(struct work *work)
{
    struct store_error error;
    // The writer thread stays out of the way, so that the n-th operation is always the same one.
    work->store = store_open(&(struct store_desc){.path = work->fixture->path,
                                                  .access = STORE_CREATE,
                                                  .flush_ms = 1000,
                                                  .gaze_capacity = 4096,
                                                  .log_capacity = 4096,
                                                  .vfs = "faulty"},
                             &error);
    if (!work->store)
        fail_msg("%s", error.text);
}

static void start_work(struct work *work, bool with_session)
{
    unlink(work->fixture->path);
    work->acknowledged = 0;
    open_store(work);
    struct store_error error;
    if (with_session)
        expect_result(fixture_create(work->store, "s1", 1, &work->session, &error), STORE_OK, &error);
}

static void copy_file(const char *from, const char *to)
{
    FILE *source = fopen(from, "rb"), *target = fopen(to, "wb");
    assert_non_null(target);
    char bytes[4096];
    for (size_t size; source && (size = fread(bytes, 1, sizeof bytes, source)) > 0;)
        assert_int_equal(fwrite(bytes, 1, size, target), size);
    if (source)
        fclose(source);
    fclose(target);
}

// What a reader finds if the machine stops now: the database and its log as they lie on disk.
static void expect_crash_safe(const struct work *work)
{
    char copy[160], log[160], copied_log[170];
    snprintf(copy, sizeof copy, "%s/copy.db", work->fixture->folder);
    snprintf(log, sizeof log, "%s-wal", work->fixture->path);
    snprintf(copied_log, sizeof copied_log, "%s-wal", copy);
    copy_file(work->fixture->path, copy);
    copy_file(log, copied_log);
    expect_sound(copy);
    assert_true(query(copy, "SELECT count(*) FROM choice") >= work->acknowledged);
    // Sessions are whole (nine trials, a segment, a participant); an answer and the end of its trial are one
    // thing.
    assert_int_equal(
        query(copy, "SELECT (SELECT count(*) FROM session WHERE (SELECT count(*) FROM trial WHERE session_id = "
                    "session.id) <> 9 OR NOT EXISTS (SELECT 1 FROM segment WHERE session_id = session.id)) + "
                    "(SELECT count(*) FROM participant WHERE id NOT IN (SELECT participant_id FROM session)) + "
                    "(SELECT count(*) FROM trial WHERE (status = 'done') <> "
                    "EXISTS (SELECT 1 FROM choice WHERE trial_id = trial.id))"),
        0);
    unlink(copy);
    unlink(copied_log);
}

static void expect_disk_sentence(const struct store_error *error, enum fault fault)
{
    bool full = fault == FAULT_FULL || fault == FAULT_FULL_ONCE;
    if (!strstr(error->text, full ? "the disk is full" : "the disk reports an error"))
        fail_msg("fault %d gives '%s'", (int)fault, error->text);
}

// --- the work that is disturbed; each returns whether it had to be done again ---

static bool create_session(struct work *work)
{
    struct store_error error;
    enum store_result result = fixture_create(work->store, "s1", 1, &work->session, &error);
    bool failed = faulty_vfs_disarm(&work->faulty);
    if (result == STORE_OK)
        return failed;
    assert_int_equal(result, STORE_FAILED);
    expect_disk_sentence(&error, work->faulty.fault);
    expect_crash_safe(work);
    expect_result(fixture_create(work->store, "s1", 1, &work->session, &error), STORE_OK, &error);
    return true;
}

static bool answer(struct work *work)
{
    struct store_error error;
    bool failed = false;
    for (int trial = 0; trial < 2; trial++) {
        for (int i = 0; i < 120; i++) { // more than a page of logs
            struct store_gaze gaze = fixture_gaze(&work->session, i);
            int64_t gaze_id = store_push_gaze(work->store, &gaze);
            struct store_frame frame = fixture_frame(&work->session, (uint64_t)(120 * trial + i), gaze_id);
            if (i % 10 == 0)
                assert_true(store_push_frame(work->store, &frame));
        }
        struct store_choice choice = fixture_choice(&work->session, trial);
        int64_t id = 0;
        enum store_result result = store_answer_choice(work->store, &choice, &id, &error);
        if (result != STORE_OK) {
            assert_int_equal(result, STORE_FAILED);
            failed = true;
            faulty_vfs_disarm(&work->faulty);
            expect_disk_sentence(&error, work->faulty.fault);
            expect_crash_safe(work);
            struct store_status status;
            store_status(work->store, &status);
            assert_true(status.failing);
            expect_result(store_answer_choice(work->store, &choice, &id, &error), STORE_OK, &error);
        }
        work->acknowledged++;
    }
    return faulty_vfs_disarm(&work->faulty) || failed;
}

static bool flush_logs(struct work *work)
{
    struct store_error error;
    for (int i = 0; i < 500; i++) {
        struct store_gaze gaze = fixture_gaze(&work->session, i);
        assert_int_equal(store_push_gaze(work->store, &gaze), i + 1);
    }
    enum store_result result = store_flush(work->store, &error);
    bool failed = faulty_vfs_disarm(&work->faulty);
    if (result != STORE_OK) {
        assert_int_equal(result, STORE_FAILED);
        expect_crash_safe(work);
        expect_result(store_flush(work->store, &error), STORE_OK, &error);
    }
    assert_int_equal(query(work->fixture->path, "SELECT count(*) FROM gaze"), 500);
    return failed;
}

// The log grows past the size where SQLite moves it into the database (1000 pages), which must not fail an
// answer.
static bool checkpoint(struct work *work)
{
    struct store_error error;
    bool failed = false;
    char effective[STORE_DETAIL_SIZE];
    snprintf(effective, sizeof effective, "{\"padding\":\"%0240d\"}", 0);
    for (int round = 0; round < 3; round++) {
        for (int i = 0; i < 2500; i++) {
            struct store_frame frame = fixture_frame(&work->session, (uint64_t)i, 0);
            frame.effective = effective;
            assert_true(store_push_frame(work->store, &frame));
        }
        while (store_flush(work->store, &error) != STORE_OK) {
            expect_disk_sentence(&error, work->faulty.fault);
            expect_crash_safe(work);
            failed = true;
            faulty_vfs_disarm(&work->faulty);
        }
    }
    failed |= faulty_vfs_disarm(&work->faulty);
    assert_int_equal(query(work->fixture->path, "SELECT count(*) FROM frame"), 7500);
    return failed;
}

static int disturb(struct work *work, bool with_session, bool (*job)(struct work *), enum fault fault)
{
    for (int n = 1; n <= LIMIT; n++) {
        start_work(work, with_session);
        faulty_vfs_arm(&work->faulty, fault, n);
        bool met = job(work);
        faulty_vfs_disarm(&work->faulty);
        fixture_close(work->store);
        expect_sound(work->fixture->path);
        assert_int_equal(query(work->fixture->path, "SELECT count(*) FROM trial"), FIXTURE_TRIALS);
        assert_int_equal(query(work->fixture->path, "SELECT count(*) FROM choice"), work->acknowledged);
        if (!met)
            return n - 1;
    }
    fail_msg("the fault was still met at n = %d", LIMIT);
    return 0;
}

static void disturb_all(void **state, const char *name, bool with_session, bool (*job)(struct work *),
                        const enum fault *faults)
{
    struct work *work = calloc(1, sizeof *work);
    work->fixture = *state;
    faulty_vfs_register(&work->faulty, "faulty");
    printf("%s:", name);
    for (; *faults != FAULTS; faults++) {
        int points = disturb(work, with_session, job, *faults);
        assert_true(points > 0);
        printf(" %d", points);
    }
    printf(" operations failed, one after another\n");
    faulty_vfs_unregister(&work->faulty);
    free(work);
}

static const enum fault all_faults[] = {FAULT_FULL, FAULT_IO, FAULT_FULL_ONCE, FAULT_IO_ONCE, FAULTS};
static const enum fault two_faults[] = {FAULT_FULL, FAULT_IO_ONCE, FAULTS};

static void test_session(void **state)
{
    disturb_all(state, "session", false, create_session, all_faults);
}

static void test_answers(void **state)
{
    disturb_all(state, "answers", true, answer, two_faults);
}

static void test_logs(void **state)
{
    disturb_all(state, "logs", true, flush_logs, all_faults);
}

static void test_open(void **state)
{
    struct work *work = calloc(1, sizeof *work);
    work->fixture = *state;
    faulty_vfs_register(&work->faulty, "faulty");
    const struct store_desc desc = {.path = work->fixture->path, .access = STORE_CREATE, .vfs = "faulty"};
    for (enum fault fault = FAULT_FULL; fault < FAULT_KILL; fault++) {
        int n = 1;
        for (; n < LIMIT; n++) {
            struct store_error error;
            faulty_vfs_arm(&work->faulty, fault, n);
            struct store *store = store_open(&desc, &error);
            bool met = faulty_vfs_disarm(&work->faulty);
            if (store) {
                fixture_close(store);
                expect_sound(work->fixture->path);
                unlink(work->fixture->path);
            } else {
                // Nothing half-made is left, and the next try succeeds.
                assert_true(met);
                expect_sentence(&error, work->fixture->path);
                assert_int_equal(access(work->fixture->path, F_OK), -1);
            }
            if (!met)
                break;
        }
        assert_true(n > 5 && n < LIMIT);
    }
    faulty_vfs_unregister(&work->faulty);
    free(work);
}

static void test_synced_before_return(void **state)
{
    struct work *work = calloc(1, sizeof *work);
    work->fixture = *state;
    faulty_vfs_register(&work->faulty, "faulty");
    start_work(work, true);
    for (int trial = 0; trial < FIXTURE_TRIALS; trial++) {
        struct store_choice choice = fixture_choice(&work->session, trial);
        struct store_error error;
        int64_t id = 0;
        int before = atomic_load(&work->faulty.syncs);
        expect_result(store_answer_choice(work->store, &choice, &id, &error), STORE_OK, &error);
        assert_true(atomic_load(&work->faulty.syncs) > before);
    }
    fixture_close(work->store);
    faulty_vfs_unregister(&work->faulty);
    free(work);
}

// The writer's failures are seen, its rows wait, and nothing is lost once there is room again.
static void test_writer_recovers(void **state)
{
    struct work *work = calloc(1, sizeof *work);
    work->fixture = *state;
    faulty_vfs_register(&work->faulty, "faulty");
    struct store_error error;
    work->store = store_open(&(struct store_desc){.path = work->fixture->path,
                                                  .access = STORE_CREATE,
                                                  .flush_ms = 10,
                                                  .gaze_capacity = 64,
                                                  .log_capacity = 64,
                                                  .vfs = "faulty"},
                             &error);
    assert_non_null(work->store);
    expect_result(fixture_create(work->store, "s1", 1, &work->session, &error), STORE_OK, &error);
    faulty_vfs_arm(&work->faulty, FAULT_FULL, 1);
    for (int i = 0; i < 64; i++) {
        struct store_gaze gaze = fixture_gaze(&work->session, i);
        assert_int_equal(store_push_gaze(work->store, &gaze), i + 1);
    }
    struct store_status status = {0};
    for (int i = 0; i < 200 && !status.failing; i++) {
        usleep(5000);
        store_status(work->store, &status);
    }
    assert_true(status.failing);
    expect_sentence(&status.error, "the disk is full");
    expect_result(store_flush(work->store, &error), STORE_FAILED, &error);
    faulty_vfs_disarm(&work->faulty);
    for (int i = 0; i < 200 && status.failing; i++) {
        usleep(5000);
        store_status(work->store, &status);
    }
    assert_false(status.failing);
    assert_int_equal(status.gaze_committed, 64);
    assert_int_equal(query(work->fixture->path, "SELECT count(*) FROM gaze"), 64);
    // Closing on a full disk says how much is lost.
    faulty_vfs_arm(&work->faulty, FAULT_FULL, 1);
    struct store_gaze gaze = fixture_gaze(&work->session, 1);
    store_push_gaze(work->store, &gaze);
    expect_result(store_close(work->store, &error), STORE_FAILED, &error);
    expect_sentence(&error, "1 log rows were lost: ");
    faulty_vfs_disarm(&work->faulty);
    expect_sound(work->fixture->path);
    faulty_vfs_unregister(&work->faulty);
    free(work);
}

static void test_checkpoints(void **state)
{
    // Some points of about three thousand, spread over writing the log and moving it into the database.
    static const int points[] = {1, 600, 1100, 1700};
    struct work *work = calloc(1, sizeof *work);
    work->fixture = *state;
    faulty_vfs_register(&work->faulty, "faulty");
    int met = 0;
    for (enum fault fault = FAULT_FULL; fault <= FAULT_IO; fault++) {
        for (size_t i = 0; i < sizeof points / sizeof *points; i++) {
            start_work(work, true);
            faulty_vfs_arm(&work->faulty, fault, points[i]);
            met += checkpoint(work);
            fixture_close(work->store);
            expect_sound(work->fixture->path);
        }
    }
    assert_true(met == 2 * 4);
    faulty_vfs_unregister(&work->faulty);
    free(work);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_open, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_session, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_answers, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_logs, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_synced_before_return, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_writer_recovers, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_checkpoints, fixture_setup, fixture_teardown),
    };
    return cmocka_run_group_tests_name("studies/store faults", tests, NULL, NULL);
}
