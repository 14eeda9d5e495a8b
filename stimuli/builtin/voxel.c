#include "stimuli/builtin/voxel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { REACH = 10 }; // cells that a ray looks for open sky

bool voxel_create(struct voxel_model *model, int32_t x, int32_t y, int32_t z, float cell_m)
{
    *model = (struct voxel_model){.size = {x, y, z}, .cell_m = cell_m};
    model->cells = calloc((size_t)x * (size_t)y * (size_t)z, 1);
    // Centred over the origin, standing on it.
    model->origin[0] = -0.5f * (float)x * cell_m;
    model->origin[2] = -0.5f * (float)z * cell_m;
    return model->cells != NULL;
}

void voxel_destroy(struct voxel_model *model)
{
    free(model->cells);
    *model = (struct voxel_model){0};
}

uint8_t voxel_at(const struct voxel_model *model, int32_t x, int32_t y, int32_t z)
{
    if (x < 0 || y < 0 || z < 0 || x >= model->size[0] || y >= model->size[1] || z >= model->size[2])
        return VOXEL_AIR;
    return model->cells[(z * model->size[1] + y) * model->size[0] + x];
}

void voxel_put(struct voxel_model *model, int32_t x, int32_t y, int32_t z, uint8_t kind)
{
    if (x < 0 || y < 0 || z < 0 || x >= model->size[0] || y >= model->size[1] || z >= model->size[2])
        return;
    model->cells[(z * model->size[1] + y) * model->size[0] + x] = kind;
}

void voxel_fill(struct voxel_model *model, const int32_t a[3], const int32_t b[3], uint8_t kind)
{
    for (int32_t z = a[2]; z < b[2]; z++)
        for (int32_t y = a[1]; y < b[1]; y++)
            for (int32_t x = a[0]; x < b[0]; x++)
                voxel_put(model, x, y, z, kind);
}

// One layer of faces in one direction.
struct layer {
    const struct voxel_model *model;
    const struct voxel_style *style;
    struct maker *maker;
    int axis, u, v;   // u, v: the other two axes, cross(u, v) = axis
    int32_t sign, at; // faces between cell `at` and at + sign
    uint32_t *keys;   // kind and corner shading per cell, 0: no face
    int64_t *shared;  // per lattice point: key and vertex made there last
    uint32_t quads;
};

static uint8_t cell_of(const struct layer *l, int32_t at, int32_t u, int32_t v)
{
    int32_t c[3];
    c[l->axis] = at;
    c[l->u] = u;
    c[l->v] = v;
    return voxel_at(l->model, c[0], c[1], c[2]);
}

static bool face_shown(const struct layer *l, uint8_t own, uint8_t next)
{
    if (own == VOXEL_AIR)
        return false;
    if (l->axis == 1 && l->sign < 0 && l->at == 0 && !l->style->floating)
        return false;
    if (next == VOXEL_AIR)
        return true;
    bool own_leafy = l->style->kinds[own].leafy, next_leafy = l->style->kinds[next].leafy;
    if (own_leafy)
        return next_leafy && l->sign > 0; // towards another leafy cell once
    return next_leafy;
}

static bool blocks(const struct layer *l, int32_t u, int32_t v)
{
    return cell_of(l, l->at + l->sign, u, v) != VOXEL_AIR;
}

// 0..3 for each corner (00, 10, 01, 11): how many of the three cells around it stand before the face.
static uint32_t corner_shading(const struct layer *l, int32_t u, int32_t v)
{
    uint32_t packed = 0;
    for (int corner = 0; corner < 4; corner++) {
        int32_t du = corner & 1 ? 1 : -1, dv = corner & 2 ? 1 : -1;
        uint32_t a = blocks(l, u + du, v), b = blocks(l, u, v + dv), c = blocks(l, u + du, v + dv);
        packed |= (a && b ? 3 : a + b + c) << (2 * corner);
    }
    return packed;
}

