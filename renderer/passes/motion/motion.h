// Motion vectors of the G-buffer's surfaces, for measurements: where each pixel was one frame ago
// (renderer_read_motion).
#ifndef RENDERER_PASSES_MOTION_MOTION_H
#define RENDERER_PASSES_MOTION_MOTION_H

#include "renderer/scene/scene_gpu.h"

struct motion {
    struct gpu *gpu;
    uint32_t width, height, motion_count;
    struct gpu_kernel kernel;
    struct gpu_image image; // rgba32f: x, y, distance then, distance now
    VkSampler sampler;
    VkDescriptorSet set;
};

struct motion_desc {
    struct gpu *gpu;
    const struct scene_gpu *scene;
    const struct gpu_buffer *frame, *counters;
    uint32_t width, height;
    VkImageView depth, id; // of the G-buffer; id null: nothing moves
};

bool motion_init(struct motion *motion, const struct motion_desc *desc);
void motion_finish(struct motion *motion);
void motion_record(const struct motion *motion, VkCommandBuffer cmd);

#endif
