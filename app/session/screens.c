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

#define LEFT "\xe2\x86\x90"
#define RIGHT "\xe2\x86\x92"
#define UP "\xe2\x86\x91"
#define DOWN "\xe2\x86\x93"

static bool can_equal(const struct protocol_question *question)
{
    return question && question->type == PROTOCOL_ASK_CHOICE && question->equal;
}

// What the keys do in the trial to come.
static const char *keys_of(const struct plan_trial *trial)
{
    bool timed = trial->resolved->view_ns > 0;
    switch (trial->kind) {
    case PROTOCOL_TOGGLE:
    case PROTOCOL_STAIRCASE:
        if (trial->question && trial->question->type == PROTOCOL_ASK_RATING)
            return "Space: switch between A and B\nEnter, once both were seen: give your rating";
        return can_equal(trial->question) ? "Space: switch between A and B\n" LEFT " or 1: choose A    " RIGHT
                                            " or 2: choose B    " DOWN " or 0: equal"
                                          : "Space: switch between A and B\n" LEFT " or 1: choose A    " RIGHT
                                            " or 2: choose B";
    case PROTOCOL_ADJUST:
        return "Space: switch between A and B\n" UP " " DOWN ": change A or B    Tab: change something else\n"
               "Enter: they look the same now";
    default:
        return timed ? "" : "Enter, once you have seen enough: go on";
    }
}

static void trial_hint(const struct machine_view *view, struct screen *out)
{
    bool by_itself = view->screen == MACHINE_REST && view->trial->resolved->advance == PROTOCOL_ADVANCE_AUTO;
    const char *keys = keys_of(view->trial);
    snprintf(out->hint, sizeof out->hint, "%s%s%s", keys, *keys && !by_itself ? "\n" : "",
             by_itself ? "" : "Enter: start");
}

// What to do with the eyes.
static const char *where_to_look(const struct plan_trial *trial)
{
    switch (trial->resolved->fixation) {
    case PROTOCOL_FIXATION_CROSS:
        return "Keep your eyes on the cross in the middle.";
    case PROTOCOL_FIXATION_MOVING:
        return "Follow the moving sphere with your eyes.";
    default:
        return "Look around in the scene.";
    }
}

static void before_trial(const struct machine_view *view, struct screen *out)
{
    if (!view->trial)
        return;
    const struct plan_trial *trial = view->trial;
    bool free_look = trial->resolved->fixation == PROTOCOL_FIXATION_FREE;
    snprintf(out->title, sizeof out->title, "%s%" PRIu32 " of %" PRIu32,
             trial->role == PROTOCOL_PRACTICE ? "Practice: " : "", view->done + 1, view->total);
    const char *count = trial->spheres[0] > 0 ? "\nCount the coloured spheres." : "";
    if (trial->kind == PROTOCOL_SEQUENTIAL)
        snprintf(out->body, sizeof out->body, "You will see the scene twice, one after the other.\n%s%s",
                 where_to_look(trial), count);
    else if (protocol_kind_is_pair(trial->kind))
        snprintf(out->body, sizeof out->body, "%s%s%s%s\n%s comes first.",
                 trial->question ? trial->question->text : "Make A and B look the same.", free_look ? "" : "\n",
                 free_look ? "" : where_to_look(trial), count, trial->first_shown == PLAN_SLOT_B ? "B" : "A");
    else
        snprintf(out->body, sizeof out->body, "%s%s", where_to_look(trial), count);
    trial_hint(view, out);
}

static void question(const struct machine_view *view, const struct screen_state *state, struct screen *out)
{
    const struct protocol_question *asked = view->question;
    if (!asked)
        return;
    if (view->subject != PLAN_SLOT_NONE)
        PUT(out->title, view->subject == PLAN_SLOT_A ? "A" : "B");
    PUT(out->body, asked->text);
    if (asked->type == PROTOCOL_ASK_CHOICE) {
        PUT(out->hint, can_equal(asked) ? LEFT " or 1: the first    " DOWN " or 0: equal    " RIGHT
                                               " or 2: the second\n"
                                               "Each key is the answer; Enter is not needed"
                                        : LEFT " or 1: the first    " RIGHT " or 2: the second\n"
                                               "Each key is the answer; Enter is not needed");
        return;
    }
    PUT(out->hint, LEFT " " RIGHT " or a number: mark\nEnter: confirm");
    PUT(out->low, asked->label_min);
    PUT(out->high, asked->label_max);
    out->scale_min = asked->scale_min;
    out->scale_max = asked->scale_max;
    out->scale_selected = state->selected;
}

// What was answered last, as far as it is a word or a number.
static void confirmation(const struct machine_view *view, struct screen *out)
{
    enum protocol_kind kind = view->trial ? view->trial->kind : PROTOCOL_RATE;
    PUT(out->title, "Answer stored");
    if (kind == PROTOCOL_ADJUST || !view->trial)
        return;
    bool asked_more = view->trial->resolved->rating_count > 0 || view->trial->resolved->count_question >= 0;
    bool choice = protocol_kind_is_pair(kind) && !asked_more && view->trial->question &&
                  view->trial->question->type == PROTOCOL_ASK_CHOICE;
    if (choice && view->last_value == PLAN_SLOT_NONE)
        PUT(out->body, "equal");
    else if (choice && kind == PROTOCOL_SEQUENTIAL)
        PUT(out->body, view->last_value == PLAN_SLOT_A ? "the first" : "the second");
    else if (choice)
        PUT(out->body, view->last_value == PLAN_SLOT_A ? "A" : "B");
    else
        snprintf(out->body, sizeof out->body, "%" PRId32, view->last_value);
}

static void stimulus(const struct machine_view *view, const struct screen_state *state, struct screen *out)
{
    if (!view->trial)
        return;
    bool toggling = protocol_kind_is_pair(view->trial->kind) && view->trial->kind != PROTOCOL_SEQUENTIAL;
    if (toggling && view->fade >= 1.0 && state->going_to != PLAN_SLOT_NONE) {
        PUT(out->title, state->going_to == PLAN_SLOT_A ? "A" : "B");
        out->size = LETTER_SIZE;
    } else if (toggling && state->look_at_both) {
        PUT(out->body, "Please look at both, A and B, before you choose.");
        PUT(out->hint, "Space: switch");
    }
}

// Whole seconds, so that the screen is drawn again once a second.
static void rest_break(const struct machine_view *view, struct screen *out)
{
    int64_t left_s = (view->wait_ns + 999999999) / 1000000000;
    PUT(out->title, "Time for a break");
    if (left_s > 0)
        snprintf(out->body, sizeof out->body, "Rest your eyes.\nIt goes on in %" PRId64 " s at the earliest.",
                 left_s);
    else
        PUT(out->body, "Go on whenever you like.");
    PUT(out->hint, left_s > 0 ? "" : "Enter: go on");
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
    case MACHINE_BREAK:
        rest_break(view, out);
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
