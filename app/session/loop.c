#include "app/response/keyboard.h"
#include "app/session/record.h"
#include "app/session/session.h"
#include "app/session/show.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

// With a simulated clock a session outruns the disk; it then waits before the store's queues are a quarter
// full.
enum { STORE_CHECK_FRAMES = 64, STORE_WAITING_MOST = 4096 };

#define END_SHOWN_NS 2000000000    // "Thank you" on a real display
#define NOTICE_SHOWN_NS 2000000000 // "Please look at both"

struct loop {
    const struct session_desc *desc;
    struct machine *machine;
    struct observer observer;
    struct recorder recorder;
    struct keyboard keyboard;
    struct fovea fovea;
    struct show show; // unused without a display
    struct screen_state state;
    int64_t notice_ns; // when "look at both" was asked for, -1: not
    int64_t steps;     // of the clock without a display
    enum machine_screen told_screen;
    uint32_t told_trial;
    char *error;
    size_t error_size;
};

static int64_t now_ns(const struct loop *loop)
{
    const struct session_desc *desc = loop->desc;
    if (desc->display)
        return display_now_ns(desc->display) - desc->origin_ns;
    return (int64_t)llround((double)loop->steps * 1e9 / desc->step_hz);
}

static void take_keys(struct loop *loop)
{
    struct display_key key;
    struct machine_view view;
    struct machine_event event;
    while (display_key(loop->desc->display, &key)) {
        if (!key.pressed)
            continue;
        machine_look(loop->machine, &view);
        bool last = overlay_last_page(&loop->show.overlay);
        switch (keyboard_press(&loop->keyboard, &view, last, key.key, &event)) {
        case KEYBOARD_EVENT:
            machine_event(loop->machine, key.at_ns - loop->desc->origin_ns, &event);
            break;
        case KEYBOARD_NEXT:
            overlay_turn(&loop->show.overlay, 1);
            break;
        case KEYBOARD_BACK:
            overlay_turn(&loop->show.overlay, -1);
            break;
        default:
            break;
        }
    }
}

static void take_observer(struct loop *loop, int64_t now)
{
    int64_t at_ns = 0;
    struct machine_view view;
    struct machine_event event;
    machine_look(loop->machine, &view);
    for (;;) {
        struct observer_errors errors = loop->desc->display ? show_errors(&loop->show, view.trial_index)
                                                            : errors_of(loop->desc->errors, view.trial_index);
        if (!observer_next(&loop->observer, now, &view, &errors, &at_ns, &event))
            return;
        machine_event(loop->machine, at_ns, &event);
        machine_look(loop->machine, &view);
    }
}

static void take_gaze(struct loop *loop, int64_t now)
{
    struct gaze_sample samples[GAZE_BATCH];
    size_t count = 0;
    while (loop->desc->gaze && (count = gaze_poll(loop->desc->gaze, now, samples, GAZE_BATCH)) > 0) {
        for (size_t i = 0; i < count; i++) {
            struct store_gaze row = {.session_id = loop->desc->ids->session_id,
                                     .segment_id = loop->desc->ids->segment_id,
                                     .trial_id = loop->recorder.trial_id,
                                     .sample = samples[i]};
            fovea_sample(&loop->fovea, &samples[i], store_push_gaze(loop->desc->store, &row));
        }
    }
}

// What the screens need to know from the records: where a switch leads, and that a choice came too early.
static void follow_record(struct loop *loop, const struct machine_record *record)
{
    if (record->kind == MACHINE_TRIAL_STARTED)
        loop->state.going_to = loop->desc->plan->trials[record->trial].first_shown;
    if (record->kind == MACHINE_TOGGLE)
        loop->state.going_to = record->slot;
    if (record->kind == MACHINE_CHOICE_EARLY)
        loop->notice_ns = record->at_ns;
    if (record->kind == MACHINE_TOGGLE || record->kind == MACHINE_TRIAL_STARTED)
        loop->notice_ns = -1;
}

static bool take_records(struct loop *loop)
{
    struct machine_record record;
    while (machine_next_record(loop->machine, &record)) {
        follow_record(loop, &record);
        enum recorder_result result = recorder_take(&loop->recorder, &record, loop->error, loop->error_size);
        if (result == RECORDER_FAILED)
            return false;
        if (result == RECORDER_ANSWERED) {
            struct machine_event stored = {.kind = MACHINE_ANSWER_STORED};
            machine_event(loop->machine, now_ns(loop), &stored);
        }
        if (record.kind == MACHINE_TRIAL_DONE && loop->desc->display &&
            !show_store_errors(&loop->show, record.trial, loop->error, loop->error_size))
            return false;
    }
    return true;
}

// The disk may fail between answers: say so at once, while the participant can still be asked to wait.
static bool check_store(struct loop *loop, bool simulated_clock)
{
    struct store_status status;
    struct store_error why;
    store_status(loop->desc->store, &status);
    if (status.failing) {
        snprintf(loop->error, loop->error_size, "%s", status.error.text);
        return false;
    }
    uint64_t waiting = status.gaze_pushed - status.gaze_committed + status.log_pushed - status.log_committed;
    if (!simulated_clock || waiting < STORE_WAITING_MOST)
        return true;
    if (store_flush(loop->desc->store, &why) == STORE_OK)
        return true;
    snprintf(loop->error, loop->error_size, "%s", why.text);
    return false;
}

