#include "app/response/keyboard.h"
#include "app/session/leap.h"
#include "app/session/ready.h"
#include "app/session/record.h"
#include "app/session/session.h"
#include "app/session/show.h"
#include "app/session/trouble.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

// With a simulated clock a session outruns the disk; it then waits before the store's queues are a quarter
// full.
enum { STORE_CHECK_FRAMES = 64, STORE_WAITING_MOST = 4096 };

#define END_SHOWN_NS 2000000000    // "Thank you" on a real display
#define NOTICE_SHOWN_NS 2000000000 // "Please look at both"
#define STORE_BUSY_MS 200          // frames stand still while a commit waits for another program
#define TROUBLE_NAP_NS 20000000    // between two looks at the disk where no display keeps the pace

struct loop {
    const struct session_desc *desc;
    struct machine *machine;
    struct observer observer;
    struct recorder recorder;
    struct keyboard keyboard;
    struct fovea fovea;
    struct show show; // unused without a display
    struct ready ready;
    struct screen_state state;
    struct trouble trouble;
    struct steady_clock clock;
    struct machine_record record; // taken from the machine and not yet stored
    bool has_record;
    int64_t notice_ns; // when "look at both" was asked for, -1: not
    struct leap leap;  // the clock without a display
    int64_t steps;     // its frames
    bool busy;         // records came with this one
    uint64_t checks;   // of the store, each so many frames
    enum machine_screen told_screen;
    uint32_t told_trial;
    char *error;
    size_t error_size;
};

static int64_t real_ns(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (int64_t)time.tv_sec * 1000000000 + time.tv_nsec;
}

static bool simulated_clock(const struct loop *loop)
{
    return !loop->desc->display || loop->desc->display->simulated_clock;
}

static void push_event(const struct loop *loop, int64_t at_ns, const char *kind, const char *detail)
{
    store_push_event(loop->desc->store, &(struct store_event){.session_id = loop->desc->ids->session_id,
                                                              .segment_id = loop->desc->ids->segment_id,
                                                              .trial_id = loop->recorder.trial_id,
                                                              .at_ns = at_ns,
                                                              .kind = kind,
                                                              .detail = detail});
}

// What is on screen stands still until somebody goes on by key.
static void pause_machine(struct loop *loop, int64_t now)
{
    struct machine_view view;
    machine_look(loop->machine, &view);
    if (view.screen != MACHINE_PAUSED && view.screen != MACHINE_ABORT)
        machine_event(loop->machine, now, &(struct machine_event){.kind = MACHINE_PAUSE});
}

// A clock that goes back is no reason to lose anything: the session's time stands still for a moment and goes
// on from there; whoever watches is told, and the trial waits for a key.
static int64_t now_ns(struct loop *loop)
{
    const struct session_desc *desc = loop->desc;
    if (!desc->display)
        return leap_time_ns(&loop->leap, loop->steps);
    int64_t back_ns = 0;
    int64_t now = steady_clock_take(&loop->clock, display_now_ns(desc->display) - desc->origin_ns, &back_ns);
    if (back_ns > 0) {
        char text[160];
        snprintf(text, sizeof text, "{\"ns\":%" PRId64 "}", back_ns);
        push_event(loop, now, "clock_back", text);
        snprintf(text, sizeof text,
                 "the computer's clock went back by %.3f s; the session's time goes on without it, and a key "
                 "goes on "
                 "with the trial",
                 (double)back_ns * 1e-9);
        if (desc->say)
            desc->say(desc->say_user, text);
        pause_machine(loop, now);
    }
    return now;
}

