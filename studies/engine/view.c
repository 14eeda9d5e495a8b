// What is on screen, from the state alone; and the words that the store and event lines use.
#include "studies/engine/machine_state.h"

#include <math.h>
#include <string.h>

const char *machine_screen_name(enum machine_screen screen)
{
    static const char *const names[] = {"consent",  "instructions", "ready",        "stimulus",
                                        "question", "storing",      "confirmation", "rest",
                                        "break",    "paused",       "abort",        "end"};
    return names[screen];
}

const char *machine_phase_name(enum machine_phase phase)
{
    static const char *const names[] = {"stimulus", "fade", "question", "rest"};
    return names[phase];
}

bool machine_is_answer(enum machine_record_kind kind)
{
    return kind == MACHINE_CHOICE || kind == MACHINE_RATING || kind == MACHINE_RESPONSES;
}

const char *machine_record_name(enum machine_record_kind kind)
{
    static const char *const names[] = {"consent_given",  "consent_refused", "trial_started", "trial_done",
                                        "trial_invalid",  "trial_skipped",   "exposure",      "toggle",
                                        "toggle_ignored", "choice_early",    "adjusted",      "choice",
                                        "rating",         "responses",       "pause_began",   "pause_ended",
                                        "abort_asked",    "abort_declined",  "clock_back",    "ended"};
    return names[kind];
}

static enum machine_screen top_screen(const struct machine *machine)
{
    return machine->asking ? MACHINE_ABORT : machine->paused ? MACHINE_PAUSED : machine->screen;
}

static const char *screen_text(const struct machine *machine, enum machine_screen screen,
                               const struct protocol_question *question)
{
    switch (screen) {
    case MACHINE_CONSENT:
        return machine->plan->protocol->consent_text;
    case MACHINE_INSTRUCTIONS:
        return machine->text;
    case MACHINE_QUESTION:
        return question ? question->text : NULL;
    default:
        return NULL;
    }
}

// Whether START ends the stimulus: where nothing else does, and all was seen.
static bool leads_on(const struct machine *machine, const struct plan_trial *trial,
                     const struct protocol_question *question)
{
    if (!protocol_kind_is_pair(trial->kind))
        return trial->resolved->view_ns == 0 && machine->stimulus.full_ns >= 0;
    return trial->kind != PROTOCOL_SEQUENTIAL && !question && stimulus_seen(machine);
}

static void look_at_stimulus(const struct machine *machine, const struct plan_trial *trial,
                             struct machine_view *out)
{
    const struct stimulus *s = &machine->stimulus;
    struct machine_ask ask = {0};
    bool gap = s->fade == FADE_GAP;
    out->phase = s->level > 0 ? MACHINE_PHASE_FADE : MACHINE_PHASE_STIMULUS;
    out->slot = gap ? PLAN_SLOT_NONE : s->slot;
    out->condition = gap ? -1 : trial->option[s->slot];
    out->fade = s->level;
    out->marker = gap;
    out->showing = s->showing;
    out->trial_started = s->began_now;
    out->may_choose = stimulus_seen(machine);
    out->stimulus_ns = s->camera_ns;
    out->adjusted = trial->kind == PROTOCOL_ADJUST ? machine->adjusted : NULL;
    out->adjust_count = machine->answers[machine->trial] == 0 ? machine_block(machine)->adjust_count : 0;
    out->adjusting = machine->adjusting;
    // A choice between two that can be switched is made while looking at them.
    bool chooses = trial->kind == PROTOCOL_TOGGLE || trial->kind == PROTOCOL_STAIRCASE;
    if (chooses && machine->answers[machine->trial] == 0 && machine_ask(machine->plan, trial, 0, &ask) &&
        ask.question->type == PROTOCOL_ASK_CHOICE)
        out->question = ask.question;
    out->may_go_on = leads_on(machine, trial, out->question);
}

