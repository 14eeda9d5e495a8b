#include "app/session/ready.h"

#include "app/session/preflight.h"
#include "app/session/wait.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#define SLICE_S 0.1 // between two looks at the keys while all waits

static void push(const struct show *show, int64_t at_ns, const char *kind, const char *detail)
{
    store_push_event(show->desc->store, &(struct store_event){.session_id = show->desc->ids->session_id,
                                                              .segment_id = show->desc->ids->segment_id,
                                                              .at_ns = at_ns,
                                                              .kind = kind,
                                                              .detail = detail});
}

// A session without one is told once.
static bool wants_preflight(struct ready *ready, const struct show *show, int64_t at_ns)
{
    const struct session_desc *desc = show->desc;
    bool known = desc->display->refresh_hz > 0.0, real = !desc->display->simulated_clock;
    bool never = desc->preflight == SESSION_PREFLIGHT_NEVER;
    if (!ready->warned && (never || (real && !known))) {
        ready->warned = true;
        push(show, at_ns, "no_preflight",
             never ? "{\"reason\":\"asked\"}" : "{\"reason\":\"the refresh rate is not known\"}");
        if (desc->say && !never)
            desc->say(desc->say_user, "no preflight: the display does not tell its refresh rate");
    }
    return !never && known && (real || desc->preflight == SESSION_PREFLIGHT_ALWAYS);
}

// The trial would be seen unready: it runs, or begins by itself.
static bool must_wait(const struct show *show, const struct machine_view *view)
{
    return show->desc->display->simulated_clock || view->screen == MACHINE_STIMULUS ||
           (view->screen == MACHINE_REST && view->trial->resolved->advance == PROTOCOL_ADVANCE_AUTO);
}

static enum ready_result fly(struct ready *ready, struct show *show, const struct machine_view *view,
                             int64_t at_ns, char *error, size_t error_size)
{
    uint32_t *divisor = &ready->divisors[view->trial->block];
    if (*divisor == 0 && !wants_preflight(ready, show, at_ns))
        *divisor = 1;
    if (*divisor > 0)
        return READY_DONE;
    switch (preflight_block(show, view->trial->block, at_ns, divisor, error, error_size)) {
    case PREFLIGHT_PASSED:
        return stage_prepare(show->desc->stage, view, error, error_size) ? READY_DONE : READY_FAILED;
    case PREFLIGHT_STOPPED:
        *divisor = 0;
        return stage_prepare(show->desc->stage, view, error, error_size) ? READY_STOPPED : READY_FAILED;
    case PREFLIGHT_CLOSED:
        return READY_CLOSED;
    default:
        return READY_FAILED;
    }
}

static enum ready_result render(struct show *show, const struct machine_view *view, char *error,
                                size_t error_size)
{
    double done = 0.0;
    struct screen screen;
    bool waits = must_wait(show, view);
    double rate_hz =
        show->desc->display->refresh_hz > 0.0 ? show->desc->display->refresh_hz : DISPLAY_HEADLESS_HZ;
    rate_hz /= show->pace.divisor;
    for (;;) {
        if (!playback_prepare(show->playback, view, rate_hz, waits ? SLICE_S : 0.0, &done, error, error_size))
            return READY_FAILED;
        if (done >= 1.0 || !waits)
            return done >= 1.0 ? READY_DONE : READY_LATER;
        enum wait_result result = wait_look(show->desc->display);
        if (result != WAIT_ON)
            return result == WAIT_CLOSED ? READY_CLOSED : READY_STOPPED;
        wait_screen(done, &screen);
        if (!show->desc->display->simulated_clock && !show_text(show, &screen)) {
            snprintf(error, error_size, "a text could not be shown");
            return READY_FAILED;
        }
    }
}

// What the trial's pictures take, and at which rate they come.
static void tell(const struct show *show, const struct machine_view *view, int64_t at_ns)
{
    char text[STORE_DETAIL_SIZE];
    const struct plan_trial *trial = view->trial;
    for (int slot = 0; slot < 2; slot++) {
        uint32_t frames = 0;
        uint64_t bytes = 0;
        if (!trial->prerendered[slot])
            continue;
        playback_size(show->playback, (enum plan_slot)slot, &frames, &bytes);
        snprintf(text, sizeof text,
                 "{\"ordinal\":%" PRIu32 ",\"option\":\"%s\",\"frames\":%" PRIu32 ",\"bytes\":%" PRIu64 "}",
                 trial->ordinal, plan_slot_name((enum plan_slot)slot), frames, bytes);
        push(show, at_ns, "prerendered", text);
    }
}

enum ready_result ready_make(struct ready *ready, struct show *show, const struct machine_view *view,
                             int64_t at_ns, char *error, size_t error_size)
{
    if (ready->done && ready->trial == view->trial_index &&
        (view->screen == MACHINE_STIMULUS || ready->attempt == view->attempt))
        return READY_DONE;
    ready->done = false;
    enum ready_result result = fly(ready, show, view, at_ns, error, error_size);
    if (result != READY_DONE)
        return result;
    show->pace.divisor =
        view->trial->resolved->pace == PROTOCOL_PACE_COMMON ? ready->divisors[view->trial->block] : 1;
    if (show->playback)
        result = render(show, view, error, error_size);
    if (result != READY_DONE)
        return result;
    tell(show, view, display_now_ns(show->desc->display) - show->desc->origin_ns);
    ready->done = true;
    ready->trial = view->trial_index;
    ready->attempt = view->attempt;
    return READY_DONE;
}
