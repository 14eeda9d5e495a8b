#include "renderer/passes/gbuffer/gbuffer.h"

#include "gbuffer.frag.h"
#include "gbuffer.frag_depth.h"
#include "gbuffer.frag_depth_id.h"
#include "gbuffer.frag_emissive.h"
#include "gbuffer.frag_emissive_id.h"
#include "gbuffer.frag_id.h"
#include "gbuffer.vert.h"
#include "gbuffer.vert_instanced.h"
#include "gbuffer.vert_multiview.h"
#include "mask.frag.h"
#include "mask.frag_kept.h"
#include "mask.vert.h"

#include <stddef.h>

static const VkFormat colour_formats[] = {VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_R32_UINT, VK_FORMAT_R8G8_UNORM,
                                          VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R16_UINT};
enum { TARGETS = countof(colour_formats) };

const VkVertexInputBindingDescription gbuffer_vertex_binding = {0, sizeof(struct scene_vertex),
                                                                VK_VERTEX_INPUT_RATE_VERTEX};
const VkVertexInputAttributeDescription gbuffer_attributes[GBUFFER_ATTRIBUTES] = {
    {0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(struct scene_vertex, position)},
    {1, 0, VK_FORMAT_R16G16_SNORM, offsetof(struct scene_vertex, normal)},
    {2, 0, VK_FORMAT_R16G16B16A16_SNORM, offsetof(struct scene_vertex, tangent)},
    {3, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(struct scene_vertex, uv[0])},
    {4, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(struct scene_vertex, uv[1])},
    {5, 0, VK_FORMAT_R8G8B8A8_UNORM, offsetof(struct scene_vertex, colour)},
};

// What is built, in the order of the fragment shader's outputs, without gaps; returns how many.
static uint32_t targets(const struct gbuffer *g, const struct gpu_image *out[TARGETS])
{
    uint32_t count = 0;
    if (g->depth_only)
        return 0;
    out[count++] = &g->base;
    out[count++] = &g->normal;
    out[count++] = &g->surface;
    if (g->has_emissive)
        out[count++] = &g->emissive;
    if (g->has_id)
        out[count++] = &g->id;
    return count;
}

static bool create_targets(struct gbuffer *g)
{
    const VkImageUsageFlags colour = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    const VkImageUsageFlags depth = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    const struct {
        const char *name;
        VkFormat format;
        VkImageUsageFlags usage;
        struct gpu_image *image;
        bool wanted;
    } list[] = {
        {"g-buffer base colour", colour_formats[0], colour, &g->base, !g->depth_only},
        {"g-buffer normal", colour_formats[1], colour, &g->normal, !g->depth_only},
        {"g-buffer surface", colour_formats[2], colour, &g->surface, !g->depth_only},
        {"g-buffer emissive", colour_formats[3], colour, &g->emissive, g->has_emissive},
        {"g-buffer id", colour_formats[4], colour, &g->id, g->has_id},
        {"g-buffer depth", VK_FORMAT_D32_SFLOAT, depth, &g->depth, true},
    };
    for (size_t i = 0; i < countof(list); i++) {
        const struct gpu_image_desc desc = {.name = list[i].name,
                                            .format = list[i].format,
                                            .width = g->width,
                                            .height = g->height,
                                            .layers = 2,
                                            .array = true,
                                            .usage = list[i].usage};
        if (list[i].wanted && !gpu_image_create(g->gpu, &desc, list[i].image))
            return false;
    }
    return true;
}

static bool create_layouts(struct gbuffer *g, const struct gpu_buffer *frame)
{
    const VkShaderStageFlags both = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
    const struct gpu_binding bindings[] = {{.type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, .stages = both},
                                           {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, .stages = both},
                                           {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, .stages = both},
                                           {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, .stages = both}};
    const struct gpu_resource resources[] = {{.buffer = frame},
                                             {.buffer = &g->scene->items},
                                             {.buffer = &g->scene->objects},
                                             {.buffer = &g->scene->materials}};
    g->frame_layout = gpu_set_layout_create(g->gpu, bindings, countof(bindings));
    if (!g->frame_layout)
        return false;
    g->frame_set = gpu_set_create(g->gpu, g->frame_layout, bindings, resources, countof(resources));
    const VkPipelineLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .setLayoutCount = 2,
        .pSetLayouts = (const VkDescriptorSetLayout[]){g->frame_layout, g->scene->material_layout},
        .pushConstantRangeCount = 1,
        .pPushConstantRanges = &(VkPushConstantRange){VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(uint32_t)},
    };
    return g->frame_set && VK(g->gpu, vkCreatePipelineLayout(g->gpu->device, &info, NULL, &g->layout));
}

