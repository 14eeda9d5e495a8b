#include "app/command/json.h"
#include "app/fovstudy/run_study.h"
#include "app/session/record.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool run_rows_plan(struct run_rows *rows, const struct protocol *protocol, uint64_t seed, int64_t number,
                   char *error, size_t error_size)
{
    rows->plan = plan_create(protocol, seed, (uint32_t)(number - 1));
    if (rows->plan) {
        rows->ids.condition_ids = calloc(rows->plan->condition_count + 1, sizeof *rows->ids.condition_ids);
        rows->ids.trial_ids = calloc(rows->plan->trial_count + 1, sizeof *rows->ids.trial_ids);
    }
    if (rows->ids.condition_ids && rows->ids.trial_ids)
        return true;
    snprintf(error, error_size, "out of memory");
    return false;
}

// Before anything is written or shown; store_create_session holds to it as well.
static bool code_is_free(struct run_rows *rows, const struct run_options *options, bool several, char *error,
                         size_t error_size)
{
    struct store_error why;
    int64_t count = 0, unfinished = 0;
    if (store_count_sessions(rows->store, options->participant, &count, &unfinished, &why) != STORE_OK) {
        snprintf(error, error_size, "%s", why.text);
        return false;
    }
    if (count == 0 || options->again || (several && !unfinished))
        return true;
    int used = snprintf(
        error, error_size,
        "%s: participant %s has a session already; give another code, or --again for a further session",
        options->database, options->participant);
    if (unfinished && used > 0 && (size_t)used < error_size)
        snprintf(error + used, error_size - (size_t)used,
                 "; session %" PRId64 " is unfinished: fovstudy resume --db '%s' %" PRId64 " goes on with it",
                 unfinished, options->database, unfinished);
    return false;
}

bool run_rows_open(struct run_rows *rows, const struct run_options *options, const struct run_study *study,
                   char *error, size_t error_size)
{
    struct store_error why;
    int64_t number = 0;
    *rows = (struct run_rows){0};
    rows->store = store_open(&(struct store_desc){.path = options->database, .access = STORE_CREATE}, &why);
    int64_t wanted = options->has_number ? (int64_t)options->number : 0;
    if (rows->store && !code_is_free(rows, options, study->protocol->several_sessions, error, error_size))
        return false;
    if (!rows->store ||
        store_participant_number(rows->store, options->participant, wanted, &number, &why) != STORE_OK) {
        snprintf(error, error_size, "%s", why.text);
        return false;
    }
    uint64_t seed = options->has_seed ? options->seed : study->protocol->seed;
    return run_rows_plan(rows, study->protocol, seed, number, error, error_size);
}

// Absolute, so that it is found from another folder.
static void json_path(FILE *out, const char *path)
{
    char *absolute = realpath(path, NULL);
    json_string(out, absolute ? absolute : path);
    free(absolute);
}

// JSON of how the session was started, beyond the columns of its own.
static char *settings_json(const struct run_options *options, const struct run_study *study,
                           const struct run_view *view)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out)
        return NULL;
    fprintf(out, "{\"gaze\":");
    json_string(out, view->gaze_name);
    fprintf(out, ",\"ipd_m\":%g,\"unblind\":%s", VIEWING_DEFAULT_IPD_M, options->unblind ? "true" : "false");
    if (options->observer) {
        char observer[RUN_JSON];
        if (observer_json(&study->observer, observer, sizeof observer))
            fprintf(out, ",\"observer\":%s", observer);
    }
    if (options->observer && study->observer.errors[0]) {
        fprintf(out, ",\"errors_file\":");
        json_path(out, study->observer.errors);
    }
    if (!view->display)
        fprintf(out, ",\"step_hz\":%.17g", run_step_hz(options));
    fprintf(out, ",\"protocol_file\":"); // resume looks whether it is still the same
    json_path(out, options->protocol);
    fprintf(out, ",\"title\":");
    json_string(out, study->protocol->title);
    fprintf(out, ",\"scenes\":{");
    for (uint32_t i = 0; i < study->protocol->scene_count; i++) {
        fprintf(out, "%s", i ? "," : "");
        json_string(out, study->protocol->scenes[i]);
        fprintf(out, ":");
        json_string(out, study_shown_scene(study->protocol, i, options->scenes, options->scene_count));
    }
    fprintf(out, "},\"planned\":[");
    for (uint32_t i = 0; i < study->protocol->analysis_count; i++) {
        const struct protocol_analysis *planned = &study->protocol->analyses[i];
        fprintf(out, "%s{\"method\":\"%s\",\"of\":\"%s\",\"per\":\"%s\"", i ? "," : "", planned->method,
                planned->of, *planned->per ? planned->per : "-");
        if (planned->margin > 0)
            fprintf(out, ",\"margin\":%.15g", planned->margin);
        fprintf(out, "}");
    }
    fprintf(out, "]}");
    return fclose(out) == 0 ? text : NULL;
}

static enum store_slot stored_slot(enum plan_slot slot)
{
    return slot == PLAN_SLOT_A ? STORE_A : slot == PLAN_SLOT_B ? STORE_B : STORE_NO_SLOT;
}

