// `fovstudy run`: joins protocol, display, renderer, gaze and store, and runs one session.
#include "app/command/options.h"
#include "app/fovstudy/check_scenes.h"
#include "app/fovstudy/commands.h"
#include "app/fovstudy/run_file.h"
#include "app/fovstudy/run_session.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// What is bound, or stands in, is looked at where nothing is drawn too: it names the errors and the session.
static bool scenes_are_there(const struct run_options *options, const struct protocol *protocol, char *error,
                             size_t error_size)
{
    struct text remarks = {0}; // for `check`
    bool ok = check_scenes(options->protocol, protocol, options->scenes, options->scene_count, false, &remarks,
                           error, error_size);
    free(text_take(&remarks));
    return ok;
}

static bool prepare(struct run *run, char *error, size_t error_size)
{
    const struct run_options *options = &run->options;
    if (!scenes_are_there(options, run->study.protocol, error, error_size))
        return false;
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
        !event_lines_open(&run->lines, options->events, options->database, error, error_size) ||
        !run_rows_open(&run->rows, options, &run->study, error, error_size) ||
        (!options->new_protocol && !run_file_protocol(options, run->study.protocol, error, error_size)))
        return false;
    run_file_remark(options, run->study.protocol, &run->view);
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
    int status = run_close(&run, result, error);
    return run.study.wrong_usage ? EXIT_USAGE : status;
}

// Finds who is complete in this protocol, with a sentence; EXIT_DONE where the run may go on.
static int pass_over(const struct run_options *options, bool out_complete[RUN_PARTICIPANTS + 1])
{
    struct run_study study;
    char error[RUN_ERROR] = "";
    bool ok = run_study_init(&study, options, error, sizeof error) &&
              scenes_are_there(options, study.protocol, error, sizeof error) &&
              (options->new_protocol || access(options->database, F_OK) != 0 ||
               run_file_protocol(options, study.protocol, error, sizeof error));
    uint64_t complete =
        ok && !options->again ? run_file_complete(options, study.protocol->sha256_hex, out_complete) : 0;
    int status = ok ? EXIT_DONE : study.wrong_usage ? EXIT_USAGE : EXIT_FAILED;
    run_study_finish(&study);
    if (!ok)
        fprintf(stderr, "fovstudy: %s\n", error);
    else if (complete > 0)
        fprintf(stderr, "fovstudy: %" PRIu64 " of %" PRIu64 " participants are complete and passed over\n",
                complete, options->participants);
    return status;
}

// Each as if the program had been started for it alone; those who are complete stay as they are, so that the
// same line goes on where it was stopped.
static int run_all(struct run_options *options)
{
    char code[RUN_CODE];
    bool complete[RUN_PARTICIPANTS + 1] = {false};
    int status = pass_over(options, complete);
    if (status != EXIT_DONE)
        return status;
    options->participant = code;
    for (uint64_t i = 1; i <= options->participants && status == EXIT_DONE; i++) {
        run_file_code(i, code);
        if (!complete[i])
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
