// What is on screen, from the state alone; and the words that the store and event lines use.
#include "studies/engine/machine_state.h"

const char *machine_screen_name(enum machine_screen screen)
{
    static const char *const names[] = {"consent",  "instructions", "ready",        "stimulus",
                                        "question", "storing",      "confirmation", "rest",
                                        "paused",   "abort",        "end"};
    return names[screen];
}

const char *machine_phase_name(enum machine_phase phase)
{
    static const char *const names[] = {"stimulus", "fade", "question", "rest"};
    return names[phase];
}

const char *machine_record_name(enum machine_record_kind kind)
{
    static const char *const names[] = {"consent_given", "consent_refused", "trial_started",  "trial_done",
                                        "exposure",      "toggle",          "toggle_ignored", "choice_early",
                                        "choice",        "rating",          "pause_began",    "pause_ended",
                                        "abort_asked",   "abort_declined",  "clock_back",     "ended"};
    return names[kind];
}

static enum machine_screen top_screen(const struct machine *machine)
{
    return machine->asking ? MACHINE_ABORT : machine->paused ? MACHINE_PAUSED : machine->screen;
}

static const char *screen_text(const struct machine *machine, enum machine_screen screen,
                               const struct plan_trial *trial)
{
    switch (screen) {
    case MACHINE_CONSENT:
        return machine->plan->protocol->consent_text;
    case MACHINE_INSTRUCTIONS:
        return machine->text;
    case MACHINE_QUESTION:
        return trial->question->text;
    default:
        return NULL;
    }
}

void machine_look(const struct machine *machine, struct machine_view *out_view)
{
    enum machine_screen screen = top_screen(machine);
    uint32_t next = machine->shown_block == UINT32_MAX ? machine_next_trial(machine) : machine->trial;
    const struct plan_trial *trial = next < machine->plan->trial_count ? &machine->plan->trials[next] : NULL;
    *out_view = (struct machine_view){.screen = screen,
                                      .phase = MACHINE_PHASE_REST,
                                      .trial = trial,
                                      .trial_index = next,
                                      .slot = PLAN_SLOT_NONE,
                                      .condition = -1,
                                      .fade = 1,
                                      .text = screen_text(machine, screen, trial),
                                      .last_value = machine->last_value,
                                      .total = machine->plan->trial_count,
                                      .complete = machine->complete};
    for (uint32_t i = 0; i < out_view->total; i++)
        out_view->done += machine->done[i];
    if (trial)
        out_view->attempt = machine->attempts[next];
    const struct stimulus *s = &machine->stimulus;
    if (screen == MACHINE_STIMULUS && !s->starting && trial) {
        out_view->phase = s->level > 0 ? MACHINE_PHASE_FADE : MACHINE_PHASE_STIMULUS;
        out_view->slot = s->slot;
        out_view->condition = trial->option[s->slot];
        out_view->fade = s->level;
        out_view->trial_started = s->began_now;
        out_view->may_choose = s->seen[0] && s->seen[1];
        out_view->stimulus_ns = s->camera_ns;
        out_view->question = trial->kind == PROTOCOL_TOGGLE ? trial->question : NULL;
    } else if (screen == MACHINE_QUESTION || screen == MACHINE_STORING || screen == MACHINE_CONFIRMATION) {
        out_view->phase = MACHINE_PHASE_QUESTION;
        out_view->question = screen == MACHINE_QUESTION && trial ? trial->question : NULL;
    } else if (screen == MACHINE_REST && trial) {
        out_view->may_choose = machine_may_go_on(machine);
    }
}
