// Gives every redrawn pixel its exact world position for the next frame's reprojection. Franke et al. 2021,
// sections 4 and 6.2: with the redrawn colours, which the tone-mapping pass writes in place, this completes the
// composed image.
#ifndef RENDERER_PASSES_COMPOSE_COMPOSE_H
#define RENDERER_PASSES_COMPOSE_COMPOSE_H

#include "renderer/gpu/gpu.h"

struct compose {
    struct gpu *gpu;
    struct gpu_kernel kernel;
    VkSampler sampler;
    VkDescriptorSet sets[2]; // by target
    const struct gpu_buffer *tiles;
};

struct compose_desc {
    struct gpu *gpu;
    const struct gpu_buffer *frame;
    VkImageView depth;              // of the G-buffer, DEPTH_READ_ONLY_OPTIMAL
    VkImageView id;                 // of the G-buffer, SHADER_READ_ONLY_OPTIMAL; null: nothing moves
    VkImageView redraw_map;         // r8 uint, GENERAL
    VkImageView position[2];        // rgba32f, GENERAL
    const struct gpu_buffer *tiles; // of the redraw map (tiles.glsl)
};

bool compose_init(struct compose *compose, const struct compose_desc *desc);
void compose_finish(struct compose *compose);
// The list of tiles must be visible to DRAW_INDIRECT and COMPUTE_SHADER.
void compose_record_tiles(const struct compose *compose, VkCommandBuffer cmd, uint32_t target);

#endif
