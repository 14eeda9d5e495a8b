// Forward shading at the rates of a map (VK_KHR_fragment_shading_rate): the picture is drawn again over depths
// that are already there, so that nothing hidden is shaded.
#ifndef RENDERER_MODES_VRS_FORWARD_H
#define RENDERER_MODES_VRS_FORWARD_H

#include "renderer/modes/deferred.h"

struct forward {
    struct gpu *gpu;
    const struct scene_gpu *scene;
    uint32_t width, height;
    float inner_deg, outer_deg;
    bool mapped; // false where the device has no map of rates: every pixel is shaded (vrs refuses; tests
                 // compare)
    struct gpu_image rates; // r8 uint, two layers
    struct gpu_image hdr;   // rgba16f, two layers, GENERAL after forward_record
    struct gpu_kernel rate;
    VkDescriptorSet rate_set;
    VkSampler sampler, compare;
    VkDescriptorSetLayout set_layout;
    VkDescriptorSet set;
    VkPipelineLayout layout;
    VkPipeline sky;
    uint32_t pipeline_count;
    struct {
        uint32_t features;
        VkPipeline pipeline;
    } pipelines[GBUFFER_PIPELINES];
};

// `deferred` has drawn the depths and, where it is on, the ambient occlusion.
bool forward_init(struct forward *forward, const struct mode_setup *setup, const struct deferred *deferred,
                  float inner_deg, float outer_deg);
void forward_finish(struct forward *forward);
void forward_rates(const struct forward *forward, VkCommandBuffer cmd);
void forward_record(const struct forward *forward, VkCommandBuffer cmd, const struct deferred *deferred);

#endif
