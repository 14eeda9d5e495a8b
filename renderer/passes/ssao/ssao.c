#include "renderer/passes/ssao/ssao.h"

#include "renderer/shared/shared.h"

#include "blur.comp.h"
#include "blur.comp_redraw.h"
#include "distance.comp.h"
#include "distance.comp_redraw.h"
#include "occlusion.comp.h"
#include "occlusion.comp_redraw.h"
#include "tiles.comp.h"

enum { LIST_GROUP = 64 };

#define BUFFER VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
#define UNIFORM VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER
#define IMAGE VK_DESCRIPTOR_TYPE_STORAGE_IMAGE
#define SAMPLED VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER

struct list_push {
    uint32_t tiles_x, tiles_y, half_x, half_y;
};

static bool listed(const struct ssao *s)
{
    return s->tiles.buffer;
}

static bool create_images(struct ssao *s)
{
    const VkImageUsageFlags usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    struct gpu_image_desc image = {.name = "half-resolution distances",
                                   .format = VK_FORMAT_R32_SFLOAT,
                                   .width = s->width,
                                   .height = s->height,
                                   .layers = 2,
                                   .array = true,
                                   .usage = usage};
    if (!gpu_image_create(s->gpu, &image, &s->distance))
        return false;
    image.format = VK_FORMAT_R8_UNORM;
    image.name = "occlusion";
    if (!gpu_image_create(s->gpu, &image, &s->occlusion))
        return false;
    image.name = "blurred occlusion";
    return gpu_image_create(s->gpu, &image, &s->shown);
}

// One kernel and its descriptor set.
static bool create_kernel(struct ssao *s, const char *name, struct gpu_code code,
                          const struct gpu_binding *bindings, const struct gpu_resource *resources,
                          uint32_t count, struct gpu_kernel *out, VkDescriptorSet *out_set)
{
    const struct gpu_kernel_desc desc = {.name = name,
                                         .code = code,
                                         .bindings = bindings,
                                         .binding_count = count,
                                         .push_bytes = out == &s->list ? sizeof(struct list_push) : 0};
    if (!gpu_kernel_create(s->gpu, &desc, out))
        return false;
    *out_set = gpu_set_create(s->gpu, out->set_layout, bindings, resources, count);
    return *out_set;
}

static bool create_distances(struct ssao *s, const struct ssao_desc *desc)
{
    const bool redraw = listed(s);
    const struct gpu_binding bindings[] = {{.type = UNIFORM},
                                           {.type = IMAGE},
                                           {.type = IMAGE, .absent = !redraw},
                                           {.type = SAMPLED},
                                           {.type = IMAGE, .absent = !redraw}};
    const struct gpu_code code = redraw ? (struct gpu_code){distance_comp_redraw, sizeof distance_comp_redraw}
                                        : (struct gpu_code){distance_comp, sizeof distance_comp};
    struct gpu_resource resources[] = {
        {.buffer = desc->frame},
        {.view = s->distance.view},
        {.view = desc->position[0]},
        {.view = desc->depth, .sampler = s->sampler, .layout = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL},
        {.view = desc->redraw_map}};
    if (!create_kernel(s, "half-resolution distances", code, bindings, resources, countof(bindings),
                       &s->distances, &s->distance_sets[0]))
        return false;
    if (!redraw)
        return true;
    resources[2].view = desc->position[1];
    s->distance_sets[1] =
        gpu_set_create(s->gpu, s->distances.set_layout, bindings, resources, countof(bindings));
    return s->distance_sets[1];
}

static bool create_list(struct ssao *s, const struct ssao_desc *desc)
{
    const struct gpu_binding bindings[] = {{.type = BUFFER}, {.type = BUFFER}};
    const struct gpu_resource resources[] = {{.buffer = desc->pyramid}, {.buffer = &s->tiles}};
    return create_kernel(s, "occlusion tiles", (struct gpu_code){tiles_comp, sizeof tiles_comp}, bindings,
                         resources, countof(bindings), &s->list, &s->list_set);
}

static bool create_occlusion(struct ssao *s, const struct ssao_desc *desc)
{
    const bool redraw = listed(s);
    const struct gpu_binding bindings[] = {{.type = UNIFORM},
                                           {.type = SAMPLED},
                                           {.type = IMAGE},
                                           {.type = IMAGE},
                                           {.type = BUFFER, .absent = !redraw}};
    const struct gpu_resource resources[] = {{.buffer = desc->frame},
                                             {.view = s->distance.view, .sampler = s->sampler},
                                             {.view = s->occlusion.view},
                                             {.view = s->shown.view},
                                             {.buffer = &s->tiles}};
    const struct gpu_code occlude = redraw
                                        ? (struct gpu_code){occlusion_comp_redraw, sizeof occlusion_comp_redraw}
                                        : (struct gpu_code){occlusion_comp, sizeof occlusion_comp};
    const struct gpu_code blur = redraw ? (struct gpu_code){blur_comp_redraw, sizeof blur_comp_redraw}
                                        : (struct gpu_code){blur_comp, sizeof blur_comp};
    return create_kernel(s, "occlusion", occlude, bindings, resources, countof(bindings), &s->occlude,
                         &s->occlude_set) &&
           create_kernel(s, "occlusion blur", blur, bindings, resources, countof(bindings), &s->blur,
                         &s->blur_set);
}

