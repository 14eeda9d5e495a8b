// Gaze from the mouse cursor: for trying a study without a tracker. One sample for both eyes per frame.
#include "app/gaze/gaze_source.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

struct mouse_gaze {
    struct gaze_source base;
    struct gaze_desc desc;
    int64_t last_ns;
};

static struct gaze_source *create(const struct gaze_desc *desc, char *error, size_t error_size)
{
    if (!desc->cursor) {
        snprintf(error, error_size,
                 "gaze from the mouse needs a window; choose --display window, or --gaze sim");
        return NULL;
    }
    struct mouse_gaze *mouse = calloc(1, sizeof *mouse);
    if (!mouse) {
        snprintf(error, error_size, "out of memory");
        return NULL;
    }
    mouse->base.kind = &gaze_mouse;
    mouse->desc = *desc;
    mouse->last_ns = -1;
    return &mouse->base;
}

static size_t poll_cursor(struct gaze_source *source, int64_t now_ns, struct gaze_sample *out, size_t capacity)
{
    struct mouse_gaze *mouse = (struct mouse_gaze *)source;
    if (capacity == 0 || now_ns <= mouse->last_ns)
        return 0;
    mouse->last_ns = now_ns;
    *out = (struct gaze_sample){.device_ns = now_ns,
                                .host_ns = now_ns,
                                .eye = GAZE_BOTH,
                                .x_deg = NAN,
                                .y_deg = NAN,
                                .pupil_mm = NAN,
                                .confidence = NAN};
    double x = 0.0, y = 0.0;
    if (mouse->desc.cursor(mouse->desc.cursor_user, &x, &y)) {
        struct dvec3 direction =
            viewing_pixel_direction(&mouse->desc.fov, mouse->desc.width, mouse->desc.height, x, y);
        viewing_angles(direction, &out->x_deg, &out->y_deg);
        out->valid = isfinite(out->x_deg) && isfinite(out->y_deg);
    }
    return 1;
}

static void destroy(struct gaze_source *source)
{
    free(source);
}

const struct gaze_kind gaze_mouse = {
    .name = "mouse",
    .description = "the cursor over the window",
    .create = create,
    .poll = poll_cursor,
    .destroy = destroy,
};
