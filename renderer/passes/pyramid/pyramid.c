#include "renderer/passes/pyramid/pyramid.h"

#include "renderer/shared/shared.h"

#include "decide.comp.h"
#include "decide.comp_moving.h"
#include "fill.comp.h"
#include "pull.comp.h"
#include "pull.comp_first.h"

#include <math.h>

static const struct gpu_binding pull_bindings[] = {
    {.type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}, // frame
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},  // colour, of the first dispatch
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},  // position
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},  // the level that is read, of the others
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},  // its depths
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},  // the level that is written
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},  // its depths
};

static const struct gpu_binding decide_bindings[] = {
    {.type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}, // frame
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},  // position
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},  // redraw map
};

static const struct gpu_binding fill_bindings[] = {
    {.type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},         // frame
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},          // colour
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},          // position
    {.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, // pyramid
    {.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, // its depths
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},          // redraw map
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},         // holes
};

static uint32_t most_levels(uint32_t width, uint32_t height)
{
    uint32_t levels = 1;
    for (uint32_t side = width > height ? width : height; levels < PYRAMID_LEVELS && 1u << levels < side;)
        levels++;
    return levels;
}

uint32_t pyramid_levels(uint32_t width, uint32_t height, float epsilon, float hole_decay)
{
    const uint32_t levels = most_levels(width, height);
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
    for (uint32_t target = 0; target < 2; target++) {
        for (uint32_t level = 0; level < p->made_levels; level++) {
            const uint32_t below = level ? level - 1 : 0;
            const struct gpu_resource resources[] = {
                {.buffer = desc->frame},          {.view = desc->colour[target]},
                {.view = desc->position[target]}, {.view = p->level_views[below]},
                {.view = p->depth_views[below]},  {.view = p->level_views[level]},
                {.view = p->depth_views[level]},
            };
            p->pull_sets[target][level] =
                gpu_set_create(p->gpu, p->pull.set_layout, pull_bindings, resources, countof(resources));
            if (!p->pull_sets[target][level])
                return false;
        }
        const struct gpu_resource resources[] = {
            {.buffer = desc->frame},
            {.view = desc->colour[target]},
            {.view = desc->position[target]},
            {.view = p->image.view, .sampler = p->sampler},
            {.view = p->depth.view, .sampler = p->sampler},
            {.view = desc->redraw_map},
            {.buffer = desc->holes ? desc->holes : desc->frame}, // never read without a list
        };
        const struct gpu_resource decide[] = {
            {.buffer = desc->frame}, {.view = desc->position[target]}, {.view = desc->redraw_map}};
        p->decide_sets[target] =
            gpu_set_create(p->gpu, p->decide[p->moving].set_layout, decide_bindings, decide, countof(decide));
        p->fill_sets[target] =
            gpu_set_create(p->gpu, p->fill.set_layout, fill_bindings, resources, countof(resources));
        if (!p->fill_sets[target] || !p->decide_sets[target])
            return false;
    }
    return true;
}

static bool create_images(struct pyramid *p)
{
    const uint32_t levels = p->made_levels;
    struct gpu_image_desc image = {.name = "pull-push pyramid",
                                   .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                                   .width = padded(p->width, levels) / 2,
                                   .height = padded(p->height, levels) / 2,
                                   .levels = levels,
                                   .layers = 2,
                                   .array = true,
                                   .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT};
    if (!gpu_image_create(p->gpu, &image, &p->image))
        return false;
    image.name = "pyramid of farthest depths";
    image.format = VK_FORMAT_R32_SFLOAT;
    if (!gpu_image_create(p->gpu, &image, &p->depth))
        return false;
    for (uint32_t level = 0; level < levels; level++) {
        p->level_views[level] = gpu_image_level_view(p->gpu, &p->image, level);
        p->depth_views[level] = gpu_image_level_view(p->gpu, &p->depth, level);
        if (!p->level_views[level] || !p->depth_views[level])
            return false;
    }
    return true;
}

// Both kinds where either may be asked for; their sets are of the same layout.
static bool create_decide(struct pyramid *p, bool both)
{
    const struct gpu_code codes[2] = {{decide_comp, sizeof decide_comp},
                                      {decide_comp_moving, sizeof decide_comp_moving}};
    for (int moving = 0; moving < 2; moving++) {
        const struct gpu_kernel_desc decide = {.name = "decide",
                                               .code = codes[moving],
                                               .bindings = decide_bindings,
                                               .binding_count = countof(decide_bindings),
                                               .push_bytes = sizeof(struct pyramid_confidence)};
        if ((both || p->moving == (moving == 1)) && !gpu_kernel_create(p->gpu, &decide, &p->decide[moving]))
            return false;
    }
    return true;
}

void pyramid_set(struct pyramid *p, const struct pyramid_confidence *confidence, bool moving)
{
    p->confidence = *confidence;
    p->confidence.levels = pyramid_levels(p->width, p->height, confidence->epsilon, confidence->hole_decay);
    p->moving = moving;
}

