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
};

struct tonemap_desc {
    struct gpu *gpu;
    const struct gpu_buffer *frame;
    uint32_t width, height;
    VkImageView hdr;        // rgba16f
    VkImageView targets[2]; // rgba8; the second may be null
    VkImageView redraw_map; // null: every pixel is written
};

bool tonemap_init(struct tonemap *tonemap, const struct tonemap_desc *desc);
void tonemap_finish(struct tonemap *tonemap);
void tonemap_record(const struct tonemap *tonemap, VkCommandBuffer cmd, uint32_t target);

#endif
