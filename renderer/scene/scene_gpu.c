#include "renderer/scene/scene_gpu.h"

#include "renderer/scene/draw_list.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static VkSamplerAddressMode address_mode(enum scene_wrap wrap)
{
    switch (wrap) {
    case SCENE_CLAMP:
        return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    case SCENE_MIRROR:
        return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
    default:
        return VK_SAMPLER_ADDRESS_MODE_REPEAT;
    }
}

static bool create_texture(struct gpu *gpu, const char *name, VkFormat format, uint32_t width, uint32_t height,
                           uint32_t levels, const uint8_t *rgba, struct gpu_image *out)
{
    return gpu_image_create(
               gpu,
               &(struct gpu_image_desc){.name = name,
                                        .format = format,
                                        .width = width,
                                        .height = height,
                                        .levels = levels,
                                        .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT},
               out) &&
           gpu_image_fill(gpu, out, rgba);
}

static bool create_textures(struct scene_gpu *s)
{
    static const uint8_t white[4] = {255, 255, 255, 255};
    const struct scene *scene = s->scene;
    s->textures = calloc(scene->texture_count + 1, sizeof *s->textures);
    s->samplers = calloc(scene->texture_count + 1, sizeof(VkSampler));
    if (!s->textures || !s->samplers)
        return false;
    for (uint32_t i = 0; i < scene->texture_count; i++) {
        const struct scene_texture *t = &scene->textures[i];
        VkFormat format = t->srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM;
        if (!create_texture(s->gpu, "texture", format, t->width, t->height, t->levels, t->rgba,
                            &s->textures[i]))
            return false;
        s->samplers[i] =
            gpu_sampler_create(s->gpu, VK_FILTER_LINEAR, t->nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR,
                               address_mode(t->wrap_u), address_mode(t->wrap_v), s->gpu->anisotropy);
        if (!s->samplers[i])
            return false;
    }
    s->plain = gpu_sampler_create(s->gpu, VK_FILTER_LINEAR, VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT,
                                  VK_SAMPLER_ADDRESS_MODE_REPEAT, 1);
    return s->plain && create_texture(s->gpu, "white", VK_FORMAT_R8G8B8A8_UNORM, 1, 1, 1, white, &s->white);
}

