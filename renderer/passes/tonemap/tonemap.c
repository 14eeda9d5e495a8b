#include "renderer/passes/tonemap/tonemap.h"

#include "renderer/shared/shared.h"

#include "tonemap.comp.h"

static const struct gpu_binding bindings[] = {
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 0}, // frame
    {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 0},  // hdr
    {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 0},  // target
    {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 0},  // redraw map, last: absent where there is none
};

bool tonemap_init(struct tonemap *t, const struct tonemap_desc *desc)
{
    *t = (struct tonemap){.gpu = desc->gpu, .width = desc->width, .height = desc->height};
    const int32_t has_redraw_map = desc->redraw_map != VK_NULL_HANDLE;
    const struct gpu_kernel_desc kernel = {.name = "tonemap",
                                           .code = {tonemap_comp, sizeof tonemap_comp},
                                           .bindings = bindings,
                                           .binding_count = countof(bindings),
                                           .constants = &has_redraw_map,
                                           .constant_count = 1};
    if (!gpu_kernel_create(t->gpu, &kernel, &t->kernel))
        return false;
    for (uint32_t i = 0; i < 2 && desc->targets[i]; i++) {
        const struct gpu_resource resources[] = {
            {.buffer = desc->frame}, {.view = desc->hdr}, {.view = desc->targets[i]}, {.view = desc->redraw_map}};
        t->sets[i] = gpu_set_create(t->gpu, t->kernel.set_layout, bindings, resources,
                                    countof(bindings) - (has_redraw_map ? 0 : 1));
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
    gpu_dispatch(cmd, &t->kernel, t->sets[target], NULL, 0, (t->width + SHARED_TILE - 1) / SHARED_TILE,
                 (t->height + SHARED_TILE - 1) / SHARED_TILE, 2);
}
