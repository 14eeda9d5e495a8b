// Screens and events. Which trial comes next and its answers are in course.c, what a trial shows in stimulus.c,
// what is on screen in view.c.
#include "studies/engine/machine_state.h"

#include <math.h>
#include <stdlib.h>

// A new record at the queue's end. Where there is no memory left for it the session ends, since nothing may be
// lost silently; NULL then.
struct machine_record *machine_push(struct machine *machine, enum machine_record_kind kind, int64_t at_ns)
{
    if (machine->record_first + machine->record_count == machine->record_capacity) {
        uint32_t capacity = machine->record_capacity ? 2 * machine->record_capacity : 64;
        struct machine_record *records = realloc(machine->records, capacity * sizeof *records);
        if (!records) {
            machine->screen = MACHINE_END;
            machine->complete = false;
            return NULL;
        }
        machine->records = records;
        machine->record_capacity = capacity;
    }
    struct machine_record *record = &machine->records[machine->record_first + machine->record_count++];
    bool in_trial = machine->screen == MACHINE_STIMULUS || machine->screen == MACHINE_QUESTION ||
                    machine->screen == MACHINE_STORING;
    *record = (struct machine_record){.kind = kind,
                                      .at_ns = at_ns,
                                      .trial = in_trial ? machine->trial : UINT32_MAX,
                                      .attempt = in_trial ? machine->attempts[machine->trial] : 0,
                                      .slot = PLAN_SLOT_NONE,
                                      .correct = -1,
                                      .level = in_trial ? machine->level : NAN,
                                      .full_start_ns = -1,
                                      .full_end_ns = -1};
    return record;
}

bool machine_next_record(struct machine *machine, struct machine_record *out_record)
{
    if (machine->record_count == 0)
        return false;
    *out_record = machine->records[machine->record_first++];
    if (--machine->record_count == 0)
        machine->record_first = 0;
    return true;
}

struct machine *machine_create(const struct plan *plan, const struct machine_start *start)
{
    struct machine *machine = calloc(1, sizeof *machine);
    if (!machine)
        return NULL;
    *machine = (struct machine){.plan = plan,
                                .now_ns = INT64_MIN,
                                .last_trial = UINT32_MAX,
                                .shown_block = UINT32_MAX,
                                .broken = UINT32_MAX,
                                .level = NAN};
    if (!course_create(machine, start)) {
        machine_destroy(machine);
        return NULL;
    }
    machine->text = plan->protocol->instructions;
    machine->screen = start && start->consented ? MACHINE_INSTRUCTIONS : MACHINE_CONSENT;
    return machine;
}

void machine_destroy(struct machine *machine)
{
    if (!machine)
        return;
    course_destroy(machine);
    free(machine->records);
    free(machine);
}

void machine_end(struct machine *machine, bool complete)
{
    machine->screen = MACHINE_END;
    machine->complete = complete;
    machine->paused = machine->asking = false;
    struct machine_record *record = machine_push(machine, MACHINE_ENDED, machine->now_ns);
    if (record)
        record->complete = complete;
}

int64_t machine_rest_ns(const struct machine *machine)
{
    return machine->screen == MACHINE_BREAK ? machine_block(machine)->break_ns
                                            : machine_running(machine)->resolved->rest_ns;
}

bool machine_may_go_on(const struct machine *machine)
{
    return machine->now_ns - machine->since_ns >= machine_rest_ns(machine);
}

// Answers have a time; who is too late gets the trial again. INT64_MAX: there is none now.
static int64_t deadline_ns(const struct machine *machine)
{
    int64_t deadline = machine_running(machine)->resolved->deadline_ns;
    if (deadline <= 0 || machine->answers[machine->trial] > 0)
        return INT64_MAX;
    if (machine->screen == MACHINE_QUESTION)
        return machine->asked_ns + deadline;
    bool answers_here = machine_running(machine)->kind == PROTOCOL_TOGGLE ||
                        machine_running(machine)->kind == PROTOCOL_STAIRCASE ||
                        machine_running(machine)->kind == PROTOCOL_ADJUST;
    if (machine->screen != MACHINE_STIMULUS || !answers_here || machine->stimulus.full_ns < 0)
        return INT64_MAX;
    return machine->stimulus.full_ns + machine->stimulus.paused_full_ns + deadline;
}

static bool is_late(const struct machine *machine)
{
    return machine->now_ns > deadline_ns(machine);
}

// What passes with time alone.
static void advance(struct machine *machine)
{
    if (machine->paused || machine->asking || machine->trial >= course_places(machine))
        return;
    if (machine->screen == MACHINE_STIMULUS && stimulus_timed_out(machine, machine->now_ns)) {
        stimulus_close_exposure(machine);
        course_ask(machine);
    }
    if (is_late(machine))
        course_invalid(machine, machine->trial, true);
    if (machine->screen == MACHINE_CONFIRMATION) {
        int64_t confirm = machine_running(machine)->resolved->confirm_ns;
        if (machine->now_ns - machine->since_ns >= confirm) {
            machine->since_ns += confirm;
            course_go_on(machine, MACHINE_REST);
        }
        return; // a rest lasts a frame at least, in which the next trial is made ready
    }
    if (machine->screen == MACHINE_REST &&
        machine_running(machine)->resolved->advance == PROTOCOL_ADVANCE_AUTO && machine_may_go_on(machine))
        course_begin(machine);
}

