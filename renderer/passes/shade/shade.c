#include "renderer/passes/shade/shade.h"

#include "renderer/shared/shared.h"

#include "choose.comp.h"
#include "light_masks.comp.h"
#include "light_masks.comp_redraw.h"
#include "shade.comp.h"
#include "shade.comp_chosen.h"
#include "shade.comp_redraw.h"

#include <string.h>

enum { COUNTERS = 11, REDRAW_MAP, LIST, LIGHT_MASKS, LEADERS, BINDINGS };
enum { BLOCK = 4 }; // pixels a side, leaders.glsl

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
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},         // tiles of it, or chosen pixels of blocks
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},         // light masks
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},         // leaders of blocks
};

static uint32_t groups_over(uint32_t pixels, uint32_t group_pixels)
{
    return (pixels + group_pixels - 1) / group_pixels;
}

static bool create_kernel(struct shade *s, const struct shade_desc *desc, const char *name,
                          struct gpu_code code, uint32_t push_bytes, struct gpu_kernel *out)
{
    const int32_t constants[] = {desc->emissive != VK_NULL_HANDLE, desc->ao != VK_NULL_HANDLE,
                                 desc->every_light, desc->shadow_map != VK_NULL_HANDLE,
                                 (int32_t)s->light_words};
    const struct gpu_kernel_desc kernel = {.name = name,
                                           .code = code,
                                           .bindings = s->bindings,
                                           .binding_count = BINDINGS,
                                           .push_bytes = push_bytes,
                                           .constants = constants,
                                           .constant_count = countof(constants)};
    return gpu_kernel_create(s->gpu, &kernel, out);
}

static bool create_kernels(struct shade *s, const struct shade_desc *desc)
{
    struct gpu_code masks = {light_masks_comp, sizeof light_masks_comp},
                    shade = {shade_comp, sizeof shade_comp};
    if (desc->redraw_map) {
        masks = (struct gpu_code){light_masks_comp_redraw, sizeof light_masks_comp_redraw};
        shade = (struct gpu_code){shade_comp_redraw, sizeof shade_comp_redraw};
    }
    if (desc->blocks)
        shade = (struct gpu_code){shade_comp_chosen, sizeof shade_comp_chosen};
    const struct gpu_code choose = {choose_comp, sizeof choose_comp};
    const uint32_t push_bytes = desc->redraw_map ? sizeof(uint32_t) : 0;
    return create_kernel(s, desc, "light masks", masks, push_bytes, &s->masks) &&
           create_kernel(s, desc, "shade", shade, push_bytes, &s->kernel) &&
           (!desc->blocks || create_kernel(s, desc, "choose", choose, 2 * sizeof(float), &s->choose));
}

static bool create_buffers(struct shade *s, const struct shade_desc *desc)
{
    const VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    const uint64_t word = sizeof(uint32_t);
    const uint64_t tiles = 2ull * groups_over(s->width, SHARED_TILE) * groups_over(s->height, SHARED_TILE);
    const uint64_t blocks = 2ull * groups_over(s->width, BLOCK) * groups_over(s->height, BLOCK);
    if (!gpu_buffer_create(s->gpu, "light masks", tiles * s->light_words * word, storage, GPU_DEVICE,
                           &s->light_masks))
        return false;
    if (!desc->blocks)
        return true;
    return gpu_buffer_create(s->gpu, "leaders", 2 * blocks * word, storage, GPU_DEVICE, &s->leaders) &&
           gpu_buffer_create(s->gpu, "chosen pixels", (SHARED_TILES_FIRST + 2ull * s->width * s->height) * word,
                             storage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                             GPU_DEVICE, &s->chosen);
}

static bool create_hdr(struct shade *s)
{
    const struct gpu_image_desc hdr = {.name = "hdr",
                                       .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                                       .width = s->width,
                                       .height = s->height,
                                       .layers = 2,
                                       .array = true,
                                       .usage = VK_IMAGE_USAGE_STORAGE_BIT};
    return gpu_image_create(s->gpu, &hdr, &s->hdr);
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

// One set for all kernels; each names what it uses of it.
static bool create_set(struct shade *s, const struct shade_desc *desc)
{
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
        [COUNTERS] = {.buffer = desc->blocks ? desc->blocks->counters : NULL},
        [REDRAW_MAP] = {.view = desc->redraw_map},
        [LIST] = {.buffer = desc->blocks  ? &s->chosen
                            : desc->tiles ? desc->tiles
                                          : desc->lights},
        [LIGHT_MASKS] = {.buffer = &s->light_masks},
        [LEADERS] = {.buffer = desc->blocks ? &s->leaders : NULL},
    };
    s->set = gpu_set_create(s->gpu, s->kernel.set_layout, s->bindings, resources, countof(resources));
    return s->set;
}

