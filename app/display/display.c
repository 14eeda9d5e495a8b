#include "app/display/display.h"

#include <stdio.h>
#include <string.h>

const struct display_kind *const display_kinds[] = {&display_window, &display_monitor, &display_headless, NULL};

struct display *display_open(const char *spec, const struct display_desc *desc, char *error, size_t error_size)
{
    size_t length = strcspn(spec, ":");
    for (size_t i = 0; display_kinds[i]; i++) {
        if (strlen(display_kinds[i]->name) != length || strncmp(display_kinds[i]->name, spec, length) != 0)
            continue;
        struct display_desc full = *desc;
        full.detail = spec[length] ? spec + length + 1 : NULL;
        return display_kinds[i]->create(&full, error, error_size);
    }
    snprintf(error, error_size, "display '%s' is not known; choose window, monitor:N, headless or none", spec);
    return NULL;
}

void display_close(struct display *display)
{
    if (display)
        display->kind->destroy(display);
}

void display_surface(struct display *display, struct renderer_desc *out)
{
    display->kind->surface(display, out);
}

int64_t display_now_ns(struct display *display)
{
    return display->kind->now_ns(display);
}

bool display_poll(struct display *display)
{
    return display->kind->poll(display);
}

bool display_key(struct display *display, struct display_key *out)
{
    return display->kind->key(display, out);
}

void display_shown(struct display *display)
{
    display->kind->shown(display);
}

bool display_cursor(struct display *display, double *out_x_px, double *out_y_px)
{
    return display->kind->cursor(display, out_x_px, out_y_px);
}

bool display_resized(struct display *display)
{
    return display->kind->resized(display);
}