static struct gpu_code fragment_code(const struct gbuffer *g, uint32_t features)
{
    if (g->depth_only && g->has_id)
        return (struct gpu_code){gbuffer_frag_depth_id, sizeof gbuffer_frag_depth_id};
    if (g->depth_only)
        return features & SCENE_GPU_MASK ? (struct gpu_code){gbuffer_frag_depth, sizeof gbuffer_frag_depth}
                                         : (struct gpu_code){0};
    if (g->has_emissive)
        return g->has_id ? (struct gpu_code){gbuffer_frag_emissive_id, sizeof gbuffer_frag_emissive_id}
                         : (struct gpu_code){gbuffer_frag_emissive, sizeof gbuffer_frag_emissive};
    return g->has_id ? (struct gpu_code){gbuffer_frag_id, sizeof gbuffer_frag_id}
                     : (struct gpu_code){gbuffer_frag, sizeof gbuffer_frag};
}

static uint32_t view_mask(const struct gbuffer *g)
{
    return g->eyes == GBUFFER_MULTIVIEW ? 0x3 : 0;
}

static VkPipeline create_pipeline(const struct gbuffer *g, uint32_t features)
{
    const struct gpu_code vertex_code[] = {
        [GBUFFER_EYE_BY_EYE] = {gbuffer_vert, sizeof gbuffer_vert},
        [GBUFFER_MULTIVIEW] = {gbuffer_vert_multiview, sizeof gbuffer_vert_multiview},
        [GBUFFER_INSTANCED] = {gbuffer_vert_instanced, sizeof gbuffer_vert_instanced}};
    const struct gpu_image *images[TARGETS];
    VkFormat formats[TARGETS];
    const uint32_t count = targets(g, images);
    for (uint32_t i = 0; i < count; i++)
        formats[i] = images[i]->format;
    int32_t constants[SCENE_GPU_FEATURES];
    for (uint32_t bit = 0; bit < SCENE_GPU_FEATURES; bit++)
        constants[bit] = (int32_t)(features >> bit & 1);
    return gpu_raster_create(g->gpu, &(struct gpu_raster_desc){.name = "g-buffer",
                                                               .vertex = vertex_code[g->eyes],
                                                               .fragment = fragment_code(g, features),
                                                               .layout = g->layout,
                                                               .vertex_binding = &gbuffer_vertex_binding,
                                                               .attributes = gbuffer_attributes,
                                                               .attribute_count = GBUFFER_ATTRIBUTES,
                                                               .colour_formats = formats,
                                                               .colour_count = count,
                                                               .depth_format = VK_FORMAT_D32_SFLOAT,
                                                               .depth_compare = VK_COMPARE_OP_GREATER,
                                                               .view_mask = view_mask(g),
                                                               .constants = constants,
                                                               .constant_count = countof(constants)});
}

// One pipeline for every set of features that occurs in the scene.
static bool create_pipelines(struct gbuffer *g)
{
    for (uint32_t b = 0; b < g->scene->bucket_count; b++) {
        uint32_t features = g->scene->buckets[b].features, known = 0;
        while (known < g->pipeline_count && g->pipelines[known].features != features)
            known++;
        if (known < g->pipeline_count)
            continue;
        if (g->pipeline_count == GBUFFER_PIPELINES) {
            gpu_say(g->gpu, GPU_ERROR, "the scene's materials need more than %d pipelines", GBUFFER_PIPELINES);
            return false;
        }
        VkPipeline pipeline = create_pipeline(g, features);
        if (!pipeline)
            return false;
        g->pipelines[g->pipeline_count].features = features;
        g->pipelines[g->pipeline_count++].pipeline = pipeline;
    }
    return true;
}

static VkPipeline create_triangle(struct gbuffer *g, const char *name, struct gpu_code fragment)
{
    return gpu_raster_create(g->gpu, &(struct gpu_raster_desc){.name = name,
                                                               .vertex = {mask_vert, sizeof mask_vert},
                                                               .fragment = fragment,
                                                               .layout = g->mask_layout,
                                                               .depth_format = VK_FORMAT_D32_SFLOAT,
                                                               .depth_compare = VK_COMPARE_OP_ALWAYS});
}

