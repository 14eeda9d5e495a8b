#include "app/session/wait.h"

#include "app/response/keyboard.h"

#include <stdio.h>
#include <string.h>

enum { STEPS = 20 }; // the text is drawn anew for each

void wait_screen(double done, struct screen *out)
{
    int step = (int)(done * STEPS);
    memset(out, 0, sizeof *out);
    snprintf(out->title, sizeof out->title, "Please wait ...");
    snprintf(out->body, sizeof out->body, "The next pictures are made ready: %d %%", step * 100 / STEPS);
    out->size = 1.0;
    out->shown = true;
}

enum wait_result wait_look(struct display *display)
{
    struct display_key key;
    enum wait_result result = WAIT_ON;
    if (display->simulated_clock)
        return WAIT_ON;
    if (!display_poll(display))
        return WAIT_CLOSED;
    while (display_key(display, &key))
        if (key.pressed && keyboard_is_abort(key.key))
            result = WAIT_STOPPED;
    return result;
}
