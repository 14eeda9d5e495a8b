// `fovstudy run`: joins protocol, display, renderer, gaze and store, and runs one session.
#include "app/command/options.h"
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

static int run_one(const struct run_options *options)
{
    static const struct run empty;
    struct run run = empty;
    char error[RUN_ERROR] = "";
    run.options = *options;
    run.lines.file = -1;
    enum session_result result = SESSION_FAILED;
    if (run_study_init(&run.study, &run.options, error, sizeof error) && prepare(&run, error, sizeof error))
        result = run_go(&run, NULL, error, sizeof error);
    return run_close(&run, result, error);
}

// Each as if the program had been started for it alone.
static int run_all(struct run_options *options)
{
    char code[16];
    int status = EXIT_DONE;
    options->participant = code;
    for (uint64_t i = 1; i <= options->participants && status == EXIT_DONE; i++) {
        snprintf(code, sizeof code, "S%03u", (unsigned)i);
        status = run_one(options);
    }
    if (status != EXIT_DONE)
        fprintf(stderr, "fovstudy: stopped at participant %s of %u\n", code, (unsigned)options->participants);
    return status;
}

int command_run(int argc, char **argv)
{
    struct run_options options;
    int status = run_options_read(&options, false, argc, argv);
    if (status >= 0)
        return status;
    return options.participants ? run_all(&options) : run_one(&options);
}
