#include "renderer/passes/reproject/reproject.h"

#include "renderer/shared/shared.h"

#include "point.frag.h"
#include "point.vert.h"
#include "resolve.comp.h"
#include "resolve.comp_points.h"
#include "splat.comp.h"

#include <math.h>
#include <string.h>

enum { FRAME, MOTIONS, POSITION, KEYS, SPLAT_BINDINGS };

// One layout for the kernel and, in the vertex shader, the points.
static const struct gpu_binding splat_bindings[SPLAT_BINDINGS] = {
    {.type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}, // frame
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // motions
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},  // position, read
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // keys, for the kernel
};

enum { SOURCE = 7, DEPTH, RESOLVE_BINDINGS };

static const struct gpu_binding resolve_bindings[RESOLVE_BINDINGS] = {
    {.type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},         // frame
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},         // motions
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},          // position, read
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},         // keys, of the kernel
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},          // colour, read
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},          // position, written
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},          // colour, written
    {.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, // source, of the points
    {.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, // depth, of the points
};

struct push {
    float drop_cosine; // above 1: none are dropped
    uint32_t drop_moving, eye;
};

static const VkFormat source_format = VK_FORMAT_R32_UINT;

static bool create_points(struct reproject *r)
{
    struct gpu_image_desc image = {.name = "point sources",
                                   .format = source_format,
                                   .width = r->width,
                                   .height = r->height,
                                   .layers = 2,
                                   .array = true,
                                   .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT};
    struct gpu_binding bindings[SPLAT_BINDINGS];
    memcpy(bindings, splat_bindings, sizeof bindings);
    for (uint32_t i = 0; i < SPLAT_BINDINGS; i++)
        bindings[i].stages = VK_SHADER_STAGE_VERTEX_BIT;
    bindings[KEYS].absent = true;
    r->point_set_layout = gpu_set_layout_create(r->gpu, bindings, countof(bindings));
    if (!r->point_set_layout || !gpu_image_create(r->gpu, &image, &r->source))
        return false;
    image.name = "point depths";
    image.format = VK_FORMAT_D32_SFLOAT;
    image.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    const VkPipelineLayoutCreateInfo layout = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .setLayoutCount = 1,
        .pSetLayouts = &r->point_set_layout,
        .pushConstantRangeCount = 1,
        .pPushConstantRanges = &(VkPushConstantRange){VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(struct push)},
    };
    if (!gpu_image_create(r->gpu, &image, &r->depth) ||
        !VK(r->gpu, vkCreatePipelineLayout(r->gpu->device, &layout, NULL, &r->point_layout)))
        return false;
    r->points = gpu_raster_create(r->gpu, &(struct gpu_raster_desc){.name = "points",
                                                                    .vertex = {point_vert, sizeof point_vert},
                                                                    .fragment = {point_frag, sizeof point_frag},
                                                                    .layout = r->point_layout,
                                                                    .points = true,
                                                                    .colour_formats = &source_format,
                                                                    .colour_count = 1,
                                                                    .depth_format = VK_FORMAT_D32_SFLOAT,
                                                                    .depth_compare = VK_COMPARE_OP_GREATER});
    return r->points;
}

static bool create_atomic(struct reproject *r)
{
    const struct gpu_kernel_desc splat = {.name = "splat",
                                          .code = {splat_comp, sizeof splat_comp},
                                          .bindings = splat_bindings,
                                          .binding_count = countof(splat_bindings),
                                          .push_bytes = sizeof(struct push)};
    return gpu_buffer_create(r->gpu, "splat keys", 2ull * r->width * r->height * sizeof(uint64_t),
                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, GPU_DEVICE,
                             &r->keys) &&
           gpu_kernel_create(r->gpu, &splat, &r->splat);
}

static bool create_sets(struct reproject *r, const struct reproject_desc *desc,
                        const struct gpu_binding *resolve)
{
    struct gpu_binding splat[SPLAT_BINDINGS];
    memcpy(splat, splat_bindings, sizeof splat);
    splat[KEYS].absent = desc->points;
    for (uint32_t from = 0; from < 2; from++) {
        const struct gpu_resource resources[] = {
            {.buffer = desc->frame},
            {.buffer = desc->motions},
            {.view = desc->position[from]},
            {.buffer = &r->keys},
            {.view = desc->colour[from]},
            {.view = desc->position[1 - from]},
            {.view = desc->colour[1 - from]},
            {.view = r->source.view, .sampler = r->sampler, .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL},
            {.view = r->depth.view, .sampler = r->sampler, .layout = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL},
        };
        r->splat_sets[from] = gpu_set_create(r->gpu, desc->points ? r->point_set_layout : r->splat.set_layout,
                                             splat, resources, SPLAT_BINDINGS);
        r->resolve_sets[from] =
            gpu_set_create(r->gpu, r->resolve.set_layout, resolve, resources, RESOLVE_BINDINGS);
        if (!r->splat_sets[from] || !r->resolve_sets[from])
            return false;
    }
    return true;
}

