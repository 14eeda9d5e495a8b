// Moving objects in a redraw map.
//
// movers_mark: the boxes of objects that moved lately, where they are and where they were, are redrawn in turns
// of MOVERS_PERIOD frames, so that one that comes from behind a corner into the trusted periphery, where no
// pixel of it is known yet, shows within that many frames: large ones strip by strip
// (renderer/shared/turn.glsl), small ones whole when it is the turn of the strip of their centre. The turn goes
// from right to left, so a small one that flies the same way waits longer; 9 frames at 0.4 strips a frame, some
// 500 degrees a second. movers_join: after moving objects were drawn everywhere, the kept pixels that they
// cover are redrawn ones.
#ifndef RENDERER_PASSES_MOVERS_MOVERS_H
#define RENDERER_PASSES_MOVERS_MOVERS_H

#include "renderer/scene/scene_gpu.h"

enum { MOVERS_PERIOD = 6 }; // frames: 67 ms at 90 Hz

struct movers {
    struct gpu *gpu;
    const struct scene_gpu *scene;
    uint32_t width, height, item_count;
    struct gpu_buffer items;      // indices of moving items
    struct gpu_buffer rectangles; // per item, eye, and now or a frame ago: first and last pixel
    struct gpu_buffer list;       // of those marked in a frame, as renderer/shared/tiles.glsl lists tiles
    struct gpu_kernel lister, mark, join;
    VkDescriptorSet list_set, mark_set, join_sets[2];
    VkSampler sampler;
};

struct movers_desc {
    struct gpu *gpu;
    const struct scene_gpu *scene;
    const struct gpu_buffer *frame;
    uint32_t width, height;
    const struct gpu_image *redraw_map; // r8 uint, GENERAL
    VkImageView position[2];            // rgba32f, GENERAL
    VkImageView depth;                  // of the G-buffer
    bool join;
};

bool movers_init(struct movers *movers, const struct movers_desc *desc);
void movers_finish(struct movers *movers);
// Writes the whole map: 1 in the boxes and tiles whose turn it is in frame `turn`, 0 elsewhere.
void movers_mark(const struct movers *movers, VkCommandBuffer cmd, const struct gpu_image *redraw_map,
                 uint32_t turn);
void movers_join(const struct movers *movers, VkCommandBuffer cmd, uint32_t source);

#endif
