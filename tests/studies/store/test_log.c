#include "fixture.h"

#include <math.h>
#include <pthread.h>
#include <sqlite3.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static struct store *begin_sized(const char *path, const struct store_desc *sizes,
                                 struct fixture_session *session)
{
    struct store_error error;
    struct store_desc desc = *sizes;
    desc.path = path;
    desc.access = STORE_CREATE;
    struct store *store = store_open(&desc, &error);
    if (!store)
        fail_msg("%s", error.text);
    expect_result(fixture_create(store, "s1", 1, session, &error), STORE_OK, &error);
    return store;
}

static struct store *begin(const char *path, struct fixture_session *session)
{
    return begin_sized(path, &(struct store_desc){.gaze_capacity = 4096, .log_capacity = 4096}, session);
}

static void flush(struct store *store)
{
    struct store_error error;
    expect_result(store_flush(store, &error), STORE_OK, &error);
}

static void expect_text(const char *path, const char *sql, const char *wanted)
{
    char *text = query_text(path, sql);
    assert_string_equal(text, wanted);
    free(text);
}

static void test_rows(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    struct fixture_session session;
    struct store *store = begin(path, &session);
    struct store_gaze gaze = fixture_gaze(&session, 3);
    assert_int_equal(store_push_gaze(store, &gaze), 1);
    gaze.sample.eye = GAZE_LEFT;
    gaze.sample.valid = false;
    gaze.sample.x_deg = gaze.sample.y_deg = gaze.sample.confidence = NAN;
    gaze.trial_id = 0;
    assert_int_equal(store_push_gaze(store, &gaze), 2);
    struct store_frame frame = fixture_frame(&session, 1, 1);
    assert_true(store_push_frame(store, &frame));
    char effective[] = "{\"foveated\":false}";
    frame = (struct store_frame){.session_id = session.ids.session_id,
                                 .segment_id = session.ids.segment_id,
                                 .number = 2,
                                 .phase = STORE_FADE,
                                 .fade_level = 1,
                                 .gpu_us = 7.25,
                                 .present_ns = 99,
                                 .present_estimated = true,
                                 .late = true,
                                 .gaze_age_us = NAN,
                                 .fovea_deg = {{NAN, NAN}, {NAN, NAN}},
                                 .effective = effective,
                                 .target_m = 2.5,
                                 .shaded_px = STORE_UNKNOWN,
                                 .triangles = STORE_UNKNOWN};
    assert_true(store_push_frame(store, &frame));
    memset(effective, 'x', sizeof effective - 1); // copied, not borrowed
    assert_true(store_push_exposure(store, &(struct store_exposure){1, session.ids.segment_id, 1, STORE_B, 10,
                                                                    40, STORE_UNKNOWN, STORE_UNKNOWN}));
    assert_true(
        store_push_event(store, &(struct store_event){1, session.ids.segment_id, 0, 5, "toggle", NULL}));
    assert_true(store_push_adjust_step(
        store, &(struct store_adjust_step){1, session.ids.segment_id, 6, "epsilon", .1}));
    flush(store);
    expect_text(path,
                "SELECT group_concat(coalesce(quote(x_deg), '-') || quote(y_deg) || eye || valid || "
                "quote(pupil_mm) || quote(confidence) || quote(trial_id) || host_ns, ' ') FROM gaze",
                "0.75-1.5both1NULL0.91"
                "3000005 NULLNULLleft0NULLNULLNULL3000005\n");
    expect_text(
        path,
        "SELECT fovea || ' ' || head_pose || ' ' || fovea_source || quote(effective) || gaze_id || "
        "option || condition_id || phase || quote(gpu_us) || cpu_us || quote(present_ns) || shaded_px || "
        "'/' || triangles || quote(target_x_deg) || attempt || quote(target_m) FROM frame WHERE number = 1",
        "{\"left\":[1.5,-2.0],\"right\":[1.25,-2.0]} {\"position\":[1.0,1.6,-2.0],\"orientation\":"
        "[0.0,0.0,0.0,1.0]} gazeNULL1a2stimulusNULL150.5NULL12345/678NULL1NULL\n");
    expect_text(
        path,
        "SELECT quote(fovea) || quote(head_pose) || quote(fovea_source) || effective || quote(gaze_id) || "
        "quote(option) || quote(condition_id) || phase || gpu_us || present_ns || present_estimated || late "
        "|| quote(shaded_px) || quote(attempt) || quote(trial_id) || quote(gaze_age_us) || target_m "
        "FROM frame WHERE number = 2",
        "NULLNULLNULL{\"foveated\":false}NULLNULLNULLfade7.259911NULLNULLNULLNULL2.5\n");
    expect_text(path, "SELECT option || start_ns || quote(full_start_ns) FROM exposure", "b10NULL\n");
    expect_text(path, "SELECT kind || quote(detail) FROM event", "toggleNULL\n");
    expect_text(path, "SELECT parameter || value FROM adjust_step", "epsilon0.1\n");
    fixture_close(store);
    // Numbers go on where the file ends.
    store = fixture_open(path, STORE_WRITE);
    assert_int_equal(store_push_gaze(store, &gaze), 3);
    fixture_close(store);
    assert_int_equal(query(path, "SELECT max(id) FROM gaze"), 3); // closing flushes
    expect_sound(path);
}

