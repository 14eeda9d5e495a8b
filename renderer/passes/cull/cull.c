#include "renderer/passes/cull/cull.h"

#include "cull_count.comp.h"
#include "cull_count.comp_redraw.h"
#include "cull_emit.comp.h"

#include <string.h>

enum { COUNTERS = 6, PYRAMID, COUNT_BINDINGS };

static const struct gpu_binding count_bindings[COUNT_BINDINGS] = {
    {.type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}, // frame
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // items
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // objects
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // groups
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // visible
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // group counts
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // counters, with a redraw map
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // or-pyramid of the redraw map
};

struct count_push {
    uint32_t tiles_x, tiles_y, levels, moving_everywhere;
};

static const struct gpu_binding emit_bindings[] = {
    {.type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}, // frame
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // items
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // groups
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // visible
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // group counts
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // draws
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // draw counts
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // counters
};

static bool create_buffers(struct cull *c)
{
    const struct scene_gpu *s = c->scene;
    const uint64_t lists = c->lists;
    const VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    const VkBufferUsageFlags indirect = storage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
    return gpu_buffer_create(c->gpu, "visible items", lists * s->item_count * sizeof(uint32_t), storage,
                             GPU_DEVICE, &c->visible) &&
           gpu_buffer_create(c->gpu, "group counts", lists * s->group_count * sizeof(uint32_t), storage,
                             GPU_DEVICE, &c->group_counts) &&
           gpu_buffer_create(c->gpu, "draws", lists * s->item_count * sizeof(struct shared_draw), indirect,
                             GPU_DEVICE, &c->draws) &&
           gpu_buffer_create(c->gpu, "draw counts", lists * s->bucket_count * sizeof(uint32_t), indirect,
                             GPU_DEVICE, &c->draw_counts);
}

static bool create_count(struct cull *c, const struct cull_desc *desc)
{
    struct gpu_binding bindings[COUNT_BINDINGS];
    memcpy(bindings, count_bindings, sizeof bindings);
    bindings[COUNTERS].absent = bindings[PYRAMID].absent = !c->by_redraw_map;
    const int32_t both_eyes = c->lists == 1;
    const struct gpu_kernel_desc count = {
        .name = "cull count",
        .code = c->by_redraw_map ? (struct gpu_code){cull_count_comp_redraw, sizeof cull_count_comp_redraw}
                                 : (struct gpu_code){cull_count_comp, sizeof cull_count_comp},
        .bindings = bindings,
        .binding_count = countof(bindings),
        .push_bytes = c->by_redraw_map ? sizeof(struct count_push) : 0,
        .constants = &both_eyes,
        .constant_count = 1};
    const struct gpu_resource resources[] = {
        {.buffer = desc->frame},       {.buffer = &c->scene->items}, {.buffer = &c->scene->objects},
        {.buffer = &c->scene->groups}, {.buffer = &c->visible},      {.buffer = &c->group_counts},
        {.buffer = desc->counters},    {.buffer = desc->pyramid},
    };
    if (!gpu_kernel_create(c->gpu, &count, &c->count))
        return false;
    c->count_set = gpu_set_create(c->gpu, c->count.set_layout, bindings, resources, countof(resources));
    return c->count_set;
}

static bool create_emit(struct cull *c, const struct cull_desc *desc)
{
    const int32_t constants[] = {(int32_t)c->scene->bucket_count, c->lists == 1, desc->instanced ? 2 : 1};
    const struct gpu_kernel_desc emit = {.name = "cull emit",
                                         .code = {cull_emit_comp, sizeof cull_emit_comp},
                                         .bindings = emit_bindings,
                                         .binding_count = countof(emit_bindings),
                                         .constants = constants,
                                         .constant_count = countof(constants)};
    const struct gpu_resource resources[] = {
        {.buffer = desc->frame},     {.buffer = &c->scene->items}, {.buffer = &c->scene->groups},
        {.buffer = &c->visible},     {.buffer = &c->group_counts}, {.buffer = &c->draws},
        {.buffer = &c->draw_counts}, {.buffer = desc->counters},
    };
    if (!gpu_kernel_create(c->gpu, &emit, &c->emit))
        return false;
    c->emit_set = gpu_set_create(c->gpu, c->emit.set_layout, emit_bindings, resources, countof(resources));
    return c->emit_set;
}

bool cull_init(struct cull *c, const struct cull_desc *desc)
{
    *c = (struct cull){.gpu = desc->gpu,
                       .scene = desc->scene,
                       .lists = desc->both_eyes ? 1 : 2,
                       .by_redraw_map = desc->pyramid != NULL,
                       .tiles_x = desc->tiles_x,
                       .tiles_y = desc->tiles_y,
                       .levels = desc->levels};
    return create_buffers(c) && create_count(c, desc) && create_emit(c, desc);
}

void cull_finish(struct cull *c)
{
    if (!c->gpu)
        return;
    gpu_set_free(c->gpu, c->count_set);
    gpu_set_free(c->gpu, c->emit_set);
    gpu_kernel_destroy(c->gpu, &c->count);
    gpu_kernel_destroy(c->gpu, &c->emit);
    gpu_buffer_destroy(c->gpu, &c->visible);
    gpu_buffer_destroy(c->gpu, &c->group_counts);
    gpu_buffer_destroy(c->gpu, &c->draws);
    gpu_buffer_destroy(c->gpu, &c->draw_counts);
    *c = (struct cull){0};
}

uint64_t cull_memory(const struct cull *c)
{
    return c->visible.size + c->group_counts.size + c->draws.size + c->draw_counts.size;
}

void cull_record(const struct cull *c, VkCommandBuffer cmd, bool moving_everywhere)
{
    const VkPipelineStageFlags2 compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    const struct count_push push = {c->tiles_x, c->tiles_y, c->levels, moving_everywhere};
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, compute);
    gpu_dispatch(cmd, &c->count, c->count_set, &push, c->by_redraw_map ? sizeof push : 0, c->scene->group_count,
                 c->lists, 1);
    gpu_barrier(cmd, compute, compute);
    gpu_dispatch(cmd, &c->emit, c->emit_set, NULL, 0, c->scene->group_count, c->lists, 1);
    gpu_barrier(cmd, compute, VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT);
}
