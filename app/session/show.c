#include "app/session/show.h"

#include "app/session/probe.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool make_playback(struct show *show);

bool show_init(struct show *show, const struct session_desc *desc)
{
    struct text_view view;
    *show = (struct show){.desc = desc};
    pace_init(&show->pace, desc->display->refresh_hz);
    text_view_init(&view, &desc->fov, desc->display->width, desc->display->height, desc->ipd_m);
    overlay_init(&show->overlay, desc->renderer, &view);
    if (playback_needed(desc->plan) && !make_playback(show))
        return false;
    if (!desc->observer)
        return true;
    show->measure = measure_create(desc->display->width, desc->display->height);
    return show->measure != NULL;
}

void show_finish(struct show *show)
{
    playback_destroy(show->playback);
    measure_destroy(show->measure);
    show->playback = NULL;
    show->measure = NULL;
}

static uint32_t scene_index(const struct show *show, const struct plan_trial *trial)
{
    uint32_t i = 0;
    while (i < show->desc->scene_count && strcmp(show->desc->scenes[i].name, trial->scene) != 0)
        i++;
    return i;
}

// The condition of the values that the participant has set, a row of its own: only simulated ones ask for it,
// since it waits for the disk. 0: it could not be written, and is asked for again.
static int64_t adjusted_condition(struct show *show, const struct protocol_option *option)
{
    struct store_error why;
    char parameters[PLAN_JSON];
    const struct protocol *protocol = show->desc->plan->protocol;
    struct store_condition row = {protocol->catalogue->modes[option->mode].name, parameters};
    if (show->adjusted_id && memcmp(&show->adjusted, option, sizeof *option) == 0)
        return show->adjusted_id;
    show->adjusted = *option;
    show->adjusted_id = 0;
    if (protocol_option_json(protocol, option, parameters, sizeof parameters))
        store_add_condition(show->desc->store, &row, &show->adjusted_id, &why);
    return show->adjusted_id;
}

// What is measured in a slot of the running trial. False: nothing, since it is empty or shows the reference.
static bool measured_key(struct show *show, const struct machine_view *view, const struct recorder *recorder,
                         enum plan_slot slot, struct measure_key *out)
{
    struct protocol_option option;
    const struct plan_trial *trial = view->trial;
    *out = (struct measure_key){.condition_id = recorder_condition(recorder, trial, slot),
                                .scene = scene_index(show, trial)};
    // What is drawn: values that contradict each other are not.
    const struct mode_choice *now = stage_now(show->desc->stage, slot);
    if (trial->kind == PROTOCOL_ADJUST && slot == trial->test_slot && now &&
        machine_option(recorder->machine, slot, &option)) {
        for (uint32_t i = 0; i < now->mode->parameter_count; i++)
            option.values[i] = plan_level(now->values[i]);
        out->condition_id = adjusted_condition(show, &option);
    }
    measure_metric(show->desc->plan->protocol, trial->resolved, out->metric);
    return out->condition_id && out->condition_id != show->desc->reference_id;
}

struct observer_errors show_errors(struct show *show, const struct machine_view *view,
                                   const struct recorder *recorder)
{
    struct measure_key key;
    struct observer_errors errors = {{0.0, 0.0}};
    if (!show->measure || (view->screen != MACHINE_STIMULUS && view->screen != MACHINE_QUESTION))
        return errors;
    for (int slot = 0; slot < 2; slot++) {
        double error = measured_key(show, view, recorder, (enum plan_slot)slot, &key)
                           ? measure_error(show->measure, &key)
                           : 0.0;
        errors.slot[slot] = isnan(error) ? 0.0 : error;
    }
    return errors;
}

bool show_store_errors(struct show *show, char *error, size_t error_size)
{
    struct measure_key measured;
    double value;
    while (show->measure && measure_next_changed(show->measure, &measured, &value)) {
        struct store_error why;
        const struct store_error_key key = {.condition_id = measured.condition_id,
                                            .reference_id = show->desc->reference_id,
                                            .scene = show->desc->scenes[measured.scene].spec,
                                            .metric = measured.metric};
        if (store_set_measured_error(show->desc->store, &key, value, &why) == STORE_OK)
            continue;
        measure_not_stored(show->measure, &measured);
        snprintf(error, error_size, "%s", why.text);
        return false;
    }
    return true;
}

bool show_measure_rest(struct show *show, char *error, size_t error_size)
{
    return !show->measure || (probe_rest(show->desc, show->measure, error, error_size) &&
                              show_store_errors(show, error, error_size));
}

bool show_target_fovea(const struct show *show, const struct machine_view *view, struct fovea_use *out)
{
    struct fixation_place at;
    if (view->trial->resolved->foveate != PROTOCOL_FOVEATE_TARGET ||
        !targets_fixation(stage_targets(show->desc->stage), view, &at))
        return false;
    fovea_on(at.point, show->desc->ipd_m, out);
    return true;
}