static void fill_keys(struct layer *l)
{
    int32_t nu = l->model->size[l->u], nv = l->model->size[l->v];
    for (int32_t v = 0; v < nv; v++) {
        for (int32_t u = 0; u < nu; u++) {
            uint8_t own = cell_of(l, l->at, u, v);
            bool shown = own != VOXEL_AIR && face_shown(l, own, cell_of(l, l->at + l->sign, u, v));
            bool leafy = shown && l->style->kinds[own].leafy;
            l->keys[v * nu + u] =
                shown ? (uint32_t)own << 8 | (leafy || l->style->plain ? 0 : corner_shading(l, u, v)) : 0;
        }
    }
}

static const float rays[][3] = {
    {0, 1, 0},           {0.5f, 0.87f, 0},     {-0.5f, 0.87f, 0},   {0, 0.87f, 0.5f},     {0, 0.87f, -0.5f},
    {0.6f, 0.5f, 0.6f},  {-0.6f, 0.5f, 0.6f},  {0.6f, 0.5f, -0.6f}, {-0.6f, 0.5f, -0.6f}, {0.95f, 0.25f, 0.1f},
    {-0.95f, 0.25f, 0},  {0.1f, 0.25f, 0.95f}, {0, 0.25f, -0.95f},  {0.9f, -0.3f, 0.2f},  {-0.9f, -0.3f, 0.2f},
    {0.2f, -0.3f, 0.9f}, {0.2f, -0.3f, -0.9f},
};

// Share of sky and of the lit ground around that a lattice point sees before a face.
static float open_share(const struct layer *l, const int32_t point[3])
{
    float sum = 0, all = 0;
    for (size_t i = 0; i < sizeof rays / sizeof rays[0]; i++) {
        float facing = rays[i][l->axis] * (float)l->sign;
        if (facing < 0.05f)
            continue;
        float weight = facing * (rays[i][1] > 0 ? 1.0f : 0.6f), through = 1;
        for (int step = 0; step < REACH && through > 0.05f; step++) {
            float t = 0.7f + 1.1f * (float)step;
            int32_t c[3];
            for (int k = 0; k < 3; k++)
                c[k] = (int32_t)floorf((float)point[k] + (k == l->axis ? 0.5f * (float)l->sign : 0) +
                                       rays[i][k] * t);
            uint8_t kind = voxel_at(l->model, c[0], c[1], c[2]);
            if (kind != VOXEL_AIR)
                through *= l->style->kinds[kind].leafy ? 0.72f : 0.0f;
        }
        sum += weight * through;
        all += weight;
    }
    return all > 0 ? sum / all : 1;
}

static void set_texture_frame(const struct layer *l, struct maker_vertex *vertex, float tile_m)
{
    const float *p = vertex->position;
    float sign = (float)l->sign;
    vertex->normal[l->axis] = sign;
    vertex->tangent[3] = 1;
    if (l->axis == 0) {
        vertex->tangent[2] = -sign;
        vertex->uv[0] = -sign * p[2] / tile_m;
        vertex->uv[1] = -p[1] / tile_m;
    } else if (l->axis == 2) {
        vertex->tangent[0] = sign;
        vertex->uv[0] = sign * p[0] / tile_m;
        vertex->uv[1] = -p[1] / tile_m;
    } else {
        vertex->tangent[0] = 1;
        vertex->uv[0] = p[0] / tile_m;
        vertex->uv[1] = sign * p[2] / tile_m;
    }
}

static uint32_t material_of(const struct layer *l, const struct voxel_kind *kind)
{
    return l->axis != 1 ? kind->side : l->sign > 0 ? kind->top : kind->bottom;
}

static uint32_t lattice_vertex(struct layer *l, uint32_t key, int32_t u, int32_t v, uint32_t shading)
{
    int64_t tag = (int64_t)(key >> 8) * 4 + shading + 1;
    int64_t *last = &l->shared[v * (l->model->size[l->u] + 1) + u];
    if (*last >> 32 == tag)
        return (uint32_t)(*last & 0xffffffff);
    static const float corner_light[4] = {1.0f, 0.78f, 0.62f, 0.5f};
    const struct voxel_kind *kind = &l->style->kinds[key >> 8];
    int32_t point[3];
    point[l->axis] = l->at + (l->sign > 0 ? 1 : 0);
    point[l->u] = u;
    point[l->v] = v;
    struct maker_vertex vertex = {0};
    for (int k = 0; k < 3; k++)
        vertex.position[k] = l->model->origin[k] + (float)point[k] * l->model->cell_m;
    set_texture_frame(l, &vertex, kind->tile_m);
    vertex.colour[0] = vertex.colour[1] = vertex.colour[2] = 1;
    vertex.hidden = 1 - (0.30f + 0.70f * open_share(l, point)) * corner_light[shading];
    uint32_t made = maker_vertex(l->maker, material_of(l, kind), &vertex);
    *last = tag << 32 | made;
    return made;
}

