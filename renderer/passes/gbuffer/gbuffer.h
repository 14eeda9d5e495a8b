// Draws the scene's surfaces: what a later pass needs to shade each pixel.
//
// Reversed depth, GREATER: 0 is infinity. With `kept` set, pixels whose depth was written before (gbuffer_mask)
// stay untouched: nearer than anything, they reject every fragment before it is shaded.
#ifndef RENDERER_PASSES_GBUFFER_GBUFFER_H
#define RENDERER_PASSES_GBUFFER_GBUFFER_H

#include "renderer/scene/scene_gpu.h"

enum { GBUFFER_PIPELINES = 64 };

struct gbuffer {
    struct gpu *gpu;
    const struct scene_gpu *scene;
    uint32_t width, height;
    bool has_emissive, has_id;
    // two layers each, one per eye
    struct gpu_image base;     // rgba8 sRGB: base colour, occlusion in alpha
    struct gpu_image normal;   // r32 uint: shading normal, octahedral snorm 2x16
    struct gpu_image surface;  // rg8: roughness, metallic
    struct gpu_image emissive; // rgba16f, only where the scene glows
    struct gpu_image id;       // r16 uint: moving id, only where asked for
    struct gpu_image depth;    // d32
    VkDescriptorSetLayout frame_layout;
    VkDescriptorSet frame_set;
    VkPipelineLayout layout;
    uint32_t pipeline_count;
    struct {
        uint32_t features;
        VkPipeline pipeline;
    } pipelines[GBUFFER_PIPELINES];
    // the mask: a full-screen triangle that writes depth 1 where the redraw map is 0
    VkDescriptorSetLayout mask_set_layout;
    VkDescriptorSet mask_set;
    VkPipelineLayout mask_layout;
    VkPipeline mask;
};

struct gbuffer_desc {
    struct gpu *gpu;
    const struct scene_gpu *scene;
    const struct gpu_buffer *frame;
    uint32_t width, height;
    bool ids;               // keep moving ids, for modes with history
    VkImageView redraw_map; // r8 uint, layout GENERAL, two layers; null: every pixel is drawn
};

bool gbuffer_init(struct gbuffer *gbuffer, const struct gbuffer_desc *desc);
void gbuffer_finish(struct gbuffer *gbuffer);
uint64_t gbuffer_memory(const struct gbuffer *gbuffer);

// Draws both eyes from the culled draws. `masked`: only pixels whose redraw map is not 0. Leaves all targets
// readable by compute (SHADER_READ_ONLY_OPTIMAL, depth DEPTH_READ_ONLY_OPTIMAL).
void gbuffer_record(const struct gbuffer *gbuffer, VkCommandBuffer cmd, const struct gpu_buffer *draws,
                    const struct gpu_buffer *draw_counts, bool masked);

#endif