int64_t machine_next_ns(const struct machine *machine)
{
    if (machine->paused || machine->asking || machine->trial >= course_places(machine))
        return INT64_MAX;
    int64_t late = deadline_ns(machine), next = INT64_MAX;
    if (machine->screen == MACHINE_STIMULUS)
        next = stimulus_next_ns(machine);
    else if (machine->screen == MACHINE_STORING)
        next = INT64_MIN;
    else if (machine->screen == MACHINE_CONFIRMATION)
        next = machine->since_ns + machine_running(machine)->resolved->confirm_ns;
    else if (machine->screen == MACHINE_REST || machine->screen == MACHINE_BREAK)
        next = machine->since_ns + machine_rest_ns(machine);
    bool waits_for_key =
        machine->screen == MACHINE_BREAK || machine_running(machine)->resolved->advance == PROTOCOL_ADVANCE_KEY;
    if ((machine->screen == MACHINE_REST || machine->screen == MACHINE_BREAK) && waits_for_key &&
        machine_may_go_on(machine))
        next = INT64_MAX;
    return late < INT64_MAX && late + 1 < next ? late + 1 : next;
}

static void tick(struct machine *machine, int64_t now_ns)
{
    if (now_ns >= machine->now_ns) {
        machine->now_ns = now_ns;
        machine->clock_back = false;
    } else if (!machine->clock_back) {
        machine->clock_back = true;
        struct machine_record *record = machine_push(machine, MACHINE_CLOCK_BACK, machine->now_ns);
        if (record)
            record->value_ns = machine->now_ns - now_ns;
    }
    advance(machine);
}

static void adjust(struct machine *machine, const struct machine_event *event)
{
    const struct protocol_block *block = machine_block(machine);
    uint32_t count = block->adjust_count;
    if (event->kind == MACHINE_ADJUST_NEXT) {
        machine->adjusting = (machine->adjusting + (event->value > 0 ? 1 : count - 1)) % count;
        return;
    }
    const struct protocol_adjust *limits = &block->adjusts[machine->adjusting];
    double value = machine->adjusted[machine->adjusting] + event->value * limits->step;
    value = value < limits->min ? limits->min : value > limits->max ? limits->max : value;
    machine->adjusted[machine->adjusting] = value;
    struct machine_record *record = machine_push(machine, MACHINE_ADJUSTED, machine->now_ns);
    if (record) {
        record->parameter = machine->adjusting;
        record->numbers[0] = value;
    }
}

static void stimulus_event(struct machine *machine, const struct machine_event *event)
{
    const struct plan_trial *trial = machine_running(machine);
    bool toggles = protocol_kind_is_pair(trial->kind) && trial->kind != PROTOCOL_SEQUENTIAL;
    struct machine_view view;
    machine_look(machine, &view);
    if (event->kind == MACHINE_TOGGLE_KEY && toggles) {
        stimulus_toggle(machine, machine->now_ns);
    } else if (event->kind == MACHINE_CHOOSE && view.question &&
               (event->value == PLAN_SLOT_A || event->value == PLAN_SLOT_B ||
                (event->value == PLAN_SLOT_NONE && view.question->equal))) {
        if (stimulus_seen(machine)) {
            stimulus_close_exposure(machine);
            course_answer(machine, MACHINE_CHOICE, event->value);
        } else {
            struct machine_record *record = machine_push(machine, MACHINE_CHOICE_EARLY, machine->now_ns);
            if (record)
                record->slot = (enum plan_slot)event->value;
        }
    } else if ((event->kind == MACHINE_ADJUST || event->kind == MACHINE_ADJUST_NEXT) &&
               trial->kind == PROTOCOL_ADJUST && machine->answers[machine->trial] == 0 &&
               !machine->stimulus.starting) {
        adjust(machine, event);
    } else if (event->kind == MACHINE_START && view.may_go_on) {
        stimulus_close_exposure(machine);
        if (trial->kind == PROTOCOL_ADJUST && machine->answers[machine->trial] == 0)
            course_answer(machine, MACHINE_RESPONSES, 0);
        else
            course_ask(machine);
    }
}

static void question_event(struct machine *machine, const struct machine_event *event)
{
    struct machine_ask ask;
    machine_ask(machine->plan, machine_running(machine), machine->answers[machine->trial], &ask);
    const struct protocol_question *question = ask.question;
    if (event->kind == MACHINE_RATE && question->type != PROTOCOL_ASK_CHOICE &&
        event->value >= question->scale_min && event->value <= question->scale_max)
        course_answer(machine, question->type == PROTOCOL_ASK_COUNT ? MACHINE_RESPONSES : MACHINE_RATING,
                      event->value);
    else if (event->kind == MACHINE_CHOOSE && question->type == PROTOCOL_ASK_CHOICE &&
             (event->value == PLAN_SLOT_A || event->value == PLAN_SLOT_B ||
              (event->value == PLAN_SLOT_NONE && question->equal)))
        course_answer(machine, MACHINE_CHOICE, event->value);
}

