// `fovstudy resume`: goes on with a session where an interruption left it.
#include "app/command/options.h"
#include "app/fovstudy/commands.h"
#include "app/fovstudy/resume_check.h"
#include "app/fovstudy/run_session.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// EXIT_DONE where there is nothing to do, EXIT_FAILED after a sentence, -1 to go on.
static int find_session(struct run *run, struct store_session_start *start, char *error, size_t error_size)
{
    struct store_error why;
    const struct run_options *options = &run->options;
    run->rows.store = store_open(&(struct store_desc){.path = options->database, .access = STORE_WRITE}, &why);
    if (!run->rows.store || store_find_session(run->rows.store, options->session, start, &why) != STORE_OK) {
        snprintf(error, error_size, "%s", why.text);
        return EXIT_FAILED;
    }
    if (!start->session_id && options->session)
        snprintf(error, error_size, "%s: there is no session %" PRId64 " in this file", options->database,
                 options->session);
    else if (!start->session_id)
        snprintf(error, error_size, "%s: there is no session to go on with; begin one with fovstudy run",
                 options->database);
    else if (strcmp(start->status, "complete") == 0)
        printf("session %" PRId64 " of participant %s is complete; there is nothing to go on with\n",
               start->session_id, start->code);
    else if (strcmp(start->status, "aborted") == 0)
        snprintf(error, error_size,
                 "%s: the participant ended session %" PRId64 "; it is not gone on with: fovstudy run --again "
                 "begins another",
                 options->database, start->session_id);
    else
        return -1;
    return start->session_id && strcmp(start->status, "complete") == 0 ? EXIT_DONE : EXIT_FAILED;
}

// How long nobody wrote; -1: not known, as across a reboot or with a simulated clock.
static int64_t gap_ns(const struct run *run, const struct store_session_start *start,
                      const struct store_segment *segment)
{
    bool same_clock = segment->boot_id && strcmp(segment->boot_id, start->last_boot_id) == 0;
    int64_t gap = run->rows.origin_ns - start->last_clock_ns;
    return same_clock && gap >= 0 ? gap : -1;
}

// Times that people read come from the wall clock; the order of rows does not.
static void warn_of_wall_clock(const struct store_session_start *start, const char *now)
{
    if (strcmp(now, start->started_at) < 0)
        fprintf(stderr,
                "fovstudy: the computer's clock (%s) is before the session's start (%s); set it right\n", now,
                start->started_at);
}

// The segment and its gap: what is written before the first frame.
static bool begin_segment(struct run *run, const struct store_session_start *start, char *error,
                          size_t error_size)
{
    struct run_words words;
    struct store_error why;
    char detail[STORE_DETAIL_SIZE], lasted[32] = "null";
    struct run_rows *rows = &run->rows;
    struct store_segment segment = run_rows_segment(rows, &run->view, "resume", &words);
    int64_t gap = gap_ns(run, start, &segment);
    uint32_t next = 0;
    const uint32_t places = rows->plan->trial_count + rows->repeat_count;
    while (next < places && rows->done[next])
        next++;
    if (gap >= 0)
        snprintf(lasted, sizeof lasted, "%" PRId64, gap);
    snprintf(detail, sizeof detail,
             "\"reason\":\"resume\",\"session\":%" PRId64 ",\"segment\":%" PRId64 ",\"answered\":%" PRIu32
             ",\"of\":%" PRIu32 ",\"attempts\":%" PRIu32 ",\"ns\":%s",
             start->session_id, start->segments + 1, rows->done_count, rows->plan->trial_count,
             next < places ? rows->attempts[next] : 0, lasted);
    char json[STORE_DETAIL_SIZE + 2];
    snprintf(json, sizeof json, "{%s}", detail);
    warn_of_wall_clock(start, words.now);
    rows->ids.session_id = start->session_id;
    rows->ids.participant_id = start->participant_id;
    rows->ids.protocol_id = start->protocol_id;
    if (store_resume_session(rows->store, start->session_id, &segment, json, &rows->ids.segment_id, &why) !=
        STORE_OK) {
        snprintf(error, error_size, "%s", why.text);
        return false;
    }
    if (event_line(&run->lines, "gap", 0, detail))
        return true;
    snprintf(error, error_size,
             "the events file cannot be written; nothing is lost: free some space and go on");
    return false;
}

static bool prepare(struct run *run, const struct store_session_start *start, char **out_difference,
                    char *error, size_t error_size)
{
    const struct run_options *options = &run->options;
    return resume_protocol_file(options, start, out_difference, error, error_size) &&
           run_study_init_stored(&run->study, options, start, error, error_size) &&
           resume_attributes(run->study.protocol, options, start, error, error_size) &&
           run_rows_plan(&run->rows, run->study.protocol, start->seed, start->number, error, error_size) &&
           resume_plan(&run->rows, start, error, error_size) &&
           run_view_init(&run->view, options, run->study.protocol, error, error_size) &&
           resume_view(&run->view, start, error, error_size) &&
           event_lines_open(&run->lines, options->events, options->database, error, error_size) &&
           run_open_gaze(run, start->segments, error, error_size) && run_find_errors(run, error, error_size) &&
           run_rows_reference(&run->rows, &run->study, error, error_size) &&
           run_make_stage(run, error, error_size) && begin_segment(run, start, error, error_size);
}

static enum session_result go_on(struct run *run, const struct store_session_start *start, char *error,
                                 size_t error_size)
{
    const struct machine_start from = {.consented = *start->consent_at != '\0',
                                       .done = run->rows.done,
                                       .attempts = run->rows.attempts,
                                       .answers = run->rows.answers,
                                       .outcomes = run->rows.outcomes,
                                       .adjusted = (const double(*)[PROTOCOL_ADJUSTED])run->rows.adjusted,
                                       .repeats = run->rows.repeats,
                                       .repeat_count = run->rows.repeat_count};
    if (isatty(STDERR_FILENO))
        fprintf(stderr,
                "session %" PRId64 " of participant %s goes on after %" PRIu32 " of %" PRIu32 " answers\n",
                start->session_id, start->code, run->rows.done_count, run->rows.plan->trial_count);
    return run_go(run, &from, error, error_size);
}

int command_resume(int argc, char **argv)
{
    static const struct run empty;
    struct run run = empty;
    struct store_session_start start = {0};
    char error[RUN_ERROR] = "", observer[RESUME_OBSERVER], *difference = NULL;
    run.lines.file = -1;
    int status = run_options_read(&run.options, true, argc, argv);
    if (status >= 0)
        return status;
    enum session_result result = SESSION_FAILED;
    status = find_session(&run, &start, error, sizeof error);
    if (status == EXIT_DONE)
        result = SESSION_COMPLETE;
    else if (status < 0 && resume_options(&run.options, &start, observer, error, sizeof error)) {
        run_options_patience(&run.options);
        if (prepare(&run, &start, &difference, error, sizeof error))
            result = go_on(&run, &start, error, sizeof error);
    }
    status = run_close(&run, result, error);
    if (difference)
        fputs(difference, stderr);
    free(difference);
    store_session_start_finish(&start);
    return status;
}
