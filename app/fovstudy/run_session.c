#include "app/fovstudy/run_session.h"

#include "app/command/options.h"
#include "app/fovstudy/rules.h"

#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

// Where the session is, unless the experimenter's panel says so. The options are named only with --unblind.
static void progress(void *user, const struct machine_view *view)
{
    const struct run *run = user;
    bool terminal = isatty(STDERR_FILENO);
    if (run->desk)
        return;
    if (terminal)
        fprintf(stderr, "\r\033[K%" PRIu32 " of %" PRIu32 " answered, %s", view->done, view->total,
                machine_screen_name(view->screen));
    if (run->options.unblind && view->screen == MACHINE_STIMULUS && view->trial) {
        const struct plan *plan = run->rows.plan;
        for (int slot = 0; slot < 2; slot++) {
            int32_t condition = view->trial->option[slot];
            if (condition >= 0)
                fprintf(stderr, "%strial %" PRIu32 " %s: %s %s\n", terminal && slot == 0 ? "\n" : "",
                        view->trial->ordinal, plan_slot_name((enum plan_slot)slot),
                        plan->conditions[condition].mode, plan->conditions[condition].parameters);
        }
    }
    if (terminal && view->screen == MACHINE_END)
        fprintf(stderr, "\n");
}

bool run_make_stage(struct run *run, char *error, size_t error_size)
{
    struct mode_choice reference;
    run_reference(run->study.protocol, &reference);
    struct stage_desc desc = {
        .renderer = run->view.renderer,
        .plan = run->rows.plan,
        .scenes = run->view.scenes,
        .scene_count = run->view.scene_count,
        .fov = run->view.fov,
        .ipd_m = VIEWING_DEFAULT_IPD_M,
        .reference = run->options.observer ? &reference : NULL,
        .moving_setting = STUDY_MOVING_OBJECTS,
        .ssao_setting = STUDY_SSAO,
        .taa_setting = STUDY_TAA,
    };
    if (!run->view.display)
        return true;
    run->stage = stage_create(&desc);
    if (!run->stage)
        snprintf(error, error_size, "out of memory");
    return run->stage != NULL;
}

bool run_find_errors(struct run *run, char *error, size_t error_size)
{
    if (run->view.display)
        return true;
    const struct protocol *protocol = run->study.protocol;
    for (uint32_t i = 0; i < protocol->scene_count; i++)
        run->specs[i] = study_shown_scene(protocol, i, run->options.scenes, run->options.scene_count);
    return run_rows_reference(&run->rows, &run->study, error, error_size) &&
           errors_init(&run->errors, run->rows.plan, run->rows.store, run->rows.reference_id, run->specs,
                       run->study.observer.errors, error, error_size);
}

bool run_open_gaze(struct run *run, int64_t segments, char *error, size_t error_size)
{
    uint64_t seed = run->rows.plan->seed * 1000003u + observer_subject(run->options.participant);
    seed +=
        (uint64_t)segments * 0x9e3779b97f4a7c15u; // 2^64 over the golden ratio: far from other participants'
    return run_view_gaze(&run->view, &run->options, seed, error, error_size);
}

static void say(void *user, const char *sentence)
{
    const struct run *run = user;
    if (run->desk)
        desk_say(run->desk, sentence);
    else
        fprintf(stderr, "%sfovstudy: %s\n", isatty(STDERR_FILENO) ? "\r\033[K" : "", sentence);
}

static void note_options(const struct run *run)
{
    if (run->options.again)
        store_push_event(run->rows.store,
                         &(struct store_event){.session_id = run->rows.ids.session_id,
                                               .segment_id = run->rows.ids.segment_id,
                                               .at_ns = 0,
                                               .kind = "again",
                                               .detail = "--again: a further session was asked for"});
    if (run->options.new_protocol)
        store_push_event(run->rows.store,
                         &(struct store_event){.session_id = run->rows.ids.session_id,
                                               .segment_id = run->rows.ids.segment_id,
                                               .at_ns = 0,
                                               .kind = "new_protocol",
                                               .detail = "--new-protocol: another protocol was asked for"});
    if (run->options.unblind)
        store_push_event(run->rows.store,
                         &(struct store_event){.session_id = run->rows.ids.session_id,
                                               .segment_id = run->rows.ids.segment_id,
                                               .at_ns = 0,
                                               .kind = "unblind",
                                               .detail = "the options were named on the terminal"});
}

