#include "renderer/modes/vrs/forward.h"

#include "forward.frag.h"
#include "gbuffer.vert.h"
#include "mask.vert.h"
#include "rate.comp.h"
#include "sky.frag.h"

_Static_assert(SCENE_GPU_FEATURES == 9, "bindings.glsl numbers its constants after the scene's features");
enum { CONSTANTS = SCENE_GPU_FEATURES + 2 };

static const VkFormat hdr_format = VK_FORMAT_R16G16B16A16_SFLOAT;

static const struct gpu_binding rate_bindings[] = {
    {.type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}, // frame
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},  // rates
};

struct rate_push {
    float inner_deg, outer_deg;
    uint32_t texel, middle, outermost;
};

static bool create_rates(struct forward *f)
{
    const uint32_t texel = f->gpu->shading_rate.texel;
    const struct gpu_image_desc rates = {.name = "shading rates",
                                         .format = VK_FORMAT_R8_UINT,
                                         .width = (f->width + texel - 1) / texel,
                                         .height = (f->height + texel - 1) / texel,
                                         .layers = 2,
                                         .array = true,
                                         .usage = VK_IMAGE_USAGE_STORAGE_BIT |
                                                  VK_IMAGE_USAGE_FRAGMENT_SHADING_RATE_ATTACHMENT_BIT_KHR};
    return gpu_image_create(f->gpu, &rates, &f->rates);
}

static bool create_hdr(struct forward *f)
{
    const struct gpu_image_desc hdr = {.name = "hdr",
                                       .format = hdr_format,
                                       .width = f->width,
                                       .height = f->height,
                                       .layers = 2,
                                       .array = true,
                                       .usage =
                                           VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_STORAGE_BIT};
    return gpu_image_create(f->gpu, &hdr, &f->hdr);
}

static bool create_rate_kernel(struct forward *f, const struct gpu_buffer *frame)
{
    const struct gpu_kernel_desc kernel = {.name = "shading rates",
                                           .code = {rate_comp, sizeof rate_comp},
                                           .bindings = rate_bindings,
                                           .binding_count = countof(rate_bindings),
                                           .push_bytes = sizeof(struct rate_push)};
    const struct gpu_resource resources[] = {{.buffer = frame}, {.view = f->rates.view}};
    if (!gpu_kernel_create(f->gpu, &kernel, &f->rate))
        return false;
    f->rate_set = gpu_set_create(f->gpu, f->rate.set_layout, rate_bindings, resources, countof(resources));
    return f->rate_set;
}

// What a scene or setting does not have is specialised away; the depths stand in for its image.
static bool create_layouts(struct forward *f, const struct mode_setup *setup, const struct deferred *d)
{
    const VkShaderStageFlags both = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
    const VkDescriptorType buffer = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    const VkDescriptorType sampled = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    const struct gpu_binding bindings[] = {
        {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, both, false}, // frame
        {buffer, both, false},                            // items
        {buffer, both, false},                            // objects
        {buffer, both, false},                            // materials
        {buffer, both, false},                            // lights
        {buffer, both, false},                            // counters
        {sampled, both, false},                           // occlusion
        {sampled, both, false},                           // its distances
        {sampled, both, false},                           // sun shadow
    };
    const struct gpu_resource depth = {.view = d->gbuffer.depth.view,
                                       .sampler = f->sampler,
                                       .layout = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL};
    const struct gpu_resource resources[] = {
        {.buffer = setup->frame},
        {.buffer = &f->scene->items},
        {.buffer = &f->scene->objects},
        {.buffer = &f->scene->materials},
        {.buffer = &f->scene->lights},
        {.buffer = setup->counters},
        d->has_ssao ? (struct gpu_resource){.view = d->ssao.shown.view, .sampler = f->sampler} : depth,
        d->has_ssao ? (struct gpu_resource){.view = d->ssao.distance.view, .sampler = f->sampler} : depth,
        {.view = setup->shadow_map ? setup->shadow_map : depth.view,
         .sampler = f->compare,
         .layout = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL},
    };
    f->set_layout = gpu_set_layout_create(f->gpu, bindings, countof(bindings));
    if (!f->set_layout)
        return false;
    f->set = gpu_set_create(f->gpu, f->set_layout, bindings, resources, countof(resources));
    const VkPipelineLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .setLayoutCount = 2,
        .pSetLayouts = (const VkDescriptorSetLayout[]){f->set_layout, f->scene->material_layout},
        .pushConstantRangeCount = 1,
        .pPushConstantRanges = &(VkPushConstantRange){both, 0, sizeof(uint32_t)},
    };
    return f->set && VK(f->gpu, vkCreatePipelineLayout(f->gpu->device, &info, NULL, &f->layout));
}

