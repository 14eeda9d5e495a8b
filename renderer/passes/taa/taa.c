#include "renderer/passes/taa/taa.h"

#include "renderer/shared/shared.h"

#include "taa.comp.h"
#include "taa.comp_id.h"
#include "taa.comp_redraw.h"

#include <string.h>

enum { POSITION = 6, REDRAW_MAP, DEPTH, ID, BINDINGS };

static const struct gpu_binding all_bindings[BINDINGS] = {
    {.type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},         // frame
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},         // motions
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},          // colour
    {.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, // history
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},          // filtered
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},          // shown
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},          // position
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},          // redraw map
    {.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, // depth
    {.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, // id
};

struct push {
    uint32_t motion_count, has_history;
};

static bool create_images(struct taa *t)
{
    struct gpu_image_desc image = {.name = "filtered colour",
                                   .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                                   .width = t->width,
                                   .height = t->height,
                                   .layers = 2,
                                   .array = true,
                                   .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT};
    if (!gpu_image_create(t->gpu, &image, &t->filtered[0]) ||
        !gpu_image_create(t->gpu, &image, &t->filtered[1]))
        return false;
    image.name = "shown colour";
    image.format = VK_FORMAT_R8G8B8A8_UNORM;
    image.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    return gpu_image_create(t->gpu, &image, &t->shown);
}

static bool create_sets(struct taa *t, const struct taa_desc *desc, const struct gpu_binding *bindings)
{
    for (uint32_t source = 0; source < 2 && desc->colour[source]; source++) {
        for (uint32_t to = 0; to < 2; to++) {
            const struct gpu_resource resources[BINDINGS] = {
                {.buffer = desc->frame},
                {.buffer = desc->motions},
                {.view = desc->colour[source]},
                {.view = t->filtered[1 - to].view, .sampler = t->linear},
                {.view = t->filtered[to].view},
                {.view = t->shown.view},
                {.view = desc->position[source]},
                {.view = desc->redraw_map},
                {.view = desc->depth, .sampler = t->plain, .layout = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL},
                {.view = desc->id, .sampler = t->plain, .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL},
            };
            t->sets[source][to] = gpu_set_create(t->gpu, t->kernel.set_layout, bindings, resources, BINDINGS);
            if (!t->sets[source][to])
                return false;
        }
    }
    return true;
}

bool taa_init(struct taa *t, const struct taa_desc *desc)
{
    *t = (struct taa){
        .gpu = desc->gpu, .width = desc->width, .height = desc->height, .motion_count = desc->motion_count};
    struct gpu_binding bindings[BINDINGS];
    memcpy(bindings, all_bindings, sizeof bindings);
    bindings[POSITION].absent = bindings[REDRAW_MAP].absent = !desc->redraw_map;
    bindings[DEPTH].absent = desc->redraw_map;
    bindings[ID].absent = desc->redraw_map || !desc->id;
    const struct gpu_kernel_desc kernel = {
        .name = "temporal antialiasing",
        .code = desc->redraw_map ? (struct gpu_code){taa_comp_redraw, sizeof taa_comp_redraw}
                : desc->id       ? (struct gpu_code){taa_comp_id, sizeof taa_comp_id}
                                 : (struct gpu_code){taa_comp, sizeof taa_comp},
        .bindings = bindings,
        .binding_count = countof(bindings),
        .push_bytes = sizeof(struct push)};
    const VkSamplerAddressMode clamp = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    t->plain = gpu_sampler_create_plain(t->gpu);
    t->linear = gpu_sampler_create(t->gpu, VK_FILTER_LINEAR, VK_FILTER_LINEAR, clamp, clamp, 1);
    return t->plain && t->linear && create_images(t) && gpu_kernel_create(t->gpu, &kernel, &t->kernel) &&
           create_sets(t, desc, bindings);
}

void taa_finish(struct taa *t)
{
    if (!t->gpu)
        return;
    for (int i = 0; i < 4; i++)
        gpu_set_free(t->gpu, t->sets[i / 2][i % 2]);
    gpu_kernel_destroy(t->gpu, &t->kernel);
    gpu_image_destroy(t->gpu, &t->filtered[0]);
    gpu_image_destroy(t->gpu, &t->filtered[1]);
    gpu_image_destroy(t->gpu, &t->shown);
    vkDestroySampler(t->gpu->device, t->linear, NULL);
    vkDestroySampler(t->gpu->device, t->plain, NULL);
    *t = (struct taa){0};
}

uint64_t taa_memory(const struct taa *t)
{
    return t->filtered[0].bytes + t->filtered[1].bytes + t->shown.bytes;
}

void taa_record(struct taa *t, VkCommandBuffer cmd, uint32_t source, bool history)
{
    const VkPipelineStageFlags2 compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    const uint32_t to = 1 - t->last;
    const struct push push = {t->motion_count, history && t->in_use};
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, compute);
    if (!t->in_use) {
        const struct gpu_image *images[] = {&t->filtered[0], &t->filtered[1], &t->shown};
        for (size_t i = 0; i < countof(images); i++)
            gpu_image_layout(cmd, images[i], VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    }
    gpu_dispatch(cmd, &t->kernel, t->sets[source][to], &push, sizeof push,
                 (t->width + SHARED_TILE - 1) / SHARED_TILE, (t->height + SHARED_TILE - 1) / SHARED_TILE, 2);
    t->last = to;
    t->in_use = true;
}
