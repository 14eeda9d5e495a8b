// `fovstudy run`: joins protocol, display, renderer, gaze and store, and runs one session.
#include "app/fovstudy/commands.h"
#include "app/fovstudy/run_session.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

static bool prepare(struct run *run, char *error, size_t error_size)
{
    const struct run_options *options = &run->options;
    if (strcmp(options->display, "none") == 0 && !run->study.observer.errors[0] &&
        access(options->database, F_OK) != 0) {
        snprintf(error, error_size,
                 "%s: there is no study file to take measured errors from; run one session with --display "
                 "headless first, "
                 "or give --observer sim:errors=FILE",
                 options->database);
        return false;
    }
    if (!run_view_init(&run->view, options, run->study.protocol, error, error_size) ||
        !event_lines_open(&run->lines, options->events, error, error_size) ||
        !run_rows_open(&run->rows, options, &run->study, error, error_size))
        return false;
    return run_open_gaze(run, 0, error, error_size) && run_find_errors(run, error, error_size) &&
           run_rows_create(&run->rows, options, &run->study, &run->view, error, error_size) &&
           run_rows_reference(&run->rows, &run->study, error, error_size) &&
           run_make_stage(run, error, error_size);
}

int command_run(int argc, char **argv)
{
    static const struct run empty;
    struct run run = empty;
    char error[RUN_ERROR] = "";
    run.lines.file = -1;
    int status = run_options_read(&run.options, false, argc, argv);
    if (status >= 0)
        return status;
    enum session_result result = SESSION_FAILED;
    if (run_study_init(&run.study, &run.options, error, sizeof error) && prepare(&run, error, sizeof error))
        result = run_go(&run, NULL, error, sizeof error);
    return run_close(&run, result, error);
}
