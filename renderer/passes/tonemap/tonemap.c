#include "renderer/passes/tonemap/tonemap.h"

#include "renderer/shared/shared.h"

#include "tonemap.comp.h"
#include "tonemap.comp_leaders.h"
#include "tonemap.comp_redraw.h"

#include <string.h>

enum { REDRAW_MAP = 3, TILES = 4, LEADERS = 5, BINDINGS };

static const struct gpu_binding all_bindings[BINDINGS] = {
    {.type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}, // frame
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},  // hdr
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},  // target
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},  // redraw map, where there is one
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // tiles of it
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // leaders, where there are any
};

static struct gpu_code code_for(const struct tonemap_desc *desc)
{
    if (desc->leaders)
        return (struct gpu_code){tonemap_comp_leaders, sizeof tonemap_comp_leaders};
    return desc->redraw_map ? (struct gpu_code){tonemap_comp_redraw, sizeof tonemap_comp_redraw}
                            : (struct gpu_code){tonemap_comp, sizeof tonemap_comp};
}

bool tonemap_init(struct tonemap *t, const struct tonemap_desc *desc)
{
    *t = (struct tonemap){.gpu = desc->gpu,
                          .width = desc->width,
                          .height = desc->height,
                          .redraw = desc->redraw_map,
                          .tiles = desc->tiles};
    struct gpu_binding bindings[BINDINGS];
    memcpy(bindings, all_bindings, sizeof bindings);
    bindings[REDRAW_MAP].absent = bindings[TILES].absent = !desc->redraw_map;
    bindings[LEADERS].absent = !desc->leaders;
    const struct gpu_kernel_desc kernel = {.name = "tonemap",
                                           .code = code_for(desc),
                                           .bindings = bindings,
                                           .binding_count = countof(bindings),
                                           .push_bytes = desc->redraw_map ? sizeof(uint32_t) : 0};
    if (!gpu_kernel_create(t->gpu, &kernel, &t->kernel))
        return false;
    for (uint32_t i = 0; i < 2 && desc->targets[i]; i++) {
        const struct gpu_resource resources[] = {{.buffer = desc->frame},
                                                 {.view = desc->hdr},
                                                 {.view = desc->targets[i]},
                                                 {.view = desc->redraw_map},
                                                 {.buffer = desc->tiles ? desc->tiles : desc->frame},
                                                 {.buffer = desc->leaders}};
        t->sets[i] = gpu_set_create(t->gpu, t->kernel.set_layout, bindings, resources, countof(bindings));
        if (!t->sets[i])
            return false;
    }
    return true;
}

void tonemap_finish(struct tonemap *t)
{
    if (!t->gpu)
        return;
    gpu_set_free(t->gpu, t->sets[0]);
    gpu_set_free(t->gpu, t->sets[1]);
    gpu_kernel_destroy(t->gpu, &t->kernel);
    *t = (struct tonemap){0};
}

void tonemap_record(const struct tonemap *t, VkCommandBuffer cmd, uint32_t target)
{
    const uint32_t listed = 0;
    gpu_dispatch(cmd, &t->kernel, t->sets[target], &listed, t->redraw ? sizeof listed : 0,
                 (t->width + SHARED_TILE - 1) / SHARED_TILE, (t->height + SHARED_TILE - 1) / SHARED_TILE, 2);
}

void tonemap_record_tiles(const struct tonemap *t, VkCommandBuffer cmd, uint32_t target)
{
    const uint32_t listed = 1;
    gpu_dispatch_indirect(cmd, &t->kernel, t->sets[target], &listed, sizeof listed, t->tiles);
}
