#include "renderer/passes/pyramid/pyramid.h"

#include "renderer/shared/shared.h"

#include "fill.comp.h"
#include "pull.comp.h"

enum { LEVELS_PER_PULL = 3 }; // an 8x8 tile comes down to one pixel

static const struct gpu_binding pull_bindings[] = {
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // frame
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},  // colour
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},  // position
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},  // the level that is read, after the first dispatch
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},  // three levels that are written
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},  {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},
};

static const struct gpu_binding fill_bindings[] = {
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},         // frame
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},         // counters
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},          // colour
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},          // position
    {.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, // pyramid
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},          // redraw map
};

struct pull_push {
    uint32_t first;  // 1: reads colour and position
    uint32_t levels; // how many are written
};

uint32_t pyramid_levels(uint32_t width, uint32_t height, float epsilon, float hole_decay)
{
    uint32_t levels = 1;
    for (uint32_t side = width > height ? width : height; levels < PYRAMID_LEVELS && 1u << levels < side;)
        levels++;
    float confidence = 1;
    for (uint32_t m = 1; m <= levels; m++) {
        confidence *= hole_decay;
        if (confidence < epsilon)
            return m > 1 ? m - 1 : 1;
    }
    return levels;
}

static uint32_t padded(uint32_t size, uint32_t levels)
{
    return (size + (1u << levels) - 1) >> levels << levels;
}

static bool create_sets(struct pyramid *p, const struct pyramid_desc *desc)
{
    const uint32_t levels = p->confidence.levels;
    p->pull_count = (levels + LEVELS_PER_PULL - 1) / LEVELS_PER_PULL;
    for (uint32_t target = 0; target < 2; target++) {
        for (uint32_t d = 0; d < p->pull_count; d++) {
            uint32_t first = d * LEVELS_PER_PULL; // of level_views
            VkImageView out[LEVELS_PER_PULL];
            for (uint32_t i = 0; i < LEVELS_PER_PULL; i++)
                out[i] = p->level_views[first + i < levels ? first + i : levels - 1];
            const struct gpu_resource resources[] = {
                {.buffer = desc->frame},
                {.view = desc->colour[target]},
                {.view = desc->position[target]},
                {.view = p->level_views[first ? first - 1 : 0]},
                {.view = out[0]},
                {.view = out[1]},
                {.view = out[2]},
            };
            p->pull_sets[target][d] =
                gpu_set_create(p->gpu, p->pull.set_layout, pull_bindings, resources, countof(resources));
            if (!p->pull_sets[target][d])
                return false;
        }
        const struct gpu_resource resources[] = {
            {.buffer = desc->frame},
            {.buffer = desc->counters},
            {.view = desc->colour[target]},
            {.view = desc->position[target]},
            {.view = p->image.view, .sampler = p->sampler},
            {.view = desc->redraw_map},
        };
        p->fill_sets[target] =
            gpu_set_create(p->gpu, p->fill.set_layout, fill_bindings, resources, countof(resources));
        if (!p->fill_sets[target])
            return false;
    }
    return true;
}

bool pyramid_init(struct pyramid *p, const struct pyramid_desc *desc)
{
    *p = (struct pyramid){
        .gpu = desc->gpu, .width = desc->width, .height = desc->height, .confidence = desc->confidence};
    const uint32_t levels =
        pyramid_levels(p->width, p->height, desc->confidence.epsilon, desc->confidence.hole_decay);
    p->confidence.levels = levels;
    const struct gpu_image_desc image = {.name = "pull-push pyramid",
                                         .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                                         .width = padded(p->width, levels) / 2,
                                         .height = padded(p->height, levels) / 2,
                                         .levels = levels,
                                         .layers = 2,
                                         .array = true,
                                         .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT};
    const struct gpu_kernel_desc pull = {.name = "pull",
                                         .code = {pull_comp, sizeof pull_comp},
                                         .bindings = pull_bindings,
                                         .binding_count = countof(pull_bindings),
                                         .push_bytes = sizeof(struct pull_push)};
    const struct gpu_kernel_desc fill = {.name = "fill",
                                         .code = {fill_comp, sizeof fill_comp},
                                         .bindings = fill_bindings,
                                         .binding_count = countof(fill_bindings),
                                         .push_bytes = sizeof(struct pyramid_confidence)};
    if (!gpu_image_create(p->gpu, &image, &p->image) || !gpu_kernel_create(p->gpu, &pull, &p->pull) ||
        !gpu_kernel_create(p->gpu, &fill, &p->fill))
        return false;
    for (uint32_t level = 0; level < levels; level++) {
        p->level_views[level] = gpu_image_level_view(p->gpu, &p->image, level);
        if (!p->level_views[level])
            return false;
    }
    p->sampler = gpu_sampler_create_plain(p->gpu);
    return p->sampler && create_sets(p, desc);
}

void pyramid_finish(struct pyramid *p)
{
    if (!p->gpu)
        return;
    for (uint32_t target = 0; target < 2; target++) {
        for (uint32_t i = 0; i < PYRAMID_LEVELS; i++)
            gpu_set_free(p->gpu, p->pull_sets[target][i]);
        gpu_set_free(p->gpu, p->fill_sets[target]);
    }
    for (uint32_t i = 0; i < PYRAMID_LEVELS; i++)
        vkDestroyImageView(p->gpu->device, p->level_views[i], NULL);
    vkDestroySampler(p->gpu->device, p->sampler, NULL);
    gpu_kernel_destroy(p->gpu, &p->pull);
    gpu_kernel_destroy(p->gpu, &p->fill);
    gpu_image_destroy(p->gpu, &p->image);
    *p = (struct pyramid){0};
}

void pyramid_pull(const struct pyramid *p, VkCommandBuffer cmd, uint32_t target)
{
    const VkPipelineStageFlags2 compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    const uint32_t levels = p->confidence.levels;
    gpu_image_layout(cmd, &p->image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    for (uint32_t d = 0; d < p->pull_count; d++) {
        const uint32_t first = d * LEVELS_PER_PULL, left = levels - first;
        const struct pull_push push = {d == 0, left < LEVELS_PER_PULL ? left : LEVELS_PER_PULL};
        const uint32_t width = padded(p->width, levels) >> first, height = padded(p->height, levels) >> first;
        gpu_dispatch(cmd, &p->pull, p->pull_sets[target][d], &push, sizeof push,
                     (width + SHARED_TILE - 1) / SHARED_TILE, (height + SHARED_TILE - 1) / SHARED_TILE, 2);
        gpu_barrier(cmd, compute, compute);
    }
}

void pyramid_fill(const struct pyramid *p, VkCommandBuffer cmd, uint32_t target)
{
    gpu_dispatch(cmd, &p->fill, p->fill_sets[target], &p->confidence, sizeof p->confidence,
                 (p->width + SHARED_TILE - 1) / SHARED_TILE, (p->height + SHARED_TILE - 1) / SHARED_TILE, 2);
}