// Which directions the fovea takes, and where they came from.
static enum store_fovea follow(const struct show *show, const struct machine_view *view,
                               const struct fovea *fovea, int64_t start_ns, struct fovea_use *out)
{
    if (show_target_fovea(show, view, out))
        return STORE_FOVEA_TARGET;
    if (!show->desc->gaze) {
        *out = (struct fovea_use){.known = false};
        return STORE_FOVEA_FIXED;
    }
    fovea_at(fovea, start_ns, out);
    return out->lost ? STORE_FOVEA_LOST : STORE_FOVEA_GAZE;
}

static void fill_fovea(const struct fovea_use *use, enum store_fovea source, struct store_frame *row)
{
    for (int eye = 0; eye < EYES; eye++) {
        row->fovea_deg[eye][0] = use->x_deg[eye];
        row->fovea_deg[eye][1] = use->y_deg[eye];
    }
    row->fovea_source = source;
    // No gaze yet: every pixel counts as foveal, and a foveated option is not what its condition says.
    if (source == STORE_FOVEA_LOST && isnan(use->x_deg[EYE_LEFT]) && isnan(use->x_deg[EYE_RIGHT]))
        row->effective = "{\"fovea\":\"everywhere\"}";
    row->gaze_id = use->sample_id;
    row->gaze_age_us = use->known ? (double)use->age_ns * 1e-3 : NAN;
}

// A full redraw costs what the option is there to save, so each one is told: JSON
// {"cause":"gaze","option":"a"}.
static void tell_redraw(const struct show *show, const struct machine_view *view,
                        const struct recorder *recorder, int64_t at_ns, enum frame_redraw redraw)
{
    char detail[64];
    if (redraw == FRAME_REDRAW_NONE)
        return;
    snprintf(detail, sizeof detail, "{\"cause\":\"%s\",\"option\":\"%s\"}", renderer_redraw_name(redraw),
             plan_slot_name(view->slot));
    store_push_event(show->desc->store, &(struct store_event){.session_id = show->desc->ids->session_id,
                                                              .segment_id = show->desc->ids->segment_id,
                                                              .trial_id = recorder->trial_id,
                                                              .at_ns = at_ns,
                                                              .kind = "full_redraw",
                                                              .detail = detail});
}

// A level and an adjusted value are conditions of their own.
static bool measure_option(struct show *show, const struct machine_view *view, const struct recorder *recorder,
                           struct renderer_option *option, const struct frame *frame)
{
    struct measure_key key;
    return !show->measure || !measured_key(show, view, recorder, view->slot, &key) ||
           !measure_due(show->measure, view, key.condition_id) ||
           measure_take(show->measure, &key, option, stage_reference(show->desc->stage), frame);
}

// Where the spheres to count stand: an event row each, JSON as targets.h says.
static void tell_spheres(const struct show *show, const struct machine_view *view,
                         const struct recorder *recorder, int64_t at_ns)
{
    char detail[STORE_DETAIL_SIZE];
    const struct targets *targets = stage_targets(show->desc->stage);
    for (uint32_t i = 0; targets_sphere_json(targets, view->showing, i, detail, sizeof detail); i++)
        store_push_event(show->desc->store, &(struct store_event){.session_id = show->desc->ids->session_id,
                                                                  .segment_id = show->desc->ids->segment_id,
                                                                  .trial_id = recorder->trial_id,
                                                                  .at_ns = at_ns,
                                                                  .kind = "sphere",
                                                                  .detail = detail});
}

// Targets over the pictures; the row tells where the eyes were asked to be.
static bool lay_marks(const struct show *show, const struct machine_view *view, struct store_frame *row)
{
    struct renderer_mark marks[RENDERER_MARKS];
    struct fixation_place at;
    const struct session_desc *desc = show->desc;
    const struct targets *targets = stage_targets(desc->stage);
    const struct targets_view eyes = {desc->fov, desc->display->width, desc->display->height, desc->ipd_m};
    if (targets_fixation(targets, view, &at)) {
        row->target_x_deg = at.x_deg;
        row->target_y_deg = at.y_deg;
        row->target_m = dvec3_length(at.point);
    }
    uint32_t count = targets_marks(targets, view, &row->head_pose, &eyes, marks, RENDERER_MARKS);
    return renderer_set_marks(desc->renderer, marks, count);
}

