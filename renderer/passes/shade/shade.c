#include "renderer/passes/shade/shade.h"

#include "renderer/shared/shared.h"

#include "shade.comp.h"
#include "shade.comp_emissive.h"
#include "shade.comp_emissive_redraw.h"
#include "shade.comp_redraw.h"

#include <string.h>

enum { EMISSIVE = 7, REDRAW_MAP = 8, BINDINGS };

static const struct gpu_binding all_bindings[BINDINGS] = {
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},         // frame
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},         // lights
    {.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, // base
    {.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, // normal
    {.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, // surface
    {.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, // depth
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},          // hdr
    {.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, // emissive, where something glows
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},          // redraw map, where there is one
};

static struct gpu_code code_for(const struct shade_desc *desc)
{
    if (desc->emissive)
        return desc->redraw_map
                   ? (struct gpu_code){shade_comp_emissive_redraw, sizeof shade_comp_emissive_redraw}
                   : (struct gpu_code){shade_comp_emissive, sizeof shade_comp_emissive};
    return desc->redraw_map ? (struct gpu_code){shade_comp_redraw, sizeof shade_comp_redraw}
                            : (struct gpu_code){shade_comp, sizeof shade_comp};
}

bool shade_init(struct shade *s, const struct shade_desc *desc)
{
    *s = (struct shade){.gpu = desc->gpu, .width = desc->width, .height = desc->height};
    struct gpu_binding bindings[BINDINGS];
    memcpy(bindings, all_bindings, sizeof bindings);
    bindings[EMISSIVE].absent = !desc->emissive;
    bindings[REDRAW_MAP].absent = !desc->redraw_map;
    const struct gpu_kernel_desc kernel = {
        .name = "shade", .code = code_for(desc), .bindings = bindings, .binding_count = countof(bindings)};
    const struct gpu_image_desc hdr = {.name = "hdr",
                                       .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                                       .width = desc->width,
                                       .height = desc->height,
                                       .layers = 2,
                                       .array = true,
                                       .usage = VK_IMAGE_USAGE_STORAGE_BIT};
    s->sampler = gpu_sampler_create_plain(s->gpu);
    if (!s->sampler || !gpu_image_create(s->gpu, &hdr, &s->hdr) ||
        !gpu_kernel_create(s->gpu, &kernel, &s->kernel))
        return false;
    const VkImageLayout colour = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    const struct gpu_resource resources[] = {
        {.buffer = desc->frame},
        {.buffer = desc->lights},
        {.view = desc->base, .sampler = s->sampler, .layout = colour},
        {.view = desc->normal, .sampler = s->sampler, .layout = colour},
        {.view = desc->surface, .sampler = s->sampler, .layout = colour},
        {.view = desc->depth, .sampler = s->sampler, .layout = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL},
        {.view = s->hdr.view},
        {.view = desc->emissive, .sampler = s->sampler, .layout = colour},
        {.view = desc->redraw_map},
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
    *s = (struct shade){0};
}

void shade_record(const struct shade *s, VkCommandBuffer cmd)
{
    gpu_image_layout(cmd, &s->hdr, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    gpu_dispatch(cmd, &s->kernel, s->set, NULL, 0, (s->width + SHARED_TILE - 1) / SHARED_TILE,
                 (s->height + SHARED_TILE - 1) / SHARED_TILE, 2);
}
