#include "renderer/passes/shadow/shadow.h"

#include "shadow.vert.h"
#include "shadow_mask.frag.h"
#include "shadow_mask.vert.h"

#include <math.h>
#include <stddef.h>

// 2 cm: what a pixel of the default view at 1280x1440 covers 12 m away. 4096: 64 MiB.
static const double finest_texel_m = 0.02;
// Around the camera's path: beyond it everything is sunlit. At 80 m and 1280x1440 a house's shadow is some 50
// pixels long; a map of the 500 m of country around `town` would have texels of 17 cm before the eye.
static const double reach_m = 80;
enum { LARGEST_MAP = 4096, BORDER = 3 }; // texels left open around everything, for the filter's reach of 2

static const VkVertexInputBindingDescription vertex_binding = {0, sizeof(struct scene_vertex),
                                                               VK_VERTEX_INPUT_RATE_VERTEX};
static const VkVertexInputAttributeDescription attributes[] = {
    {0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(struct scene_vertex, position)},
    {3, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(struct scene_vertex, uv[0])},
    {4, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(struct scene_vertex, uv[1])},
    {5, 0, VK_FORMAT_R8G8B8A8_UNORM, offsetof(struct scene_vertex, colour)},
};

struct push {
    float clip_from_mesh[16];
    uint32_t material;
    uint32_t sky_in_alpha;
};

// Drawing the map needs these once.
struct tools {
    VkDescriptorSetLayout set_layout;
    VkDescriptorSet set;
    VkPipelineLayout layout;
    VkPipeline opaque, masked;
};

// Right, up and towards the sun as rows: a rotation.
static void sun_axes(struct dvec3 towards, struct dvec3 out[3])
{
    const struct dvec3 aside = fabs(towards.y) < 0.9 ? (struct dvec3){0, 1, 0} : (struct dvec3){1, 0, 0};
    out[2] = dvec3_normalise(towards);
    out[0] = dvec3_normalise(dvec3_cross(aside, out[2]));
    out[1] = dvec3_cross(out[2], out[0]);
}

struct extent {
    double low[3], high[3];
};

static void grow(struct extent *e, const struct dvec3 axes[3], struct dvec3 p)
{
    for (int i = 0; i < 3; i++) {
        const double at = dvec3_dot(axes[i], p);
        e->low[i] = fmin(e->low[i], at);
        e->high[i] = fmax(e->high[i], at);
    }
}

// By the boxes of submodels, in the sun's axes. False where nothing stands still.
static bool measure(const struct scene_gpu *s, const struct dvec3 axes[3], struct extent *out)
{
    const struct scene *scene = s->scene;
    *out = (struct extent){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        const struct scene_instance *instance = &scene->instances[i];
        const struct scene_mesh *mesh = &scene->meshes[instance->mesh];
        for (uint32_t k = 0; instance->moving_id == 0 && k < mesh->submodel_count; k++) {
            const struct scene_box *box = &scene->submodels[mesh->first_submodel + k].bounds;
            for (int corner = 0; corner < 8 && box->min[0] <= box->max[0]; corner++)
                grow(out, axes,
                     dmat4_point(&s->now[instance->node],
                                 (struct dvec3){(double)(corner & 1 ? box->max : box->min)[0],
                                                (double)(corner & 2 ? box->max : box->min)[1],
                                                (double)(corner & 4 ? box->max : box->min)[2]}));
        }
    }
    return out->low[0] <= out->high[0];
}

// What is farther from the camera's path than reach_m, sideways from the sun, is left out.
static void keep_near_path(const struct camera_path *path, const struct dvec3 axes[3], struct extent *e)
{
    struct extent near = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (uint32_t i = 0; i < path->knot_count; i++)
        grow(&near, axes, path->knots[i].position);
    for (int i = 0; i < 2; i++) {
        const double low = fmax(e->low[i], near.low[i] - reach_m),
                     high = fmin(e->high[i], near.high[i] + reach_m);
        if (low < high) { // a path that comes nowhere near the scene says nothing
            e->low[i] = low;
            e->high[i] = high;
        }
    }
}