static bool create_material_sets(struct scene_gpu *s)
{
    struct gpu_binding bindings[SCENE_SLOTS];
    for (uint32_t i = 0; i < SCENE_SLOTS; i++)
        bindings[i] = (struct gpu_binding){.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                           .stages = VK_SHADER_STAGE_FRAGMENT_BIT};
    s->material_layout = gpu_set_layout_create(s->gpu, bindings, SCENE_SLOTS);
    s->material_sets = calloc(s->scene->material_count, sizeof(VkDescriptorSet));
    if (!s->material_layout || !s->material_sets)
        return false;
    for (uint32_t i = 0; i < s->scene->material_count; i++) {
        struct gpu_resource resources[SCENE_SLOTS];
        for (uint32_t slot = 0; slot < SCENE_SLOTS; slot++) {
            int32_t t = s->scene->materials[i].use[slot].texture;
            resources[slot] = (struct gpu_resource){.view = t >= 0 ? s->textures[t].view : s->white.view,
                                                    .sampler = t >= 0 ? s->samplers[t] : s->plain,
                                                    .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        }
        s->material_sets[i] = gpu_set_create(s->gpu, s->material_layout, bindings, resources, SCENE_SLOTS);
        if (!s->material_sets[i])
            return false;
    }
    return true;
}

static bool create_materials(struct scene_gpu *s)
{
    const struct scene *scene = s->scene;
    struct shared_material *list = calloc(scene->material_count, sizeof *list);
    if (!list)
        return false;
    for (uint32_t i = 0; i < scene->material_count; i++) {
        const struct scene_material *m = &scene->materials[i];
        memcpy(list[i].base_colour, m->base_colour, sizeof list[i].base_colour);
        memcpy(list[i].emissive, m->emissive, sizeof list[i].emissive);
        list[i].metallic = m->metallic;
        list[i].roughness = m->roughness;
        list[i].normal_scale = m->normal_scale;
        list[i].occlusion_strength = m->occlusion_strength;
        list[i].alpha_cutoff = m->alpha_cutoff;
        for (uint32_t slot = 0; slot < SCENE_SLOTS; slot++) {
            list[i].uv_sets |= (m->use[slot].uv_set & 1u) << slot;
            memcpy(&list[i].transforms[6 * slot], m->use[slot].transform, 6 * sizeof(float));
        }
    }
    bool ok = gpu_buffer_create_filled(s->gpu, "materials", list, scene->material_count * sizeof *list,
                                       VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, &s->materials);
    free(list);
    return ok;
}

// So that no product with a distance or a highlight overflows, which a surface that faces away would turn into
// no number: infinity times 0. Any strength this side of it is white.
static const float brightest = 1e30f;

// Lights lie in world coordinates on the CPU and are rewritten when the origin moves.
static void place_lights(struct scene_gpu *s)
{
    struct shared_light *list = s->lights.mapped;
    for (uint32_t i = 0; i < s->scene->light_count; i++) {
        const struct scene_light *l = &s->scene->lights[i];
        struct dvec3 p = dvec3_sub(l->position, s->origin);
        list[i] = (struct shared_light){
            .position = {(float)p.x, (float)p.y, (float)p.z},
            .range_m = l->range_m,
            .intensity = {fminf(l->intensity[0], brightest), fminf(l->intensity[1], brightest),
                          fminf(l->intensity[2], brightest)},
            .cos_inner = l->cos_inner,
            .direction = {(float)l->direction.x, (float)l->direction.y, (float)l->direction.z},
            .cos_outer = l->cos_outer};
    }
}

static bool create_geometry(struct scene_gpu *s)
{
    const struct scene *scene = s->scene;
    struct gpu *gpu = s->gpu;
    s->now = calloc(scene->node_count + 1, sizeof *s->now);
    s->before = calloc(scene->node_count + 1, sizeof *s->before);
    if (!s->now || !s->before)
        return false;
    s->still = calloc(s->scene->instance_count + 1, sizeof *s->still);
    if (!s->still)
        return false;
    scene_pose(scene, 0, false, s->now);
    scene_pose(scene, 0, false, s->before);
    s->motion_count = scene->moving_count + 1;
    const VkDeviceSize motions = 2 * s->motion_count * sizeof(struct fmat4);
    return draw_list_create(s) &&
           gpu_buffer_create_filled(gpu, "vertices", scene->vertices,
                                    scene->vertex_count * sizeof *scene->vertices,
                                    VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, &s->vertices) &&
           gpu_buffer_create_filled(gpu, "indices", scene->indices, scene->index_count * sizeof *scene->indices,
                                    VK_BUFFER_USAGE_INDEX_BUFFER_BIT, &s->indices) &&
           gpu_buffer_create(gpu, "objects", s->object_count * sizeof(struct shared_object),
                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, GPU_DEVICE,
                             &s->objects) &&
           gpu_buffer_create(gpu, "motions", motions,
                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, GPU_DEVICE,
                             &s->motions) &&
           gpu_buffer_create(gpu, "object staging", s->object_count * sizeof(struct shared_object) + motions,
                             VK_BUFFER_USAGE_TRANSFER_SRC_BIT, GPU_HOST, &s->staging) &&
           gpu_buffer_create(gpu, "lights", scene->light_count * sizeof(struct shared_light),
                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, GPU_HOST, &s->lights);
}

struct scene_gpu *scene_gpu_create(struct gpu *gpu, const struct scene *scene)
{
    struct scene_gpu *s = calloc(1, sizeof *s);
    if (!s)
        return NULL;
    s->gpu = gpu;
    s->scene = scene;
    if (create_textures(s) && create_material_sets(s) && create_materials(s) && create_geometry(s))
        return s;
    scene_gpu_destroy(s);
    return NULL;
}

void scene_gpu_destroy(struct scene_gpu *s)
{
    if (!s)
        return;
    struct gpu *gpu = s->gpu;
    for (uint32_t i = 0; s->material_sets && i < s->scene->material_count; i++)
        gpu_set_free(gpu, s->material_sets[i]);
    vkDestroyDescriptorSetLayout(gpu->device, s->material_layout, NULL);
    for (uint32_t i = 0; s->textures && s->samplers && i < s->scene->texture_count; i++) {
        gpu_image_destroy(gpu, &s->textures[i]);
        vkDestroySampler(gpu->device, s->samplers[i], NULL);
    }
    gpu_image_destroy(gpu, &s->white);
    vkDestroySampler(gpu->device, s->plain, NULL);
    struct gpu_buffer *buffers[] = {&s->vertices, &s->indices,   &s->items,  &s->groups, &s->objects,
                                    &s->motions,  &s->materials, &s->lights, &s->staging};
    for (uint32_t i = 0; i < countof(buffers); i++)
        gpu_buffer_destroy(gpu, buffers[i]);
    free(s->textures);
    free(s->samplers);
    free(s->material_sets);
    free(s->buckets);
    free(s->object_instance);
    free(s->now);
    free(s->before);
    free(s->still);
    free(s);
}

// Updates without motion after which an object counts as standing: a few times the six frames within which its
// box must be redrawn after it last moved (passes/movers), since several options may update for each frame.
enum { STILL_UPDATES = 48 };

static bool same_place(const struct dmat4 *a, const struct dmat4 *b)
{
    return memcmp(a, b, sizeof *a) == 0;
}

static struct shared_object place_object(const struct scene_gpu *s, uint32_t object)
{
    const struct scene_instance *instance = &s->scene->instances[s->object_instance[object]];
    struct fmat4 m = geometry_relative(&s->now[instance->node], s->origin);
    struct shared_object placed = {.moving_id = instance->moving_id};
    placed.moved = instance->moving_id && s->still[object] < STILL_UPDATES;
    memcpy(placed.world_from_mesh, m.m, sizeof m.m);
    return placed;
}

// World `to` from world `from` for one moving instance, both relative to the present origin.
static struct fmat4 motion_of(const struct scene_gpu *s, const struct dmat4 *to, const struct dmat4 *from)
{
    struct dmat4 to_origin = dmat4_identity(), from_origin = dmat4_identity();
    for (int i = 0; i < 3; i++) {
        double o = i == 0 ? s->origin.x : i == 1 ? s->origin.y : s->origin.z;
        to_origin.m[12 + i] = -o;
        from_origin.m[12 + i] = o;
    }
    struct dmat4 mesh_from_world = dmat4_inverse(from);
    struct dmat4 m = dmat4_multiply(to, &mesh_from_world);
    m = dmat4_multiply(&to_origin, &m);
    m = dmat4_multiply(&m, &from_origin);
    struct fmat4 narrow;
    for (int i = 0; i < 16; i++)
        narrow.m[i] = (float)m.m[i];
    return narrow;
}

void scene_gpu_update(struct scene_gpu *s, VkCommandBuffer cmd, struct dvec3 position, double animation_s,
                      double before_s)
{
    struct dvec3 origin = geometry_snap_origin(s->origin, position);
    bool moved = dvec3_length(dvec3_sub(origin, s->origin)) > 0;
    bool all = moved || !s->placed;
    if (!all && s->scene->moving_count == 0)
        return;
    s->origin = origin;
    if (all)
        place_lights(s);
    if (s->scene->moving_count) {
        scene_pose(s->scene, animation_s, true, s->now);
        scene_pose(s->scene, before_s, true, s->before);
    }
    const uint32_t count = all ? s->object_count : s->moving_object_count;
    struct shared_object *objects = s->staging.mapped;
    struct fmat4 *motions = (struct fmat4 *)(void *)(objects + s->object_count);
    struct dmat4 identity = dmat4_identity();
    motions[0] = motions[s->motion_count] = geometry_relative(&identity, (struct dvec3){0, 0, 0});
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t node = s->scene->instances[s->object_instance[i]].node;
        if (i < s->moving_object_count)
            s->still[i] =
                same_place(&s->now[node], &s->before[node]) ? s->still[i] + (s->still[i] < STILL_UPDATES) : 0;
        objects[i] = place_object(s, i);
        const uint32_t id = objects[i].moving_id;
        if (id) {
            motions[id] = motion_of(s, &s->now[node], &s->before[node]);
            motions[s->motion_count + id] = motion_of(s, &s->before[node], &s->now[node]);
        }
    }
    s->placed = true;
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_2_COPY_BIT);
    vkCmdCopyBuffer(cmd, s->staging.buffer, s->objects.buffer, 1,
                    &(VkBufferCopy){.size = count * sizeof *objects});
    vkCmdCopyBuffer(cmd, s->staging.buffer, s->motions.buffer, 1,
                    &(VkBufferCopy){.srcOffset = s->object_count * sizeof *objects, .size = s->motions.size});
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_COPY_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
}

static void copy3(float *out, const float *in)
{
    memcpy(out, in, 3 * sizeof *in);
}

void scene_gpu_constants(const struct scene_gpu *s, struct shared_frame *out)
{
    const struct scene *scene = s->scene;
    const float *e = scene->sun.illuminance;
    out->sun_direction[0] = (float)scene->sun.direction.x;
    out->sun_direction[1] = (float)scene->sun.direction.y;
    out->sun_direction[2] = (float)scene->sun.direction.z;
    out->sun_direction[3] = e[0] > 0 || e[1] > 0 || e[2] > 0 ? 1 : 0;
    for (int i = 0; i < 3; i++)
        out->sun_illuminance[i] = fminf(e[i], brightest);
    copy3(out->sky_zenith, scene->sky.zenith);
    copy3(out->sky_horizon, scene->sky.horizon);
    copy3(out->sky_ground, scene->sky.ground);
    out->light_count = scene->light_count;
    out->item_count = s->item_count;
    out->exposure = 0.18f / scene->luminance; // key value of Reinhard et al. 2002, equation 2
}
