// Text for the participant: a panel drawn as an image to lay over both eyes.
//
// Use: text_view_init -> text_draw for each page -> hand rgba and places to the renderer -> text_image_finish.
// The panel stands straight ahead at a comfortable distance, so both eyes meet on it; sizes are degrees of
// visual angle, with a least number of pixels for small images. What does not fit one panel becomes further
// pages. Does not: draw to a screen, keep state, shape scripts that join letters or run right to left.
#ifndef APP_DISPLAY_TEXT_H
#define APP_DISPLAY_TEXT_H

#include "stimuli/viewing.h"

#include <stdbool.h>
#include <stdint.h>

// Cap height. 1.8 degrees is more than twenty times the acuity limit of a headset with 15 pixels per degree,
// and readable in the blur of a simple lens; below 13 px the strokes of the font run into each other.
#define TEXT_CAP_DEG 1.8
#define TEXT_CAP_MIN_PX 13.0
#define TEXT_DISTANCE_M 2.0 // vergence of 1.8 degrees, near the resting point of most headset optics

struct text_view {
    struct viewing_fov fov[EYES];
    uint32_t width, height; // per eye, pixels
    double ipd_m;
};

// One screen. Strings are UTF-8, a newline breaks the line, an empty line stays; NULL is nothing. borrowed for
// the call
struct text_screen {
    const char *title; // larger, first
    const char *body;
    const char *hint; // dimmer, last: which key does what
    const char *more; // at the foot of every page that another one follows
    // A row of numbers from scale_min to scale_max with one marked, between body and hint; equal: no row.
    int scale_min, scale_max, scale_selected;
    const char *scale_low, *scale_high; // what its ends mean; NULL for nothing
    double size;                        // factor on TEXT_CAP_DEG; 0 counts as 1
};

struct text_image {
    uint8_t *rgba; // sRGB, straight alpha; owned, text_image_finish frees
    uint32_t width, height;
    int32_t left[EYES], top[EYES];
    uint32_t page, pages; // which page of the screen this is (from 0), and how many there are
    double cap_px;        // cap height of the body as drawn
};

// A view of two equal, symmetric eyes.
void text_view_init(struct text_view *view, const struct viewing_fov *fov, uint32_t width, uint32_t height,
                    double ipd_m);

// Draws a page (the last one where page is beyond it). False where memory ran out or the view is unusable.
bool text_draw(const struct text_view *view, const struct text_screen *screen, uint32_t page,
               struct text_image *out);
void text_image_finish(struct text_image *image);

#endif
