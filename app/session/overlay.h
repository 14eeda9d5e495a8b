// The text over both eyes: draws a screen when it changed, turns its pages.
#ifndef APP_SESSION_OVERLAY_H
#define APP_SESSION_OVERLAY_H

#include "app/display/text.h"
#include "app/session/screens.h"
#include "renderer/renderer.h"

struct overlay {
    struct renderer *renderer; // borrowed
    struct text_view view;
    struct screen screen; // as drawn
    uint32_t page, pages; // of it; pages 0: no text is shown
};

void overlay_init(struct overlay *overlay, struct renderer *renderer, const struct text_view *view);
// Shows this screen from the next frame on, from its first page where it is another one. False: no memory, or
// the renderer refused.
bool overlay_set(struct overlay *overlay, const struct screen *screen);
bool overlay_turn(struct overlay *overlay, int pages); // forward or back, as far as there are pages
bool overlay_last_page(const struct overlay *overlay);

#endif