// The place of the running or next trial; course_places: none is left.
static uint32_t place_ahead(const struct machine *machine)
{
    return machine->shown_block == UINT32_MAX ? course_next(machine) : machine->trial;
}

bool machine_option(const struct machine *machine, enum plan_slot slot, struct protocol_option *out)
{
    uint32_t place = place_ahead(machine);
    const struct plan *plan = machine->plan;
    if (slot == PLAN_SLOT_NONE || place >= course_places(machine))
        return false;
    const struct plan_trial *trial = machine_trial(machine, place);
    if (trial->option[slot] < 0)
        return false;
    const struct plan_condition *condition = &plan->conditions[trial->option[slot]];
    *out = (struct protocol_option){.mode = condition->mode_index};
    memcpy(out->values, condition->values, sizeof out->values);
    if (slot != trial->test_slot)
        return true;
    double level = course_level(machine, place);
    if (!isnan(level))
        *out = plan_level_option(plan, trial, level);
    const struct protocol_block *block = &plan->protocol->blocks[trial->block];
    const bool begun = machine->screen == MACHINE_STIMULUS || machine->screen == MACHINE_QUESTION ||
                       machine->screen == MACHINE_STORING;
    const double *values = begun                          ? machine->adjusted
                           : machine->answers[place] == 0 ? trial->adjust_start
                                                          : machine->answered[place];
    for (uint32_t i = 0; trial->kind == PROTOCOL_ADJUST && i < block->adjust_count; i++)
        out->values[block->adjusts[i].parameter] = plan_level(values[i]);
    return true;
}

// Of the running trial, or of the one that comes next where one does.
static double level_of(const struct machine *machine, uint32_t next)
{
    switch (machine->screen) {
    case MACHINE_INSTRUCTIONS:
    case MACHINE_READY:
    case MACHINE_REST:
    case MACHINE_BREAK:
        return next < course_places(machine) ? course_level(machine, next) : (double)NAN;
    case MACHINE_STIMULUS:
    case MACHINE_QUESTION:
    case MACHINE_STORING:
        return machine->level;
    default:
        return NAN;
    }
}

void machine_look(const struct machine *machine, struct machine_view *out_view)
{
    enum machine_screen screen = top_screen(machine);
    uint32_t places = course_places(machine);
    uint32_t next = place_ahead(machine);
    const struct plan_trial *trial = next < places ? machine_trial(machine, next) : NULL;
    *out_view = (struct machine_view){.screen = screen,
                                      .phase = MACHINE_PHASE_REST,
                                      .trial = trial,
                                      .trial_index = next,
                                      .slot = PLAN_SLOT_NONE,
                                      .subject = PLAN_SLOT_NONE,
                                      .condition = -1,
                                      .fade = 1,
                                      .level = level_of(machine, next),
                                      .last_value = machine->last_value,
                                      .total = places,
                                      .complete = machine->complete};
    for (uint32_t i = 0; i < places; i++)
        out_view->done += machine->done[i];
    if (trial)
        out_view->attempt = machine->attempts[next];
    if (screen == MACHINE_STIMULUS && !machine->stimulus.starting && trial) {
        look_at_stimulus(machine, trial, out_view);
    } else if (screen == MACHINE_QUESTION || screen == MACHINE_STORING || screen == MACHINE_CONFIRMATION) {
        struct machine_ask ask = {0};
        out_view->phase = MACHINE_PHASE_QUESTION;
        if (screen == MACHINE_QUESTION && trial &&
            machine_ask(machine->plan, trial, machine->answers[next], &ask)) {
            out_view->question = ask.question;
            out_view->subject = ask.subject;
        }
    } else if ((screen == MACHINE_REST || screen == MACHINE_BREAK) && trial) {
        int64_t left = machine_rest_ns(machine) - (machine->now_ns - machine->since_ns);
        out_view->may_choose = machine_may_go_on(machine);
        out_view->wait_ns = left > 0 ? left : 0;
    }
    out_view->text = screen_text(machine, screen, out_view->question);
}
