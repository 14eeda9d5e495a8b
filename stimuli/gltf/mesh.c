// Primitives as vertices and triangles, cut into submodels.
#include "stimuli/gltf/build.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// One primitive on its way.
struct part {
    struct scene_vertex *vertices; // owned
    uint32_t vertex_count;
    uint32_t *indices; // owned, triangles
    uint32_t index_count;
};

static bool no_memory(struct gltf_build *build)
{
    return gltf_fail(&build->report, "out of memory");
}

static int16_t snorm(float value)
{
    return (int16_t)lroundf(fminf(fmaxf(value, -1.0f), 1.0f) * 32767.0f);
}

static uint8_t unorm(float value)
{
    return (uint8_t)lroundf(fminf(fmaxf(value, 0.0f), 1.0f) * 255.0f);
}

static void store_tangent(struct scene_vertex *vertex, const float *value)
{
    double x = (double)value[0], y = (double)value[1], z = (double)value[2];
    double length = sqrt(x * x + y * y + z * z);
    // A zero tangent keeps w = 0 and is made anew.
    if (!(length > 1e-12))
        return;
    for (int k = 0; k < 3; k++)
        vertex->tangent[k] = snorm((float)((double)value[k] / length));
    vertex->tangent[3] = value[3] < 0.0f ? -32767 : 32767;
}

static void store(struct scene_vertex *vertex, enum gltf_attribute attribute, const float *value,
                  uint32_t width)
{
    switch (attribute) {
    case GLTF_POSITION:
        memcpy(vertex->position, value, sizeof vertex->position);
        break;
    case GLTF_NORMAL:
        scene_encode_normal(value, vertex->normal);
        break;
    case GLTF_TANGENT:
        store_tangent(vertex, value);
        break;
    case GLTF_TEXCOORD_0:
        memcpy(vertex->uv[0], value, sizeof vertex->uv[0]);
        break;
    case GLTF_TEXCOORD_1:
        memcpy(vertex->uv[1], value, sizeof vertex->uv[1]);
        break;
    default:
        for (uint32_t k = 0; k < width; k++)
            vertex->colour[k] = unorm(value[k]);
    }
}

static bool read_vertices(struct gltf_build *build, const struct gltf_primitive *p, struct part *part)
{
    const struct gltf_document *d = build->document;
    part->vertex_count = (uint32_t)d->accessors[p->attribute[GLTF_POSITION]].count;
    part->vertices = calloc(part->vertex_count, sizeof *part->vertices);
    float *values = malloc((size_t)part->vertex_count * 4 * sizeof *values);
    bool ok = (part->vertices != NULL && values != NULL) || no_memory(build);
    for (uint32_t i = 0; ok && i < part->vertex_count; i++)
        memset(part->vertices[i].colour, 255, sizeof part->vertices[i].colour);
    for (int k = 0; ok && k < GLTF_ATTRIBUTES; k++) {
        if (p->attribute[k] == -1)
            continue;
        uint32_t width = d->accessors[p->attribute[k]].width;
        ok = gltf_read_floats(d, p->attribute[k], values, &build->report);
        for (uint32_t i = 0; ok && i < part->vertex_count; i++)
            store(&part->vertices[i], (enum gltf_attribute)k, values + (size_t)i * width, width);
    }
    free(values);
    return ok;
}

// Triangle i of a strip or fan, wound like the first (glTF 2.0, section 3.7.2.1).
static void unroll(int32_t mode, const uint32_t *corners, uint32_t i, uint32_t out[3])
{
    bool odd = i % 2 == 1;
    out[0] = mode == 5 ? corners[i] : corners[i + 1];
    out[1] = mode == 5 ? corners[i + (odd ? 2 : 1)] : corners[i + 2];
    out[2] = mode == 5 ? corners[i + (odd ? 1 : 2)] : corners[0];
}

static bool read_triangles(struct gltf_build *build, const struct gltf_primitive *p, struct part *part)
{
    const struct gltf_document *d = build->document;
    uint32_t count = p->indices != -1 ? (uint32_t)d->accessors[p->indices].count : part->vertex_count;
    uint32_t *corners = malloc((size_t)count * sizeof *corners);
    if (corners == NULL)
        return no_memory(build);
    for (uint32_t i = 0; p->indices == -1 && i < count; i++)
        corners[i] = i;
    if (p->indices != -1 && !gltf_read_indices(d, p->indices, part->vertex_count, corners, &build->report)) {
        free(corners);
        return false;
    }
    if (p->mode == 4) {
        part->indices = corners;
        part->index_count = count;
        return true;
    }
    uint32_t triangles = count >= 3 ? count - 2 : 0;
    part->indices = malloc(((size_t)triangles * 3 + 1) * sizeof *part->indices);
    for (uint32_t i = 0; part->indices != NULL && i < triangles; i++)
        unroll(p->mode, corners, i, part->indices + (size_t)i * 3);
    part->index_count = triangles * 3;
    free(corners);
    return part->indices != NULL || no_memory(build);
}

static void face_normal(const struct scene_vertex *corners, int16_t out[2])
{
    struct dvec3 at[3];
    for (int k = 0; k < 3; k++)
        at[k] = (struct dvec3){(double)corners[k].position[0], (double)corners[k].position[1],
                               (double)corners[k].position[2]};
    struct dvec3 n = dvec3_normalise(dvec3_cross(dvec3_sub(at[1], at[0]), dvec3_sub(at[2], at[0])));
    scene_encode_normal((const float[3]){(float)n.x, (float)n.y, (float)n.z}, out);
}

