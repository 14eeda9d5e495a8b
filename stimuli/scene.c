#include "stimuli/scene.h"

#include "stimuli/builtin/builtin.h"
#include "stimuli/gltf.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static bool ends_with(const char *text, const char *end)
{
    size_t text_length = strlen(text), end_length = strlen(end);
    return text_length >= end_length && strcasecmp(text + text_length - end_length, end) == 0;
}

struct scene *scene_open(const char *spec, char *error, size_t error_size)
{
    if (ends_with(spec, ".gltf") || ends_with(spec, ".glb") || strchr(spec, '/') != NULL)
        return gltf_open(spec, error, error_size);
    char name[64];
    snprintf(name, sizeof name, "%.*s", (int)strcspn(spec, ":"), spec);
    if (!builtin_scene_known(name)) {
        snprintf(error, error_size,
                 "scene '%.200s' is neither a built-in scene (see `fovstudy scenes`) nor a .gltf or .glb file",
                 spec);
        return NULL;
    }
    return builtin_scene_open(spec, error, error_size);
}

void scene_destroy(struct scene *scene)
{
    if (scene == NULL)
        return;
    for (uint32_t i = 0; i < scene->texture_count; i++)
        free(scene->textures[i].rgba);
    for (uint32_t i = 0; i < scene->channel_count; i++) {
        free(scene->channels[i].times);
        free(scene->channels[i].values);
    }
    free(scene->vertices);
    free(scene->indices);
    free(scene->submodels);
    free(scene->meshes);
    free(scene->materials);
    free(scene->textures);
    free(scene->nodes);
    free(scene->instances);
    free(scene->channels);
    free(scene->lights);
    free(scene);
}

// Octahedral map: Meyer et al., On Floating-Point Normal Vectors, EGSR 2010; z is the axis of the octahedron.
void scene_encode_normal(const float normal[3], int16_t out[2])
{
    double x = (double)normal[0], y = (double)normal[1], z = (double)normal[2];
    double sum = fabs(x) + fabs(y) + fabs(z);
    if (!(sum > 0.0) || !isfinite(sum)) {
        out[0] = out[1] = 0;
        return;
    }
    double u = x / sum, v = y / sum;
    if (z < 0.0) {
        double folded_u = copysign(1.0 - fabs(v), u);
        v = copysign(1.0 - fabs(u), v);
        u = folded_u;
    }
    out[0] = (int16_t)lround(u * 32767.0);
    out[1] = (int16_t)lround(v * 32767.0);
}

static void grow_box(struct scene_box *box, const struct scene_box *by)
{
    for (int axis = 0; axis < 3; axis++) {
        box->min[axis] = fminf(box->min[axis], by->min[axis]);
        box->max[axis] = fmaxf(box->max[axis], by->max[axis]);
    }
}

static struct scene_box mesh_box(const struct scene *scene, const struct scene_mesh *mesh)
{
    struct scene_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (uint32_t i = 0; i < mesh->submodel_count; i++)
        grow_box(&box, &scene->submodels[mesh->first_submodel + i].bounds);
    return box;
}

static void grow_bounds(struct scene *scene, const struct scene_box *box, const struct dmat4 *world)
{
    for (int corner = 0; corner < 8 && box->min[0] <= box->max[0]; corner++) {
        struct dvec3 local = {(double)(corner & 1 ? box->max : box->min)[0],
                              (double)(corner & 2 ? box->max : box->min)[1],
                              (double)(corner & 4 ? box->max : box->min)[2]};
        struct dvec3 p = dmat4_point(world, local);
        scene->bounds_min.x = fmin(scene->bounds_min.x, p.x);
        scene->bounds_min.y = fmin(scene->bounds_min.y, p.y);
        scene->bounds_min.z = fmin(scene->bounds_min.z, p.z);
        scene->bounds_max.x = fmax(scene->bounds_max.x, p.x);
        scene->bounds_max.y = fmax(scene->bounds_max.y, p.y);
        scene->bounds_max.z = fmax(scene->bounds_max.z, p.z);
    }
}

static void measure_bounds(struct scene *scene, const struct scene_box *boxes, const struct dmat4 *world)
{
    scene->bounds_min = (struct dvec3){INFINITY, INFINITY, INFINITY};
    scene->bounds_max = (struct dvec3){-INFINITY, -INFINITY, -INFINITY};
    // Where everything moves, the pose at time 0 has to do.
    bool all_move = scene->moving_count == scene->instance_count;
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        const struct scene_instance *instance = &scene->instances[i];
        if (instance->moving_id == 0 || all_move)
            grow_bounds(scene, &boxes[instance->mesh], &world[instance->node]);
    }
    if (!(scene->bounds_min.x <= scene->bounds_max.x))
        scene->bounds_min = scene->bounds_max = (struct dvec3){0.0, 0.0, 0.0};
}

static int compare_channels(const void *a, const void *b)
{
    const struct scene_channel *x = a, *y = b;
    if (x->node != y->node)
        return x->node < y->node ? -1 : 1;
    return (int)x->target - (int)y->target;
}

void scene_finish(struct scene *scene)
{
    // scene_pose walks nodes and channels side by side.
    if (scene->channel_count > 0)
        qsort(scene->channels, scene->channel_count, sizeof *scene->channels, compare_channels);
    for (uint32_t i = 0; i < scene->channel_count; i++)
        scene->nodes[scene->channels[i].node].animated = true;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        struct scene_node *node = &scene->nodes[i];
        node->moving = node->animated || node->held || (node->parent >= 0 && scene->nodes[node->parent].moving);
    }
    scene->moving_count = 0;
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        struct scene_instance *instance = &scene->instances[i];
        instance->moving_id = scene->nodes[instance->node].moving ? ++scene->moving_count : 0;
    }
    struct scene_box *boxes = calloc(scene->mesh_count + 1u, sizeof *boxes);
    uint64_t *triangles = calloc(scene->mesh_count + 1u, sizeof *triangles);
    struct dmat4 *world = malloc((scene->node_count + 1u) * sizeof *world);
    if (boxes != NULL && triangles != NULL && world != NULL) {
        for (uint32_t i = 0; i < scene->mesh_count; i++) {
            boxes[i] = mesh_box(scene, &scene->meshes[i]);
            for (uint32_t k = 0; k < scene->meshes[i].submodel_count; k++)
                triangles[i] += scene->submodels[scene->meshes[i].first_submodel + k].index_count / 3;
        }
        scene->triangle_count = 0;
        for (uint32_t i = 0; i < scene->instance_count; i++)
            scene->triangle_count += triangles[scene->instances[i].mesh];
        scene_pose(scene, 0.0, false, world);
        measure_bounds(scene, boxes, world);
    }
    free(boxes);
    free(triangles);
    free(world);
}
