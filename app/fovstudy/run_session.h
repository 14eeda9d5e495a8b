// The parts of a session that `run` and `resume` share once its rows are there.
//
// Use: study, rows and view made by the command -> run_find_errors, run_make_stage -> run_go -> run_close.
#ifndef APP_FOVSTUDY_RUN_SESSION_H
#define APP_FOVSTUDY_RUN_SESSION_H

#include "app/fovstudy/run_study.h"
#include "app/session/session.h"

struct run {
    struct run_options options;
    struct run_study study;
    struct run_view view;
    struct run_rows rows;
    struct stage *stage;
    struct errors errors;
    const char *specs[PROTOCOL_SCENES]; // what is shown for each scene, for the errors; borrowed
    struct event_lines lines;
    struct desk *desk; // while the session runs on a terminal
};

// Without frames the observer's errors must be known before a session is made.
bool run_find_errors(struct run *run, char *error, size_t error_size);
bool run_make_stage(struct run *run, char *error, size_t error_size);
// Each participant looks around in another way, and after each interruption; `segments`: of the session so far.
bool run_open_gaze(struct run *run, int64_t segments, char *error, size_t error_size);
// `start` NULL: from the beginning.
enum session_result run_go(struct run *run, const struct machine_start *start, char *error, size_t error_size);
// Says how it went, frees all, returns the exit status. `error` is said where the result is SESSION_FAILED.
int run_close(struct run *run, enum session_result result, const char *error);

#endif