bool shade_init(struct shade *s, const struct shade_desc *desc)
{
    const VkDeviceSize lights = desc->lights->size / sizeof(struct shared_light);
    *s = (struct shade){.gpu = desc->gpu,
                        .width = desc->width,
                        .height = desc->height,
                        .light_words = lights > 32 ? (uint32_t)(lights + 31) / 32 : 1,
                        .blocks = desc->blocks,
                        .inner_deg = desc->blocks ? desc->blocks->inner_deg : 0,
                        .outer_deg = desc->blocks ? desc->blocks->outer_deg : 0,
                        .redraw = desc->redraw_map,
                        .tiles = desc->tiles};
    memcpy(s->bindings, all_bindings, sizeof all_bindings);
    s->bindings[REDRAW_MAP].absent = !desc->redraw_map;
    s->bindings[COUNTERS].absent = s->bindings[LEADERS].absent = !desc->blocks;
    s->bindings[LIST].absent = !desc->redraw_map && !desc->blocks;
    s->sampler = gpu_sampler_create_plain(s->gpu);
    s->compare = gpu_sampler_create_compare(s->gpu);
    return s->sampler && s->compare && create_hdr(s) && create_buffers(s, desc) && create_kernels(s, desc) &&
           create_set(s, desc);
}

void shade_finish(struct shade *s)
{
    if (!s->gpu)
        return;
    gpu_set_free(s->gpu, s->set);
    gpu_kernel_destroy(s->gpu, &s->masks);
    gpu_kernel_destroy(s->gpu, &s->choose);
    gpu_kernel_destroy(s->gpu, &s->kernel);
    gpu_buffer_destroy(s->gpu, &s->light_masks);
    gpu_buffer_destroy(s->gpu, &s->leaders);
    gpu_buffer_destroy(s->gpu, &s->chosen);
    gpu_image_destroy(s->gpu, &s->hdr);
    vkDestroySampler(s->gpu->device, s->sampler, NULL);
    vkDestroySampler(s->gpu->device, s->compare, NULL);
    *s = (struct shade){0};
}

uint64_t shade_memory(const struct shade *s)
{
    return s->hdr.bytes + s->light_masks.size + s->leaders.size + s->chosen.size;
}

static void record_masks(const struct shade *s, VkCommandBuffer cmd, uint32_t listed)
{
    gpu_dispatch(cmd, &s->masks, s->set, &listed, s->redraw ? sizeof listed : 0,
                 groups_over(s->width, SHARED_TILE * SHARED_TILE),
                 groups_over(s->height, SHARED_TILE * SHARED_TILE), 2);
}

static void record_chosen(const struct shade *s, VkCommandBuffer cmd)
{
    const VkPipelineStageFlags2 compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    const float rings[2] = {s->inner_deg, s->outer_deg};
    const uint32_t empty[SHARED_TILES_FIRST] = {0, 1, 1, 0};
    vkCmdUpdateBuffer(cmd, s->chosen.buffer, 0, sizeof empty, empty);
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, compute);
    gpu_dispatch(cmd, &s->choose, s->set, rings, sizeof rings, groups_over(s->width, BLOCK * SHARED_TILE),
                 groups_over(s->height, BLOCK * SHARED_TILE), 2);
    gpu_barrier(cmd, compute, compute | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT);
    gpu_dispatch_indirect(cmd, &s->kernel, s->set, NULL, 0, &s->chosen);
}

void shade_record(const struct shade *s, VkCommandBuffer cmd)
{
    const VkPipelineStageFlags2 compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    const uint32_t listed = 0;
    gpu_image_layout(cmd, &s->hdr, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    record_masks(s, cmd, listed);
    if (s->blocks) {
        record_chosen(s, cmd);
        return;
    }
    gpu_barrier(cmd, compute, compute);
    gpu_dispatch(cmd, &s->kernel, s->set, &listed, s->redraw ? sizeof listed : 0,
                 groups_over(s->width, SHARED_TILE), groups_over(s->height, SHARED_TILE), 2);
}

void shade_record_tiles(const struct shade *s, VkCommandBuffer cmd)
{
    const VkPipelineStageFlags2 compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    const uint32_t listed = 1;
    gpu_image_layout(cmd, &s->hdr, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    record_masks(s, cmd, listed);
    gpu_barrier(cmd, compute, compute);
    gpu_dispatch_indirect(cmd, &s->kernel, s->set, &listed, sizeof listed, s->tiles);
}