static void tell(struct loop *loop, const struct machine_view *view)
{
    if (!loop->desc->progress || (loop->told_screen == view->screen && loop->told_trial == view->trial_index))
        return;
    loop->told_screen = view->screen;
    loop->told_trial = view->trial_index;
    loop->desc->progress(loop->desc->progress_user, view);
}

// Options are made while the participant reads or rests, so that a stimulus never waits for them.
static bool prepare(struct loop *loop)
{
    struct machine_view view;
    machine_look(loop->machine, &view);
    bool soon = view.screen == MACHINE_INSTRUCTIONS || view.screen == MACHINE_READY ||
                view.screen == MACHINE_REST || view.screen == MACHINE_STIMULUS;
    if (!loop->desc->stage || !view.trial || !soon)
        return true;
    return stage_prepare(loop->desc->stage, view.trial_index, loop->error, loop->error_size);
}

static bool present(struct loop *loop, const struct machine_view *view, int64_t now)
{
    if (!loop->desc->display) {
        loop->steps++;
        return true;
    }
    loop->state.selected = keyboard_selected(&loop->keyboard, view);
    loop->state.starts_trial = view->text != loop->desc->plan->protocol->instructions;
    loop->state.look_at_both = loop->notice_ns >= 0 && now - loop->notice_ns < NOTICE_SHOWN_NS;
    return show_frame(&loop->show, view, &loop->state, &loop->fovea, &loop->recorder, now, loop->error,
                      loop->error_size);
}

// One frame. False: the session is over, by failure or at its end (*out_view tells).
static bool step(struct loop *loop, struct machine_view *out_view, bool *out_failed)
{
    const struct session_desc *desc = loop->desc;
    *out_failed = true;
    if (desc->display && !display_poll(desc->display)) {
        snprintf(loop->error, loop->error_size,
                 "the window was closed; what was answered is stored, session %" PRId64 " is unfinished",
                 desc->ids->session_id);
        return false;
    }
    if (desc->observer)
        take_observer(loop, now_ns(loop));
    if (desc->display)
        take_keys(loop);
    if (!prepare(loop))
        return false;
    int64_t now = now_ns(loop);
    take_gaze(loop, now);
    machine_frame(loop->machine, now, out_view);
    if (!take_records(loop))
        return false;
    tell(loop, out_view);
    if (!present(loop, out_view, now))
        return false;
    bool simulated = !desc->display || desc->display->simulated_clock;
    uint64_t count = desc->display ? loop->show.number : (uint64_t)loop->steps;
    if (count % STORE_CHECK_FRAMES == 0 && !check_store(loop, simulated))
        return false;
    *out_failed = false;
    return out_view->screen != MACHINE_END;
}

// The last screen stays a moment where somebody sees it.
static void linger(struct loop *loop, const struct machine_view *last)
{
    bool failed = false;
    struct machine_view view = *last;
    int64_t until_ns = now_ns(loop) + END_SHOWN_NS;
    if (!loop->desc->display || loop->desc->display->simulated_clock)
        return;
    while (now_ns(loop) < until_ns && display_poll(loop->desc->display) && !failed)
        failed = !present(loop, &view, now_ns(loop));
}

// What the rows of `frame` are held against: a segment without this event did not end by itself.
static void tell_submitted(const struct session_desc *desc, const struct show *show)
{
    char detail[64];
    if (!desc->display)
        return;
    snprintf(detail, sizeof detail, "{\"frames\":%" PRIu64 "}", show->number);
    store_push_event(desc->store,
                     &(struct store_event){.session_id = desc->ids->session_id,
                                           .segment_id = desc->ids->segment_id,
                                           .at_ns = display_now_ns(desc->display) - desc->origin_ns,
                                           .kind = "frames_submitted",
                                           .detail = detail});
}

enum session_result session_run(const struct session_desc *desc, char *error, size_t error_size)
{
    struct machine_start start = {0};
    struct machine_view view = {0};
    struct loop loop = {
        .desc = desc,
        .machine = machine_create(desc->plan, &start),
        .recorder = {.store = desc->store, .plan = desc->plan, .ids = desc->ids, .lines = desc->lines},
        .state = {.going_to = PLAN_SLOT_NONE},
        .notice_ns = -1,
        .told_screen = MACHINE_END,
        .error = error,
        .error_size = error_size,
    };
    bool failed = true;
    snprintf(error, error_size, "out of memory");
    if (!loop.machine)
        return SESSION_FAILED;
    if (desc->observer)
        observer_start(&loop.observer, desc->observer, desc->plan->seed, desc->plan->number);
    if (!desc->display || show_init(&loop.show, desc)) {
        while (step(&loop, &view, &failed))
            continue;
        if (!failed)
            linger(&loop, &view);
        if (!failed && view.complete && desc->display)
            failed = !show_measure_rest(&loop.show, error, error_size);
    }
    tell_submitted(desc, &loop.show);
    show_finish(&loop.show);
    machine_destroy(loop.machine);
    if (failed)
        return SESSION_FAILED;
    return view.complete ? SESSION_COMPLETE : SESSION_ENDED;
}
