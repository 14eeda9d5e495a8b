// Draws the scene's surfaces: what a later pass needs to shade each pixel.
//
// Reversed depth, GREATER: 0 is infinity. With a redraw map, kept pixels get depth 1 first: nearer than
// anything, they reject every fragment before it is shaded.
#ifndef RENDERER_PASSES_GBUFFER_GBUFFER_H
#define RENDERER_PASSES_GBUFFER_GBUFFER_H

#include "renderer/scene/scene_gpu.h"

enum { GBUFFER_PIPELINES = 64, GBUFFER_ATTRIBUTES = 6 };

// What gbuffer.vert reads, for passes that draw the same surfaces with it.
extern const VkVertexInputBindingDescription gbuffer_vertex_binding;
extern const VkVertexInputAttributeDescription gbuffer_attributes[GBUFFER_ATTRIBUTES];

// How the eyes are drawn. The last two draw both at once, from one list of draws (cull.h).
enum gbuffer_eyes {
    GBUFFER_EYE_BY_EYE,
    GBUFFER_MULTIVIEW, // where gpu->multiview
    GBUFFER_INSTANCED, // where gpu->output_layer; every draw has two instances
};

struct gbuffer {
    struct gpu *gpu;
    const struct scene_gpu *scene;
    uint32_t width, height;
    bool depth_only, has_emissive, has_id;
    enum gbuffer_eyes eyes;
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
    VkDescriptorSet mask_sets[2];
    VkPipelineLayout mask_layout;
    VkPipeline mask;
    VkPipeline kept; // the same triangle, but it writes the kept pixels' own depths
};

struct gbuffer_desc {
    struct gpu *gpu;
    const struct scene_gpu *scene;
    const struct gpu_buffer *frame;
    uint32_t width, height;
    bool depth_only;         // and ids, where asked for: nothing to shade from
    enum gbuffer_eyes eyes;  // with a redraw map eye by eye
    bool ids;                // keep moving ids, for modes with history
    VkImageView redraw_map;  // r8 uint, layout GENERAL, two layers; null: every pixel is drawn
    VkImageView position[2]; // rgba32f, GENERAL: of the kept pixels, for GBUFFER_MOVING_EVERYWHERE; else null
};

enum gbuffer_extent {
    GBUFFER_ALL,               // every pixel
    GBUFFER_MASKED,            // pixels whose redraw map is not 0
    GBUFFER_MOVING_EVERYWHERE, // those, and moving objects wherever they are nearer than what is kept
};

bool gbuffer_init(struct gbuffer *gbuffer, const struct gbuffer_desc *desc);
void gbuffer_finish(struct gbuffer *gbuffer);
uint64_t gbuffer_memory(const struct gbuffer *gbuffer);

// Draws both eyes from the culled draws. Leaves all targets readable by compute (SHADER_READ_ONLY_OPTIMAL,
// depth DEPTH_READ_ONLY_OPTIMAL). source: which positions hold what is kept.
void gbuffer_record(const struct gbuffer *gbuffer, VkCommandBuffer cmd, const struct gpu_buffer *draws,
                    const struct gpu_buffer *draw_counts, enum gbuffer_extent extent, uint32_t source);

#endif
