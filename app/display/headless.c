// No screen: frames are drawn and kept, and time is counted in them, so that a run repeats exactly.
#include "app/display/display.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { DEFAULT_WIDTH = 320, DEFAULT_HEIGHT = 360 }; // per eye; what a software driver draws in reasonable time

struct headless {
    struct display base;
    int64_t frames;
};

static struct display *create(const struct display_desc *desc, char *error, size_t error_size)
{
    double hz = desc->refresh_hz == 0.0 ? DISPLAY_HEADLESS_HZ : desc->refresh_hz;
    if (desc->detail) {
        snprintf(error, error_size, "display 'headless' takes nothing after its name; --refresh sets its rate");
        return NULL;
    }
    if (!(hz >= 1.0 && hz <= 1000.0)) {
        snprintf(error, error_size, "the headless clock runs at 1 to 1000 Hz, not at %g", hz);
        return NULL;
    }
    struct headless *headless = calloc(1, sizeof *headless);
    if (!headless) {
        snprintf(error, error_size, "out of memory");
        return NULL;
    }
    headless->base = (struct display){
        .kind = &display_headless,
        .width = desc->width ? desc->width : DEFAULT_WIDTH,
        .height = desc->height ? desc->height : DEFAULT_HEIGHT,
        .refresh_hz = hz,
        .simulated_clock = true,
    };
    snprintf(headless->base.name, sizeof headless->base.name, "headless %g Hz", hz);
    return &headless->base;
}

static void destroy(struct display *display)
{
    free(display);
}

static void surface(struct display *display, struct renderer_desc *out)
{
    (void)display;
    out->create_surface = NULL;
}

static int64_t now_ns(struct display *display)
{
    const struct headless *headless = (const struct headless *)display;
    return (int64_t)llround((double)headless->frames * 1e9 / display->refresh_hz);
}

static bool poll_nothing(struct display *display)
{
    (void)display;
    return true;
}

static bool no_key(struct display *display, struct display_key *out)
{
    (void)display;
    (void)out;
    return false;
}

static void shown(struct display *display)
{
    ((struct headless *)display)->frames++;
}

static bool no_cursor(struct display *display, double *out_x_px, double *out_y_px)
{
    (void)display;
    (void)out_x_px;
    (void)out_y_px;
    return false;
}

static bool never_resized(struct display *display)
{
    (void)display;
    return false;
}

const struct display_kind display_headless = {
    .name = "headless",
    .description = "no screen, time counted in frames (--refresh)",
    .create = create,
    .destroy = destroy,
    .surface = surface,
    .now_ns = now_ns,
    .poll = poll_nothing,
    .key = no_key,
    .shown = shown,
    .cursor = no_cursor,
    .resized = never_resized,
};
