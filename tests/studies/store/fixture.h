// A folder of its own for every test, a small study to write, and plain SQL to look at what was written.
#ifndef TESTS_STORE_FIXTURE_H
#define TESTS_STORE_FIXTURE_H

#include "studies/store/store.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

// Whether timings mean nothing.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define INSTRUMENTED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define INSTRUMENTED 1
#endif
#endif
#ifndef INSTRUMENTED
#define INSTRUMENTED 0
#endif

enum { FIXTURE_TRIALS = 9, FIXTURE_CONDITIONS = 3 };

struct fixture {
    char folder[64];
    char path[96]; // of the study file, not made yet
};

int fixture_setup(void **state);      // cmocka's: *state is a struct fixture
int fixture_setup_disk(void **state); // on a disk, not in memory
int fixture_teardown(void **state);

// Fails the test with the sentence where the result is another one.
void expect_result(enum store_result result, enum store_result wanted, const struct store_error *error);
void expect_sentence(const struct store_error *error, const char *part);

struct store *fixture_open(const char *path, enum store_access access);
void fixture_close(struct store *store);

struct fixture_session {
    struct store_session_ids ids;
    int64_t condition_ids[FIXTURE_CONDITIONS], trial_ids[FIXTURE_TRIALS];
};

// A session of nine toggle trials. The desc lives as long as `out_parts`.
struct fixture_parts {
    struct store_condition conditions[FIXTURE_CONDITIONS];
    struct store_trial trials[FIXTURE_TRIALS];
};
struct store_session fixture_session(struct fixture_parts *parts, const char *code, int64_t number);
enum store_result fixture_create(struct store *store, const char *code, int64_t number,
                                 struct fixture_session *out_session, struct store_error *error);

struct store_choice fixture_choice(const struct fixture_session *session, int trial);
struct store_gaze fixture_gaze(const struct fixture_session *session, int64_t n);
struct store_frame fixture_frame(const struct fixture_session *session, uint64_t number, int64_t gaze_id);

// The first column of the first row; fails the test where the SQL does.
int64_t query(const char *path, const char *sql);
// The first column of all rows, joined by line ends; caller frees.
char *query_text(const char *path, const char *sql);
// SQLite's code of a statement run on the file by somebody else.
int outsider(const char *path, const char *sql);

// integrity_check and foreign_key_check say nothing.
void expect_sound(const char *path);

#endif
