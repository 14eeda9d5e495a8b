#include "renderer/passes/shade/shade.h"

#include "renderer/shared/shared.h"

#include "shade.comp.h"

static const struct gpu_binding bindings[] = {
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 0},         // frame
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 0},         // lights
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 0}, // base
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 0}, // normal
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 0}, // surface
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 0}, // emissive
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 0}, // depth
    {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 0},          // hdr
    {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 0},          // redraw map, last: absent where there is none
};

bool shade_init(struct shade *s, const struct shade_desc *desc)
{
    *s = (struct shade){.gpu = desc->gpu, .width = desc->width, .height = desc->height};
    const int32_t constants[] = {desc->emissive != VK_NULL_HANDLE, desc->redraw_map != VK_NULL_HANDLE};
    const uint32_t binding_count = countof(bindings) - (desc->redraw_map ? 0 : 1);
    const struct gpu_kernel_desc kernel = {.name = "shade",
                                           .code = {shade_comp, sizeof shade_comp},
                                           .bindings = bindings,
                                           .binding_count = countof(bindings),
                                           .constants = constants,
                                           .constant_count = countof(constants)};
    const struct gpu_image_desc hdr = {.name = "hdr",
                                       .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                                       .width = desc->width,
                                       .height = desc->height,
                                       .layers = 2,
                                       .array = true,
                                       .usage = VK_IMAGE_USAGE_STORAGE_BIT};
    s->sampler = gpu_sampler_create(s->gpu, VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                    VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, 1);
    if (!s->sampler || !gpu_image_create(s->gpu, &hdr, &s->hdr) || !gpu_kernel_create(s->gpu, &kernel, &s->kernel))
        return false;
    const VkImageLayout colour = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    const struct gpu_resource resources[] = {
        {.buffer = desc->frame},
        {.buffer = desc->lights},
        {.view = desc->base, .sampler = s->sampler, .layout = colour},
        {.view = desc->normal, .sampler = s->sampler, .layout = colour},
        {.view = desc->surface, .sampler = s->sampler, .layout = colour},
        {.view = desc->emissive ? desc->emissive : desc->base, .sampler = s->sampler, .layout = colour},
        {.view = desc->depth, .sampler = s->sampler, .layout = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL},
        {.view = s->hdr.view},
        {.view = desc->redraw_map},
    };
    s->set = gpu_set_create(s->gpu, s->kernel.set_layout, bindings, resources, binding_count);
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
    *s = (struct shade){0};
}

void shade_record(const struct shade *s, VkCommandBuffer cmd)
{
    gpu_image_layout(cmd, &s->hdr, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    gpu_dispatch(cmd, &s->kernel, s->set, NULL, 0, (s->width + SHARED_TILE - 1) / SHARED_TILE,
                 (s->height + SHARED_TILE - 1) / SHARED_TILE, 2);
}