bool ssao_init(struct ssao *s, const struct ssao_desc *desc)
{
    *s = (struct ssao){.gpu = desc->gpu,
                       .width = (desc->width + 1) / 2,
                       .height = (desc->height + 1) / 2,
                       .tiles_x = desc->tiles_x,
                       .tiles_y = desc->tiles_y};
    const uint64_t most =
        2ull * ((s->width + SHARED_TILE - 1) / SHARED_TILE) * ((s->height + SHARED_TILE - 1) / SHARED_TILE);
    s->sampler = gpu_sampler_create_plain(s->gpu);
    if (!s->sampler || !create_images(s))
        return false;
    if (desc->pyramid &&
        (!gpu_buffer_create(s->gpu, "occlusion tiles", (SHARED_TILES_FIRST + most) * sizeof(uint32_t),
                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT |
                                VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                            GPU_DEVICE, &s->tiles) ||
         !create_list(s, desc)))
        return false;
    return create_distances(s, desc) && create_occlusion(s, desc);
}

void ssao_finish(struct ssao *s)
{
    if (!s->gpu)
        return;
    VkDescriptorSet sets[] = {s->distance_sets[0], s->distance_sets[1], s->list_set, s->occlude_set,
                              s->blur_set};
    for (size_t i = 0; i < countof(sets); i++)
        gpu_set_free(s->gpu, sets[i]);
    struct gpu_kernel *kernels[] = {&s->distances, &s->list, &s->occlude, &s->blur};
    for (size_t i = 0; i < countof(kernels); i++)
        gpu_kernel_destroy(s->gpu, kernels[i]);
    gpu_image_destroy(s->gpu, &s->distance);
    gpu_image_destroy(s->gpu, &s->occlusion);
    gpu_image_destroy(s->gpu, &s->shown);
    gpu_buffer_destroy(s->gpu, &s->tiles);
    vkDestroySampler(s->gpu->device, s->sampler, NULL);
    *s = (struct ssao){0};
}

uint64_t ssao_memory(const struct ssao *s)
{
    return s->distance.bytes + s->occlusion.bytes + s->shown.bytes + s->tiles.size;
}

static void record_list(const struct ssao *s, VkCommandBuffer cmd)
{
    const uint32_t x = (s->width + SHARED_TILE - 1) / SHARED_TILE,
                   y = (s->height + SHARED_TILE - 1) / SHARED_TILE;
    const struct list_push push = {s->tiles_x, s->tiles_y, x, y};
    const uint32_t empty[SHARED_TILES_FIRST] = {0, 1, 1, 0};
    vkCmdUpdateBuffer(cmd, s->tiles.buffer, 0, sizeof empty, empty);
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
    gpu_dispatch(cmd, &s->list, s->list_set, &push, sizeof push, (2 * x * y + LIST_GROUP - 1) / LIST_GROUP, 1,
                 1);
}

static void record_kernel(const struct ssao *s, VkCommandBuffer cmd, const struct gpu_kernel *kernel,
                          VkDescriptorSet set)
{
    if (listed(s))
        gpu_dispatch_indirect(cmd, kernel, set, NULL, 0, &s->tiles);
    else
        gpu_dispatch(cmd, kernel, set, NULL, 0, (s->width + SHARED_TILE - 1) / SHARED_TILE,
                     (s->height + SHARED_TILE - 1) / SHARED_TILE, 2);
}

void ssao_record(const struct ssao *s, VkCommandBuffer cmd, uint32_t source)
{
    const VkPipelineStageFlags2 compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    const struct gpu_image *images[] = {&s->distance, &s->occlusion, &s->shown};
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
    for (size_t i = 0; i < countof(images); i++)
        gpu_image_layout(cmd, images[i], VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    if (listed(s))
        record_list(s, cmd);
    gpu_dispatch(cmd, &s->distances, s->distance_sets[source], NULL, 0,
                 (s->width + SHARED_TILE - 1) / SHARED_TILE, (s->height + SHARED_TILE - 1) / SHARED_TILE, 2);
    gpu_barrier(cmd, compute, compute | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT);
    record_kernel(s, cmd, &s->occlude, s->occlude_set);
    gpu_barrier(cmd, compute, compute);
    record_kernel(s, cmd, &s->blur, s->blur_set);
    gpu_barrier(cmd, compute, compute);
}
