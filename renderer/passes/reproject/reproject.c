#include "renderer/passes/reproject/reproject.h"

#include "renderer/passes/reproject/points.h"
#include "renderer/shared/shared.h"

#include "candidates.comp.h"
#include "ranges.comp.h"
#include "ranges.comp_points.h"
#include "resolve.comp.h"
#include "resolve.comp_points.h"
#include "show_through.comp.h"
#include "show_through.comp_points.h"
#include "splat.comp.h"

#include <math.h>
#include <string.h>

enum { KEYS = 3, SPLAT_BINDINGS, SOURCE = 7, DEPTH, BINDINGS = 12 };

// One numbering for all kernels and, up to SPLAT_BINDINGS, the points' vertex shader.
static const struct gpu_binding all_bindings[BINDINGS] = {
    {.type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},         // frame
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},         // motions
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},          // position, read
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},         // keys, of the splat
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},          // colour, read
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},          // position, written
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},          // colour, written
    {.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, // source, of the points
    {.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, // depth, of the points
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},         // ranges
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},         // tiles where something may show through
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},         // holes
};

#define CODE(words) ((struct gpu_code){words, sizeof words})

static uint32_t tile_count(const struct reproject *r)
{
    return 2 * ((r->width + SHARED_TILE - 1) / SHARED_TILE) * ((r->height + SHARED_TILE - 1) / SHARED_TILE);
}

static bool create_buffers(struct reproject *r, bool points)
{
    const VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    const VkDeviceSize list = (SHARED_TILES_FIRST + tile_count(r)) * sizeof(uint32_t),
                       pixels = 2ull * r->width * r->height;
    return (points || gpu_buffer_create(r->gpu, "splat keys", pixels * sizeof(uint64_t), storage, GPU_DEVICE,
                                        &r->keys)) &&
           gpu_buffer_create(r->gpu, "depth ranges of tiles", 2ull * tile_count(r) * sizeof(uint32_t), storage,
                             GPU_DEVICE, &r->ranges) &&
           gpu_buffer_create(r->gpu, "tiles of near points", list,
                             storage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT, GPU_DEVICE, &r->near_tiles) &&
           gpu_buffer_create(r->gpu, "holes", (SHARED_TILES_FIRST + pixels) * sizeof(uint32_t),
                             storage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT, GPU_DEVICE, &r->holes);
}

static bool create_kernels(struct reproject *r, const struct gpu_binding *bindings, bool points,
                           int32_t has_motion)
{
    const struct {
        const char *name;
        struct gpu_code code;
        struct gpu_kernel *kernel;
    } list[] = {
        {"splat", CODE(splat_comp), &r->splat},
        {"resolve", points ? CODE(resolve_comp_points) : CODE(resolve_comp), &r->resolve},
        {"depth ranges", points ? CODE(ranges_comp_points) : CODE(ranges_comp), &r->measure},
        {"show-through candidates", CODE(candidates_comp), &r->candidates},
        {"show-through", points ? CODE(show_through_comp_points) : CODE(show_through_comp), &r->show_through},
    };
    for (size_t i = 0; i < countof(list); i++) {
        const struct gpu_kernel_desc desc = {.name = list[i].name,
                                             .code = list[i].code,
                                             .bindings = bindings,
                                             .binding_count = BINDINGS,
                                             .push_bytes = i == 0 ? sizeof(struct reproject_push) : 0,
                                             .constants = &has_motion,
                                             .constant_count = 1};
        if (!(points && i == 0) && !gpu_kernel_create(r->gpu, &desc, list[i].kernel))
            return false;
    }
    return true;
}

static bool create_sets(struct reproject *r, const struct reproject_desc *desc,
                        const struct gpu_binding *bindings)
{
    for (uint32_t from = 0; from < 2; from++) {
        const struct gpu_resource resources[BINDINGS] = {
            {.buffer = desc->frame},
            {.buffer = desc->motions},
            {.view = desc->position[from]},
            {.buffer = &r->keys},
            {.view = desc->colour[from]},
            {.view = desc->position[1 - from]},
            {.view = desc->colour[1 - from]},
            {.view = r->source.view, .sampler = r->sampler, .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL},
            {.view = r->depth.view, .sampler = r->sampler, .layout = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL},
            {.buffer = &r->ranges},
            {.buffer = &r->near_tiles},
            {.buffer = &r->holes},
        };
        r->sets[from] = gpu_set_create(r->gpu, r->resolve.set_layout, bindings, resources, BINDINGS);
        if (desc->points)
            r->point_sets[from] =
                gpu_set_create(r->gpu, r->point_set_layout, bindings, resources, SPLAT_BINDINGS);
        if (!r->sets[from] || (desc->points && !r->point_sets[from]))
            return false;
    }
    return true;
}

