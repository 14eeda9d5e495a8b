// The log under the load of a study: frames at 90 Hz and gaze at 1,000 Hz from threads of their own, many times
// as fast as they come. A push may cost a tenth of a millisecond of wall time in 99 of 100, no row is dropped,
// and memory does not grow.
//
// FOVSTUDY_SOAK set: an hour of it, 324,000 frames and 3.6 million samples, at 20 times its speed.
#include "fixture.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum {
    FRAME_HZ = 90,
    GAZE_HZ = 1000,
    SPEED = INSTRUMENTED ? 5 : 20,
    SHORT_S = INSTRUMENTED ? 20 : 90,
    HOUR_S = 3600
};
enum { TICKS_HZ = 200, COST_BINS = 10000, WARM_ROWS = 36000 };
enum { GAZE_CAPACITY = 65536, LOG_CAPACITY = 16384 }; // the store's defaults
#define BIN_NS 100        // width of a bin: the last one takes all from a millisecond on
#define COST_NS 100000    // of a push, at the 99th percentile
#define GROWTH_SHARE 0.01 // of the resident memory

struct source {
    struct store *store;
    const struct fixture_session *session;
    int64_t count;
    int rate_hz;
    int64_t (*push)(struct source *source, int64_t n);
    uint32_t bins[COST_BINS];
    int64_t dropped, slowest_ns, real_ns; // real_ns: how long the clock was not scaled
    pthread_t thread;
};

static int64_t now_ns(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (int64_t)time.tv_sec * 1000000000 + time.tv_nsec;
}

// Without pages of program files (libc's own come in as its functions are first called).
static int64_t resident_bytes(void)
{
    char line[256];
    long long kib = 0, all = 0;
    FILE *file = fopen("/proc/self/status", "r");
    assert_non_null(file);
    while (fgets(line, sizeof line, file))
        if (sscanf(line, "RssAnon: %lld", &kib) == 1 || sscanf(line, "RssShmem: %lld", &kib) == 1)
            all += kib;
    fclose(file);
    assert_true(all > 0);
    return all * 1024;
}

static int64_t push_frame(struct source *source, int64_t n)
{
    struct store_frame frame = fixture_frame(source->session, (uint64_t)n, 0);
    return store_push_frame(source->store, &frame);
}

static int64_t push_gaze(struct source *source, int64_t n)
{
    struct store_gaze gaze = fixture_gaze(source->session, n);
    return store_push_gaze(source->store, &gaze);
}

static bool crowded(struct store *store)
{
    struct store_status status;
    store_status(store, &status);
    return status.gaze_pushed - status.gaze_committed > GAZE_CAPACITY / 2 ||
           status.log_pushed - status.log_committed > LOG_CAPACITY / 2;
}

// In ticks, since no sleep is as short as a scaled millisecond. Where the disk makes the store wait for
// seconds, its queue must hold what comes in real time: a clock that goes on twenty times as fast would ask for
// twenty times as much, so it then goes at its own speed.
static void *run(void *argument)
{
    struct source *source = argument;
    int64_t last_ns = now_ns(), scaled_ns = 0;
    for (int64_t n = 0; n < source->count;) {
        usleep(1000000 / TICKS_HZ);
        int64_t now = now_ns();
        bool real = crowded(source->store);
        scaled_ns += (now - last_ns) * (real ? 1 : SPEED);
        source->real_ns += real ? now - last_ns : 0;
        last_ns = now;
        int64_t due = scaled_ns / 1000 * source->rate_hz / 1000000;
        for (; n < due && n < source->count; n++) {
            int64_t before_ns = now_ns();
            source->dropped += source->push(source, n) == 0;
            int64_t cost_ns = now_ns() - before_ns;
            int64_t bin = cost_ns / BIN_NS;
            source->bins[bin < COST_BINS ? bin : COST_BINS - 1]++;
            source->slowest_ns = cost_ns > source->slowest_ns ? cost_ns : source->slowest_ns;
        }
    }
    return NULL;
}

static double percentile_us(const struct source *source, double share)
{
    int64_t below = 0;
    int bin = 0;
    while (bin < COST_BINS && (double)(below += source->bins[bin]) < share * (double)source->count)
        bin++;
    return (bin + 1) * BIN_NS * 1e-3;
}