static VkPipeline create_pipeline(const struct forward *f, const int32_t *constants, bool sky)
{
    struct gpu_raster_desc desc = {.name = sky ? "sky" : "forward",
                                   .vertex = {gbuffer_vert, sizeof gbuffer_vert},
                                   .fragment = {forward_frag, sizeof forward_frag},
                                   .layout = f->layout,
                                   .vertex_binding = &gbuffer_vertex_binding,
                                   .attributes = gbuffer_attributes,
                                   .attribute_count = GBUFFER_ATTRIBUTES,
                                   .colour_formats = &hdr_format,
                                   .colour_count = 1,
                                   .depth_format = VK_FORMAT_D32_SFLOAT,
                                   .depth_compare = VK_COMPARE_OP_EQUAL,
                                   .keep_depth = true,
                                   .shading_rate = f->mapped,
                                   .constants = constants,
                                   .constant_count = CONSTANTS};
    if (sky) { // a triangle over the screen at depth 0, infinity
        desc.vertex = (struct gpu_code){mask_vert, sizeof mask_vert};
        desc.fragment = (struct gpu_code){sky_frag, sizeof sky_frag};
        desc.vertex_binding = NULL;
        desc.attribute_count = 0;
    }
    return gpu_raster_create(f->gpu, &desc);
}

// For the sets of features that the depths were drawn with.
static bool create_pipelines(struct forward *f, const struct deferred *d, bool shadow)
{
    int32_t constants[CONSTANTS] = {0};
    constants[SCENE_GPU_FEATURES] = d->has_ssao;
    constants[SCENE_GPU_FEATURES + 1] = shadow;
    f->sky = create_pipeline(f, constants, true);
    bool ok = f->sky;
    for (; ok && f->pipeline_count < d->gbuffer.pipeline_count; f->pipeline_count++) {
        const uint32_t features = d->gbuffer.pipelines[f->pipeline_count].features;
        for (uint32_t bit = 0; bit < SCENE_GPU_FEATURES; bit++)
            constants[bit] = (int32_t)(features >> bit & 1);
        f->pipelines[f->pipeline_count].features = features;
        f->pipelines[f->pipeline_count].pipeline = create_pipeline(f, constants, false);
        ok = f->pipelines[f->pipeline_count].pipeline;
    }
    return ok;
}

bool forward_init(struct forward *f, const struct mode_setup *setup, const struct deferred *d, float inner_deg,
                  float outer_deg)
{
    *f = (struct forward){.gpu = setup->gpu,
                          .scene = setup->scene,
                          .width = setup->width,
                          .height = setup->height,
                          .mapped = setup->gpu->shading_rate.texel > 0,
                          .inner_deg = inner_deg,
                          .outer_deg = outer_deg};
    f->sampler = gpu_sampler_create_plain(f->gpu);
    f->compare = gpu_sampler_create_compare(f->gpu);
    return f->sampler && f->compare && create_hdr(f) &&
           (!f->mapped || (create_rates(f) && create_rate_kernel(f, setup->frame))) &&
           create_layouts(f, setup, d) && create_pipelines(f, d, setup->shadow_map);
}

void forward_finish(struct forward *f)
{
    if (!f->gpu)
        return;
    VkDevice device = f->gpu->device;
    for (uint32_t i = 0; i < GBUFFER_PIPELINES; i++)
        vkDestroyPipeline(device, f->pipelines[i].pipeline, NULL);
    vkDestroyPipeline(device, f->sky, NULL);
    vkDestroyPipelineLayout(device, f->layout, NULL);
    gpu_set_free(f->gpu, f->set);
    vkDestroyDescriptorSetLayout(device, f->set_layout, NULL);
    gpu_set_free(f->gpu, f->rate_set);
    gpu_kernel_destroy(f->gpu, &f->rate);
    gpu_image_destroy(f->gpu, &f->rates);
    gpu_image_destroy(f->gpu, &f->hdr);
    vkDestroySampler(device, f->sampler, NULL);
    vkDestroySampler(device, f->compare, NULL);
    *f = (struct forward){0};
}

void forward_rates(const struct forward *f, VkCommandBuffer cmd)
{
    const struct gpu_shading_rate *rate = &f->gpu->shading_rate;
    if (!f->mapped)
        return;
    const struct rate_push push = {.inner_deg = f->inner_deg,
                                   .outer_deg = f->outer_deg,
                                   .texel = rate->texel,
                                   .middle = gpu_shading_rate_code(2, 2),
                                   .outermost = gpu_shading_rate_code(rate->largest, rate->largest)};
    gpu_image_layout(cmd, &f->rates, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    gpu_dispatch(cmd, &f->rate, f->rate_set, &push, sizeof push,
                 (f->rates.width + SHARED_TILE - 1) / SHARED_TILE,
                 (f->rates.height + SHARED_TILE - 1) / SHARED_TILE, 2);
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                VK_PIPELINE_STAGE_2_FRAGMENT_SHADING_RATE_ATTACHMENT_BIT_KHR);
}