bool reproject_init(struct reproject *r, const struct reproject_desc *desc)
{
    *r = (struct reproject){.gpu = desc->gpu, .width = desc->width, .height = desc->height};
    struct gpu_binding bindings[BINDINGS];
    memcpy(bindings, all_bindings, sizeof bindings);
    bindings[KEYS].absent = desc->points;
    bindings[SOURCE].absent = bindings[DEPTH].absent = !desc->points;
    r->sampler = gpu_sampler_create_plain(r->gpu);
    return r->sampler && create_buffers(r, desc->points) &&
           (!desc->points || points_create(r, bindings, SPLAT_BINDINGS, !desc->still)) &&
           create_kernels(r, bindings, desc->points, !desc->still) && create_sets(r, desc, bindings);
}

void reproject_finish(struct reproject *r)
{
    if (!r->gpu)
        return;
    for (uint32_t i = 0; i < 2; i++) {
        gpu_set_free(r->gpu, r->sets[i]);
        gpu_set_free(r->gpu, r->point_sets[i]);
    }
    struct gpu_kernel *kernels[] = {&r->splat, &r->resolve, &r->measure, &r->candidates, &r->show_through};
    for (size_t i = 0; i < countof(kernels); i++)
        gpu_kernel_destroy(r->gpu, kernels[i]);
    struct gpu_buffer *buffers[] = {&r->keys, &r->ranges, &r->near_tiles, &r->holes};
    for (size_t i = 0; i < countof(buffers); i++)
        gpu_buffer_destroy(r->gpu, buffers[i]);
    points_destroy(r);
    vkDestroySampler(r->gpu->device, r->sampler, NULL);
    *r = (struct reproject){0};
}

uint64_t reproject_memory(const struct reproject *r)
{
    return r->source.bytes + r->depth.bytes + r->keys.size + r->ranges.size + r->near_tiles.size +
           r->holes.size;
}

static void record_show_through(const struct reproject *r, VkCommandBuffer cmd, VkDescriptorSet set)
{
    const VkPipelineStageFlags2 compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    const uint32_t group = SHARED_TILE * SHARED_TILE; // pixels a side of a work group of tiles
    const uint32_t x = (r->width + group - 1) / group, y = (r->height + group - 1) / group;
    gpu_dispatch(cmd, &r->measure, set, NULL, 0, x, y, 2);
    gpu_barrier(cmd, compute, compute);
    gpu_dispatch(cmd, &r->candidates, set, NULL, 0, x, y, 2);
    gpu_barrier(cmd, compute, compute | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT);
    gpu_dispatch_indirect(cmd, &r->show_through, set, NULL, 0, &r->near_tiles);
}

void reproject_record(const struct reproject *r, VkCommandBuffer cmd, uint32_t from, float drop_deg,
                      bool drop_moving)
{
    const VkPipelineStageFlags2 compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    const uint32_t x = (r->width + SHARED_TILE - 1) / SHARED_TILE,
                   y = (r->height + SHARED_TILE - 1) / SHARED_TILE;
    const double rad_per_deg = 0.017453292519943295;
    const struct reproject_push push = {drop_deg > 0 ? (float)cos((double)drop_deg * rad_per_deg) : 2,
                                        drop_moving, 0};
    const uint32_t empty[SHARED_TILES_FIRST] = {0, 1, 1, 0};
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
    vkCmdUpdateBuffer(cmd, r->near_tiles.buffer, 0, sizeof empty, empty);
    vkCmdUpdateBuffer(cmd, r->holes.buffer, 0, sizeof empty, empty);
    if (!r->points)
        vkCmdFillBuffer(cmd, r->keys.buffer, 0, VK_WHOLE_SIZE, 0);
    // whether a fill is a clear or a copy is read both ways; all transfers cover it
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, compute);
    if (r->points)
        points_draw(r, cmd, from, push);
    else
        gpu_dispatch(cmd, &r->splat, r->sets[from], &push, sizeof push, x, y, 2);
    gpu_barrier(cmd, compute, compute);
    gpu_dispatch(cmd, &r->resolve, r->sets[from], NULL, 0, x, y, 2);
    gpu_barrier(cmd, compute, compute);
    record_show_through(r, cmd, r->sets[from]);
    gpu_barrier(cmd, compute, compute);
}