static void test_before_the_answer(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    struct fixture_session session;
    struct store *store = begin(path, &session);
    struct store_error error;
    int64_t id = 0;
    for (int trial = 0; trial < FIXTURE_TRIALS; trial++) {
        struct store_gaze gaze = fixture_gaze(&session, trial);
        for (int i = 0; i < 100; i++)
            store_push_gaze(store, &gaze);
        struct store_choice choice = fixture_choice(&session, trial);
        expect_result(store_answer_choice(store, &choice, &id, &error), STORE_OK, &error);
        assert_int_equal(query(path, "SELECT count(*) FROM gaze"), 100 * (trial + 1));
    }
    fixture_close(store);
}

static void test_within_a_second(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    struct fixture_session session;
    struct store *store = begin_sized(path, &(struct store_desc){0}, &session);
    struct store_gaze gaze = fixture_gaze(&session, 1);
    store_push_gaze(store, &gaze);
    usleep(900000);
    assert_int_equal(query(path, "SELECT count(*) FROM gaze"), 1);
    fixture_close(store);
    // A queue that fills up does not wait for the interval's end.
    store = store_open(&(struct store_desc){.path = path, .flush_ms = 1000, .gaze_capacity = 64}, NULL);
    for (int i = 0; i < 40; i++)
        store_push_gaze(store, &gaze);
    usleep(300000);
    assert_int_equal(query(path, "SELECT count(*) FROM gaze"), 41);
    fixture_close(store);
}

static void test_overflow(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    struct fixture_session session;
    struct store_error error;
    struct store *store = begin_sized(
        path, &(struct store_desc){.gaze_capacity = 8, .log_capacity = 4, .busy_ms = 10, .flush_ms = 20},
        &session);
    sqlite3 *other = NULL;
    assert_int_equal(sqlite3_open(path, &other), 0);
    assert_int_equal(sqlite3_exec(other, "BEGIN IMMEDIATE", NULL, NULL, NULL), 0);
    for (int i = 0; i < 20; i++) {
        struct store_gaze gaze = fixture_gaze(&session, i);
        assert_int_equal(store_push_gaze(store, &gaze), i < 8 ? i + 1 : 0);
        struct store_frame frame = fixture_frame(&session, (uint64_t)i, 0);
        assert_int_equal(store_push_frame(store, &frame), i < 4);
    }
    usleep(200000); // the writer tries, and fails
    struct store_status status;
    store_status(store, &status);
    assert_true(status.failing);
    expect_sentence(&status.error, "locked");
    assert_int_equal(status.gaze_pushed, 8);
    assert_int_equal(status.gaze_dropped, 12);
    assert_int_equal(status.log_dropped, 16);
    assert_int_equal(status.gaze_committed, 0);
    assert_int_equal(sqlite3_exec(other, "COMMIT", NULL, NULL, NULL), 0);
    sqlite3_close(other);
    flush(store);
    store_status(store, &status);
    assert_false(status.failing);
    assert_int_equal(status.gaze_committed, 8);
    assert_int_equal(status.log_committed, 4);
    expect_text(
        path, "SELECT kind || at_ns || session_id || detail FROM event",
        "log_overflow444444441{\"gaze\":12,\"frame\":16,\"exposure\":0,\"event\":0,\"adjust_step\":0}\n");
    // Reported once; ids have no gap; texts that are too long count as well.
    struct store_gaze gaze = fixture_gaze(&session, 1);
    assert_int_equal(store_push_gaze(store, &gaze), 9);
    char text[STORE_DETAIL_SIZE + 1];
    memset(text, 'x', STORE_DETAIL_SIZE);
    text[STORE_DETAIL_SIZE] = '\0';
    struct store_event event = {1, 1, 0, 77, "note", text};
    assert_false(store_push_event(store, &event));
    text[STORE_DETAIL_SIZE - 1] = '\0';
    assert_true(store_push_event(store, &event));
    flush(store);
    expect_text(path, "SELECT kind || at_ns || ' ' || length(detail) FROM event WHERE id > 1",
                "note77 255\nlog_overflow77 59\n");
    assert_int_equal(query(path, "SELECT json_extract(detail, '$.event') FROM event WHERE id = 3"), 1);
    expect_result(store_close(store, &error), STORE_OK, &error);
    assert_int_equal(query(path, "SELECT count(*) FROM gaze"), 9);
}