static void add_quad(struct layer *l, uint32_t key, int32_t u, int32_t v, int32_t width, int32_t height)
{
    l->quads++;
    if (l->maker == NULL)
        return;
    uint32_t shading[4], corner[4]; // 00, 10, 01, 11
    for (int i = 0; i < 4; i++) {
        shading[i] = key >> (2 * i) & 3;
        corner[i] = lattice_vertex(l, key, i & 1 ? u + width : u, i & 2 ? v + height : v, shading[i]);
    }
    uint32_t material = material_of(l, &l->style->kinds[key >> 8]);
    // The diagonal joins the darker pair, so that shading stays symmetric.
    bool other = shading[0] + shading[3] < shading[1] + shading[2];
    const uint32_t split[2][6] = {{0, 1, 3, 0, 3, 2}, {0, 1, 2, 1, 3, 2}};
    for (int t = 0; t < 6; t += 3) {
        const uint32_t *s = &split[other][t];
        uint32_t b = l->sign > 0 ? s[1] : s[2], c = l->sign > 0 ? s[2] : s[1];
        maker_triangle(l->maker, material, corner[s[0]], corner[b], corner[c]);
    }
}

static void merge_layer(struct layer *l)
{
    int32_t nu = l->model->size[l->u], nv = l->model->size[l->v], span = l->style->span;
    for (int32_t v = 0; v < nv; v++) {
        for (int32_t u = 0; u < nu; u++) {
            uint32_t key = l->keys[v * nu + u];
            if (key == 0)
                continue;
            uint32_t s0 = key & 3, s1 = key >> 2 & 3, s2 = key >> 4 & 3, s3 = key >> 6 & 3;
            int32_t width = 1, height = 1;
            if (s0 == s1 && s2 == s3)
                while (width < span && u + width < nu && l->keys[v * nu + u + width] == key)
                    width++;
            bool grows = s0 == s2 && s1 == s3;
            while (grows && height < span && v + height < nv) {
                for (int32_t i = 0; i < width && grows; i++)
                    grows = l->keys[(v + height) * nu + u + i] == key;
                height += grows;
            }
            for (int32_t j = 0; j < height; j++)
                memset(&l->keys[(v + j) * nu + u], 0, (size_t)width * sizeof *l->keys);
            add_quad(l, key, u, v, width, height);
        }
    }
}

uint32_t voxel_mesh(struct maker *maker, const struct voxel_model *model, const struct voxel_style *style)
{
    int32_t most = model->size[0] > model->size[1] ? model->size[0] : model->size[1];
    most = (most > model->size[2] ? most : model->size[2]) + 1;
    struct layer layer = {.model = model, .style = style, .maker = maker};
    layer.keys = malloc((size_t)most * (size_t)most * sizeof *layer.keys);
    layer.shared = malloc((size_t)most * (size_t)most * sizeof *layer.shared);
    if (layer.keys == NULL || layer.shared == NULL) {
        if (maker != NULL)
            maker->failed = true;
    } else {
        for (int side = 0; side < 6; side++) {
            layer.axis = side / 2;
            layer.u = (layer.axis + 1) % 3;
            layer.v = (layer.axis + 2) % 3;
            layer.sign = side & 1 ? 1 : -1;
            for (layer.at = 0; layer.at < model->size[layer.axis]; layer.at++) {
                memset(layer.shared, 0, (size_t)most * (size_t)most * sizeof *layer.shared);
                fill_keys(&layer);
                merge_layer(&layer);
            }
        }
    }
    free(layer.keys);
    free(layer.shared);
    return 2 * layer.quads;
}
