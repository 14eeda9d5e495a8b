// `fovstudy run`: joins protocol, display, renderer, gaze and store, and runs one session.
#include "app/command/options.h"
#include "app/fovstudy/commands.h"
#include "app/fovstudy/rules.h"
#include "app/fovstudy/run_study.h"
#include "app/session/session.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

struct run {
    struct run_options options;
    struct run_study study;
    struct run_view view;
    struct run_rows rows;
    struct stage *stage;
    struct errors errors;
    struct event_lines lines;
};

// On a terminal: where the session is. The options are named only with --unblind.
static void progress(void *user, const struct machine_view *view)
{
    const struct run *run = user;
    bool terminal = isatty(STDERR_FILENO);
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

static bool make_stage(struct run *run, char *error, size_t error_size)
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

// Without frames the observer's errors must be known before a session is made.
static bool find_errors(struct run *run, char *error, size_t error_size)
{
    if (run->view.display)
        return true;
    const char *specs[PROTOCOL_SCENES];
    const struct protocol *protocol = run->study.protocol;
    for (uint32_t i = 0; i < protocol->scene_count; i++)
        specs[i] = study_scene_spec(run->options.scenes, run->options.scene_count, protocol->scenes[i]);
    return run_rows_conditions(&run->rows, error, error_size) &&
           run_rows_reference(&run->rows, &run->study, error, error_size) &&
           errors_init(&run->errors, run->rows.plan, run->rows.store, run->rows.ids.condition_ids,
                       run->rows.reference_id, specs, run->study.observer.errors, error, error_size);
}

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
    // Each participant looks around in another way.
    uint64_t gaze_seed = run->rows.plan->seed * 1000003u + run->rows.plan->number;
    return run_view_gaze(&run->view, options, gaze_seed, error, error_size) &&
           find_errors(run, error, error_size) &&
           run_rows_create(&run->rows, options, &run->study, &run->view, error, error_size) &&
           run_rows_reference(&run->rows, &run->study, error, error_size) && make_stage(run, error, error_size);
}

static void note_unblind(const struct run *run)
{
    if (run->options.unblind)
        store_push_event(run->rows.store,
                         &(struct store_event){.session_id = run->rows.ids.session_id,
                                               .segment_id = run->rows.ids.segment_id,
                                               .at_ns = 0,
                                               .kind = "unblind",
                                               .detail = "the options were named on the terminal"});
}

static enum session_result go(struct run *run, char *error, size_t error_size)
{
    const struct run_options *options = &run->options;
    struct session_desc desc = {
        .plan = run->rows.plan,
        .store = run->rows.store,
        .ids = &run->rows.ids,
        .reference_id = run->rows.reference_id,
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
        .errors = &run->errors,
        .step_hz = options->refresh_hz > 0.0 ? options->refresh_hz : DISPLAY_HEADLESS_HZ,
        .progress = progress,
        .progress_user = run,
    };
    note_unblind(run);
    enum session_result result = session_run(&desc, error, error_size);
    // A renderer's sentence says more than that a frame failed.
    if (result == SESSION_FAILED && run->view.renderer_error[0])
        snprintf(error, error_size, "%s", run->view.renderer_error);
    return result;
}

// A session that failed may go on; its rules are applied when it ends, or by `fovstudy exclude`.
static void apply_rules(struct run *run)
{
    char why[RUN_ERROR] = "";
    if (!rules_end_session(run->rows.store, run->options.database, run->study.protocol, &run->rows.ids, why,
                           sizeof why))
        fprintf(stderr, "fovstudy: the exclusion rules are not applied yet (%s); fovstudy exclude does it\n",
                why);
}

static void finish(struct run *run)
{
    stage_destroy(run->stage);
    errors_finish(&run->errors);
    event_lines_close(&run->lines);
    run_view_finish(&run->view);
    run_study_finish(&run->study);
}

int command_run(int argc, char **argv)
{
    static const struct run empty;
    struct run run = empty;
    char error[RUN_ERROR] = "", late[RUN_ERROR] = "";
    run.lines.file = -1;
    int status = run_options_read(&run.options, argc, argv);
    if (status >= 0)
        return status;
    enum session_result result = SESSION_FAILED;
    if (run_study_init(&run.study, &run.options, error, sizeof error) && prepare(&run, error, sizeof error))
        result = go(&run, error, sizeof error);
    if (result != SESSION_FAILED)
        apply_rules(&run);
    if (!run_rows_finish(&run.rows, late, sizeof late) && result != SESSION_FAILED) {
        snprintf(error, sizeof error, "%s", late);
        result = SESSION_FAILED;
    }
    if (result == SESSION_FAILED)
        fprintf(stderr, "fovstudy: %s\n", error);
    else if (result == SESSION_ENDED)
        fprintf(stderr, "fovstudy: the participant ended the session; what was answered is stored\n");
    finish(&run);
    return result == SESSION_COMPLETE ? EXIT_DONE : EXIT_FAILED;
}
