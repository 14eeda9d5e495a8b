#include "app/session/screens.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

// The letter of a switch, by the size of other text: it is on screen for a quarter of a second.
#define LETTER_SIZE 3.0

static void put(char *out, size_t size, const char *text)
{
    snprintf(out, size, "%s", text ? text : "");
    size_t length = strlen(out);
    while (length > 0 && out[length - 1] == '\n')
        out[--length] = '\0';
}

#define PUT(field, text) put(field, sizeof(field), text)

#define SWITCH_KEYS                                                                                            \
    "Space: switch between A and B\n\xe2\x86\x90 or 1: choose A    \xe2\x86\x92 or 2: choose B\n"

// What the keys do in the trial to come, and how it starts.
static void trial_hint(const struct machine_view *view, struct screen *out)
{
    bool toggle = view->trial->kind == PROTOCOL_TOGGLE;
    bool by_itself = view->screen == MACHINE_REST && view->trial->resolved->advance == PROTOCOL_ADVANCE_AUTO;
    snprintf(out->hint, sizeof out->hint, "%s%s", toggle ? SWITCH_KEYS : "",
             by_itself ? ""
             : toggle  ? "Enter: start"
                       : "Enter: start; Enter again: give your rating");
}

static void before_trial(const struct machine_view *view, struct screen *out)
{
    if (!view->trial)
        return;
    bool toggle = view->trial->kind == PROTOCOL_TOGGLE;
    snprintf(out->title, sizeof out->title, "%" PRIu32 " of %" PRIu32, view->done + 1, view->total);
    if (toggle)
        snprintf(out->body, sizeof out->body, "%s\n%s comes first.",
                 view->trial->question ? view->trial->question->text : "",
                 view->trial->first_shown == PLAN_SLOT_B ? "B" : "A");
    else
        PUT(out->body, "Look around in the scene.");
    trial_hint(view, out);
}

static void question(const struct machine_view *view, const struct screen_state *state, struct screen *out)
{
    if (!view->question)
        return;
    PUT(out->body, view->question->text);
    PUT(out->hint, "\xe2\x86\x90 \xe2\x86\x92 or a number: mark\nEnter: confirm");
    PUT(out->low, view->question->label_min);
    PUT(out->high, view->question->label_max);
    out->scale_min = view->question->scale_min;
    out->scale_max = view->question->scale_max;
    out->scale_selected = state->selected;
}

static void confirmation(const struct machine_view *view, struct screen *out)
{
    bool choice = view->trial && view->trial->kind == PROTOCOL_TOGGLE;
    PUT(out->title, "Answer stored");
    if (choice)
        PUT(out->body, view->last_value == PLAN_SLOT_A ? "A" : "B");
    else
        snprintf(out->body, sizeof out->body, "%" PRId32, view->last_value);
}

static void stimulus(const struct machine_view *view, const struct screen_state *state, struct screen *out)
{
    bool toggling = view->trial && view->trial->kind == PROTOCOL_TOGGLE;
    if (toggling && view->fade >= 1.0 && state->going_to != PLAN_SLOT_NONE) {
        PUT(out->title, state->going_to == PLAN_SLOT_A ? "A" : "B");
        out->size = LETTER_SIZE;
    } else if (toggling && state->look_at_both) {
        PUT(out->body, "Please look at both, A and B, before you choose.");
        PUT(out->hint, "Space: switch");
    }
}

static void end(const struct machine_view *view, struct screen *out)
{
    PUT(out->title, "Thank you");
    PUT(out->body, view->complete ? "That was all. You may take the headset off."
                                  : "The session has ended. You may take the headset off.");
}

void screen_of(const struct machine_view *view, const struct screen_state *state, struct screen *out)
{
    memset(out, 0, sizeof *out);
    PUT(out->more, "\xe2\x86\x92 or Enter: read on");
    out->size = 1.0;
    if (state->wait) {
        PUT(out->title, "Please wait ...");
        PUT(out->body, "The study cannot be stored just now.\nNothing is lost. Please call the experimenter.");
        out->shown = true;
        return;
    }
    switch (view->screen) {
    case MACHINE_CONSENT:
        PUT(out->title, "Consent");
        PUT(out->body, view->text);
        PUT(out->hint, "Y: yes    N: no");
        break;
    case MACHINE_INSTRUCTIONS:
        PUT(out->body, view->text);
        PUT(out->hint, "Enter: go on");
        if (state->starts_trial && view->trial)
            trial_hint(view, out);
        break;
    case MACHINE_READY:
    case MACHINE_REST:
        before_trial(view, out);
        break;
    case MACHINE_STIMULUS:
        stimulus(view, state, out);
        break;
    case MACHINE_QUESTION:
        question(view, state, out);
        break;
    case MACHINE_STORING:
        break;
    case MACHINE_CONFIRMATION:
        confirmation(view, out);
        break;
    case MACHINE_PAUSED:
        PUT(out->title, "Pause");
        PUT(out->hint, "Enter: go on");
        break;
    case MACHINE_ABORT:
        PUT(out->title, "End the session?");
        PUT(out->body, "What you have answered is kept.");
        PUT(out->hint, "Y: end    N: go on");
        break;
    case MACHINE_END:
        end(view, out);
        break;
    }
    out->shown = out->title[0] || out->body[0] || out->hint[0];
}

bool screen_same(const struct screen *a, const struct screen *b)
{
    if (!a->shown || !b->shown)
        return a->shown == b->shown;
    return strcmp(a->title, b->title) == 0 && strcmp(a->body, b->body) == 0 && strcmp(a->hint, b->hint) == 0 &&
           strcmp(a->more, b->more) == 0 && strcmp(a->low, b->low) == 0 && strcmp(a->high, b->high) == 0 &&
           a->scale_min == b->scale_min && a->scale_max == b->scale_max &&
           a->scale_selected == b->scale_selected && !(a->size < b->size) && !(a->size > b->size);
}

struct text_screen screen_text(const struct screen *screen)
{
    return (struct text_screen){
        .title = screen->title,
        .body = screen->body,
        .hint = screen->hint,
        .more = screen->more,
        .scale_min = screen->scale_min,
        .scale_max = screen->scale_max,
        .scale_selected = screen->scale_selected,
        .scale_low = screen->low[0] ? screen->low : NULL,
        .scale_high = screen->high[0] ? screen->high : NULL,
        .size = screen->size,
    };
}