// Square texels; the map is as wide and high as the extent asks for.
static void place(struct shadow *s, const struct dvec3 axes[3], const struct extent *e, uint32_t out_size[2])
{
    const uint32_t limit = s->gpu->properties.limits.maxImageDimension2D;
    const uint32_t most = limit < LARGEST_MAP ? limit : LARGEST_MAP;
    const double span[2] = {e->high[0] - e->low[0], e->high[1] - e->low[1]};
    s->texel_m = fmax(finest_texel_m, fmax(span[0], span[1]) / (most - 2 * BORDER - 1));
    s->map_from_world = dmat4_identity();
    for (int i = 0; i < 3; i++) {
        double low = e->low[i], size;
        if (i < 2) {
            out_size[i] = (uint32_t)ceil(span[i] / s->texel_m) + 2 * BORDER;
            size = out_size[i] * s->texel_m;
            low -= BORDER * s->texel_m;
        } else { // depth: from 0 at the nearest point to the sun to 1 at the farthest, a texel free at either
                 // end
            size = -(e->high[i] - e->low[i] + 2 * s->texel_m);
            low = e->high[i] + s->texel_m;
        }
        const double axis[3] = {axes[i].x, axes[i].y, axes[i].z};
        for (int k = 0; k < 3; k++)
            s->map_from_world.m[4 * k + i] = axis[k] / size;
        s->map_from_world.m[12 + i] = -low / size;
    }
}

static VkPipeline create_pipeline(struct gpu *gpu, VkPipelineLayout layout, bool masked)
{
    struct gpu_raster_desc desc = {.name = "sun shadow",
                                   .vertex = {shadow_vert, sizeof shadow_vert},
                                   .layout = layout,
                                   .vertex_binding = &vertex_binding,
                                   .attributes = attributes,
                                   .attribute_count = masked ? countof(attributes) : 1,
                                   .depth_format = VK_FORMAT_D32_SFLOAT,
                                   .depth_compare = VK_COMPARE_OP_LESS,
                                   // Normals that differ from the true surface's (bump maps, few facets on a
                                   // round thing) get too small an offset when the map is read: a texel more.
                                   .slope_bias = 1};
    if (masked) {
        desc.vertex = (struct gpu_code){shadow_mask_vert, sizeof shadow_mask_vert};
        desc.fragment = (struct gpu_code){shadow_mask_frag, sizeof shadow_mask_frag};
    }
    return gpu_raster_create(gpu, &desc);
}

static bool create_tools(struct gpu *gpu, const struct scene_gpu *scene, struct tools *t)
{
    const VkShaderStageFlags both = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
    const struct gpu_binding binding = {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, .stages = both};
    t->set_layout = gpu_set_layout_create(gpu, &binding, 1);
    if (!t->set_layout)
        return false;
    t->set =
        gpu_set_create(gpu, t->set_layout, &binding, &(struct gpu_resource){.buffer = &scene->materials}, 1);
    const VkPipelineLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .setLayoutCount = 2,
        .pSetLayouts = (const VkDescriptorSetLayout[]){t->set_layout, scene->material_layout},
        .pushConstantRangeCount = 1,
        .pPushConstantRanges = &(VkPushConstantRange){both, 0, sizeof(struct push)},
    };
    return t->set && VK(gpu, vkCreatePipelineLayout(gpu->device, &info, NULL, &t->layout)) &&
           (t->opaque = create_pipeline(gpu, t->layout, false)) &&
           (!(scene->features & SCENE_GPU_MASK) || (t->masked = create_pipeline(gpu, t->layout, true)));
}

static void destroy_tools(struct gpu *gpu, struct tools *t)
{
    vkDestroyPipeline(gpu->device, t->opaque, NULL);
    vkDestroyPipeline(gpu->device, t->masked, NULL);
    vkDestroyPipelineLayout(gpu->device, t->layout, NULL);
    gpu_set_free(gpu, t->set);
    vkDestroyDescriptorSetLayout(gpu->device, t->set_layout, NULL);
}

// One draw for each run of submodels of one material that lie one after another.
static void draw_instance(const struct tools *t, VkCommandBuffer cmd, const struct scene_gpu *s,
                          const struct scene_instance *instance, const struct dmat4 *clip_from_world)
{
    const struct scene_mesh *mesh = &s->scene->meshes[instance->mesh];
    const struct scene_submodel *list = &s->scene->submodels[mesh->first_submodel];
    const struct dmat4 clip_from_mesh = dmat4_multiply(clip_from_world, &s->now[instance->node]);
    struct push push;
    for (int i = 0; i < 16; i++)
        push.clip_from_mesh[i] = (float)clip_from_mesh.m[i];
    for (uint32_t k = 0, next; k < mesh->submodel_count; k = next) {
        uint32_t count = list[k].index_count;
        for (next = k + 1; next < mesh->submodel_count && list[next].material == list[k].material &&
                           list[next].first_index == list[k].first_index + count;
             next++)
            count += list[next].index_count;
        const struct scene_material *material = &s->scene->materials[list[k].material];
        push.material = list[k].material;
        push.sky_in_alpha = material->sky_in_alpha;
        vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, material->alpha_mask ? t->masked : t->opaque);
        if (material->alpha_mask)
            vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, t->layout, 1, 1,
                                    &s->material_sets[push.material], 0, NULL);
        vkCmdPushConstants(cmd, t->layout, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                           sizeof push, &push);
        vkCmdDrawIndexed(cmd, count, 1, list[k].first_index, 0, 0);
    }
}

