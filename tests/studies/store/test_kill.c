// The program is killed (SIGKILL): between two file operations and in the middle of a write, at seeded moments,
// and while it only logs. What it had acknowledged on a pipe must be in the file.
#include "faulty_vfs.h"
#include "fixture.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

struct acknowledged {
    int64_t trial_id, choice_id, gaze_id; // gaze_id: the last one pushed before the answer
    int64_t at_ns;
};

static int64_t now_ns(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (int64_t)time.tv_sec * 1000000000 + time.tv_nsec;
}

// In the child: sessions of nine answers without end. An acknowledgement is one write to the pipe.
static void work(const char *path, int pipe_end, const char *vfs, struct faulty_vfs *faulty, int kill_at)
{
    struct store_error error;
    struct store *store = store_open(&(struct store_desc){.path = path,
                                                          .access = STORE_CREATE,
                                                          .gaze_capacity = 4096,
                                                          .log_capacity = 512,
                                                          .flush_ms = vfs ? 1000 : 3,
                                                          .vfs = vfs},
                                     &error);
    if (!store)
        _exit(2);
    if (faulty)
        faulty_vfs_arm(faulty, FAULT_KILL, kill_at);
    for (int64_t number = 1;; number++) {
        struct fixture_session session;
        char code[32];
        snprintf(code, sizeof code, "s%d", (int)number);
        if (fixture_create(store, code, number, &session, &error) != STORE_OK)
            _exit(3);
        for (int trial = 0; trial < FIXTURE_TRIALS; trial++) {
            struct acknowledged line = {.trial_id = session.trial_ids[trial]};
            for (int i = 0; i < 50; i++) {
                struct store_gaze gaze = fixture_gaze(&session, i);
                line.gaze_id = store_push_gaze(store, &gaze);
                struct store_frame frame = fixture_frame(&session, (uint64_t)i, line.gaze_id);
                if (i % 10 == 0 && !store_push_frame(store, &frame))
                    _exit(4);
            }
            struct store_choice choice = fixture_choice(&session, trial);
            if (store_answer_choice(store, &choice, &line.choice_id, &error) != STORE_OK)
                _exit(5);
            if (write(pipe_end, &line, sizeof line) != sizeof line)
                _exit(6);
        }
    }
}

// `last`: a line that was read already, or zero.
static void expect_acknowledged(const char *path, int pipe_end, struct acknowledged last, int *out_count)
{
    // Opened as the program would after the crash, which also brings the log home.
    struct store *store = fixture_open(path, STORE_WRITE);
    struct store_error error;
    expect_result(store_check(store, &error), STORE_OK, &error);
    struct acknowledged line;
    int count = last.choice_id > 0;
    for (; read(pipe_end, &line, sizeof line) == sizeof line; count++)
        last = line;
    // Ids and trials count up, so that the last line stands for all before it.
    char sql[256];
    snprintf(sql, sizeof sql, "SELECT count(*) FROM choice WHERE id <= %lld", (long long)last.choice_id);
    assert_int_equal(query(path, sql), count);
    snprintf(sql, sizeof sql, "SELECT count(*) FROM gaze WHERE id <= %lld", (long long)last.gaze_id);
    assert_int_equal(query(path, sql), last.gaze_id);
    assert_int_equal(query(path, "SELECT count(*) FROM choice AS c JOIN trial AS t ON t.id = trial_id "
                                 "WHERE status <> 'done'"),
                     0);
    assert_int_equal(query(path,
                           "SELECT count(*) FROM session WHERE (SELECT count(*) FROM trial WHERE session_id = "
                           "session.id) <> 9"),
                     0);
    // And the work goes on: the next free number, the next answer.
    int64_t number = 0, id = 0;
    struct fixture_session session;
    expect_result(store_participant_number(store, "next", 0, &number, &error), STORE_OK, &error);
    assert_int_equal(number, query(path, "SELECT count(*) + 1 FROM participant"));
    expect_result(fixture_create(store, "next", number, &session, &error), STORE_OK, &error);
    struct store_choice choice = fixture_choice(&session, 0);
    expect_result(store_answer_choice(store, &choice, &id, &error), STORE_OK, &error);
    fixture_close(store);
    *out_count += count;
}

