#include "stimuli/builtin/maker.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Makes room for `extra` more; false and maker->failed where memory ran out.
static bool reserve(struct maker *maker, void **array, uint32_t *capacity, uint32_t count, uint32_t extra,
                    size_t element)
{
    if (maker->failed)
        return false;
    if (count + extra <= *capacity)
        return true;
    uint32_t wanted = *capacity < 64 ? 64 : *capacity * 2;
    if (wanted < count + extra)
        wanted = count + extra;
    void *grown = realloc(*array, (size_t)wanted * element);
    if (grown == NULL) {
        maker->failed = true;
        return false;
    }
    *array = grown;
    *capacity = wanted;
    return true;
}

bool maker_create(struct maker *maker, const char *name)
{
    *maker = (struct maker){.scene = calloc(1, sizeof(struct scene))};
    if (maker->scene == NULL)
        return false;
    snprintf(maker->scene->name, sizeof maker->scene->name, "%s", name);
    maker->scene->textures = calloc(MAKER_TEXTURES, sizeof(struct scene_texture));
    maker->scene->materials = calloc(MAKER_MATERIALS, sizeof(struct scene_material));
    maker->failed = maker->scene->textures == NULL || maker->scene->materials == NULL;
    return true;
}

struct scene *maker_finish(struct maker *maker)
{
    struct scene *scene = maker->scene;
    for (uint32_t i = 0; i < MAKER_MATERIALS; i++) {
        free(maker->buckets[i].vertices);
        free(maker->buckets[i].indices);
    }
    bool failed = maker->failed;
    *maker = (struct maker){0};
    if (failed) {
        scene_destroy(scene);
        return NULL;
    }
    scene_finish(scene);
    return scene;
}

int32_t maker_texture(struct maker *maker, uint32_t size, uint8_t *rgba, bool srgb, bool nearest,
                      float alpha_cutoff)
{
    struct scene *scene = maker->scene;
    if (maker->failed || rgba == NULL || scene->texture_count == MAKER_TEXTURES) {
        free(rgba);
        maker->failed = true;
        return 0;
    }
    struct scene_texture *texture = &scene->textures[scene->texture_count];
    *texture = (struct scene_texture){
        .width = size, .height = size, .levels = 1, .srgb = srgb, .nearest = nearest, .rgba = rgba};
    scene->texture_count++;
    if (!scene_make_mips(texture, alpha_cutoff))
        maker->failed = true;
    return (int32_t)scene->texture_count - 1;
}

uint32_t maker_material(struct maker *maker, const struct maker_material_desc *desc)
{
    struct scene *scene = maker->scene;
    if (maker->failed || scene->material_count == MAKER_MATERIALS) {
        maker->failed = true;
        return 0;
    }
    struct scene_material *m = &scene->materials[scene->material_count];
    const float *c = desc->colour;
    bool white = c[0] <= 0 && c[1] <= 0 && c[2] <= 0;
    *m = (struct scene_material){
        .base_colour = {white ? 1 : c[0], white ? 1 : c[1], white ? 1 : c[2], 1},
        .emissive = {desc->emissive[0], desc->emissive[1], desc->emissive[2]},
        .metallic = desc->metallic,
        .roughness = desc->roughness,
        .normal_scale = desc->normal_scale > 0 ? desc->normal_scale : 1,
        .occlusion_strength = 1,
        .alpha_cutoff = 0.5f,
        .alpha_mask = desc->alpha_mask,
        .double_sided = desc->double_sided,
        .sky_in_alpha = true,
    };
    snprintf(m->name, sizeof m->name, "%s", desc->name);
    for (int slot = 0; slot < SCENE_SLOTS; slot++)
        m->use[slot] = (struct scene_texture_use){.texture = -1, .transform = {1, 0, 0, 0, 1, 0}};
    m->use[SCENE_BASE_COLOUR].texture = desc->base - 1;
    m->use[SCENE_METALLIC_ROUGHNESS].texture = desc->surface - 1;
    m->use[SCENE_NORMAL].texture = desc->normal - 1;
    m->use[SCENE_EMISSIVE].texture = desc->emission - 1;
    return scene->material_count++;
}

void maker_mesh_begin(struct maker *maker)
{
    for (uint32_t i = 0; i < MAKER_MATERIALS; i++) {
        maker->buckets[i].vertex_count = 0;
        maker->buckets[i].index_count = 0;
    }
}

uint32_t maker_vertex(struct maker *maker, uint32_t material, const struct maker_vertex *vertex)
{
    struct maker_bucket *b = &maker->buckets[material];
    void *array = b->vertices;
    if (!reserve(maker, &array, &b->vertex_capacity, b->vertex_count, 1, sizeof *vertex))
        return 0;
    b->vertices = array;
    b->vertices[b->vertex_count] = *vertex;
    return b->vertex_count++;
}

void maker_triangle(struct maker *maker, uint32_t material, uint32_t a, uint32_t b, uint32_t c)
{
    struct maker_bucket *bucket = &maker->buckets[material];
    void *array = bucket->indices;
    if (!reserve(maker, &array, &bucket->index_capacity, bucket->index_count, 3, sizeof a))
        return;
    bucket->indices = array;
    uint32_t *to = &bucket->indices[bucket->index_count];
    to[0] = a;
    to[1] = b;
    to[2] = c;
    bucket->index_count += 3;
}

uint32_t maker_mesh_triangles(const struct maker *maker)
{
    uint32_t triangles = 0;
    for (uint32_t i = 0; i < MAKER_MATERIALS; i++)
        triangles += maker->buckets[i].index_count / 3;
    return triangles;
}