static void draw_map(const struct shadow *shadow, const struct tools *t, VkCommandBuffer cmd,
                     const struct scene_gpu *s)
{
    const VkRenderingAttachmentInfo depth = {.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                             .imageView = shadow->map.layer_views[0],
                                             .imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                                             .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                             .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                             .clearValue = {.depthStencil = {.depth = 1}}};
    const VkRect2D area = {.extent = {shadow->map.width, shadow->map.height}};
    struct dmat4 clip_from_map = dmat4_identity();
    clip_from_map.m[0] = clip_from_map.m[5] = 2;
    clip_from_map.m[12] = clip_from_map.m[13] = -1;
    const struct dmat4 clip_from_world = dmat4_multiply(&clip_from_map, &shadow->map_from_world);
    gpu_image_layout(cmd, &shadow->map, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
    vkCmdBeginRendering(cmd, &(VkRenderingInfo){.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                                .renderArea = area,
                                                .layerCount = 1,
                                                .pDepthAttachment = &depth});
    vkCmdSetViewport(cmd, 0, 1, &(VkViewport){0, 0, (float)shadow->map.width, (float)shadow->map.height, 0, 1});
    vkCmdSetScissor(cmd, 0, 1, &area);
    vkCmdSetCullMode(cmd, VK_CULL_MODE_NONE); // a wall modelled from one side only casts a shadow too
    vkCmdSetFrontFace(cmd, VK_FRONT_FACE_COUNTER_CLOCKWISE);
    vkCmdBindVertexBuffers(cmd, 0, 1, &s->vertices.buffer, &(VkDeviceSize){0});
    vkCmdBindIndexBuffer(cmd, s->indices.buffer, 0, VK_INDEX_TYPE_UINT32);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, t->layout, 0, 1, &t->set, 0, NULL);
    for (uint32_t i = 0; i < s->scene->instance_count; i++) {
        if (s->scene->instances[i].moving_id == 0)
            draw_instance(t, cmd, s, &s->scene->instances[i], &clip_from_world);
    }
    vkCmdEndRendering(cmd);
    gpu_image_layout(cmd, &shadow->map, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                     VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL);
}

bool shadow_init(struct shadow *s, struct gpu *gpu, const struct scene_gpu *scene)
{
    *s = (struct shadow){.gpu = gpu};
    const float *e = scene->scene->sun.illuminance;
    struct dvec3 axes[3];
    struct extent extent;
    sun_axes(scene->scene->sun.direction, axes);
    if (!(e[0] > 0 || e[1] > 0 || e[2] > 0) || !measure(scene, axes, &extent))
        return true;
    keep_near_path(&scene->scene->path, axes, &extent);
    uint32_t size[2];
    place(s, axes, &extent, size);
    const struct gpu_image_desc map = {.name = "sun shadow",
                                       .format = VK_FORMAT_D32_SFLOAT,
                                       .width = size[0],
                                       .height = size[1],
                                       .array = true,
                                       .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
                                                VK_IMAGE_USAGE_SAMPLED_BIT};
    struct tools tools = {0};
    bool ok = gpu_image_create(gpu, &map, &s->map) && create_tools(gpu, scene, &tools);
    VkCommandBuffer cmd = ok ? gpu_once_begin(gpu) : VK_NULL_HANDLE;
    if (cmd) {
        draw_map(s, &tools, cmd, scene);
        ok = gpu_once_end(gpu, cmd);
    }
    destroy_tools(gpu, &tools);
    if (ok && cmd)
        return true;
    shadow_finish(s);
    return false;
}

void shadow_finish(struct shadow *s)
{
    if (s->gpu)
        gpu_image_destroy(s->gpu, &s->map);
    *s = (struct shadow){0};
}

void shadow_constants(const struct shadow *s, struct dvec3 origin, struct shared_frame *out)
{
    const struct dvec3 moved = dmat4_point(&s->map_from_world, origin);
    const double translation[3] = {moved.x, moved.y, moved.z};
    for (int i = 0; i < 16; i++)
        out->shadow_from_world[i] = (float)s->map_from_world.m[i];
    for (int i = 0; i < 3; i++)
        out->shadow_from_world[12 + i] = (float)translation[i];
    out->shadow_texel_m = (float)s->texel_m;
}