static void fill_trials(const struct plan *plan, struct store_condition *conditions, struct store_trial *trials)
{
    for (uint32_t i = 0; i < plan->condition_count; i++)
        conditions[i] = (struct store_condition){plan->conditions[i].mode, plan->conditions[i].parameters};
    for (uint32_t i = 0; i < plan->trial_count; i++) {
        const struct plan_trial *trial = &plan->trials[i];
        trials[i] = (struct store_trial){
            .ordinal = trial->ordinal,
            .block = plan->protocol->blocks[trial->block].name,
            .kind = plan_trial_kind(trial),
            .scene = trial->scene,
            .settings = trial->settings,
            .factors = trial->factors,
            .option_a = trial->option[0],
            .option_b = trial->option[1],
            .test_slot = stored_slot(trial->test_slot),
            .first_shown = stored_slot(trial->first_shown),
            .fixation = trial->fixation,
            .seed = trial->seed,
        };
    }
}

static void read_boot_id(char *out, size_t size)
{
    FILE *file = fopen("/proc/sys/kernel/random/boot_id", "r");
    if (!file || !fgets(out, (int)size, file))
        out[0] = '\0';
    out[strcspn(out, "\n")] = '\0';
    if (file)
        fclose(file);
}

struct store_segment run_rows_segment(struct run_rows *rows, const struct run_view *view, const char *reason,
                                      struct run_words *words)
{
    bool simulated_clock = !view->display || view->display->simulated_clock;
    rows->origin_ns = simulated_clock ? 0 : display_now_ns(view->display);
    record_time_utc(words->now);
    read_boot_id(words->boot_id, sizeof words->boot_id);
    return (struct store_segment){
        .started_at = words->now,
        .mono_origin_ns = rows->origin_ns,
        .clock = simulated_clock ? "simulated" : "monotonic",
        // A simulated clock starts at 0 in every run, whichever computer.
        .boot_id = !simulated_clock && words->boot_id[0] ? words->boot_id : NULL,
        .app_version = FOVSTUDY_VERSION,
        .reason = reason,
    };
}

static struct store_session describe(const struct run_options *options, const struct run_study *study,
                                     const struct run_view *view, const struct run_rows *rows)
{
    const struct renderer_device *device = view->renderer ? renderer_device(view->renderer) : NULL;
    struct display *display = view->display;
    return (struct store_session){
        .protocol = {study->protocol->name, study->protocol->sha256_hex, study->protocol->text},
        .participant = {.code = options->participant,
                        .kind = options->observer ? "simulated" : "person",
                        .attributes = study->attributes,
                        .number = (int64_t)rows->plan->number + 1},
        .seed = rows->plan->seed,
        .device = device ? device->name : NULL,
        .driver = device ? device->driver : NULL,
        .display = options->display,
        .refresh_hz = display ? display->refresh_hz : 0.0,
        .width_px = display ? display->width : 0,
        .height_px = display ? display->height : 0,
        .fov_deg = display ? options->fov_deg : 0.0,
        .again = options->again || study->protocol->several_sessions,
        .condition_count = rows->plan->condition_count,
        .trial_count = rows->plan->trial_count,
    };
}

static bool create_session(struct run_rows *rows, struct store_session *session, char *error, size_t error_size)
{
    struct store_error why;
    struct store_condition *conditions = calloc(rows->plan->condition_count + 1, sizeof *conditions);
    struct store_trial *trials = calloc(rows->plan->trial_count + 1, sizeof *trials);
    bool done = false;
    if (!conditions || !trials) {
        snprintf(error, error_size, "out of memory");
        goto end;
    }
    fill_trials(rows->plan, conditions, trials);
    session->conditions = conditions;
    session->trials = trials;
    done = store_create_session(rows->store, session, &rows->ids, &why) == STORE_OK;
    if (!done)
        snprintf(error, error_size, "%s", why.text);
end:
    free(conditions);
    free(trials);
    return done;
}

bool run_rows_create(struct run_rows *rows, const struct run_options *options, const struct run_study *study,
                     const struct run_view *view, char *error, size_t error_size)
{
    struct run_words words;
    char *settings = settings_json(options, study, view);
    if (!settings) {
        snprintf(error, error_size, "out of memory");
        return false;
    }
    struct store_session session = describe(options, study, view, rows);
    session.segment = run_rows_segment(rows, view, "start", &words);
    session.started_at = words.now;
    session.settings = settings;
    bool done = create_session(rows, &session, error, error_size);
    free(settings);
    return done;
}

bool run_rows_reference(struct run_rows *rows, const struct run_study *study, char *error, size_t error_size)
{
    struct store_error why;
    char parameters[PLAN_JSON];
    const struct protocol *protocol = study->protocol;
    const struct protocol_option *option = &protocol->options[protocol->reference];
    struct store_condition condition = {protocol->catalogue->modes[option->mode].name, parameters};
    if (!protocol_option_json(protocol, option, parameters, sizeof parameters)) {
        snprintf(error, error_size, "the reference's parameters are too long");
        return false;
    }
    if (store_add_condition(rows->store, &condition, &rows->reference_id, &why) == STORE_OK)
        return true;
    snprintf(error, error_size, "%s", why.text);
    return false;
}

bool run_rows_finish(struct run_rows *rows, char *error, size_t error_size)
{
    struct store_error why;
    enum store_result closed =
        rows->ids.session_id ? store_close(rows->store, &why) : store_abandon(rows->store, &why);
    bool done = closed == STORE_OK;
    if (!done)
        snprintf(error, error_size, "%s", why.text);
    plan_destroy(rows->plan);
    free(rows->ids.condition_ids);
    free(rows->ids.trial_ids);
    free(rows->done);
    free(rows->attempts);
    free(rows->answers);
    free(rows->outcomes);
    free(rows->adjusted);
    free(rows->repeats);
    return done;
}