static void draw_sky(const struct forward *f, VkCommandBuffer cmd)
{
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, f->sky);
    vkCmdSetCullMode(cmd, VK_CULL_MODE_NONE);
    vkCmdSetFrontFace(cmd, VK_FRONT_FACE_COUNTER_CLOCKWISE);
    vkCmdDraw(cmd, 3, 1, 0, 0);
}

static VkPipeline pipeline_for(const struct forward *f, uint32_t features)
{
    uint32_t i = 0;
    while (f->pipelines[i].features != features)
        i++;
    return f->pipelines[i].pipeline;
}

static void draw_surfaces(const struct forward *f, VkCommandBuffer cmd, const struct cull *cull, uint32_t eye)
{
    const struct scene_gpu *s = f->scene;
    vkCmdBindVertexBuffers(cmd, 0, 1, &s->vertices.buffer, &(VkDeviceSize){0});
    vkCmdBindIndexBuffer(cmd, s->indices.buffer, 0, VK_INDEX_TYPE_UINT32);
    for (uint32_t b = 0; b < s->bucket_count; b++) {
        const struct scene_bucket *bucket = &s->buckets[b];
        vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_for(f, bucket->features));
        vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, f->layout, 1, 1,
                                &s->material_sets[bucket->material], 0, NULL);
        vkCmdSetCullMode(cmd, bucket->double_sided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT);
        vkCmdSetFrontFace(cmd, bucket->mirrored ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE);
        vkCmdDrawIndexedIndirectCount(
            cmd, cull->draws.buffer,
            ((VkDeviceSize)eye * s->item_count + bucket->first_item) * sizeof(struct shared_draw),
            cull->draw_counts.buffer, ((VkDeviceSize)eye * s->bucket_count + b) * sizeof(uint32_t),
            bucket->item_count, sizeof(struct shared_draw));
    }
}

static void draw_eye(const struct forward *f, VkCommandBuffer cmd, const struct deferred *d, uint32_t eye)
{
    const uint32_t texel = f->gpu->shading_rate.texel;
    const VkRenderingAttachmentInfo colour = {.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                              .imageView = f->hdr.layer_views[eye],
                                              .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                              .loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE, // every pixel is drawn
                                              .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
    const VkRenderingAttachmentInfo depth = {.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                             .imageView = d->gbuffer.depth.layer_views[eye],
                                             .imageLayout = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL,
                                             .loadOp = VK_ATTACHMENT_LOAD_OP_LOAD,
                                             .storeOp = VK_ATTACHMENT_STORE_OP_NONE};
    const VkRenderingFragmentShadingRateAttachmentInfoKHR rates = {
        .sType = VK_STRUCTURE_TYPE_RENDERING_FRAGMENT_SHADING_RATE_ATTACHMENT_INFO_KHR,
        .imageView = f->rates.layer_views[eye],
        .imageLayout = VK_IMAGE_LAYOUT_GENERAL,
        .shadingRateAttachmentTexelSize = {texel, texel}};
    const VkRect2D area = {.extent = {f->width, f->height}};
    vkCmdBeginRendering(cmd, &(VkRenderingInfo){.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                                .pNext = f->mapped ? &rates : NULL,
                                                .renderArea = area,
                                                .layerCount = 1,
                                                .colorAttachmentCount = 1,
                                                .pColorAttachments = &colour,
                                                .pDepthAttachment = &depth});
    vkCmdSetViewport(cmd, 0, 1, &(VkViewport){0, 0, (float)f->width, (float)f->height, 0, 1});
    vkCmdSetScissor(cmd, 0, 1, &area);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, f->layout, 0, 1, &f->set, 0, NULL);
    vkCmdPushConstants(cmd, f->layout, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof eye,
                       &eye);
    draw_sky(f, cmd);
    draw_surfaces(f, cmd, &d->cull, eye);
    vkCmdEndRendering(cmd);
}

void forward_record(const struct forward *f, VkCommandBuffer cmd, const struct deferred *d)
{
    gpu_image_layout(cmd, &f->hdr, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    // ambient occlusion is left ready for kernels only
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT);
    for (uint32_t eye = 0; eye < 2; eye++)
        draw_eye(f, cmd, d, eye);
    gpu_image_layout(cmd, &f->hdr, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL);
}