// A session that failed may go on; its rules are applied when it ends, or by `fovstudy exclude`.
static void apply_rules(const struct run *run)
{
    char why[RUN_ERROR] = "";
    if (!rules_end_session(run->rows.store, run->options.database, run->study.protocol, &run->rows.ids, why,
                           sizeof why))
        fprintf(stderr, "fovstudy: the exclusion rules are not applied yet (%s); fovstudy exclude does it\n",
                why);
}

enum session_result run_go(struct run *run, const struct machine_start *start, char *error, size_t error_size)
{
    const struct run_options *options = &run->options;
    struct session_desc desc = {
        .plan = run->rows.plan,
        .store = run->rows.store,
        .ids = &run->rows.ids,
        .reference_id = run->rows.reference_id,
        .start = start,
        .origin_ns = run->rows.origin_ns,
        .lines = &run->lines,
        .display = run->view.display,
        .renderer = run->view.renderer,
        .stage = run->stage,
        .scenes = run->view.scenes,
        .scene_count = run->view.scene_count,
        .fov = run->view.fov,
        .ipd_m = VIEWING_DEFAULT_IPD_M,
        .gaze = run->view.gaze,
        .observer = options->observer ? &run->study.observer : NULL,
        .observer_subject = observer_subject(options->participant),
        .errors = &run->errors,
        .step_hz = run_step_hz(options),
        .progress = progress,
        .progress_user = run,
        .say = say,
        .say_user = run,
        .preflight = options->no_preflight ? SESSION_PREFLIGHT_NEVER
                     : options->preflight  ? SESSION_PREFLIGHT_ALWAYS
                                           : SESSION_PREFLIGHT_REAL,
        .preflight_frames = (uint32_t)options->preflight,
        .playback_bytes = options->playback_mb * 1000000,
        .patience_s = options->patience_s,
    };
    desc.desk = run->desk =
        desk_open(&(struct desk_desc){.out = stderr,
                                      .in = STDIN_FILENO,
                                      .plan = run->rows.plan,
                                      .participant = options->participant,
                                      .refresh_hz = run->view.display ? run->view.display->refresh_hz : 0.0,
                                      .has_gaze = run->view.gaze != NULL,
                                      .unblind = options->unblind});
    signal(SIGPIPE, SIG_IGN); // a reader of the events that goes away is told in a sentence
    note_options(run);
    struct store_error why;
    if (options->observer && store_rehearse(run->rows.store, &why) != STORE_OK) {
        snprintf(error, error_size, "%s", why.text);
        return SESSION_FAILED;
    }
    enum session_result result = session_run(&desc, error, error_size);
    desk_close(run->desk);
    run->desk = NULL;
    // A renderer's sentence says more than that a frame failed.
    if (result == SESSION_FAILED && run->view.renderer_error[0])
        snprintf(error, error_size, "%s", run->view.renderer_error);
    if (result != SESSION_FAILED)
        apply_rules(run);
    return result;
}

int run_close(struct run *run, enum session_result result, const char *error)
{
    char late[RUN_ERROR] = "";
    if (!run_rows_finish(&run->rows, late, sizeof late) && result != SESSION_FAILED) {
        error = late;
        result = SESSION_FAILED;
    }
    if (result == SESSION_FAILED)
        fprintf(stderr, "fovstudy: %s\n", error);
    else if (result == SESSION_ENDED)
        fprintf(stderr, "fovstudy: the participant ended the session; what was answered is stored\n");
    stage_destroy(run->stage);
    errors_finish(&run->errors);
    event_lines_close(&run->lines);
    run_view_finish(&run->view);
    run_study_finish(&run->study);
    return result == SESSION_COMPLETE ? EXIT_DONE : EXIT_FAILED;
}