// The rest of a session goes on beside: an answer now and then waits for the disk, a push never. Memory is
// measured once each thing has been done once.
static void answer_meanwhile(struct store *store, const struct fixture_session *session, int64_t run_ns,
                             int64_t *out_before)
{
    struct store_error error;
    for (int trial = 0; trial < FIXTURE_TRIALS; trial++) {
        if (trial == 1)
            *out_before = resident_bytes();
        int64_t id = 0;
        struct store_choice choice = fixture_choice(session, trial);
        expect_result(store_answer_choice(store, &choice, &id, &error), STORE_OK, &error);
        nanosleep(&(struct timespec){.tv_sec = run_ns / FIXTURE_TRIALS / 1000000000,
                                     .tv_nsec = run_ns / FIXTURE_TRIALS % 1000000000},
                  NULL);
    }
}

// SQLite's page cache and the threads' stacks fill once; what counts is what comes after.
static void warm_up(struct store *store, const struct fixture_session *session)
{
    struct store_error error;
    for (int64_t n = 0; n < WARM_ROWS; n++) {
        struct store_gaze gaze = fixture_gaze(session, n);
        struct store_frame frame = fixture_frame(session, (uint64_t)n, 0);
        assert_int_not_equal(store_push_gaze(store, &gaze), 0);
        assert_true(store_push_frame(store, &frame));
        if (n % 12000 == 11999) // more at once than later
            expect_result(store_flush(store, &error), STORE_OK, &error);
    }
    expect_result(store_flush(store, &error), STORE_OK, &error);
}

static void report(const char *name, const struct source *source)
{
    printf("%s: %lld pushes, median %.1f us, p99 %.1f us, p99.9 %.1f us, slowest %.1f us, %lld dropped, %.1f s "
           "at real speed\n",
           name, (long long)source->count, percentile_us(source, 0.5), percentile_us(source, 0.99),
           percentile_us(source, 0.999), (double)source->slowest_ns * 1e-3, (long long)source->dropped,
           (double)source->real_ns * 1e-9);
    assert_int_equal(source->dropped, 0);
    if (!INSTRUMENTED)
        assert_true(percentile_us(source, 0.99) * 1e3 <= COST_NS);
}

static void test_load(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    int64_t seconds = getenv("FOVSTUDY_SOAK") ? HOUR_S : SHORT_S;
    struct store_error error;
    struct store *store = store_open(&(struct store_desc){.path = path, .access = STORE_CREATE}, &error);
    struct fixture_session session;
    struct source *sources = calloc(2, sizeof *sources);
    assert_non_null(store);
    expect_result(fixture_create(store, "s1", 1, &session, &error), STORE_OK, &error);
    sources[0] = (struct source){.store = store,
                                 .session = &session,
                                 .count = FRAME_HZ * seconds,
                                 .rate_hz = FRAME_HZ,
                                 .push = push_frame};
    sources[1] = (struct source){
        .store = store, .session = &session, .count = GAZE_HZ * seconds, .rate_hz = GAZE_HZ, .push = push_gaze};
    warm_up(store, &session);
    int64_t run_ns = seconds * 1000000000 / SPEED, start_ns = now_ns();
    for (int i = 0; i < 2; i++)
        assert_int_equal(pthread_create(&sources[i].thread, NULL, run, &sources[i]), 0);
    int64_t before = 0;
    answer_meanwhile(store, &session, run_ns, &before);
    for (int i = 0; i < 2; i++)
        pthread_join(sources[i].thread, NULL);
    int64_t after = resident_bytes(), took_ns = now_ns() - start_ns;
    fixture_close(store);
    printf("%.1f s for %lld s of a session; resident %.2f MiB, then %.2f MiB\n", (double)took_ns * 1e-9,
           (long long)seconds, (double)before / 1048576, (double)after / 1048576);
    report("frames", &sources[0]);
    report("gaze", &sources[1]);
    if (!INSTRUMENTED)
        assert_true((double)(after - before) <= GROWTH_SHARE * (double)before);
    assert_int_equal(query(path, "SELECT count(*) FROM frame"), sources[0].count + WARM_ROWS);
    assert_int_equal(query(path, "SELECT count(*) FROM gaze"), sources[1].count + WARM_ROWS);
    assert_int_equal(query(path, "SELECT count(*) FROM event"), 0); // no overflow, nothing refused
    free(sources);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_load, fixture_setup_disk, fixture_teardown),
    };
    return cmocka_run_group_tests_name("studies/store load", tests, NULL, NULL);
}
