#include "renderer/passes/compose/compose.h"

#include "compose.comp.h"
#include "compose.comp_id.h"

#include <string.h>

enum { ID = 4, TILES, BINDINGS };

static const struct gpu_binding all_bindings[BINDINGS] = {
    {.type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},         // frame
    {.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, // depth
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},          // redraw map
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},          // position
    {.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, // id, where something moves
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},         // tiles
};

bool compose_init(struct compose *c, const struct compose_desc *desc)
{
    *c = (struct compose){.gpu = desc->gpu, .tiles = desc->tiles};
    struct gpu_binding bindings[BINDINGS];
    memcpy(bindings, all_bindings, sizeof bindings);
    bindings[ID].absent = !desc->id;
    const struct gpu_code code = desc->id ? (struct gpu_code){compose_comp_id, sizeof compose_comp_id}
                                          : (struct gpu_code){compose_comp, sizeof compose_comp};
    const struct gpu_kernel_desc kernel = {
        .name = "compose", .code = code, .bindings = bindings, .binding_count = countof(bindings)};
    c->sampler = gpu_sampler_create_plain(c->gpu);
    if (!c->sampler || !gpu_kernel_create(c->gpu, &kernel, &c->kernel))
        return false;
    for (uint32_t target = 0; target < 2; target++) {
        const struct gpu_resource resources[] = {
            {.buffer = desc->frame},
            {.view = desc->depth, .sampler = c->sampler, .layout = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL},
            {.view = desc->redraw_map},
            {.view = desc->position[target]},
            {.view = desc->id, .sampler = c->sampler, .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL},
            {.buffer = desc->tiles},
        };
        c->sets[target] = gpu_set_create(c->gpu, c->kernel.set_layout, bindings, resources, countof(bindings));
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

void compose_record_tiles(const struct compose *c, VkCommandBuffer cmd, uint32_t target)
{
    gpu_dispatch_indirect(cmd, &c->kernel, c->sets[target], NULL, 0, c->tiles);
}