// A primitive without normals is flat-shaded, and its tangents do not count (glTF 2.0, section 3.7.2.1).
static bool make_flat(struct gltf_build *build, struct part *part)
{
    struct scene_vertex *flat = malloc(((size_t)part->index_count + 1) * sizeof *flat);
    if (flat == NULL)
        return no_memory(build);
    for (uint32_t i = 0; i < part->index_count; i += 3) {
        int16_t normal[2];
        for (uint32_t k = i; k < i + 3; k++) {
            flat[k] = part->vertices[part->indices[k]];
            part->indices[k] = k;
        }
        face_normal(flat + i, normal);
        for (uint32_t k = i; k < i + 3; k++) {
            memcpy(flat[k].normal, normal, sizeof normal);
            flat[k].tangent[3] = 0;
        }
    }
    free(part->vertices);
    part->vertices = flat;
    part->vertex_count = part->index_count;
    return true;
}

// Drops vertices that no triangle uses: exporters let many primitives share one large table.
static bool compact(struct gltf_build *build, struct part *part)
{
    uint32_t *place = malloc(((size_t)part->vertex_count + 1) * sizeof *place);
    if (place == NULL)
        return no_memory(build);
    memset(place, 0, (size_t)part->vertex_count * sizeof *place);
    for (uint32_t i = 0; i < part->index_count; i++)
        place[part->indices[i]] = 1;
    uint32_t used = 0;
    for (uint32_t i = 0; i < part->vertex_count; i++)
        if (place[i] != 0) {
            part->vertices[used] = part->vertices[i];
            place[i] = used++;
        }
    for (uint32_t i = 0; i < part->index_count; i++)
        part->indices[i] = place[part->indices[i]];
    part->vertex_count = used;
    free(place);
    return true;
}

// Grows an array to hold `more` entries beyond `count`; capacity doubles so that many primitives stay cheap.
static bool reserve(void **array, uint32_t *capacity, uint32_t count, uint32_t more, size_t size)
{
    if (more <= *capacity - count)
        return true;
    uint64_t wanted =
        (uint64_t)*capacity * 2 > (uint64_t)count + more ? (uint64_t)*capacity * 2 : (uint64_t)count + more;
    void *grown = wanted <= UINT32_MAX ? realloc(*array, (size_t)wanted * size) : NULL;
    if (grown == NULL)
        return false;
    *array = grown;
    *capacity = (uint32_t)wanted;
    return true;
}

struct capacities {
    uint32_t vertices, indices, submodels;
};

static bool append(struct gltf_build *build, const struct part *part, uint32_t material,
                   struct capacities *room)
{
    struct scene *scene = build->scene;
    // What scene_split can give.
    uint32_t pieces = part->index_count / 3 / SCENE_SUBMODEL_TRIANGLES + 1;
    void *vertices = scene->vertices, *indices = scene->indices, *submodels = scene->submodels;
    bool ok =
        reserve(&vertices, &room->vertices, scene->vertex_count, part->vertex_count, sizeof *scene->vertices);
    ok = ok && reserve(&indices, &room->indices, scene->index_count, part->index_count, sizeof *scene->indices);
    ok = ok && reserve(&submodels, &room->submodels, scene->submodel_count, pieces, sizeof *scene->submodels);
    scene->vertices = vertices;
    scene->indices = indices;
    scene->submodels = submodels;
    if (!ok)
        return no_memory(build);
    memcpy(scene->vertices + scene->vertex_count, part->vertices, part->vertex_count * sizeof *part->vertices);
    uint32_t *to = scene->indices + scene->index_count;
    for (uint32_t i = 0; i < part->index_count; i++)
        to[i] = part->indices[i] + scene->vertex_count;
    scene->vertex_count += part->vertex_count;
    scene->submodel_count +=
        scene_split(scene->vertices, scene->vertex_count, to, part->index_count, scene->index_count, material,
                    scene->submodels + scene->submodel_count);
    scene->index_count += part->index_count;
    return true;
}

static bool build_primitive(struct gltf_build *build, const struct gltf_primitive *p, struct capacities *room)
{
    struct part part = {0};
    uint32_t material = p->material >= 0 ? (uint32_t)p->material : build->scene->material_count - 1;
    bool ok = read_vertices(build, p, &part) && read_triangles(build, p, &part);
    if (ok && p->attribute[GLTF_NORMAL] == -1)
        ok = make_flat(build, &part);
    ok = ok && compact(build, &part);
    if (ok && part.index_count > 0) {
        scene_make_tangents(part.vertices, part.vertex_count, part.indices, part.index_count);
        ok = append(build, &part, material, room);
    }
    free(part.vertices);
    free(part.indices);
    return ok;
}

bool gltf_build_meshes(struct gltf_build *build)
{
    const struct gltf_document *d = build->document;
    struct scene *scene = build->scene;
    struct capacities room = {0, 0, 0};
    scene->meshes = calloc(d->mesh_count + 1u, sizeof *scene->meshes);
    gltf_at(&build->report, "meshes");
    if (scene->meshes == NULL)
        return no_memory(build);
    scene->mesh_count = d->mesh_count;
    for (uint32_t i = 0; i < d->mesh_count; i++) {
        scene->meshes[i].first_submodel = scene->submodel_count;
        for (uint32_t k = 0; k < d->meshes[i].primitive_count; k++) {
            const struct gltf_primitive *p = &d->primitives[d->meshes[i].first_primitive + k];
            gltf_at(&build->report, "meshes[%u].primitives[%u]", i, k);
            if (p->mode >= 4 && !build_primitive(build, p, &room))
                return false;
        }
        scene->meshes[i].submodel_count = scene->submodel_count - scene->meshes[i].first_submodel;
    }
    gltf_at(&build->report, "meshes");
    return scene->index_count > 0 || gltf_fail(&build->report, "the file has no triangle");
}
