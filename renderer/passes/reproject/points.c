#include "renderer/passes/reproject/points.h"

#include "point.frag.h"
#include "point.vert.h"

#include <string.h>

static const VkFormat source_format = VK_FORMAT_R32_UINT;

bool points_create(struct reproject *r, const struct gpu_binding *kernel_bindings, uint32_t count,
                   int32_t has_motion)
{
    struct gpu_image_desc image = {.name = "point sources",
                                   .format = source_format,
                                   .width = r->width,
                                   .height = r->height,
                                   .layers = 2,
                                   .array = true,
                                   .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT};
    struct gpu_binding bindings[GPU_BINDINGS];
    memcpy(bindings, kernel_bindings, count * sizeof *bindings);
    for (uint32_t i = 0; i < count; i++)
        bindings[i].stages = VK_SHADER_STAGE_VERTEX_BIT;
    r->point_set_layout = gpu_set_layout_create(r->gpu, bindings, count);
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
        .pPushConstantRanges =
            &(VkPushConstantRange){VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(struct reproject_push)},
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
                                                                    .depth_compare = VK_COMPARE_OP_GREATER,
                                                                    .constants = &has_motion,
                                                                    .constant_count = 1});
    return r->points;
}

void points_destroy(struct reproject *r)
{
    vkDestroyPipeline(r->gpu->device, r->points, NULL);
    vkDestroyPipelineLayout(r->gpu->device, r->point_layout, NULL);
    vkDestroyDescriptorSetLayout(r->gpu->device, r->point_set_layout, NULL);
    gpu_image_destroy(r->gpu, &r->source);
    gpu_image_destroy(r->gpu, &r->depth);
}

void points_draw(const struct reproject *r, VkCommandBuffer cmd, uint32_t from, struct reproject_push push)
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
                                &r->point_sets[from], 0, NULL);
        vkCmdPushConstants(cmd, r->point_layout, VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof push, &push);
        vkCmdDraw(cmd, r->width * r->height, 1, 0, 0);
        vkCmdEndRendering(cmd);
    }
    gpu_image_layout(cmd, &r->source, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                     VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    gpu_image_layout(cmd, &r->depth, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                     VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL);
}
