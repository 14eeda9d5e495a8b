// What a mode's room is given: for creation, and for recording one frame. Private to the renderer.
#ifndef RENDERER_MODES_ROOM_H
#define RENDERER_MODES_ROOM_H

#include "renderer/gpu/frame.h"
#include "renderer/mode.h"
#include "renderer/scene/scene_gpu.h"
#include "renderer/settings.h"

// What an option consists of and why: text lines, and bytes in all.
struct mode_explanation {
    char text[8192];
    size_t used;
    uint64_t bytes;
};

struct mode_setup {
    struct gpu *gpu;
    const struct scene_gpu *scene;
    VkImageView shadow_map; // of the sun, for shade_desc; null: the scene has no sun
    uint32_t width, height; // per eye
    const double *values;   // of the mode's parameters, in table order
    struct renderer_settings settings;
    const struct gpu_buffer *frame;    // shared_frame, filled before every record
    const struct gpu_buffer *counters; // shared_counters, zeroed before every record
    struct mode_explanation *explanation;
};

struct mode_record {
    struct gpu_frame *gpu_frame; // begun
    uint64_t number;             // of the frame
    bool history;                // false: nothing from earlier frames may be used
    bool moving;                 // objects move
    struct mode_result *result;  // set by the mode
};

// Valid until the mode's next record.
struct mode_result {
    const struct gpu_image *colour;     // rgba8, sRGB-encoded, two layers, layout GENERAL
    const struct gpu_image *redraw_map; // r8 uint, GENERAL; NULL: everything was drawn
    const struct gpu_image *motion;     // rgba32f, GENERAL; NULL: not kept
    bool counts_shaded;                 // the kernels counted shaded_px; otherwise it is every pixel
};

// Adds "bytes: what, why" to an explanation.
void mode_explain(struct mode_explanation *explanation, uint64_t bytes, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

extern const struct mode mode_regular;
extern const struct mode mode_time_warped;
extern const struct mode mode_vrs;

#endif
