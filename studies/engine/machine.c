// Screens and events. Trials' insides are in stimulus.c, what is on screen in view.c.
#include "studies/engine/machine_state.h"

#include <stdlib.h>
#include <string.h>

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
                                .shown_block = UINT32_MAX,
                                .done = calloc(plan->trial_count + 1, sizeof *machine->done),
                                .attempts = calloc(plan->trial_count + 1, sizeof *machine->attempts)};
    if (!machine->done || !machine->attempts) {
        machine_destroy(machine);
        return NULL;
    }
    if (start && start->done)
        memcpy(machine->done, start->done, plan->trial_count * sizeof *machine->done);
    if (start && start->attempts)
        memcpy(machine->attempts, start->attempts, plan->trial_count * sizeof *machine->attempts);
    machine->text = plan->protocol->instructions;
    machine->screen = start && start->consented ? MACHINE_INSTRUCTIONS : MACHINE_CONSENT;
    return machine;
}

void machine_destroy(struct machine *machine)
{
    if (!machine)
        return;
    free(machine->records);
    free(machine->attempts);
    free(machine->done);
    free(machine);
}

static void end(struct machine *machine, bool complete)
{
    machine->screen = MACHINE_END;
    machine->complete = complete;
    machine->paused = machine->asking = false;
    struct machine_record *record = machine_push(machine, MACHINE_ENDED, machine->now_ns);
    if (record)
        record->complete = complete;
}

uint32_t machine_next_trial(const struct machine *machine)
{
    uint32_t trial = 0;
    while (trial < machine->plan->trial_count && machine->done[trial])
        trial++;
    return trial;
}

static void begin_trial(struct machine *machine)
{
    machine->screen = MACHINE_STIMULUS;
    stimulus_begin(machine);
}

// Towards the first trial that has no answer: its block's beginning where that is new, else `same_block`.
static void go_on(struct machine *machine, enum machine_screen same_block)
{
    machine->trial = machine_next_trial(machine);
    if (machine->trial == machine->plan->trial_count) {
        end(machine, true);
        return;
    }
    uint32_t index = machine->plan->trials[machine->trial].block;
    if (index == machine->shown_block) {
        machine->screen = same_block;
        return;
    }
    machine->shown_block = index;
    machine->text = machine->plan->protocol->blocks[index].instructions;
    machine->screen = *machine->text ? MACHINE_INSTRUCTIONS : MACHINE_READY;
}