bool pyramid_init(struct pyramid *p, const struct pyramid_desc *desc)
{
    *p = (struct pyramid){.gpu = desc->gpu, .width = desc->width, .height = desc->height, .holes = desc->holes};
    pyramid_set(p, &desc->confidence, desc->moving);
    p->made_levels = desc->all_levels ? most_levels(p->width, p->height) : p->confidence.levels;
    struct gpu_kernel_desc pull = {.name = "pull first",
                                   .code = {pull_comp_first, sizeof pull_comp_first},
                                   .bindings = pull_bindings,
                                   .binding_count = countof(pull_bindings)};
    const struct gpu_kernel_desc fill = {.name = "fill",
                                         .code = {fill_comp, sizeof fill_comp},
                                         .bindings = fill_bindings,
                                         .binding_count = countof(fill_bindings),
                                         .push_bytes = sizeof(struct pyramid_confidence)};
    if (!create_images(p) || !gpu_kernel_create(p->gpu, &pull, &p->pull_first))
        return false;
    pull.name = "pull";
    pull.code = (struct gpu_code){pull_comp, sizeof pull_comp};
    if (!gpu_kernel_create(p->gpu, &pull, &p->pull) || !create_decide(p, desc->may_move) ||
        !gpu_kernel_create(p->gpu, &fill, &p->fill))
        return false;
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
        gpu_set_free(p->gpu, p->decide_sets[target]);
        gpu_set_free(p->gpu, p->fill_sets[target]);
    }
    for (uint32_t i = 0; i < PYRAMID_LEVELS; i++) {
        vkDestroyImageView(p->gpu->device, p->level_views[i], NULL);
        vkDestroyImageView(p->gpu->device, p->depth_views[i], NULL);
    }
    vkDestroySampler(p->gpu->device, p->sampler, NULL);
    gpu_kernel_destroy(p->gpu, &p->pull_first);
    gpu_kernel_destroy(p->gpu, &p->pull);
    gpu_kernel_destroy(p->gpu, &p->decide[0]);
    gpu_kernel_destroy(p->gpu, &p->decide[1]);
    gpu_kernel_destroy(p->gpu, &p->fill);
    gpu_image_destroy(p->gpu, &p->image);
    gpu_image_destroy(p->gpu, &p->depth);
    *p = (struct pyramid){0};
}

uint64_t pyramid_memory(const struct pyramid *p)
{
    return p->image.bytes + p->depth.bytes;
}

void pyramid_pull(const struct pyramid *p, VkCommandBuffer cmd, uint32_t target)
{
    const VkPipelineStageFlags2 compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    gpu_image_layout(cmd, &p->image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    gpu_image_layout(cmd, &p->depth, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    for (uint32_t level = 0; level < p->confidence.levels; level++) {
        const uint32_t width = padded(p->width, p->confidence.levels) >> (level + 1),
                       height = padded(p->height, p->confidence.levels) >> (level + 1);
        gpu_dispatch(cmd, level ? &p->pull : &p->pull_first, p->pull_sets[target][level], NULL, 0,
                     (width + SHARED_TILE - 1) / SHARED_TILE, (height + SHARED_TILE - 1) / SHARED_TILE, 2);
        gpu_barrier(cmd, compute, compute);
    }
}

// c_e = S_1(x) = x^2 (3 - 2 x) reaches epsilon at x = 1/2 - sin(asin(1 - 2 epsilon) / 3).
static double trusted_cosine(const struct pyramid_confidence *c)
{
    const double epsilon = (double)c->epsilon,
                 width = fmax((double)c->periphery_deg - (double)c->fovea_deg, 1e-3);
    const double x = 0.5 - sin(asin(1 - 2 * fmin(fmax(epsilon, 0), 1)) / 3);
    return cos(fmin((double)c->fovea_deg + x * width, 180) * 0.017453292519943295);
}

void pyramid_fill(const struct pyramid *p, VkCommandBuffer cmd, uint32_t target, uint32_t turn)
{
    const VkPipelineStageFlags2 compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    const uint32_t x = (p->width + SHARED_TILE - 1) / SHARED_TILE,
                   y = (p->height + SHARED_TILE - 1) / SHARED_TILE;
    struct pyramid_confidence push = p->confidence;
    push.turn = turn;
    push.trusted_cosine = (float)trusted_cosine(&push);
    push.listed = p->holes != NULL;
    gpu_dispatch(cmd, &p->decide[p->moving], p->decide_sets[target], &push, sizeof push, x, y, 2);
    gpu_barrier(cmd, compute, compute | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT);
    if (p->holes)
        gpu_dispatch_indirect(cmd, &p->fill, p->fill_sets[target], &push, sizeof push, p->holes);
    else
        gpu_dispatch(cmd, &p->fill, p->fill_sets[target], &push, sizeof push,
                     (p->width + SHARED_TILE - 1) / SHARED_TILE,
                     (2 * p->height + SHARED_TILE - 1) / SHARED_TILE, 1);
}
