#include "renderer/passes/movers/movers.h"

#include "join.comp.h"
#include "list.comp.h"
#include "mark.comp.h"

#include <stdlib.h>

struct mark_push {
    uint32_t count, turn, period, motion_count;
};

static const struct gpu_binding list_bindings[] = {
    {.type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}, // frame
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // items
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // objects
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // motions
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // moving items
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // list
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // rectangles
};

static const struct gpu_binding mark_bindings[] = {
    {.type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}, // frame
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // list
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // rectangles
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},  // redraw map
};

static const struct gpu_binding join_bindings[] = {
    {.type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},         // frame
    {.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, // depth
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},          // position
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},          // redraw map
};

static bool list_items(struct movers *m)
{
    const struct scene_gpu *s = m->scene;
    uint32_t *list = malloc((s->item_count + 1) * sizeof *list);
    if (!list)
        return false;
    for (uint32_t b = 0; b < s->bucket_count; b++) {
        const struct scene_bucket *bucket = &s->buckets[b];
        for (uint32_t i = 0; bucket->moving && i < bucket->item_count; i++)
            list[m->item_count++] = bucket->first_item + i;
    }
    bool ok = gpu_buffer_create_filled(m->gpu, "moving items", list, m->item_count * sizeof *list,
                                       VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, &m->items);
    free(list);
    return ok;
}

static bool create_list(struct movers *m, const struct movers_desc *desc)
{
    const struct gpu_kernel_desc list = {.name = "list moving boxes",
                                         .code = {list_comp, sizeof list_comp},
                                         .bindings = list_bindings,
                                         .binding_count = countof(list_bindings),
                                         .push_bytes = sizeof(struct mark_push)};
    const VkDeviceSize most = 4ull * m->item_count; // rectangles: of two eyes, now and a frame ago
    const VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    if (!gpu_buffer_create(m->gpu, "moving boxes", (SHARED_TILES_FIRST + most) * sizeof(uint32_t),
                           storage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                           GPU_DEVICE, &m->list) ||
        !gpu_buffer_create(m->gpu, "moving rectangles", (most + 1) * 2 * sizeof(uint32_t), storage, GPU_DEVICE,
                           &m->rectangles) ||
        !gpu_kernel_create(m->gpu, &list, &m->lister))
        return false;
    const struct gpu_resource resources[] = {{.buffer = desc->frame},        {.buffer = &m->scene->items},
                                             {.buffer = &m->scene->objects}, {.buffer = &m->scene->motions},
                                             {.buffer = &m->items},          {.buffer = &m->list},
                                             {.buffer = &m->rectangles}};
    m->list_set = gpu_set_create(m->gpu, m->lister.set_layout, list_bindings, resources, countof(resources));
    return m->list_set;
}

static bool create_mark(struct movers *m, const struct movers_desc *desc)
{
    const struct gpu_kernel_desc mark = {.name = "mark moving boxes",
                                         .code = {mark_comp, sizeof mark_comp},
                                         .bindings = mark_bindings,
                                         .binding_count = countof(mark_bindings),
                                         .push_bytes = sizeof(struct mark_push)};
    const struct gpu_resource resources[] = {{.buffer = desc->frame},
                                             {.buffer = &m->list},
                                             {.buffer = &m->rectangles},
                                             {.view = desc->redraw_map->view}};
    if (!gpu_kernel_create(m->gpu, &mark, &m->mark))
        return false;
    m->mark_set = gpu_set_create(m->gpu, m->mark.set_layout, mark_bindings, resources, countof(resources));
    return m->mark_set;
}

static bool create_join(struct movers *m, const struct movers_desc *desc)
{
    const struct gpu_kernel_desc join = {.name = "join moving pixels",
                                         .code = {join_comp, sizeof join_comp},
                                         .bindings = join_bindings,
                                         .binding_count = countof(join_bindings)};
    if (!gpu_kernel_create(m->gpu, &join, &m->join))
        return false;
    for (int i = 0; i < 2; i++) {
        const struct gpu_resource resources[] = {
            {.buffer = desc->frame},
            {.view = desc->depth, .sampler = m->sampler, .layout = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL},
            {.view = desc->position[i]},
            {.view = desc->redraw_map->view}};
        m->join_sets[i] =
            gpu_set_create(m->gpu, m->join.set_layout, join_bindings, resources, countof(resources));
        if (!m->join_sets[i])
            return false;
    }
    return true;
}

bool movers_init(struct movers *m, const struct movers_desc *desc)
{
    *m = (struct movers){.gpu = desc->gpu, .scene = desc->scene, .width = desc->width, .height = desc->height};
    m->sampler = gpu_sampler_create_plain(m->gpu);
    return m->sampler && list_items(m) && create_list(m, desc) && create_mark(m, desc) &&
           (!desc->join || create_join(m, desc));
}

void movers_finish(struct movers *m)
{
    if (!m->gpu)
        return;
    gpu_set_free(m->gpu, m->list_set);
    gpu_set_free(m->gpu, m->mark_set);
    gpu_set_free(m->gpu, m->join_sets[0]);
    gpu_set_free(m->gpu, m->join_sets[1]);
    gpu_kernel_destroy(m->gpu, &m->lister);
    gpu_kernel_destroy(m->gpu, &m->mark);
    gpu_kernel_destroy(m->gpu, &m->join);
    gpu_buffer_destroy(m->gpu, &m->items);
    gpu_buffer_destroy(m->gpu, &m->list);
    gpu_buffer_destroy(m->gpu, &m->rectangles);
    vkDestroySampler(m->gpu->device, m->sampler, NULL);
    *m = (struct movers){0};
}

void movers_mark(const struct movers *m, VkCommandBuffer cmd, const struct gpu_image *redraw_map, uint32_t turn)
{
    const VkImageSubresourceRange all = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 2};
    const struct mark_push push = {m->item_count, turn, MOVERS_PERIOD, m->scene->motion_count};
    const uint32_t empty[SHARED_TILES_FIRST] = {0, 1, 1, 0};
    const VkPipelineStageFlags2 compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
    vkCmdClearColorImage(cmd, redraw_map->image, VK_IMAGE_LAYOUT_GENERAL, &(VkClearColorValue){.uint32 = {0}},
                         1, &all);
    vkCmdUpdateBuffer(cmd, m->list.buffer, 0, sizeof empty, empty);
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, compute);
    gpu_dispatch(cmd, &m->lister, m->list_set, &push, sizeof push,
                 (m->item_count + SHARED_CULL_GROUP - 1) / SHARED_CULL_GROUP, 2, 1);
    gpu_barrier(cmd, compute, compute | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT);
    gpu_dispatch_indirect(cmd, &m->mark, m->mark_set, &push, sizeof push, &m->list);
    gpu_barrier(cmd, compute, compute);
}

void movers_join(const struct movers *m, VkCommandBuffer cmd, uint32_t source)
{
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
    gpu_dispatch(cmd, &m->join, m->join_sets[source], NULL, 0, (m->width + SHARED_TILE - 1) / SHARED_TILE,
                 (m->height + SHARED_TILE - 1) / SHARED_TILE, 2);
}
