// Lights the G-buffer in compute: GGX with sun, sky and point lights, linear HDR out (cd/m^2, rgba16f).
//
// BRDF after Karis, "Real Shading in Unreal Engine 4", SIGGRAPH 2013 course notes; details in shade.comp.
#ifndef RENDERER_PASSES_SHADE_SHADE_H
#define RENDERER_PASSES_SHADE_SHADE_H

#include "renderer/gpu/gpu.h"

struct shade {
    struct gpu *gpu;
    uint32_t width, height;
    struct gpu_kernel kernel;
    VkDescriptorSet set;
    VkSampler sampler;
    struct gpu_image hdr; // two layers, layout GENERAL while in use
};

struct shade_desc {
    struct gpu *gpu;
    const struct gpu_buffer *frame, *lights;
    uint32_t width, height;
    // the G-buffer's targets, layouts as gbuffer_record leaves them
    VkImageView base, normal, surface, depth;
    VkImageView emissive;   // null: nothing glows
    VkImageView redraw_map; // r8 uint, GENERAL; null: every pixel is shaded
};

bool shade_init(struct shade *shade, const struct shade_desc *desc);
void shade_finish(struct shade *shade);
void shade_record(const struct shade *shade, VkCommandBuffer cmd);

#endif