static void take_keys(struct loop *loop)
{
    struct display_key key;
    struct machine_view view;
    struct machine_event event;
    while (display_key(loop->desc->display, &key)) {
        if (!key.pressed || loop->trouble.on) // nothing can be taken while it cannot be stored
            continue;
        machine_look(loop->machine, &view);
        bool last = overlay_last_page(&loop->show.overlay);
        switch (keyboard_press(&loop->keyboard, &view, last, key.key, &event)) {
        case KEYBOARD_EVENT:
            machine_event(loop->machine, key.at_ns - loop->desc->origin_ns + loop->clock.shift_ns, &event);
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
        struct observer_errors errors = loop->desc->display ? show_errors(&loop->show, &view, &loop->recorder)
                                                            : errors_at(loop->desc->errors, loop->machine);
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
        loop->state.going_to = machine_trial(loop->machine, record->trial)->first_shown;
    if (record->kind == MACHINE_TOGGLE)
        loop->state.going_to = record->slot;
    if (record->kind == MACHINE_CHOICE_EARLY)
        loop->notice_ns = record->at_ns;
    if (record->kind == MACHINE_TOGGLE || record->kind == MACHINE_TRIAL_STARTED)
        loop->notice_ns = -1;
}

// Stores the record in hand; false: it waits (trouble is told), or the session fails (*out_failed).
static bool take_record(struct loop *loop, bool *out_failed)
{
    const struct machine_record *record = &loop->record;
    enum recorder_result result = recorder_take(&loop->recorder, record, loop->error, loop->error_size);
    *out_failed = result == RECORDER_FAILED;
    bool waits = result == RECORDER_WAIT ||
                 (result == RECORDER_DONE && record->kind == MACHINE_TRIAL_DONE && loop->desc->display &&
                  !show_store_errors(&loop->show, loop->error, loop->error_size));
    if (waits)
        trouble_tell(&loop->trouble, real_ns(), loop->error);
    if (waits || *out_failed)
        return false;
    loop->has_record = false;
    if (result == RECORDER_ANSWERED)
        machine_event(loop->machine, now_ns(loop), &(struct machine_event){.kind = MACHINE_ANSWER_STORED});
    return true;
}

// False: the session fails. What cannot be stored now stays in hand, and all behind it in the machine.
static bool take_records(struct loop *loop)
{
    bool failed = false;
    for (;;) {
        if (!loop->has_record) {
            loop->has_record = machine_next_record(loop->machine, &loop->record);
            if (!loop->has_record)
                return true;
            loop->busy = true;
            follow_record(loop, &loop->record);
        }
        if (!take_record(loop, &failed))
            return !failed;
    }
}

// The disk may fail between answers: known at once, while the participant can still be asked to wait.
static void check_store(struct loop *loop)
{
    struct store_status status;
    struct store_error why;
    store_status(loop->desc->store, &status);
    uint64_t waiting = status.gaze_pushed - status.gaze_committed + status.log_pushed - status.log_committed;
    if (status.failing)
        trouble_tell(&loop->trouble, real_ns(), status.error.text);
    else if (simulated_clock(loop) && waiting >= STORE_WAITING_MOST &&
             store_flush(loop->desc->store, &why) != STORE_OK)
        trouble_tell(&loop->trouble, real_ns(), why.text);
}

// While there is trouble: tries again. False: the session fails.
static bool bear_trouble(struct loop *loop)
{
    int64_t now = real_ns();
    double patience_s = loop->desc->patience_s;
    if (!trouble_due(&loop->trouble, now))
        return true;
    loop->trouble.retry_ns = now + TROUBLE_RETRY_NS;
    if (loop->has_record && !take_records(loop))
        return false;
    struct store_status status;
    store_status(loop->desc->store, &status); // the store's own thread tries again by itself
    if (!loop->has_record && !status.failing) {
        push_event(loop, now_ns(loop), "store_trouble", loop->trouble.sentence);
        trouble_over(&loop->trouble, real_ns());
        return true;
    }
    if (!loop->has_record)
        trouble_tell(&loop->trouble, now, status.error.text);
    double waited_s = (double)(real_ns() - loop->trouble.since_ns) * 1e-9;
    snprintf(loop->error, loop->error_size, "gave up after %.1f s: %s", waited_s, loop->trouble.sentence);
    return !(patience_s > 0.0) || waited_s < patience_s;
}

static void tell(struct loop *loop, const struct machine_view *view)
{
    if (!loop->desc->progress || (loop->told_screen == view->screen && loop->told_trial == view->trial_index))
        return;
    loop->told_screen = view->screen;
    loop->told_trial = view->trial_index;
    loop->desc->progress(loop->desc->progress_user, view);
}

static void say_closed(struct loop *loop);

// Preflight and prerendered pictures. Without a display nothing is shown that could be late.
static bool make_ready(struct loop *loop, const struct machine_view *view)
{
    int64_t now = now_ns(loop);
    switch (ready_make(&loop->ready, &loop->show, view, now, loop->error, loop->error_size)) {
    case READY_STOPPED:
        machine_event(loop->machine, now_ns(loop), &(struct machine_event){.kind = MACHINE_ABORT_KEY});
        return true;
    case READY_CLOSED:
        say_closed(loop);
        return false;
    case READY_FAILED:
        return false;
    default:
        return true;
    }
}

// Options are made while the participant reads or rests, so that a stimulus never waits for them.
static bool prepare(struct loop *loop)
{
    struct machine_view view;
    machine_look(loop->machine, &view);
    bool soon = view.screen == MACHINE_INSTRUCTIONS || view.screen == MACHINE_READY ||
                view.screen == MACHINE_REST || view.screen == MACHINE_BREAK || view.screen == MACHINE_STIMULUS;
    if (!loop->desc->stage || !view.trial || !soon)
        return true;
    return stage_prepare(loop->desc->stage, &view, loop->error, loop->error_size) && make_ready(loop, &view);
}

// The experimenter's keys and notes; a note belongs to the trial that runs.
static void take_desk(struct loop *loop, int64_t now)
{
    struct machine_view view;
    struct machine_event event;
    char note[DESK_NOTE], detail[STORE_DETAIL_SIZE];
    enum desk_command command = DESK_NOTHING;
    if (!loop->desc->desk)
        return;
    do {
        machine_look(loop->machine, &view);
        command = desk_take(loop->desc->desk, &view, &event, note);
        if (command == DESK_EVENT && !loop->trouble.on)
            machine_event(loop->machine, now, &event);
        if (command == DESK_NOTED) {
            snprintf(detail, sizeof detail, "%s", note);
            push_event(loop, now, "note", detail);
        }
    } while (command != DESK_NOTHING);
}

static void show_desk(struct loop *loop, const struct machine_view *view, int64_t now)
{
    struct fovea_use gaze = {.known = false};
    if (!loop->desc->desk)
        return;
    if (loop->desc->gaze)
        fovea_at(&loop->fovea, now, &gaze);
    if (loop->desc->display && !isnan(loop->show.frame_ms))
        desk_frame(loop->desc->desk, loop->show.frame_ms, loop->show.late);
    desk_show(loop->desc->desk, now, view, &gaze, loop->trouble.on ? loop->trouble.sentence : NULL);
}

static bool present(struct loop *loop, const struct machine_view *view, int64_t now)
{
    if (!loop->desc->display) {
        bool busy = loop->busy || loop->trouble.on;
        loop->steps = leap_next(&loop->leap, loop->steps, loop->machine, view, &loop->observer, busy);
        loop->checks++;
        loop->busy = false;
        return true;
    }
    loop->state.selected = keyboard_selected(&loop->keyboard, view);
    loop->state.starts_trial = view->text != loop->desc->plan->protocol->instructions;
    loop->state.look_at_both = loop->notice_ns >= 0 && now - loop->notice_ns < NOTICE_SHOWN_NS;
    loop->state.wait = loop->trouble.on;
    return show_frame(&loop->show, view, &loop->state, &loop->fovea, &loop->recorder, now, loop->error,
                      loop->error_size);
}

static void say_closed(struct loop *loop)
{
    int64_t session_id = loop->desc->ids->session_id;
    bool answer = loop->has_record && !loop->recorder.line_waits && machine_is_answer(loop->record.kind);
    snprintf(loop->error, loop->error_size,
             "the window was closed; %s, session %" PRId64 " is unfinished: fovstudy resume goes on with it",
             answer ? "the last answer could not be stored" : "what was answered is stored", session_id);
}

// Where time is simulated nothing moves while there is trouble. False: the session fails.
static bool stand_still(struct loop *loop)
{
    nanosleep(&(struct timespec){.tv_nsec = TROUBLE_NAP_NS}, NULL);
    return bear_trouble(loop);
}

// The machine's frame and what comes of it. False: the session fails.
static bool advance(struct loop *loop, struct machine_view *out_view)
{
    const struct session_desc *desc = loop->desc;
    if (desc->observer && !loop->trouble.on)
        take_observer(loop, now_ns(loop));
    if (desc->display)
        take_keys(loop);
    take_desk(loop, now_ns(loop));
    if (!prepare(loop))
        return false;
    int64_t now = now_ns(loop);
    take_gaze(loop, now);
    machine_frame(loop->machine, now, out_view);
    if (!loop->trouble.on && !take_records(loop))
        return false;
    uint64_t count = desc->display ? loop->show.number : loop->checks;
    if (!simulated_clock(loop) || count % STORE_CHECK_FRAMES == 0)
        check_store(loop);
    if (loop->trouble.on) {
        pause_machine(loop, now);
        machine_look(loop->machine, out_view);
    }
    tell(loop, out_view);
    bool good = present(loop, out_view, now);
    show_desk(loop, out_view, now);
    return good;
}

// One frame. False: the session is over, by failure or at its end (*out_view tells).
static bool step(struct loop *loop, struct machine_view *out_view, bool *out_failed)
{
    const struct session_desc *desc = loop->desc;
    *out_failed = true;
    if (desc->display && !display_poll(desc->display)) {
        say_closed(loop);
        return false;
    }
    bool still = loop->trouble.on && simulated_clock(loop);
    if (still ? !stand_still(loop) : !bear_trouble(loop) || !advance(loop, out_view))
        return false;
    *out_failed = false;
    return out_view->screen != MACHINE_END || loop->has_record;
}

// The last screen stays a moment where somebody sees it.
static void linger(struct loop *loop, const struct machine_view *last)
{
    bool failed = false;
    struct machine_view view = *last;
    int64_t until_ns = now_ns(loop) + END_SHOWN_NS;
    if (simulated_clock(loop))
        return;
    while (now_ns(loop) < until_ns && display_poll(loop->desc->display) && !failed)
        failed = !present(loop, &view, now_ns(loop));
}

// A session whose last answer was stored and whose end was not: nothing is left to show.
static bool end_at_once(struct loop *loop, struct machine_view *out_view, bool *out_failed)
{
    machine_look(loop->machine, out_view);
    if (out_view->trial)
        return false;
    out_view->complete = true;
    loop->record = (struct machine_record){.kind = MACHINE_ENDED, .trial = UINT32_MAX, .complete = true};
    loop->has_record = true;
    bool good = take_records(loop);
    while (good && loop->has_record)
        good = stand_still(loop);
    *out_failed = !good;
    return true;
}

static bool run(struct loop *loop, struct machine_view *out_view)
{
    const struct session_desc *desc = loop->desc;
    bool failed = true;
    if (!end_at_once(loop, out_view, &failed)) {
        while (step(loop, out_view, &failed))
            continue;
        if (!failed)
            linger(loop, out_view);
    }
    if (!failed && out_view->complete && desc->display)
        failed = !show_measure_rest(&loop->show, loop->error, loop->error_size);
    return !failed;
}

enum session_result session_run(const struct session_desc *desc, char *error, size_t error_size)
{
    static const struct machine_start beginning;
    struct machine_view view = {0};
    struct loop loop = {
        .desc = desc,
        .machine = machine_create(desc->plan, desc->start ? desc->start : &beginning),
        .recorder = {.store = desc->store,
                     .plan = desc->plan,
                     .ids = desc->ids,
                     .lines = desc->lines,
                     .device = desc->observer ? "observer" : "keyboard"},
        .state = {.going_to = PLAN_SLOT_NONE},
        .trouble = {.say = desc->say, .user = desc->say_user},
        .leap = {.step_hz = desc->step_hz},
        .notice_ns = -1,
        .told_screen = MACHINE_END,
        .error = error,
        .error_size = error_size,
    };
    snprintf(error, error_size, "out of memory");
    if (!loop.machine)
        return SESSION_FAILED;
    store_set_busy(desc->store, STORE_BUSY_MS);
    if (desc->observer)
        observer_start(&loop.observer, desc->observer, desc->plan->seed, desc->observer_subject);
    loop.recorder.machine = loop.machine;
    uint32_t places = desc->plan->trial_count + (desc->start ? desc->start->repeat_count : 0);
    bool good = recorder_init(&loop.recorder, places) && (!desc->display || show_init(&loop.show, desc)) &&
                run(&loop, &view);
    show_tell_submitted(&loop.show);
    show_finish(&loop.show);
    recorder_finish(&loop.recorder);
    machine_destroy(loop.machine);
    if (!good)
        return SESSION_FAILED;
    return view.complete ? SESSION_COMPLETE : SESSION_ENDED;
}
