#include "renderer/passes/compose/compose.h"

#include "renderer/shared/shared.h"

#include "compose.comp.h"

static const struct gpu_binding bindings[] = {
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 0},         // frame
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 0}, // depth
    {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 0},          // redraw map
    {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 0},          // position
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 0}, // id, last: absent where nothing moves
};

bool compose_init(struct compose *c, const struct compose_desc *desc)
{
    *c = (struct compose){.gpu = desc->gpu, .width = desc->width, .height = desc->height};
    const int32_t has_id = desc->id != VK_NULL_HANDLE;
    const struct gpu_kernel_desc kernel = {.name = "compose",
                                           .code = {compose_comp, sizeof compose_comp},
                                           .bindings = bindings,
                                           .binding_count = countof(bindings),
                                           .constants = &has_id,
                                           .constant_count = 1};
    c->sampler = gpu_sampler_create(c->gpu, VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                    VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, 1);
    if (!c->sampler || !gpu_kernel_create(c->gpu, &kernel, &c->kernel))
        return false;
    for (uint32_t target = 0; target < 2; target++) {
        const struct gpu_resource resources[] = {
            {.buffer = desc->frame},
            {.view = desc->depth, .sampler = c->sampler, .layout = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL},
            {.view = desc->redraw_map},
            {.view = desc->position[target]},
            {.view = desc->id, .sampler = c->sampler, .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL},
        };
        c->sets[target] = gpu_set_create(c->gpu, c->kernel.set_layout, bindings, resources,
                                         countof(bindings) - (has_id ? 0 : 1));
        if (!c->sets[target])
            return false;
    }
    return true;
}

void compose_finish(struct compose *c)
{
    if (!c->gpu)
        return;
    gpu_set_free(c->gpu, c->sets[0]);
    gpu_set_free(c->gpu, c->sets[1]);
    gpu_kernel_destroy(c->gpu, &c->kernel);
    vkDestroySampler(c->gpu->device, c->sampler, NULL);
    *c = (struct compose){0};
}

void compose_record(const struct compose *c, VkCommandBuffer cmd, uint32_t target)
{
    gpu_dispatch(cmd, &c->kernel, c->sets[target], NULL, 0, (c->width + SHARED_TILE - 1) / SHARED_TILE,
                 (c->height + SHARED_TILE - 1) / SHARED_TILE, 2);
}
