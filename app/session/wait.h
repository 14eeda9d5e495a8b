// What the participant sees while something is made ready: a text with its progress; and what they may do
// meanwhile.
#ifndef APP_SESSION_WAIT_H
#define APP_SESSION_WAIT_H

#include "app/session/show.h"

enum wait_result { WAIT_ON, WAIT_STOPPED, WAIT_CLOSED }; // WAIT_STOPPED: Escape

void wait_screen(double done, struct screen *out); // done 0..1
// Keys pressed meanwhile mean nothing, but for Escape. With a simulated clock there is nobody: WAIT_ON.
enum wait_result wait_look(struct display *display);

#endif
