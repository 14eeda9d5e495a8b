// Screen-space ambient occlusion at half resolution with 32 samples and an edge-aware blur (Franke et al. 2021,
// section 8.4, after Mittring 2007 and Bavoil et al. 2008; the estimator is named in occlusion.comp).
//
// From distances alone: normals come from their slopes, so that reprojected pixels, which have no normals,
// occlude and are occluded like redrawn ones. With a redraw map only the tiles that redrawn pixels depend on
// are computed (section 7); what lies in the others is old and never read.
#ifndef RENDERER_PASSES_SSAO_SSAO_H
#define RENDERER_PASSES_SSAO_SSAO_H

#include "renderer/gpu/gpu.h"

struct ssao {
    struct gpu *gpu;
    uint32_t width, height;            // half resolution
    uint32_t tiles_x, tiles_y;         // of the redraw map's pyramid
    struct gpu_image distance;         // r32f, along the view axis, 0: background
    struct gpu_image occlusion, shown; // r8 unorm: before and after the blur; 1: open
    struct gpu_buffer tiles;           // with a redraw map: half-resolution tiles (renderer/shared/tiles.glsl)
    struct gpu_kernel distances, list, occlude, blur;
    VkSampler sampler;
    VkDescriptorSet distance_sets[2], list_set, occlude_set, blur_set;
};

struct ssao_desc {
    struct gpu *gpu;
    const struct gpu_buffer *frame;
    uint32_t width, height;           // full resolution
    VkImageView depth;                // of the G-buffer, DEPTH_READ_ONLY_OPTIMAL
    VkImageView redraw_map;           // null: every pixel is drawn; else also:
    VkImageView position[2];          // rgba32f, GENERAL, of the kept pixels
    const struct gpu_buffer *pyramid; // of the redraw map (passes/redraw), and its shape
    uint32_t tiles_x, tiles_y;
};

bool ssao_init(struct ssao *ssao, const struct ssao_desc *desc);
void ssao_finish(struct ssao *ssao);
uint64_t ssao_memory(const struct ssao *ssao);
// Leaves `shown` and `distance` readable by compute, layout GENERAL. source: which positions.
void ssao_record(const struct ssao *ssao, VkCommandBuffer cmd, uint32_t source);

#endif
