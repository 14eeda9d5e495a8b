// Modes side by side on one scene: the same renderer, the same frames, each mode in turn.
#ifndef APP_FOVBENCH_LINEUP_H
#define APP_FOVBENCH_LINEUP_H

#include "app/fovbench/request.h"
#include "renderer/renderer.h"

struct lineup_desc {
    const char *device;     // NULL: the best
    uint32_t width, height; // pixels per eye
    bool pass_times;
    const struct request_mode *modes; // borrowed for the call
    size_t mode_count;
    struct renderer_settings settings;
};

struct lineup {
    struct renderer *renderer;
    struct renderer_scene *scene;
    struct renderer_option *options[REQUEST_MODES];
    size_t count;
};

// `scene` must outlive it. False after a sentence on stderr; the line-up is then empty.
bool lineup_init(struct lineup *lineup, const struct lineup_desc *desc, const struct scene *scene);
void lineup_finish(struct lineup *lineup);

// Draws a frame with every mode. The order starts one mode later with each frame, so that what one leaves
// behind (caches, clocks) meets all of them. out_stats: one for each mode, or NULL. False after a sentence on
// stderr.
bool lineup_draw(struct lineup *lineup, const struct frame *frame, struct frame_stats *out_stats);

#endif
