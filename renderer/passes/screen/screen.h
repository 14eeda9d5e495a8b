// What the participant sees: both eyes side by side, mixed with gray, under marks and an overlay.
#ifndef RENDERER_PASSES_SCREEN_SCREEN_H
#define RENDERER_PASSES_SCREEN_SCREEN_H

#include "renderer/gpu/gpu.h"

enum { SCREEN_MARKS = 80 };

struct shared_mark; // renderer/shared/shared.h

struct screen {
    struct gpu *gpu;
    uint32_t width, height;    // per eye
    struct gpu_image image;    // rgba8, sRGB-encoded, 2 * width, layout GENERAL after the first record
    struct gpu_image overlay;  // GENERAL after the next record; the upper left part of it is shown
    struct gpu_buffer staging; // what it will hold
    struct gpu_buffer marks;   // SCREEN_MARKS shared_mark
    uint32_t mark_count;
    struct gpu_kernel gray, coloured;
    VkDescriptorSet set;
    VkSampler sampler;
    int32_t left[2], top[2];
    uint32_t overlay_width, overlay_height; // 0: none is shown
    bool overlay_new, overlay_used;         // to be copied; has left its first layout
    bool used;
};

bool screen_init(struct screen *screen, struct gpu *gpu, uint32_t width, uint32_t height);
void screen_finish(struct screen *screen);
// rgba8 straight alpha; NULL removes the overlay. Outside a frame.
bool screen_set_overlay(struct screen *screen, const uint8_t *rgba, uint32_t width, uint32_t height,
                        const int32_t left[2], const int32_t top[2]);
// At most SCREEN_MARKS. Outside a frame.
void screen_set_marks(struct screen *screen, const struct shared_mark *marks, uint32_t count);
// `colour`: two layers, rgba8, layout GENERAL; NULL: gray.
void screen_record(struct screen *screen, VkCommandBuffer cmd, const struct gpu_image *colour, float fade);

#endif
