// Tone mapping with a fixed luminance and sRGB encoding: the global operator of Reinhard, Stark, Shirley and
// Ferwerda, "Photographic Tone Reproduction for Digital Images", SIGGRAPH 2002, equations 2 and 3, on
// luminance.
#ifndef RENDERER_PASSES_TONEMAP_TONEMAP_H
#define RENDERER_PASSES_TONEMAP_TONEMAP_H

#include "renderer/gpu/gpu.h"

struct tonemap {
    struct gpu *gpu;
    uint32_t width, height;
    struct gpu_kernel kernel;
    VkDescriptorSet sets[2];
    bool redraw;
    const struct gpu_buffer *tiles;
};

struct tonemap_desc {
    struct gpu *gpu;
    const struct gpu_buffer *frame;
    uint32_t width, height;
    VkImageView hdr;                // rgba16f
    VkImageView targets[2];         // rgba8; the second may be null
    VkImageView redraw_map;         // null: every pixel is written
    const struct gpu_buffer *tiles; // of the redraw map (tiles.glsl); NULL: tonemap_record_tiles is not used
    // Whose HDR colour a pixel has (leaders.glsl), not with a redraw map; NULL: its own.
    const struct gpu_buffer *leaders;
};

bool tonemap_init(struct tonemap *tonemap, const struct tonemap_desc *desc);
void tonemap_finish(struct tonemap *tonemap);
void tonemap_record(const struct tonemap *tonemap, VkCommandBuffer cmd, uint32_t target);
// The redraw map's pixels from the list of tiles, which must be visible to DRAW_INDIRECT and COMPUTE_SHADER.
void tonemap_record_tiles(const struct tonemap *tonemap, VkCommandBuffer cmd, uint32_t target);

#endif