static bool create_mask(struct gbuffer *g, const struct gbuffer_desc *desc)
{
    const bool keeps = desc->position[0];
    const struct gpu_binding bindings[] = {
        {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, .stages = VK_SHADER_STAGE_FRAGMENT_BIT},
        {.type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, .stages = VK_SHADER_STAGE_FRAGMENT_BIT},
        {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, .stages = VK_SHADER_STAGE_FRAGMENT_BIT, .absent = !keeps}};
    g->mask_set_layout = gpu_set_layout_create(g->gpu, bindings, countof(bindings));
    if (!g->mask_set_layout)
        return false;
    for (int i = 0; i < 2; i++) {
        const struct gpu_resource resources[] = {
            {.view = desc->redraw_map}, {.buffer = desc->frame}, {.view = desc->position[i]}};
        g->mask_sets[i] = gpu_set_create(g->gpu, g->mask_set_layout, bindings, resources, countof(resources));
        if (!g->mask_sets[i])
            return false;
    }
    const VkPipelineLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .setLayoutCount = 1,
        .pSetLayouts = &g->mask_set_layout,
        .pushConstantRangeCount = 1,
        .pPushConstantRanges = &(VkPushConstantRange){VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(uint32_t)},
    };
    if (!VK(g->gpu, vkCreatePipelineLayout(g->gpu->device, &info, NULL, &g->mask_layout)))
        return false;
    g->mask = create_triangle(g, "redraw mask", (struct gpu_code){mask_frag, sizeof mask_frag});
    if (keeps)
        g->kept = create_triangle(g, "kept depths", (struct gpu_code){mask_frag_kept, sizeof mask_frag_kept});
    return g->mask && (!keeps || g->kept);
}

bool gbuffer_init(struct gbuffer *g, const struct gbuffer_desc *desc)
{
    *g = (struct gbuffer){.gpu = desc->gpu,
                          .scene = desc->scene,
                          .width = desc->width,
                          .height = desc->height,
                          .depth_only = desc->depth_only,
                          .eyes = desc->eyes,
                          .has_emissive = !desc->depth_only && desc->scene->features & SCENE_GPU_EMISSIVE,
                          .has_id = desc->ids};
    return create_targets(g) && create_layouts(g, desc->frame) && create_pipelines(g) &&
           (!desc->redraw_map || create_mask(g, desc));
}

void gbuffer_finish(struct gbuffer *g)
{
    if (!g->gpu)
        return;
    VkDevice device = g->gpu->device;
    vkDestroyPipeline(device, g->mask, NULL);
    vkDestroyPipeline(device, g->kept, NULL);
    vkDestroyPipelineLayout(device, g->mask_layout, NULL);
    gpu_set_free(g->gpu, g->mask_sets[0]);
    gpu_set_free(g->gpu, g->mask_sets[1]);
    vkDestroyDescriptorSetLayout(device, g->mask_set_layout, NULL);
    for (uint32_t i = 0; i < g->pipeline_count; i++)
        vkDestroyPipeline(device, g->pipelines[i].pipeline, NULL);
    vkDestroyPipelineLayout(device, g->layout, NULL);
    gpu_set_free(g->gpu, g->frame_set);
    vkDestroyDescriptorSetLayout(device, g->frame_layout, NULL);
    struct gpu_image *images[] = {&g->base, &g->normal, &g->surface, &g->emissive, &g->id, &g->depth};
    for (size_t i = 0; i < countof(images); i++)
        gpu_image_destroy(g->gpu, images[i]);
    *g = (struct gbuffer){0};
}

uint64_t gbuffer_memory(const struct gbuffer *g)
{
    return g->base.bytes + g->normal.bytes + g->surface.bytes + g->emissive.bytes + g->id.bytes +
           g->depth.bytes;
}

// What may be drawn: one rendering of an eye, or of both. The first clears depth, the others go on.
struct part {
    VkPipeline before;     // a triangle drawn before it, null: none
    bool statics, movings; // which buckets
    bool first;
};

static void draw_triangle(const struct gbuffer *g, VkCommandBuffer cmd, VkPipeline pipeline, uint32_t eye,
                          uint32_t source)
{
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, g->mask_layout, 0, 1, &g->mask_sets[source],
                            0, NULL);
    vkCmdPushConstants(cmd, g->mask_layout, VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof eye, &eye);
    vkCmdSetCullMode(cmd, VK_CULL_MODE_NONE);
    vkCmdSetFrontFace(cmd, VK_FRONT_FACE_COUNTER_CLOCKWISE);
    vkCmdDraw(cmd, 3, 1, 0, 0);
}

static VkPipeline pipeline_for(const struct gbuffer *g, uint32_t features)
{
    uint32_t i = 0;
    while (g->pipelines[i].features != features)
        i++;
    return g->pipelines[i].pipeline;
}