static void test_refused_rows(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    struct fixture_session session;
    struct store_error error;
    int64_t id = 0;
    struct store *store = begin(path, &session);
    for (int i = 1; i <= 5; i++) {
        struct store_gaze gaze = fixture_gaze(&session, i);
        if (i == 2)
            gaze.sample.confidence = 1.5;
        if (i == 3)
            gaze.sample.eye = (enum gaze_eye)9;
        if (i == 4)
            gaze.segment_id = 99; // there is no segment to report it in
        store_push_gaze(store, &gaze);
    }
    struct store_frame frame = fixture_frame(&session, 1, 5);
    frame.effective = "{";
    assert_true(store_push_frame(store, &frame));
    frame.effective = NULL;
    assert_true(store_push_frame(store, &frame));
    // They do not stop the answer, nor the rows beside them.
    struct store_choice choice = fixture_choice(&session, 0);
    expect_result(store_answer_choice(store, &choice, &id, &error), STORE_OK, &error);
    struct store_status status;
    store_status(store, &status);
    assert_int_equal(status.refused, 4);
    expect_text(path, "SELECT group_concat(id) FROM gaze", "1,5\n");
    assert_int_equal(query(path, "SELECT count(*) FROM frame"), 1);
    expect_text(path, "SELECT kind || json_extract(detail, '$.table') || at_ns FROM event ORDER BY id",
                "log_refusedgaze2000005\nlog_refusedgaze3000005\nlog_refusedframe11111111\n");
    // A refused answer takes no log row with it.
    struct store_gaze gaze = fixture_gaze(&session, 6);
    store_push_gaze(store, &gaze);
    expect_result(store_answer_choice(store, &choice, &id, &error), STORE_REFUSED, &error);
    flush(store);
    assert_int_equal(query(path, "SELECT count(*) FROM gaze WHERE id = 6"), 1);
    fixture_close(store);
}

// The same pushes give the same rows and ids, whenever the writer happens to commit.
static void test_deterministic(void **state)
{
    struct fixture *fixture = *state;
    static const char dump[] =
        "SELECT quote(id) || quote(number) || quote(gaze_id) || quote(start_ns) || fovea FROM frame UNION ALL "
        "SELECT quote(id) || quote(trial_id) || quote(device_ns) || quote(x_deg) FROM gaze UNION ALL "
        "SELECT quote(id) || kind || quote(at_ns) FROM event UNION ALL "
        "SELECT quote(id) || quote(trial_id) || quote(answered_ns) FROM choice";
    char *first = NULL;
    for (int run = 0; run < 3; run++) {
        char path[128];
        snprintf(path, sizeof path, "%s/run%d.db", fixture->folder, run);
        struct fixture_session session;
        struct store *store = begin_sized(
            path, &(struct store_desc){.flush_ms = run == 1 ? 1 : 1000, .gaze_capacity = run == 2 ? 2048 : 0},
            &session);
        for (int i = 0; i < 2000; i++) {
            struct store_gaze gaze = fixture_gaze(&session, i);
            int64_t gaze_id = store_push_gaze(store, &gaze);
            struct store_frame frame = fixture_frame(&session, (uint64_t)i, gaze_id);
            if (i % 11 == 0)
                assert_true(store_push_frame(store, &frame));
            struct store_event event = {1, 1, 0, i, "toggle", NULL};
            if (i % 100 == 0)
                assert_true(store_push_event(store, &event));
            struct store_choice choice = fixture_choice(&session, i / 250);
            int64_t id = 0;
            struct store_error error;
            if (i % 250 == 0)
                expect_result(store_answer_choice(store, &choice, &id, &error), STORE_OK, &error);
            if (run == 1 && i % 100 == 0)
                usleep(2000);
        }
        fixture_close(store);
        char *text = query_text(path, dump);
        if (first)
            assert_string_equal(text, first);
        else
            first = strdup(text);
        free(text);
    }
    free(first);
}

struct pusher {
    struct store *store;
    const struct fixture_session *session;
    int count;
    pthread_t thread;
};

static void *push_gaze(void *argument)
{
    struct pusher *pusher = argument;
    for (int i = 0; i < pusher->count; i++) {
        struct store_gaze gaze = fixture_gaze(pusher->session, i);
        while (store_push_gaze(pusher->store, &gaze) == 0)
            usleep(1000);
    }
    return NULL;
}

static void *push_frames(void *argument)
{
    struct pusher *pusher = argument;
    for (int i = 0; i < pusher->count; i++) {
        struct store_frame frame = fixture_frame(pusher->session, (uint64_t)i, 0);
        while (!store_push_frame(pusher->store, &frame))
            usleep(1000);
        struct store_status status;
        store_status(pusher->store, &status);
    }
    return NULL;
}