static uint8_t unorm8(float v)
{
    return (uint8_t)lrintf(fminf(fmaxf(v, 0), 1) * 255);
}

static struct scene_vertex pack(const struct maker_vertex *from)
{
    struct scene_vertex v = {
        .position = {from->position[0], from->position[1], from->position[2]},
        .uv = {{from->uv[0], from->uv[1]}, {from->uv[0], from->uv[1]}},
        .colour = {unorm8(from->colour[0]), unorm8(from->colour[1]), unorm8(from->colour[2]),
                   unorm8(1 - from->hidden)},
    };
    scene_encode_normal(from->normal, v.normal);
    for (int i = 0; i < 3; i++)
        v.tangent[i] = (int16_t)lrintf(from->tangent[i] * 32767);
    v.tangent[3] = (int16_t)(from->tangent[3] > 0 ? 32767 : from->tangent[3] < 0 ? -32767 : 0);
    return v;
}

static void append_bucket(struct maker *maker, uint32_t material)
{
    struct scene *s = maker->scene;
    struct maker_bucket *b = &maker->buckets[material];
    void *vertices = s->vertices, *indices = s->indices, *submodels = s->submodels;
    bool room = reserve(maker, &vertices, &maker->vertex_capacity, s->vertex_count, b->vertex_count,
                        sizeof *s->vertices);
    s->vertices = vertices;
    room = room &&
           reserve(maker, &indices, &maker->index_capacity, s->index_count, b->index_count, sizeof *s->indices);
    s->indices = indices;
    room = room && reserve(maker, &submodels, &maker->submodel_capacity, s->submodel_count, b->index_count / 3,
                           sizeof *s->submodels);
    s->submodels = submodels;
    if (!room)
        return;
    struct scene_vertex *v = &s->vertices[s->vertex_count];
    uint32_t *index = &s->indices[s->index_count];
    for (uint32_t i = 0; i < b->vertex_count; i++)
        v[i] = pack(&b->vertices[i]);
    memcpy(index, b->indices, b->index_count * sizeof *index);
    scene_make_tangents(v, b->vertex_count, index, b->index_count);
    s->submodel_count += scene_split(v, b->vertex_count, index, b->index_count, s->index_count, material,
                                     &s->submodels[s->submodel_count]);
    for (uint32_t i = 0; i < b->index_count; i++)
        index[i] += s->vertex_count;
    s->vertex_count += b->vertex_count;
    s->index_count += b->index_count;
}

uint32_t maker_mesh_end(struct maker *maker)
{
    struct scene *s = maker->scene;
    void *meshes = s->meshes;
    bool room = reserve(maker, &meshes, &maker->mesh_capacity, s->mesh_count, 1, sizeof *s->meshes);
    s->meshes = meshes;
    if (!room)
        return 0;
    uint32_t first = s->submodel_count;
    for (uint32_t i = 0; i < s->material_count; i++)
        if (maker->buckets[i].index_count > 0)
            append_bucket(maker, i);
    s->meshes[s->mesh_count] = (struct scene_mesh){first, s->submodel_count - first};
    return s->mesh_count++;
}

uint32_t maker_node(struct maker *maker, int32_t parent, struct dvec3 translation, struct dquat rotation)
{
    struct scene *s = maker->scene;
    void *nodes = s->nodes;
    bool room = reserve(maker, &nodes, &maker->node_capacity, s->node_count, 1, sizeof *s->nodes);
    s->nodes = nodes;
    if (!room)
        return 0;
    struct dvec3 one = {1, 1, 1};
    s->nodes[s->node_count] = (struct scene_node){.parent = parent,
                                                  .local = dmat4_compose(translation, rotation, one),
                                                  .translation = translation,
                                                  .rotation = rotation,
                                                  .scale = one};
    return s->node_count++;
}

void maker_instance(struct maker *maker, uint32_t mesh, uint32_t node)
{
    struct scene *s = maker->scene;
    void *instances = s->instances;
    bool room =
        reserve(maker, &instances, &maker->instance_capacity, s->instance_count, 1, sizeof *s->instances);
    s->instances = instances;
    if (room)
        s->instances[s->instance_count++] = (struct scene_instance){.mesh = mesh, .node = node};
}

void maker_channel(struct maker *maker, uint32_t node, enum scene_channel_target target, uint32_t key_count,
                   const float *times, const float *values)
{
    struct scene *s = maker->scene;
    void *channels = s->channels;
    bool room = reserve(maker, &channels, &maker->channel_capacity, s->channel_count, 1, sizeof *s->channels);
    s->channels = channels;
    if (!room)
        return;
    size_t value_bytes = key_count * (target == SCENE_ROTATION ? 4 : 3) * sizeof(float);
    float *own_times = malloc(key_count * sizeof(float)), *own_values = malloc(value_bytes);
    if (own_times == NULL || own_values == NULL) {
        free(own_times);
        free(own_values);
        maker->failed = true;
        return;
    }
    memcpy(own_times, times, key_count * sizeof(float));
    memcpy(own_values, values, value_bytes);
    s->nodes[node].animated = true;
    s->channels[s->channel_count++] = (struct scene_channel){.node = node,
                                                             .target = target,
                                                             .interpolation = SCENE_LINEAR,
                                                             .key_count = key_count,
                                                             .times = own_times,
                                                             .values = own_values};
}

void maker_light(struct maker *maker, const struct scene_light *light)
{
    struct scene *s = maker->scene;
    void *lights = s->lights;
    bool room = reserve(maker, &lights, &maker->light_capacity, s->light_count, 1, sizeof *s->lights);
    s->lights = lights;
    if (room)
        s->lights[s->light_count++] = *light;
}
