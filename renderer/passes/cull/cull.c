#include "renderer/passes/cull/cull.h"

#include "cull_count.comp.h"
#include "cull_emit.comp.h"

static const struct gpu_binding count_bindings[] = {
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // frame
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // items
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // objects
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // groups
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // visible
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // group counts
};

static const struct gpu_binding emit_bindings[] = {
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // frame
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
    const VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    const VkBufferUsageFlags indirect = storage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
    return gpu_buffer_create(c->gpu, "visible items", 2ull * s->item_count * sizeof(uint32_t), storage,
                             GPU_DEVICE, &c->visible) &&
           gpu_buffer_create(c->gpu, "group counts", 2ull * s->group_count * sizeof(uint32_t), storage,
                             GPU_DEVICE, &c->group_counts) &&
           gpu_buffer_create(c->gpu, "draws", 2ull * s->item_count * sizeof(struct shared_draw), indirect,
                             GPU_DEVICE, &c->draws) &&
           gpu_buffer_create(c->gpu, "draw counts", 2ull * s->bucket_count * sizeof(uint32_t), indirect,
                             GPU_DEVICE, &c->draw_counts);
}

bool cull_init(struct cull *c, struct gpu *gpu, const struct scene_gpu *scene, const struct gpu_buffer *frame,
               const struct gpu_buffer *counters)
{
    *c = (struct cull){.gpu = gpu, .scene = scene};
    const struct gpu_kernel_desc count = {.name = "cull count",
                                          .code = {cull_count_comp, sizeof cull_count_comp},
                                          .bindings = count_bindings,
                                          .binding_count = countof(count_bindings)};
    const int32_t buckets = (int32_t)scene->bucket_count;
    const struct gpu_kernel_desc emit = {.name = "cull emit",
                                         .code = {cull_emit_comp, sizeof cull_emit_comp},
                                         .bindings = emit_bindings,
                                         .binding_count = countof(emit_bindings),
                                         .constants = &buckets,
                                         .constant_count = 1};
    if (!create_buffers(c) || !gpu_kernel_create(gpu, &count, &c->count) ||
        !gpu_kernel_create(gpu, &emit, &c->emit))
        return false;
    const struct gpu_resource count_resources[] = {
        {.buffer = frame},          {.buffer = &scene->items}, {.buffer = &scene->objects},
        {.buffer = &scene->groups}, {.buffer = &c->visible},   {.buffer = &c->group_counts},
    };
    const struct gpu_resource emit_resources[] = {
        {.buffer = frame},           {.buffer = &scene->items},    {.buffer = &scene->groups},
        {.buffer = &c->visible},     {.buffer = &c->group_counts}, {.buffer = &c->draws},
        {.buffer = &c->draw_counts}, {.buffer = counters},
    };
    c->count_set =
        gpu_set_create(gpu, c->count.set_layout, count_bindings, count_resources, countof(count_resources));
    c->emit_set =
        gpu_set_create(gpu, c->emit.set_layout, emit_bindings, emit_resources, countof(emit_resources));
    return c->count_set && c->emit_set;
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

void cull_record(const struct cull *c, VkCommandBuffer cmd)
{
    const VkPipelineStageFlags2 compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, compute);
    gpu_dispatch(cmd, &c->count, c->count_set, NULL, 0, c->scene->group_count, 2, 1);
    gpu_barrier(cmd, compute, compute);
    gpu_dispatch(cmd, &c->emit, c->emit_set, NULL, 0, c->scene->group_count, 2, 1);
    gpu_barrier(cmd, compute, VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT);
}
