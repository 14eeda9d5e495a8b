#include "renderer/passes/redraw/redraw.h"

#include "coarse.comp.h"
#include "count.comp.h"

enum { COARSE_GROUP = 64 };

static const struct gpu_binding count_bindings[] = {
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},  // redraw map
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // pyramid
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // tiles
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // counters
};

static const struct gpu_binding coarse_bindings[] = {
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // pyramid
};

struct push {
    uint32_t tiles_x, tiles_y, levels, last;
};

static uint32_t power_of_two(uint32_t least)
{
    uint32_t p = 1;
    while (p < least)
        p *= 2;
    return p;
}

// Texels of both eyes in all levels; *out_coarse: without the finest.
static uint32_t texels(const struct redraw *r, uint32_t *out_coarse)
{
    uint32_t sum = 0;
    for (uint32_t level = 0; level < r->levels; level++) {
        const uint32_t x = r->tiles_x >> level, y = r->tiles_y >> level;
        sum += 2 * (x ? x : 1) * (y ? y : 1);
    }
    *out_coarse = sum - 2 * r->tiles_x * r->tiles_y;
    return sum;
}

bool redraw_init(struct redraw *r, const struct redraw_desc *desc)
{
    *r = (struct redraw){.gpu = desc->gpu, .width = desc->width, .height = desc->height, .levels = 1};
    r->tiles_x = power_of_two((r->width + SHARED_TILE - 1) / SHARED_TILE);
    r->tiles_y = power_of_two((r->height + SHARED_TILE - 1) / SHARED_TILE);
    for (uint32_t side = r->tiles_x > r->tiles_y ? r->tiles_x : r->tiles_y; side > 1; side /= 2)
        r->levels++;
    uint32_t coarse;
    const VkDeviceSize word = sizeof(uint32_t), list = SHARED_TILES_FIRST + 2ull * r->tiles_x * r->tiles_y;
    const VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    const struct gpu_kernel_desc count = {.name = "redraw count",
                                          .code = {count_comp, sizeof count_comp},
                                          .bindings = count_bindings,
                                          .binding_count = countof(count_bindings),
                                          .push_bytes = sizeof(struct push)};
    const struct gpu_kernel_desc coarse_desc = {.name = "redraw pyramid",
                                                .code = {coarse_comp, sizeof coarse_comp},
                                                .bindings = coarse_bindings,
                                                .binding_count = countof(coarse_bindings),
                                                .push_bytes = sizeof(struct push)};
    if (!gpu_buffer_create(r->gpu, "redraw pyramid", texels(r, &coarse) * word, storage, GPU_DEVICE,
                           &r->pyramid) ||
        !gpu_buffer_create(r->gpu, "redraw tiles", list * word,
                           storage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                           GPU_DEVICE, &r->tiles) ||
        !gpu_kernel_create(r->gpu, &count, &r->count) || !gpu_kernel_create(r->gpu, &coarse_desc, &r->coarse))
        return false;
    const struct gpu_resource count_resources[] = {
        {.view = desc->redraw_map}, {.buffer = &r->pyramid}, {.buffer = &r->tiles}, {.buffer = desc->counters}};
    const struct gpu_resource coarse_resources[] = {{.buffer = &r->pyramid}};
    r->count_set =
        gpu_set_create(r->gpu, r->count.set_layout, count_bindings, count_resources, countof(count_resources));
    r->coarse_set = gpu_set_create(r->gpu, r->coarse.set_layout, coarse_bindings, coarse_resources,
                                   countof(coarse_resources));
    return r->count_set && r->coarse_set;
}

void redraw_finish(struct redraw *r)
{
    if (!r->gpu)
        return;
    gpu_set_free(r->gpu, r->count_set);
    gpu_set_free(r->gpu, r->coarse_set);
    gpu_kernel_destroy(r->gpu, &r->count);
    gpu_kernel_destroy(r->gpu, &r->coarse);
    gpu_buffer_destroy(r->gpu, &r->pyramid);
    gpu_buffer_destroy(r->gpu, &r->tiles);
    *r = (struct redraw){0};
}

uint64_t redraw_memory(const struct redraw *r)
{
    return r->pyramid.size + r->tiles.size;
}

void redraw_record(const struct redraw *r, VkCommandBuffer cmd, bool last)
{
    const VkPipelineStageFlags2 compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    const struct push push = {r->tiles_x, r->tiles_y, r->levels, last};
    const uint32_t empty[SHARED_TILES_FIRST] = {0, 1, 1, 0};
    uint32_t coarse;
    texels(r, &coarse);
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
    vkCmdUpdateBuffer(cmd, r->tiles.buffer, 0, sizeof empty, empty);
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, compute);
    gpu_dispatch(cmd, &r->count, r->count_set, &push, sizeof push, (r->tiles_x + SHARED_TILE - 1) / SHARED_TILE,
                 (r->tiles_y + SHARED_TILE - 1) / SHARED_TILE, 2);
    gpu_barrier(cmd, compute, compute);
    gpu_dispatch(cmd, &r->coarse, r->coarse_set, &push, sizeof push, (coarse + COARSE_GROUP - 1) / COARSE_GROUP,
                 1, 1);
    gpu_barrier(cmd, compute, compute | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT);
}
