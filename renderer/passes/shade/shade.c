#include "renderer/passes/shade/shade.h"

#include "renderer/shared/shared.h"

#include "coarse.comp.h"
#include "shade.comp.h"
#include "shade.comp_redraw.h"

#include <string.h>

enum { COUNTERS = 11, REDRAW_MAP = 12, TILES = 13, BINDINGS };

static const struct gpu_binding all_bindings[BINDINGS] = {
    {.type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},         // frame
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},         // lights
    {.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, // base
    {.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, // normal
    {.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, // surface
    {.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, // depth
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},          // hdr
    {.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, // emissive
    {.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, // occlusion
    {.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, // its distances
    {.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, // sun shadow
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},         // counters, where blocks are shaded
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},          // redraw map, where there is one
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},         // tiles of it
};

static struct gpu_code code_for(const struct shade_desc *desc)
{
    if (desc->blocks)
        return (struct gpu_code){coarse_comp, sizeof coarse_comp};
    return desc->redraw_map ? (struct gpu_code){shade_comp_redraw, sizeof shade_comp_redraw}
                            : (struct gpu_code){shade_comp, sizeof shade_comp};
}

static bool create_kernel(struct shade *s, const struct shade_desc *desc, struct gpu_binding *bindings)
{
    memcpy(bindings, all_bindings, sizeof all_bindings);
    bindings[REDRAW_MAP].absent = bindings[TILES].absent = !desc->redraw_map;
    bindings[COUNTERS].absent = !desc->blocks;
    const uint32_t push_bytes = desc->blocks ? 2 * sizeof(float) : desc->redraw_map ? sizeof(uint32_t) : 0;
    const int32_t constants[] = {desc->emissive != VK_NULL_HANDLE, desc->ao != VK_NULL_HANDLE,
                                 desc->every_light, desc->shadow_map != VK_NULL_HANDLE};
    return gpu_kernel_create(s->gpu,
                             &(struct gpu_kernel_desc){.name = "shade",
                                                       .code = code_for(desc),
                                                       .bindings = bindings,
                                                       .binding_count = BINDINGS,
                                                       .push_bytes = push_bytes,
                                                       .constants = constants,
                                                       .constant_count = countof(constants)},
                             &s->kernel);
}

// `image`, or what stands in for it where there is none: the kernel's variant does not read it, but what a
// shader names must be bound.
static struct gpu_resource sampled(const struct shade *s, VkImageView image, VkImageLayout layout,
                                   VkImageView other)
{
    return (struct gpu_resource){.view = image ? image : other,
                                 .sampler = s->sampler,
                                 .layout = image ? layout : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
}

bool shade_init(struct shade *s, const struct shade_desc *desc)
{
    *s = (struct shade){.gpu = desc->gpu,
                        .width = desc->width,
                        .height = desc->height,
                        .blocks = desc->blocks,
                        .inner_deg = desc->blocks ? desc->blocks->inner_deg : 0,
                        .outer_deg = desc->blocks ? desc->blocks->outer_deg : 0,
                        .redraw = desc->redraw_map,
                        .tiles = desc->tiles};
    const struct gpu_image_desc hdr = {.name = "hdr",
                                       .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                                       .width = desc->width,
                                       .height = desc->height,
                                       .layers = 2,
                                       .array = true,
                                       .usage = VK_IMAGE_USAGE_STORAGE_BIT};
    struct gpu_binding bindings[BINDINGS];
    s->sampler = gpu_sampler_create_plain(s->gpu);
    s->compare = gpu_sampler_create_compare(s->gpu);
    if (!s->sampler || !s->compare || !gpu_image_create(s->gpu, &hdr, &s->hdr) ||
        !create_kernel(s, desc, bindings))
        return false;
    const VkImageLayout colour = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    const struct gpu_resource resources[BINDINGS] = {
        {.buffer = desc->frame},
        {.buffer = desc->lights},
        {.view = desc->base, .sampler = s->sampler, .layout = colour},
        {.view = desc->normal, .sampler = s->sampler, .layout = colour},
        {.view = desc->surface, .sampler = s->sampler, .layout = colour},
        {.view = desc->depth, .sampler = s->sampler, .layout = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL},
        {.view = s->hdr.view},
        sampled(s, desc->emissive, colour, desc->base),
        sampled(s, desc->ao, VK_IMAGE_LAYOUT_GENERAL, desc->base),
        sampled(s, desc->ao_depth, VK_IMAGE_LAYOUT_GENERAL, desc->base),
        {.view = desc->shadow_map ? desc->shadow_map : desc->depth,
         .sampler = s->compare,
         .layout = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL},
        {.buffer = desc->blocks ? desc->blocks->counters : NULL},
        [REDRAW_MAP] = {.view = desc->redraw_map},
        [TILES] = {.buffer = desc->tiles ? desc->tiles : desc->frame},
    };
    s->set = gpu_set_create(s->gpu, s->kernel.set_layout, bindings, resources, countof(resources));
    return s->set;
}

void shade_finish(struct shade *s)
{
    if (!s->gpu)
        return;
    gpu_set_free(s->gpu, s->set);
    gpu_kernel_destroy(s->gpu, &s->kernel);
    gpu_image_destroy(s->gpu, &s->hdr);
    vkDestroySampler(s->gpu->device, s->sampler, NULL);
    vkDestroySampler(s->gpu->device, s->compare, NULL);
    *s = (struct shade){0};
}

void shade_record(const struct shade *s, VkCommandBuffer cmd)
{
    const uint32_t listed = 0;
    const float rings[2] = {s->inner_deg, s->outer_deg};
    gpu_image_layout(cmd, &s->hdr, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    gpu_dispatch(cmd, &s->kernel, s->set, s->blocks ? (const void *)rings : &listed,
                 s->blocks   ? sizeof rings
                 : s->redraw ? sizeof listed
                             : 0,
                 (s->width + SHARED_TILE - 1) / SHARED_TILE, (s->height + SHARED_TILE - 1) / SHARED_TILE, 2);
}

void shade_record_tiles(const struct shade *s, VkCommandBuffer cmd)
{
    const uint32_t listed = 1;
    gpu_image_layout(cmd, &s->hdr, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    gpu_dispatch_indirect(cmd, &s->kernel, s->set, &listed, sizeof listed, s->tiles);
}