static void test_threads(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    struct fixture_session session;
    struct store *store = begin_sized(
        path, &(struct store_desc){.gaze_capacity = 256, .log_capacity = 64, .flush_ms = 5}, &session);
    struct pusher pushers[3];
    for (int i = 0; i < 3; i++) {
        pushers[i] = (struct pusher){.store = store, .session = &session, .count = i < 2 ? 4000 : 2000};
        assert_int_equal(pthread_create(&pushers[i].thread, NULL, i < 2 ? push_gaze : push_frames, &pushers[i]),
                         0);
    }
    struct store_error error;
    int64_t id = 0;
    for (int trial = 0; trial < FIXTURE_TRIALS; trial++) {
        struct store_choice choice = fixture_choice(&session, trial);
        expect_result(store_answer_choice(store, &choice, &id, &error), STORE_OK, &error);
        usleep(3000);
    }
    for (int i = 0; i < 3; i++)
        pthread_join(pushers[i].thread, NULL);
    fixture_close(store);
    assert_int_equal(query(path, "SELECT count(*) FROM gaze"), 8000);
    assert_int_equal(query(path, "SELECT max(id) FROM gaze"), 8000);
    assert_int_equal(query(path, "SELECT count(DISTINCT number) FROM frame"), 2000);
    assert_int_equal(query(path, "SELECT count(*) FROM choice"), FIXTURE_TRIALS);
    // What was dropped while a queue was full (and pushed again) stands in the events.
    int64_t reported = query(path, "SELECT coalesce(sum(json_extract(detail, '$.gaze')), 0) FROM event");
    assert_true(reported >= 0);
    expect_sound(path);
}

static double now_s(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static long resident_pages(void)
{
    long size = 0, resident = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (file && fscanf(file, "%ld %ld", &size, &resident) != 2)
        resident = 0;
    if (file)
        fclose(file);
    return resident;
}

// A frame loop that never sleeps: as fast as the queue takes it, throttled only where the queue is half full.
static void push_timed(struct store *store, const struct fixture_session *session, int count, double *out_s)
{
    struct store_status status;
    for (int i = 0; i < count; i++) {
        struct store_gaze gaze = fixture_gaze(session, i);
        struct store_frame frame = fixture_frame(session, (uint64_t)i, 0);
        double start = now_s();
        bool taken = i % 11 ? store_push_gaze(store, &gaze) != 0 : store_push_frame(store, &frame);
        out_s[i] = now_s() - start;
        assert_true(taken);
        if (i % 1000 == 0)
            do {
                store_status(store, &status);
                usleep(status.gaze_pushed - status.gaze_committed > 30000 ? 1000 : 0);
            } while (status.gaze_pushed - status.gaze_committed > 30000);
    }
}

static void test_latency_and_memory(void **state)
{
    enum { PUSHES = 300000, WARM_UP = 100000 };
    const char *path = ((struct fixture *)*state)->path;
    struct fixture_session session;
    struct store *store = begin_sized(path, &(struct store_desc){.flush_ms = 100}, &session);
    double *seconds = malloc(PUSHES * sizeof *seconds);
    memset(seconds, 1, PUSHES * sizeof *seconds);
    push_timed(store, &session, WARM_UP, seconds);
    flush(store);
    long before = resident_pages();
    push_timed(store, &session, PUSHES, seconds);
    flush(store);
    long after = resident_pages();
    fixture_close(store);
    qsort(seconds, PUSHES, sizeof *seconds, by_value);
    double p99 = seconds[PUSHES / 100 * 99];
    printf("push: median %.2f us, p99 %.2f us, p99.9 %.2f us, worst %.0f us; resident %ld -> %ld pages\n",
           1e6 * seconds[PUSHES / 2], 1e6 * p99, 1e6 * seconds[PUSHES / 1000 * 999], 1e6 * seconds[PUSHES - 1],
           before, after);
    free(seconds);
    assert_int_equal(query(path, "SELECT (SELECT count(*) FROM gaze) + (SELECT count(*) FROM frame)"),
                     WARM_UP + PUSHES);
    assert_int_equal(query(path, "SELECT count(*) FROM event"), 0);
    if (!INSTRUMENTED) {
        assert_true(p99 <= 1e-4); // DESIGN: a push never makes the render thread wait
        assert_true((double)after <= 1.01 * (double)before); // memory grows less than 1 %
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_rows, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_before_the_answer, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_within_a_second, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_overflow, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_refused_rows, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_deterministic, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_threads, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_latency_and_memory, fixture_setup_disk, fixture_teardown),
    };
    return cmocka_run_group_tests_name("studies/store log", tests, NULL, NULL);
}