static void screen_event(struct machine *machine, const struct machine_event *event)
{
    switch (machine->screen) {
    case MACHINE_CONSENT:
        if (event->kind == MACHINE_YES) {
            machine_push(machine, MACHINE_CONSENT_GIVEN, machine->now_ns);
            machine->screen = *machine->text ? MACHINE_INSTRUCTIONS : MACHINE_READY;
            if (!*machine->text)
                course_go_on(machine, MACHINE_READY);
        } else if (event->kind == MACHINE_NO) {
            machine_push(machine, MACHINE_CONSENT_REFUSED, machine->now_ns);
            machine_end(machine, false);
        }
        break;
    case MACHINE_INSTRUCTIONS:
        if (event->kind == MACHINE_START && machine->shown_block == UINT32_MAX)
            course_go_on(machine, MACHINE_READY);
        else if (event->kind == MACHINE_START)
            course_begin(machine);
        break;
    case MACHINE_READY:
        if (event->kind == MACHINE_START)
            course_begin(machine);
        break;
    case MACHINE_STIMULUS:
        stimulus_event(machine, event);
        break;
    case MACHINE_QUESTION:
        question_event(machine, event);
        break;
    case MACHINE_STORING:
        if (event->kind == MACHINE_ANSWER_STORED)
            course_stored(machine);
        break;
    case MACHINE_REST:
    case MACHINE_BREAK:
        if (event->kind == MACHINE_START && machine_may_go_on(machine))
            course_begin(machine);
        break;
    case MACHINE_CONFIRMATION:
    case MACHINE_PAUSED:
    case MACHINE_ABORT:
    case MACHINE_END:
        break;
    }
}

// The running trial while it runs, else the one answered last.
static void flag(struct machine *machine)
{
    bool running = machine->screen == MACHINE_STIMULUS || machine->screen == MACHINE_QUESTION;
    uint32_t place = running ? machine->trial : machine->last_trial;
    if (place != UINT32_MAX && (!running || !machine->stimulus.starting))
        course_invalid(machine, place, false);
}

static void suspend(struct machine *machine)
{
    if (machine->paused || machine->asking)
        return;
    machine->suspended_ns = machine->now_ns;
    if (machine->screen == MACHINE_STIMULUS)
        stimulus_close_exposure(machine);
}

static void resume(struct machine *machine)
{
    if (machine->paused || machine->asking)
        return;
    int64_t passed = machine->now_ns - machine->suspended_ns;
    machine->since_ns += passed;
    if (machine->screen == MACHINE_STIMULUS)
        stimulus_resume(machine, passed);
    else if (machine->screen == MACHINE_QUESTION)
        machine->asked_ns += passed;
}

// Pause and abort lie above every screen but those where an answer is on its way to the store and the end.
static bool suspension_event(struct machine *machine, const struct machine_event *event)
{
    if (machine->asking) {
        if (event->kind == MACHINE_YES) {
            machine_end(machine, false);
        } else if (event->kind == MACHINE_NO || event->kind == MACHINE_ABORT_KEY) {
            machine->asking = false;
            machine_push(machine, MACHINE_ABORT_DECLINED, machine->now_ns);
            resume(machine);
        }
        return true;
    }
    if (event->kind == MACHINE_ABORT_KEY) {
        suspend(machine);
        machine->asking = true;
        machine_push(machine, MACHINE_ABORT_ASKED, machine->now_ns);
        return true;
    }
    if (machine->paused) {
        if (event->kind == MACHINE_PAUSE || event->kind == MACHINE_START) {
            machine->paused = false;
            machine_push(machine, MACHINE_PAUSE_ENDED, machine->now_ns);
            resume(machine);
        }
        return true;
    }
    if (event->kind == MACHINE_PAUSE && machine->screen != MACHINE_CONSENT) {
        suspend(machine);
        machine->paused = true;
        machine_push(machine, MACHINE_PAUSE_BEGAN, machine->now_ns);
        return true;
    }
    return false;
}

void machine_event(struct machine *machine, int64_t now_ns, const struct machine_event *event)
{
    tick(machine, now_ns);
    if (machine->screen == MACHINE_END)
        return;
    if (machine->screen == MACHINE_STORING) {
        screen_event(machine, event);
    } else if (!suspension_event(machine, event)) {
        if (event->kind == MACHINE_FLAG)
            flag(machine);
        else
            screen_event(machine, event);
    }
}

void machine_frame(struct machine *machine, int64_t now_ns, struct machine_view *out_view)
{
    tick(machine, now_ns);
    if (machine->screen == MACHINE_STIMULUS && !machine->paused && !machine->asking)
        stimulus_frame(machine, machine->now_ns);
    machine_look(machine, out_view);
}