// Renders the option of the view; fills what the row tells about it.
static bool draw_option(struct show *show, const struct machine_view *view, const struct fovea *fovea,
                        const struct recorder *recorder, struct store_frame *row, char *error,
                        size_t error_size)
{
    struct fovea_use use;
    struct frame_stats stats;
    enum store_fovea source = follow(show, view, fovea, row->start_ns, &use);
    struct frame frame = stage_frame(show->desc->stage, view, show->pace.number, &use, &row->head_pose);
    struct renderer_option *option = stage_option(show->desc->stage, view->slot);
    memset(&stats, 0, sizeof stats);
    bool gaze = source == STORE_FOVEA_GAZE || source == STORE_FOVEA_LOST;
    frame.gaze_returned = gaze && fovea_returned(&show->gaze_lost, &use);
    if (!option || !renderer_draw(option, &frame, &stats)) {
        snprintf(error, error_size, "the GPU could not draw frame %llu", (unsigned long long)show->number);
        return false;
    }
    if (!measure_option(show, view, recorder, option, &frame)) {
        snprintf(error, error_size, "the image error of frame %llu could not be measured",
                 (unsigned long long)show->number);
        return false;
    }
    tell_redraw(show, view, recorder, row->start_ns, stats.redraw);
    // A staircase trial has a condition for its level; what somebody adjusts has none.
    row->effective = view->adjusted ? stage_effective(show->desc->stage, view->slot) : NULL;
    fill_fovea(&use, source, row);
    row->cpu_us = stats.cpu_ms * 1e3;
    row->gpu_us = stats.gpu_ms * 1e3;
    row->shaded_px = (int64_t)stats.shaded_px;
    row->triangles = (int64_t)stats.triangles;
    return true;
}

static struct store_frame empty_row(const struct show *show, const struct machine_view *view,
                                    const struct recorder *recorder, int64_t start_ns)
{
    static const enum store_phase phases[] = {[MACHINE_PHASE_STIMULUS] = STORE_STIMULUS,
                                              [MACHINE_PHASE_FADE] = STORE_FADE,
                                              [MACHINE_PHASE_QUESTION] = STORE_QUESTION,
                                              [MACHINE_PHASE_REST] = STORE_REST};
    bool stimulus = view->screen == MACHINE_STIMULUS;
    return (struct store_frame){
        .session_id = show->desc->ids->session_id,
        .segment_id = show->desc->ids->segment_id,
        .trial_id = recorder->trial_id,
        .attempt = recorder->trial_id ? recorder->attempt : 0,
        .number = show->number,
        .option = !stimulus || view->slot == PLAN_SLOT_NONE ? STORE_NO_SLOT
                  : view->slot == PLAN_SLOT_A               ? STORE_A
                                                            : STORE_B,
        .phase = phases[view->phase],
        .fade_level = view->fade,
        .start_ns = start_ns,
        .cpu_us = NAN,
        .gpu_us = NAN,
        .gaze_age_us = NAN,
        .fovea_deg = {{NAN, NAN}, {NAN, NAN}},
        .fovea_source = STORE_NO_FOVEA,
        .target_x_deg = NAN,
        .target_y_deg = NAN,
        .target_m = NAN,
        .shaded_px = STORE_UNKNOWN,
        .triangles = STORE_UNKNOWN,
    };
}

// When the frame reached the eyes: computed, since neither kind of display reports it.
static void time_row(struct show *show, bool visible, bool repeated, struct store_frame *row)
{
    struct display *display = show->desc->display;
    bool known = display->refresh_hz > 0.0;
    row->present_estimated = true;
    row->present_ns = display->simulated_clock ? row->start_ns + llround(1e9 / display->refresh_hz)
                                               : display_now_ns(display) - show->desc->origin_ns;
    show->frame_ms = show->pace.present_ns < 0 || display->simulated_clock
                         ? (double)NAN
                         : (double)(row->present_ns - show->pace.present_ns) * 1e-6;
    bool late = pace_late(&show->pace, visible, repeated, row->present_ns);
    if (!display->simulated_clock)
        row->late = known ? late || row->late : STORE_UNKNOWN;
    show->late = row->late == 1;
}

static bool measure_played(void *user, const struct machine_view *view, uint32_t number,
                           const struct frame *frame)
{
    struct show *show = user;
    const struct session_desc *desc = show->desc;
    struct measure_key key = {.condition_id = desc->ids->condition_ids[view->condition],
                              .scene = scene_index(show, view->trial)};
    measure_metric(desc->plan->protocol, view->trial->resolved, key.metric);
    return !show->measure || key.condition_id == desc->reference_id || !measure_at(number + 1) ||
           measure_take(show->measure, &key, stage_option(desc->stage, view->slot),
                        stage_reference(desc->stage), frame);
}

static bool target_fovea(void *user, const struct machine_view *view, struct fovea_use *out)
{
    return show_target_fovea(user, view, out);
}

static bool make_playback(struct show *show)
{
    const struct session_desc *desc = show->desc;
    show->playback = playback_create(&(struct playback_desc){.renderer = desc->renderer,
                                                             .stage = desc->stage,
                                                             .width = desc->display->width,
                                                             .height = desc->display->height,
                                                             .budget_bytes = desc->playback_bytes,
                                                             .fovea = target_fovea,
                                                             .drawn = measure_played,
                                                             .user = show});
    return show->playback != NULL;
}