// At the n-th write, sync, truncation or deletion, the write being torn in half.
static void test_kill_inside(void **state)
{
    struct fixture *fixture = *state;
    int count = 0, points = 0;
    for (int n = 1; n <= 160; n += 5, points++) {
        unlink(fixture->path);
        int ends[2];
        assert_int_equal(pipe(ends), 0);
        pid_t child = fork();
        if (child == 0) {
            struct faulty_vfs faulty;
            faulty_vfs_register(&faulty, "faulty");
            work(fixture->path, ends[1], "faulty", &faulty, n);
        }
        close(ends[1]);
        int status = 0;
        waitpid(child, &status, 0);
        assert_true(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
        expect_acknowledged(fixture->path, ends[0], (struct acknowledged){0}, &count);
        close(ends[0]);
    }
    printf("killed inside %d operations, %d acknowledged answers, none lost\n", points, count);
    assert_true(count > points);
}

// At any moment, the writer thread running.
static void test_kill_anywhere(void **state)
{
    struct fixture *fixture = *state;
    uint32_t random = 20260102; // the seed
    int count = 0;
    for (int i = 0; i < 20; i++) {
        random = random * 1664525u + 1013904223u; // Numerical Recipes' generator; only spreads the moments
        unlink(fixture->path);
        int ends[2];
        assert_int_equal(pipe(ends), 0);
        pid_t child = fork();
        if (child == 0)
            work(fixture->path, ends[1], NULL, NULL, 0);
        close(ends[1]);
        // From the first answer on: before it there may be no file yet.
        struct acknowledged first;
        assert_int_equal(read(ends[0], &first, sizeof first), sizeof first);
        usleep((random >> 8) % 40000);
        kill(child, SIGKILL);
        waitpid(child, NULL, 0);
        expect_acknowledged(fixture->path, ends[0], first, &count);
        close(ends[0]);
    }
    printf("killed at 20 moments, %d acknowledged answers, none lost\n", count);
}

// In the child: logs only, a thousand samples a second, with the defaults.
static void only_log(const char *path, int pipe_end)
{
    struct store *store = store_open(&(struct store_desc){.path = path, .access = STORE_CREATE}, NULL);
    struct fixture_session session;
    struct store_error error;
    if (!store || fixture_create(store, "s1", 1, &session, &error) != STORE_OK)
        _exit(2);
    for (int i = 0;; i++) {
        struct store_gaze gaze = fixture_gaze(&session, i);
        struct acknowledged line = {.gaze_id = store_push_gaze(store, &gaze), .at_ns = now_ns()};
        if (write(pipe_end, &line, sizeof line) != sizeof line)
            _exit(6);
        usleep(1000);
    }
}

static void test_kill_while_logging(void **state)
{
    static const int64_t LOST_NS = INSTRUMENTED ? 2000000000 : 1000000000; // sanitizers slow the writer down
    enum { CHILDREN = 3 };
    struct fixture *fixture = *state;
    char paths[CHILDREN][128];
    int ends[CHILDREN][2];
    pid_t children[CHILDREN];
    int64_t killed_ns[CHILDREN];
    for (int i = 0; i < CHILDREN; i++) {
        snprintf(paths[i], sizeof paths[i], "%s/log%d.db", fixture->folder, i);
        assert_int_equal(pipe(ends[i]), 0);
        children[i] = fork();
        if (children[i] == 0)
            only_log(paths[i], ends[i][1]);
        close(ends[i][1]);
    }
    struct acknowledged line;
    for (int i = 0; i < CHILDREN; i++) // all have begun
        assert_int_equal(read(ends[i][0], &line, sizeof line), sizeof line);
    usleep((useconds_t)(LOST_NS / 1000 + 200000));
    for (int i = 0; i < CHILDREN; i++) {
        usleep(130000); // another phase of the interval each
        killed_ns[i] = now_ns();
        kill(children[i], SIGKILL);
        waitpid(children[i], NULL, 0);
    }
    for (int i = 0; i < CHILDREN; i++) {
        int64_t due = 0, pushed = 0;
        for (; read(ends[i][0], &line, sizeof line) == sizeof line; pushed = line.gaze_id)
            if (line.at_ns < killed_ns[i] - LOST_NS)
                due = line.gaze_id;
        close(ends[i][0]);
        int64_t found = query(paths[i], "SELECT count(*) FROM gaze");
        printf("pushed %d, older than a second %d, found %d\n", (int)pushed, (int)due, (int)found);
        assert_true(due > 0 && found >= due && found <= pushed + 1);
        expect_sound(paths[i]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_kill_inside, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_kill_anywhere, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_kill_while_logging, fixture_setup, fixture_teardown),
    };
    return cmocka_run_group_tests_name("studies/store kill", tests, NULL, NULL);
}
