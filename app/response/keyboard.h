// Keys as answers: which event of the session a pressed key means on the present screen.
//
// Use: keyboard_press per key in order of time; send the event to the machine where it returns KEYBOARD_EVENT.
// The selection on a rating scale lives in struct keyboard, since only Enter makes it an answer.
// Does not: read a device, keep time, or decide whether the session takes the event.
#ifndef APP_RESPONSE_KEYBOARD_H
#define APP_RESPONSE_KEYBOARD_H

#include "studies/engine/machine.h"

#include <stdbool.h>
#include <stdint.h>

struct keyboard {
    enum machine_screen screen; // the selection belongs to this screen, trial, question and option
    uint32_t trial;
    const struct protocol_question *question;
    enum plan_slot subject;
    bool selecting;
    int32_t selected; // meaningful while selecting
    bool typed;       // by digits, to which more may be added
};

enum keyboard_meaning {
    KEYBOARD_NOTHING,
    KEYBOARD_EVENT,    // *out_event is for the machine
    KEYBOARD_SELECTED, // the selection moved
    KEYBOARD_NEXT, // the next page of a long text; on the last page it is MACHINE_START where the screen waits
    KEYBOARD_BACK, // the page before
};

// `key` is a GLFW key number; `last_page` whether the screen's text is read to its end.
enum keyboard_meaning keyboard_press(struct keyboard *keyboard, const struct machine_view *view, bool last_page,
                                     int key, struct machine_event *out_event);
bool keyboard_is_abort(int key); // it asks to end the session, on every screen
// The marked rating, or scale_min - 1 where none is: what the screen shows.
int32_t keyboard_selected(const struct keyboard *keyboard, const struct machine_view *view);

#endif
