// What the participant reads on each screen of the session. Nothing here depends on what an option renders
// with.
//
// Use: screen_of each frame; where it differs from the one shown (screen_same), draw it. Does not: draw.
#ifndef APP_SESSION_SCREENS_H
#define APP_SESSION_SCREENS_H

#include "app/display/text.h"
#include "studies/engine/machine.h"

#include <stdbool.h>
#include <stdint.h>

// What the screen depends on, besides the machine's view.
struct screen_state {
    enum plan_slot going_to; // the option a switch leads to: its letter is shown while all is gray
    int32_t selected;        // marked rating
    bool look_at_both;       // a choice came before both were seen
    bool starts_trial;       // INSTRUCTIONS: a trial follows at once
    bool wait;               // the study file cannot be written: over every screen
};

struct screen {
    bool shown; // false: no text
    char title[96], body[8192], hint[320], more[64], low[96], high[96];
    int scale_min, scale_max, scale_selected;
    double size;
};

void screen_of(const struct machine_view *view, const struct screen_state *state, struct screen *out);
bool screen_same(const struct screen *a, const struct screen *b);
// The screen as text.h wants it; borrows from `screen`.
struct text_screen screen_text(const struct screen *screen);

#endif