bool reproject_init(struct reproject *r, const struct reproject_desc *desc)
{
    *r = (struct reproject){.gpu = desc->gpu, .width = desc->width, .height = desc->height};
    struct gpu_binding bindings[RESOLVE_BINDINGS];
    memcpy(bindings, resolve_bindings, sizeof bindings);
    bindings[KEYS].absent = desc->points;
    bindings[SOURCE].absent = bindings[DEPTH].absent = !desc->points;
    const struct gpu_kernel_desc resolve = {
        .name = "resolve",
        .code = desc->points ? (struct gpu_code){resolve_comp_points, sizeof resolve_comp_points}
                             : (struct gpu_code){resolve_comp, sizeof resolve_comp},
        .bindings = bindings,
        .binding_count = countof(bindings)};
    r->sampler = gpu_sampler_create_plain(r->gpu);
    return r->sampler && (desc->points ? create_points(r) : create_atomic(r)) &&
           gpu_kernel_create(r->gpu, &resolve, &r->resolve) && create_sets(r, desc, bindings);
}

void reproject_finish(struct reproject *r)
{
    if (!r->gpu)
        return;
    for (uint32_t i = 0; i < 2; i++) {
        gpu_set_free(r->gpu, r->splat_sets[i]);
        gpu_set_free(r->gpu, r->resolve_sets[i]);
    }
    gpu_kernel_destroy(r->gpu, &r->splat);
    gpu_kernel_destroy(r->gpu, &r->resolve);
    gpu_buffer_destroy(r->gpu, &r->keys);
    vkDestroyPipeline(r->gpu->device, r->points, NULL);
    vkDestroyPipelineLayout(r->gpu->device, r->point_layout, NULL);
    vkDestroyDescriptorSetLayout(r->gpu->device, r->point_set_layout, NULL);
    gpu_image_destroy(r->gpu, &r->source);
    gpu_image_destroy(r->gpu, &r->depth);
    vkDestroySampler(r->gpu->device, r->sampler, NULL);
    *r = (struct reproject){0};
}

uint64_t reproject_memory(const struct reproject *r)
{
    return r->points ? r->source.bytes + r->depth.bytes : r->keys.size;
}

static void draw_points(const struct reproject *r, VkCommandBuffer cmd, uint32_t from, struct push push)
{
    const VkRect2D area = {.extent = {r->width, r->height}};
    gpu_image_layout(cmd, &r->source, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    gpu_image_layout(cmd, &r->depth, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
    for (push.eye = 0; push.eye < 2; push.eye++) {
        const VkRenderingAttachmentInfo colour = {.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                                  .imageView = r->source.layer_views[push.eye],
                                                  .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                                  .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                                  .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
        VkRenderingAttachmentInfo depth = colour;
        depth.imageView = r->depth.layer_views[push.eye];
        depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
        const VkRenderingInfo info = {.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                      .renderArea = area,
                                      .layerCount = 1,
                                      .colorAttachmentCount = 1,
                                      .pColorAttachments = &colour,
                                      .pDepthAttachment = &depth};
        vkCmdBeginRendering(cmd, &info);
        vkCmdSetViewport(cmd, 0, 1, &(VkViewport){0, 0, (float)r->width, (float)r->height, 0, 1});
        vkCmdSetScissor(cmd, 0, 1, &area);
        vkCmdSetCullMode(cmd, VK_CULL_MODE_NONE);
        vkCmdSetFrontFace(cmd, VK_FRONT_FACE_COUNTER_CLOCKWISE);
        vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, r->points);
        vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, r->point_layout, 0, 1,
                                &r->splat_sets[from], 0, NULL);
        vkCmdPushConstants(cmd, r->point_layout, VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof push, &push);
        vkCmdDraw(cmd, r->width * r->height, 1, 0, 0);
        vkCmdEndRendering(cmd);
    }
    gpu_image_layout(cmd, &r->source, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                     VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    gpu_image_layout(cmd, &r->depth, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                     VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL);
}

void reproject_record(const struct reproject *r, VkCommandBuffer cmd, uint32_t from, float drop_deg,
                      bool drop_moving)
{
    const VkPipelineStageFlags2 compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    const uint32_t x = (r->width + SHARED_TILE - 1) / SHARED_TILE,
                   y = (r->height + SHARED_TILE - 1) / SHARED_TILE;
    const struct push push = {drop_deg > 0 ? (float)cos((double)drop_deg * 0.017453292519943295) : 2,
                              drop_moving, 0};
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
    if (r->points) {
        draw_points(r, cmd, from, push);
    } else {
        vkCmdFillBuffer(cmd, r->keys.buffer, 0, VK_WHOLE_SIZE, 0);
        // whether a fill is a clear or a copy is read both ways; all transfers cover it
        gpu_barrier(cmd, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, compute);
        gpu_dispatch(cmd, &r->splat, r->splat_sets[from], &push, sizeof push, x, y, 2);
        gpu_barrier(cmd, compute, compute);
    }
    gpu_dispatch(cmd, &r->resolve, r->resolve_sets[from], NULL, 0, x, y, 2);
    gpu_barrier(cmd, compute, compute);
}
