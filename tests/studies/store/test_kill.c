// The program is killed (SIGKILL): between two file operations and in the middle of a write, within commits and
// checkpoints, with the power gone as well, at seeded moments, and while it only logs. What it had acknowledged
// on a pipe must be in the file, and the session goes on with the same trials.
//
// FOVSTUDY_SOAK=N: N seeded points instead of the few that fit every run of the tests.
#include "faulty_vfs.h"
#include "fixture.h"
#include "studies/store/resume.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
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
static void work(const char *path, int pipe_end, const char *vfs, struct faulty_vfs *faulty, int kill_at,
                 uint32_t power_seed)
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
    if (power_seed)
        faulty_vfs_arm_power(faulty, kill_at, power_seed);
    else if (faulty)
        faulty_vfs_arm(faulty, FAULT_KILL, kill_at);
    for (int64_t number = 1;; number++) {
        struct fixture_session session;
        char code[32];
        snprintf(code, sizeof code, "s%d", (int)number);
        if (fixture_create(store, code, number, &session, &error) != STORE_OK)
            _exit(3);
        for (int trial = 0; trial < FIXTURE_TRIALS; trial++) {
            struct acknowledged line = {.trial_id = session.trial_ids[trial]};
            int64_t attempt = 0;
            if (store_start_trial(store, line.trial_id, session.ids.segment_id, 0, &attempt, &error) !=
                STORE_OK)
                _exit(7);
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

struct left {
    int count, done, running;
    bool in_order; // all that is done lies before all that is not
};

static bool take_planned(void *user, const struct store_planned *trial)
{
    struct left *left = user;
    bool done = strcmp(trial->status, "done") == 0, running = strcmp(trial->status, "running") == 0;
    left->in_order = left->in_order && trial->ordinal == ++left->count &&
                     (!done || left->done == trial->ordinal - 1) &&
                     (!running || left->done == trial->ordinal - 1) && trial->attempt == (done || running);
    left->done += done;
    left->running += running;
    return true;
}

// The session that was interrupted goes on behind the last acknowledged answer; at most one more was stored.
static void expect_resumable(struct store *store, const struct acknowledged *last)
{
    struct store_session_start start;
    struct store_error error;
    struct left left = {.in_order = true};
    expect_result(store_find_session(store, 0, &start, &error), STORE_OK, &error);
    if (start.session_id) {
        int64_t before = (start.session_id - 1) * FIXTURE_TRIALS; // trials of the sessions before
        expect_result(store_read_planned(store, start.session_id, take_planned, &left, &error), STORE_OK,
                      &error);
        assert_int_equal(left.count, FIXTURE_TRIALS);
        assert_true(left.in_order && left.running <= 1);
        assert_true(before + left.done == last->choice_id || before + left.done == last->choice_id + 1);
        int64_t segment_id = 0;
        struct store_segment segment = {.started_at = "2026-01-02T03:05:05Z",
                                        .clock = "simulated",
                                        .app_version = "0.1.0",
                                        .reason = "resume"};
        expect_result(store_resume_session(store, start.session_id, &segment, "{}", &segment_id, &error),
                      STORE_OK, &error);
    } else {
        assert_int_equal(last->choice_id, 0);
    }
    store_session_start_finish(&start);
}

// `last`: a line that was read already, or zero.
static void expect_acknowledged(const char *path, int pipe_end, struct acknowledged last, int count,
                                int *out_count, int64_t *slowest_ns)
{
    struct acknowledged line;
    for (; read(pipe_end, &line, sizeof line) == sizeof line; count++)
        last = line;
    // Opened as the program would after the crash, which also brings the log home.
    int64_t start_ns = now_ns();
    struct store *store = fixture_open(path, STORE_WRITE);
    struct store_error error;
    expect_resumable(store, &last);
    int64_t ready_ns = now_ns() - start_ns;
    *slowest_ns = ready_ns > *slowest_ns ? ready_ns : *slowest_ns;
    assert_true(ready_ns < (INSTRUMENTED ? 10 : 2) * (int64_t)1000000000);
    expect_result(store_check(store, &error), STORE_OK, &error);
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
    int64_t slowest_ns = 0;
    for (int n = 1; n <= 160; n += 5, points++) {
        unlink(fixture->path);
        int ends[2];
        assert_int_equal(pipe(ends), 0);
        pid_t child = fork();
        if (child == 0) {
            struct faulty_vfs faulty;
            faulty_vfs_register(&faulty, "faulty");
            work(fixture->path, ends[1], "faulty", &faulty, n, 0);
        }
        close(ends[1]);
        int status = 0;
        waitpid(child, &status, 0);
        assert_true(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
        expect_acknowledged(fixture->path, ends[0], (struct acknowledged){0}, 0, &count, &slowest_ns);
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
    int64_t slowest_ns = 0;
    for (int i = 0; i < 20; i++) {
        random = random * 1664525u + 1013904223u; // Numerical Recipes' generator; only spreads the moments
        unlink(fixture->path);
        int ends[2];
        assert_int_equal(pipe(ends), 0);
        pid_t child = fork();
        if (child == 0)
            work(fixture->path, ends[1], NULL, NULL, 0, 0);
        close(ends[1]);
        // From the first answer on: before it there may be no file yet.
        struct acknowledged first;
        assert_int_equal(read(ends[0], &first, sizeof first), sizeof first);
        usleep((random >> 8) % 40000);
        kill(child, SIGKILL);
        waitpid(child, NULL, 0);
        expect_acknowledged(fixture->path, ends[0], first, 1, &count, &slowest_ns);
        close(ends[0]);
    }
    printf("killed at 20 moments, %d acknowledged answers, none lost\n", count);
}

// One point: the n-th operation (which reaches into the checkpoints, from about the thousandth on), with the
// power cut or not, or a moment while both threads write.
static void kill_at_point(struct fixture *fixture, int point, uint32_t random, int *count, int64_t *slowest_ns)
{
    enum { FIRST_COMMITS = 300, WITH_CHECKPOINTS = 4000 };
    bool moment = point % 4 == 3;
    int n = 1 + (int)(random % (point % 4 == 0 ? FIRST_COMMITS : WITH_CHECKPOINTS));
    uint32_t power_seed = point % 4 == 2 ? random | 1 : 0;
    char shm[160];
    unlink(fixture->path);
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    pid_t child = fork();
    if (child == 0) {
        struct faulty_vfs faulty;
        faulty_vfs_register(&faulty, "faulty");
        if (moment)
            work(fixture->path, ends[1], NULL, NULL, 0, 0);
        work(fixture->path, ends[1], "faulty", &faulty, n, power_seed);
    }
    close(ends[1]);
    struct acknowledged first = {0};
    if (moment) {
        assert_int_equal(read(ends[0], &first, sizeof first), sizeof first);
        usleep(random % 60000);
        kill(child, SIGKILL);
    }
    // Acknowledgements of a long run are more than a pipe holds.
    struct acknowledged line;
    int before = first.choice_id > 0;
    while (read(ends[0], &line, sizeof line) == sizeof line) {
        before++;
        first = line;
    }
    int status = 0;
    waitpid(child, &status, 0);
    assert_true(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
    snprintf(shm, sizeof shm, "%s-shm", fixture->path);
    if (power_seed)
        unlink(shm); // memory does not survive
    expect_acknowledged(fixture->path, ends[0], first, before, count, slowest_ns);
    close(ends[0]);
}

static void test_kill_points(void **state)
{
    enum { POINTS = INSTRUMENTED ? 24 : 100 };
    const char *soak = getenv("FOVSTUDY_SOAK");
    int points = soak ? atoi(soak) : POINTS, count = 0;
    int64_t slowest_ns = 0;
    uint32_t random = 20261125; // the seed
    for (int i = 0; i < points; i++) {
        random = random * 1664525u + 1013904223u;
        kill_at_point(*state, i, random >> 8, &count, &slowest_ns);
    }
    printf("killed at %d points, %d acknowledged answers, none lost; ready after at most %.3f s\n", points,
           count, (double)slowest_ns * 1e-9);
    assert_true(count > points);
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
        cmocka_unit_test_setup_teardown(test_kill_points, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_kill_while_logging, fixture_setup, fixture_teardown),
    };
    return cmocka_run_group_tests_name("studies/store kill", tests, NULL, NULL);
}