// Draws, takes or keeps the picture of a visible option; *out_repeated: it is the one shown before.
static bool make_picture(struct show *show, const struct machine_view *view, const struct fovea *fovea,
                         const struct recorder *recorder, struct store_frame *row, bool *out_repeated,
                         char *error, size_t error_size)
{
    bool fresh = false, held = false;
    row->condition_id = recorder_condition(recorder, view->trial, view->slot);
    if (playback_plays(show->playback, view)) {
        playback_take(show->playback, view, show->desc->display->simulated_clock, row, &fresh, &held);
        row->late = held && !show->desc->display->simulated_clock;
        *out_repeated = !fresh;
        return true;
    }
    *out_repeated = !pace_due(&show->pace, view->slot, view->trial_started, row->start_ns);
    if (*out_repeated)
        row->effective = "{\"repeated\":true}";
    return *out_repeated || draw_option(show, view, fovea, recorder, row, error, error_size);
}

static bool put(struct show *show, const struct machine_view *view, bool visible)
{
    struct renderer *renderer = show->desc->renderer;
    if (visible && playback_plays(show->playback, view))
        return playback_show(show->playback, view->slot, view->fade);
    return renderer_show(renderer, visible ? stage_option(show->desc->stage, view->slot) : NULL,
                         visible ? view->fade : 1.0);
}

// At which rate the trial's pictures come, where it may be another than the screen's.
static void tell_pace(const struct show *show, const struct machine_view *view, const struct recorder *recorder,
                      int64_t at_ns)
{
    char detail[96];
    const struct pace *pace = &show->pace;
    if (view->screen != MACHINE_STIMULUS || !view->trial_started || view->showing > 0 ||
        view->trial->resolved->pace != PROTOCOL_PACE_COMMON)
        return;
    snprintf(detail, sizeof detail, "{\"hz\":%.9g,\"divisor\":%u,\"refresh_hz\":%.9g}",
             pace->refresh_hz / pace->divisor, pace->divisor, pace->refresh_hz);
    store_push_event(show->desc->store, &(struct store_event){.session_id = show->desc->ids->session_id,
                                                              .segment_id = show->desc->ids->segment_id,
                                                              .trial_id = recorder->trial_id,
                                                              .at_ns = at_ns,
                                                              .kind = "pace",
                                                              .detail = detail});
}

bool show_text(struct show *show, const struct screen *screen)
{
    if (display_resized(show->desc->display))
        renderer_resized(show->desc->renderer);
    bool good = overlay_set(&show->overlay, screen) && renderer_show(show->desc->renderer, NULL, 1.0);
    show->pace.present_ns = -1; // what comes next was not kept waiting by a frame
    display_shown(show->desc->display);
    return good;
}

bool show_frame(struct show *show, const struct machine_view *view, const struct screen_state *state,
                const struct fovea *fovea, const struct recorder *recorder, int64_t start_ns, char *error,
                size_t error_size)
{
    struct screen screen;
    bool repeated = false;
    struct store_frame row = empty_row(show, view, recorder, start_ns);
    bool visible = view->screen == MACHINE_STIMULUS && view->slot != PLAN_SLOT_NONE && view->fade < 1.0;
    tell_pace(show, view, recorder, start_ns);
    if (visible)
        stage_adjust(show->desc->stage, view);
    if (visible && !make_picture(show, view, fovea, recorder, &row, &repeated, error, error_size))
        return false;
    screen_of(view, state, &screen);
    if (display_resized(show->desc->display))
        renderer_resized(show->desc->renderer);
    if (view->screen == MACHINE_STIMULUS && view->trial_started)
        tell_spheres(show, view, recorder, start_ns);
    if (!lay_marks(show, view, &row) || !overlay_set(&show->overlay, &screen) || !put(show, view, visible)) {
        snprintf(error, error_size, "frame %llu could not be shown", (unsigned long long)show->number);
        return false;
    }
    time_row(show, visible, repeated, &row);
    display_shown(show->desc->display);
    store_push_frame(show->desc->store, &row); // what does not fit is counted and reported by the store
    show->number++;
    return true;
}

void show_tell_submitted(const struct show *show)
{
    char detail[64];
    if (!show->desc || !show->desc->display)
        return;
    snprintf(detail, sizeof detail, "{\"frames\":%llu}", (unsigned long long)show->number);
    store_push_event(show->desc->store,
                     &(struct store_event){.session_id = show->desc->ids->session_id,
                                           .segment_id = show->desc->ids->segment_id,
                                           .at_ns = display_now_ns(show->desc->display) - show->desc->origin_ns,
                                           .kind = "frames_submitted",
                                           .detail = detail});
}
