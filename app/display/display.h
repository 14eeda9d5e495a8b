// What shows the frames and keeps the time: one interface, one table of kinds.
//
// Use: display_open -> display_surface into the renderer's description -> per frame: display_key until false,
//      renderer_show, display_shown -> display_close after the renderer is gone.
// Does not: draw, or know what is shown. No kind puts anything about the condition on a title, cursor or sound.
// One thread, the one that started the program (GLFW's rule).
// Adding a kind: a file with one `const struct display_kind` and one line in display.c.
#ifndef APP_DISPLAY_DISPLAY_H
#define APP_DISPLAY_DISPLAY_H

#include "renderer/renderer.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define DISPLAY_HEADLESS_HZ 90.0 // a headset's usual rate (HTC Vive, Valve Index at its lowest)

struct display;

struct display_desc {
    uint32_t width, height; // per eye, pixels; 0: what the kind thinks fit (display_size says)
    double refresh_hz;  // headless: its clock's rate; others show at the screen's own. 0: DISPLAY_HEADLESS_HZ
    const char *detail; // what follows the colon in "monitor:1"; NULL where nothing does
};

// A key as the display saw it.
struct display_key {
    int64_t at_ns; // same clock as now_ns
    int key;       // a GLFW key number
    bool pressed;  // false: released; repeats are not reported
};

struct display_kind {
    const char *name;
    const char *description;
    // NULL with one sentence in `error`.
    struct display *(*create)(const struct display_desc *desc, char *error, size_t error_size);
    void (*destroy)(struct display *display);
    void (*surface)(struct display *display, struct renderer_desc *out);
    int64_t (*now_ns)(struct display *display);
    // Looks for news from the window system; false where the window was closed.
    bool (*poll)(struct display *display);
    bool (*key)(struct display *display, struct display_key *out);
    void (*shown)(struct display *display);
    bool (*cursor)(struct display *display, double *out_x_px, double *out_y_px);
    bool (*resized)(struct display *display);
};

// Each kind's display begins with this.
struct display {
    const struct display_kind *kind;
    uint32_t width, height; // per eye, pixels, as opened
    double refresh_hz;      // of the screen, or of the headless clock
    bool simulated_clock;   // time moves by frames only
    char name[128];         // for the record: "window 1280x720", "HDMI-1", "headless 90 Hz"
};

extern const struct display_kind *const display_kinds[]; // NULL-terminated
extern const struct display_kind display_window, display_monitor, display_headless;

// "window", "monitor:N" (from 0), "headless". NULL with one sentence in `error`.
struct display *display_open(const char *spec, const struct display_desc *desc, char *error, size_t error_size);
void display_close(struct display *display); // NULL is fine

// Fills what the renderer needs to present here: nothing for headless.
void display_surface(struct display *display, struct renderer_desc *out);
// Nanoseconds of a clock that only goes forward; its origin is anywhere. The headless clock moves only in
// display_shown.
int64_t display_now_ns(struct display *display);
bool display_poll(struct display *display);
// The next key event, oldest first; false where there is none left.
bool display_key(struct display *display, struct display_key *out);
// A frame has been handed to the screen (after renderer_show).
void display_shown(struct display *display);
// The cursor in pixels of the eye image it is over; false where it is over none or there is no cursor.
bool display_cursor(struct display *display, double *out_x_px, double *out_y_px);
// True once after the window changed size: the caller tells the renderer.
bool display_resized(struct display *display);

#endif