static void draw_buckets(const struct gbuffer *g, VkCommandBuffer cmd, const struct gpu_buffer *draws,
                         const struct gpu_buffer *draw_counts, uint32_t eye, const struct part *part)
{
    const struct scene_gpu *s = g->scene;
    vkCmdBindVertexBuffers(cmd, 0, 1, &s->vertices.buffer, &(VkDeviceSize){0});
    vkCmdBindIndexBuffer(cmd, s->indices.buffer, 0, VK_INDEX_TYPE_UINT32);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, g->layout, 0, 1, &g->frame_set, 0, NULL);
    vkCmdPushConstants(cmd, g->layout, VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof eye, &eye);
    for (uint32_t b = 0; b < s->bucket_count; b++) {
        const struct scene_bucket *bucket = &s->buckets[b];
        if (!(bucket->moving ? part->movings : part->statics))
            continue;
        vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_for(g, bucket->features));
        vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, g->layout, 1, 1,
                                &s->material_sets[bucket->material], 0, NULL);
        vkCmdSetCullMode(cmd, bucket->double_sided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT);
        vkCmdSetFrontFace(cmd, bucket->mirrored ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE);
        vkCmdDrawIndexedIndirectCount(
            cmd, draws->buffer,
            ((VkDeviceSize)eye * s->item_count + bucket->first_item) * sizeof(struct shared_draw),
            draw_counts->buffer, ((VkDeviceSize)eye * s->bucket_count + b) * sizeof(uint32_t),
            bucket->item_count, sizeof(struct shared_draw));
    }
}

// What a rendering draws into: one eye's layer, or both.
static VkImageView attached(const struct gbuffer *g, const struct gpu_image *image, uint32_t eye)
{
    return g->eyes == GBUFFER_EYE_BY_EYE ? image->layer_views[eye] : image->view;
}

static void draw_part(const struct gbuffer *g, VkCommandBuffer cmd, const struct gpu_buffer *draws,
                      const struct gpu_buffer *draw_counts, uint32_t eye, uint32_t source,
                      const struct part *part)
{
    const struct gpu_image *images[TARGETS];
    VkRenderingAttachmentInfo colours[TARGETS];
    const uint32_t count = targets(g, images);
    for (uint32_t i = 0; i < count; i++)
        colours[i] =
            (VkRenderingAttachmentInfo){.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                        .imageView = attached(g, images[i], eye),
                                        .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                        // the id of the background is 0; the rest is read only under depth
                                        .loadOp = !part->first          ? VK_ATTACHMENT_LOAD_OP_LOAD
                                                  : images[i] == &g->id ? VK_ATTACHMENT_LOAD_OP_CLEAR
                                                                        : VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                                        .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
    VkRenderingAttachmentInfo depth = {.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                       .imageView = attached(g, &g->depth, eye),
                                       .imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                                       .loadOp = part->first ? VK_ATTACHMENT_LOAD_OP_CLEAR
                                                             : VK_ATTACHMENT_LOAD_OP_LOAD,
                                       .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
    const VkRect2D area = {.extent = {g->width, g->height}};
    VkRenderingInfo info = {.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                            .renderArea = area,
                            .layerCount = g->eyes == GBUFFER_INSTANCED ? 2 : 1,
                            .viewMask = view_mask(g),
                            .pDepthAttachment = &depth};
    const VkPipelineStageFlags2 tests =
        VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
    vkCmdSetViewport(cmd, 0, 1, &(VkViewport){0, 0, (float)g->width, (float)g->height, 0, 1});
    vkCmdSetScissor(cmd, 0, 1, &area);
    if (!part->first)
        gpu_barrier(cmd, tests | VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                    tests | VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT);
    if (part->before) {
        vkCmdBeginRendering(cmd, &info);
        draw_triangle(g, cmd, part->before, eye, source);
        vkCmdEndRendering(cmd);
        gpu_barrier(cmd, tests, tests);
        depth.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    }
    info.colorAttachmentCount = count;
    info.pColorAttachments = colours;
    vkCmdBeginRendering(cmd, &info);
    draw_buckets(g, cmd, draws, draw_counts, eye, part);
    vkCmdEndRendering(cmd);
}

void gbuffer_record(const struct gbuffer *g, VkCommandBuffer cmd, const struct gpu_buffer *draws,
                    const struct gpu_buffer *draw_counts, enum gbuffer_extent extent, uint32_t source)
{
    const struct gpu_image *images[TARGETS];
    const uint32_t count = targets(g, images);
    for (uint32_t i = 0; i < count; i++)
        gpu_image_layout(cmd, images[i], VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    gpu_image_layout(cmd, &g->depth, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
    const bool apart = extent == GBUFFER_MOVING_EVERYWHERE;
    const struct part drawn = {extent == GBUFFER_ALL ? VK_NULL_HANDLE : g->mask, true, !apart, true};
    const struct part moving = {g->kept, false, true, false};
    for (uint32_t eye = 0; eye < (g->eyes == GBUFFER_EYE_BY_EYE ? 2 : 1); eye++) {
        draw_part(g, cmd, draws, draw_counts, eye, source, &drawn);
        if (apart)
            draw_part(g, cmd, draws, draw_counts, eye, source, &moving);
    }
    for (uint32_t i = 0; i < count; i++)
        gpu_image_layout(cmd, images[i], VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                         VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    gpu_image_layout(cmd, &g->depth, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                     VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL);
}
