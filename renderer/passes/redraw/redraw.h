// What the redraw map means for whole tiles and regions: the list of tiles that hold redrawn pixels, for
// indirect dispatches, and the or-pyramid over them, for culling. Franke et al. 2021, section 6.1: "we compute
// a mip-map of the redraw map (using the or operator)".
//
// The pyramid's finest level has one texel a tile; its sides are padded to powers of two, so that every coarser
// texel covers exactly four finer ones and no redrawn pixel is lost at an edge. The list's order is of no
// consequence: every pixel is worked on alone.
#ifndef RENDERER_PASSES_REDRAW_REDRAW_H
#define RENDERER_PASSES_REDRAW_REDRAW_H

#include "renderer/gpu/gpu.h"
#include "renderer/shared/shared.h"

struct redraw {
    struct gpu *gpu;
    uint32_t width, height;
    uint32_t tiles_x, tiles_y; // padded to powers of two
    uint32_t levels;           // of the pyramid
    struct gpu_buffer
        pyramid; // one word a texel, both eyes' level 0, then both eyes' level 1, ...: not 0: redrawn
    struct gpu_buffer tiles; // the list (renderer/shared/tiles.glsl)
    struct gpu_kernel count, coarse;
    VkDescriptorSet count_set, coarse_set;
};

struct redraw_desc {
    struct gpu *gpu;
    const struct gpu_buffer *counters;
    uint32_t width, height;
    VkImageView redraw_map; // r8 uint, GENERAL, two layers
};

bool redraw_init(struct redraw *redraw, const struct redraw_desc *desc);
void redraw_finish(struct redraw *redraw);
uint64_t redraw_memory(const struct redraw *redraw);
// Reads the redraw map; leaves pyramid and tiles readable by compute and indirect dispatches. `last`: the map
// is complete, its pixels are added to counters.shaded_px.
void redraw_record(const struct redraw *redraw, VkCommandBuffer cmd, bool last);

#endif