// What passes with time alone.
static void advance(struct machine *machine)
{
    if (machine->paused || machine->asking || machine->trial >= machine->plan->trial_count)
        return;
    const struct protocol_settings *settings = machine->plan->trials[machine->trial].resolved;
    if (machine->screen == MACHINE_STIMULUS && settings->view_ns > 0 && machine->stimulus.full_ns >= 0 &&
        machine->plan->trials[machine->trial].kind == PROTOCOL_RATE &&
        stimulus_reaction(machine, machine->now_ns) >= settings->view_ns) {
        stimulus_close_exposure(machine);
        machine->screen = MACHINE_QUESTION;
    }
    if (machine->screen == MACHINE_CONFIRMATION &&
        machine->now_ns - machine->since_ns >= settings->confirm_ns) {
        machine->since_ns += settings->confirm_ns;
        go_on(machine, MACHINE_REST);
    }
    if (machine->screen == MACHINE_REST) {
        settings = machine->plan->trials[machine->trial].resolved;
        if (settings->advance == PROTOCOL_ADVANCE_AUTO &&
            machine->now_ns - machine->since_ns >= settings->rest_ns)
            begin_trial(machine);
    }
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

static void answer(struct machine *machine, enum machine_record_kind kind, int32_t value)
{
    struct machine_record *record = machine_push(machine, kind, machine->now_ns);
    if (!record)
        return;
    record->value = value;
    record->slot = kind == MACHINE_CHOICE ? (enum plan_slot)value : PLAN_SLOT_A;
    record->reaction_ns = stimulus_reaction(machine, machine->now_ns);
    record->toggles = machine->stimulus.toggles;
    machine->last_value = value;
    machine_push(machine, MACHINE_TRIAL_DONE, machine->now_ns);
    machine->screen = machine->screen == MACHINE_END ? MACHINE_END : MACHINE_STORING;
}

static void stimulus_event(struct machine *machine, const struct machine_event *event)
{
    bool toggle_trial = machine->plan->trials[machine->trial].kind == PROTOCOL_TOGGLE;
    const struct stimulus *s = &machine->stimulus;
    if (event->kind == MACHINE_TOGGLE_KEY && toggle_trial) {
        stimulus_toggle(machine, machine->now_ns);
    } else if (event->kind == MACHINE_CHOOSE && toggle_trial && (event->value == 0 || event->value == 1)) {
        if (s->seen[0] && s->seen[1]) {
            stimulus_close_exposure(machine);
            answer(machine, MACHINE_CHOICE, event->value);
        } else {
            struct machine_record *record = machine_push(machine, MACHINE_CHOICE_EARLY, machine->now_ns);
            if (record)
                record->slot = (enum plan_slot)event->value;
        }
    } else if (event->kind == MACHINE_START && !toggle_trial && s->full_ns >= 0 &&
               machine->plan->trials[machine->trial].resolved->view_ns == 0) {
        stimulus_close_exposure(machine);
        machine->screen = MACHINE_QUESTION;
    }
}

bool machine_may_go_on(const struct machine *machine)
{
    return machine->now_ns - machine->since_ns >= machine->plan->trials[machine->trial].resolved->rest_ns;
}

static void screen_event(struct machine *machine, const struct machine_event *event)
{
    const struct protocol_question *question;
    switch (machine->screen) {
    case MACHINE_CONSENT:
        if (event->kind == MACHINE_YES) {
            machine_push(machine, MACHINE_CONSENT_GIVEN, machine->now_ns);
            machine->screen = *machine->text ? MACHINE_INSTRUCTIONS : MACHINE_READY;
            if (!*machine->text)
                go_on(machine, MACHINE_READY);
        } else if (event->kind == MACHINE_NO) {
            machine_push(machine, MACHINE_CONSENT_REFUSED, machine->now_ns);
            end(machine, false);
        }
        break;
    case MACHINE_INSTRUCTIONS:
        if (event->kind == MACHINE_START && machine->shown_block == UINT32_MAX)
            go_on(machine, MACHINE_READY);
        else if (event->kind == MACHINE_START)
            begin_trial(machine);
        break;
    case MACHINE_READY:
        if (event->kind == MACHINE_START)
            begin_trial(machine);
        break;
    case MACHINE_STIMULUS:
        stimulus_event(machine, event);
        break;
    case MACHINE_QUESTION:
        question = machine->plan->trials[machine->trial].question;
        if (event->kind == MACHINE_RATE && event->value >= question->scale_min &&
            event->value <= question->scale_max)
            answer(machine, MACHINE_RATING, event->value);
        break;
    case MACHINE_STORING:
        if (event->kind == MACHINE_ANSWER_STORED) {
            machine->done[machine->trial] = true;
            machine->screen = MACHINE_CONFIRMATION;
            machine->since_ns = machine->now_ns;
        }
        break;
    case MACHINE_REST:
        if (event->kind == MACHINE_START && machine_may_go_on(machine))
            begin_trial(machine);
        break;
    case MACHINE_CONFIRMATION:
    case MACHINE_PAUSED:
    case MACHINE_ABORT:
    case MACHINE_END:
        break;
    }
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
        machine->stimulus.paused_full_ns += passed;
}

// Pause and abort lie above every screen but those where an answer is on its way to the store and the end.
static bool suspension_event(struct machine *machine, const struct machine_event *event)
{
    if (machine->asking) {
        if (event->kind == MACHINE_YES) {
            end(machine, false);
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
    if (machine->screen == MACHINE_STORING || !suspension_event(machine, event))
        screen_event(machine, event);
}

void machine_frame(struct machine *machine, int64_t now_ns, struct machine_view *out_view)
{
    tick(machine, now_ns);
    if (machine->screen == MACHINE_STIMULUS && !machine->paused && !machine->asking)
        stimulus_frame(machine, machine->now_ns);
    machine_look(machine, out_view);
}
