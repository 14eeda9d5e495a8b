#include "stimuli/builtin/visibility.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

enum { SKY_MAP = 272 }; // texels a side, about 0.13 m in a court of 33 m

struct depth_map {
    float right[3], up[3], towards[3]; // orthonormal; towards the light
    float low[2], scale;               // texel = (dot - low) * scale
    int32_t size;
    float *depth; // the greatest distance along `towards`; owned by the caller
};

static inline float least(float a, float b)
{
    return a < b ? a : b;
}

static inline float most(float a, float b)
{
    return a > b ? a : b;
}

static inline float dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

void visibility_sky(const struct scene_sky *sky, float height, float out[3])
{
    const float *other = height > 0 ? sky->zenith : sky->ground;
    float share = fminf(fabsf(height), 1);
    for (int i = 0; i < 3; i++)
        out[i] = sky->horizon[i] + (other[i] - sky->horizon[i]) * share;
}

static void map_axes(struct depth_map *map, const float towards[3])
{
    float a[3] = {fabsf(towards[1]) < 0.9f ? 0.0f : 1.0f, fabsf(towards[1]) < 0.9f ? 1.0f : 0.0f, 0};
    const float *t = towards;
    float r[3] = {a[1] * t[2] - a[2] * t[1], a[2] * t[0] - a[0] * t[2], a[0] * t[1] - a[1] * t[0]};
    float n = 1 / sqrtf(dot(r, r));
    for (int i = 0; i < 3; i++) {
        map->right[i] = r[i] * n;
        map->towards[i] = t[i];
    }
    r[0] = map->right[0], r[1] = map->right[1], r[2] = map->right[2];
    map->up[0] = t[1] * r[2] - t[2] * r[1];
    map->up[1] = t[2] * r[0] - t[0] * r[2];
    map->up[2] = t[0] * r[1] - t[1] * r[0];
}

static void map_bounds(struct depth_map *map, const struct maker *maker)
{
    float high[2] = {-FLT_MAX, -FLT_MAX};
    map->low[0] = map->low[1] = FLT_MAX;
    for (uint32_t m = 0; m < MAKER_MATERIALS; m++) {
        const struct maker_bucket *b = &maker->buckets[m];
        for (uint32_t i = 0; i < b->vertex_count; i++) {
            float at[2] = {dot(b->vertices[i].position, map->right), dot(b->vertices[i].position, map->up)};
            for (int k = 0; k < 2; k++) {
                map->low[k] = least(map->low[k], at[k]);
                high[k] = most(high[k], at[k]);
            }
        }
    }
    float span = most(high[0] - map->low[0], high[1] - map->low[1]) + 0.01f;
    map->scale = (float)map->size / span;
}

static void to_map(const struct depth_map *map, const float p[3], float out[3])
{
    out[0] = (dot(p, map->right) - map->low[0]) * map->scale;
    out[1] = (dot(p, map->up) - map->low[1]) * map->scale;
    out[2] = dot(p, map->towards);
}

static void write_depth(const struct depth_map *map, int32_t x, int32_t y, float depth)
{
    if (x < 0 || y < 0 || x >= map->size || y >= map->size)
        return;
    float *to = &map->depth[y * map->size + x];
    *to = most(*to, depth);
}

static void draw_triangle(const struct depth_map *map, const float a[3], const float b[3], const float c[3])
{
    int32_t x0 = (int32_t)floorf(least(a[0], least(b[0], c[0]))), x1 = (int32_t)most(a[0], most(b[0], c[0]));
    int32_t y0 = (int32_t)floorf(least(a[1], least(b[1], c[1]))), y1 = (int32_t)most(a[1], most(b[1], c[1]));
    float area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if (x1 - x0 <= 1 && y1 - y0 <= 1) {
        write_depth(map, (int32_t)((a[0] + b[0] + c[0]) / 3), (int32_t)((a[1] + b[1] + c[1]) / 3),
                    (a[2] + b[2] + c[2]) / 3);
        return;
    }
    if (fabsf(area) < 1e-6f)
        return;
    float inverse = 1 / area;
    for (int32_t y = y0; y <= y1; y++) {
        for (int32_t x = x0; x <= x1; x++) {
            float px = (float)x + 0.5f, py = (float)y + 0.5f;
            float u = ((c[1] - a[1]) * (px - a[0]) - (c[0] - a[0]) * (py - a[1])) * inverse;
            float v = ((b[0] - a[0]) * (py - a[1]) - (b[1] - a[1]) * (px - a[0])) * inverse;
            if (u >= -1e-4f && v >= -1e-4f && u + v <= 1.0001f)
                write_depth(map, x, y, a[2] + (b[2] - a[2]) * u + (c[2] - a[2]) * v);
        }
    }
}

static void draw_map(struct depth_map *map, const struct maker *maker, const float towards[3],
                     uint32_t open_material, float *projected)
{
    map_axes(map, towards);
    map_bounds(map, maker);
    for (int32_t i = 0; i < map->size * map->size; i++)
        map->depth[i] = -FLT_MAX;
    for (uint32_t m = 0; m < MAKER_MATERIALS; m++) {
        const struct maker_bucket *b = &maker->buckets[m];
        if (m == open_material)
            continue;
        for (uint32_t i = 0; i < b->vertex_count; i++)
            to_map(map, b->vertices[i].position, &projected[i * 3]);
        for (uint32_t i = 0; i < b->index_count; i += 3)
            draw_triangle(map, &projected[b->indices[i] * 3], &projected[b->indices[i + 1] * 3],
                          &projected[b->indices[i + 2] * 3]);
    }
}

static bool open_at(const struct depth_map *map, float x, float y, float depth)
{
    int32_t ix = (int32_t)floorf(x), iy = (int32_t)floorf(y);
    if (ix < 0 || iy < 0 || ix >= map->size || iy >= map->size)
        return true;
    return map->depth[iy * map->size + ix] <= depth;
}

// Evenly over the sphere (Fibonacci).
static void direction_of(uint32_t i, uint32_t count, float out[3])
{
    float y = 1 - 2 * ((float)i + 0.5f) / (float)count, r = sqrtf(1 - y * y), a = (float)i * 2.39996323f;
    out[0] = r * cosf(a);
    out[1] = y;
    out[2] = r * sinf(a);
}

struct light_sum {
    float open[3], all;
};

static float facing(const struct scene_material *material, const struct maker_vertex *v, const float towards[3])
{
    float c = dot(v->normal, towards);
    // A thin sheet is lit from the side the eye is on; half of each is a fair share.
    return material->double_sided ? 0.5f * fabsf(c) + 0.1f : most(c, 0);
}

static void lift(const struct maker_vertex *v, const float towards[3], float metres, float out[3])
{
    float side = dot(v->normal, towards) < 0 ? -1.0f : 1.0f; // only double-sided sheets ask for their back
    for (int i = 0; i < 3; i++)
        out[i] = v->position[i] + side * v->normal[i] * metres;
}

static void add_sky(struct light_sum *sums, const struct maker *maker, const struct depth_map *map,
                    const struct visibility_desc *desc)
{
    float radiance[3];
    visibility_sky(desc->sky, map->towards[1], radiance);
    if (map->towards[1] < 0)
        for (int i = 0; i < 3; i++)
            radiance[i] = desc->below[i];
    for (uint32_t m = 0, s = 0; m < MAKER_MATERIALS; m++) {
        const struct maker_bucket *b = &maker->buckets[m];
        for (uint32_t i = 0; i < b->vertex_count; i++, s++) {
            float weight = facing(&maker->scene->materials[m], &b->vertices[i], map->towards), p[3], at[3];
            if (weight <= 0)
                continue;
            lift(&b->vertices[i], map->towards, desc->lift_m, p);
            to_map(map, p, at);
            bool open = open_at(map, at[0], at[1], at[2] + 0.5f / map->scale);
            sums[s].all += weight;
            for (int k = 0; k < 3; k++)
                sums[s].open[k] += weight * (open ? radiance[k] : desc->bounce[k]);
        }
    }
}

static float brightness(const float c[3])
{
    return 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2]; // ITU-R BT.709
}

static void write_shares(const struct light_sum *sums, const struct maker *maker,
                         const struct visibility_desc *desc)
{
    for (uint32_t m = 0, s = 0; m < MAKER_MATERIALS; m++) {
        struct maker_bucket *b = (struct maker_bucket *)&maker->buckets[m];
        for (uint32_t i = 0; i < b->vertex_count; i++, s++) {
            float full[3];
            visibility_sky(desc->sky, b->vertices[i].normal[1], full);
            if (sums[s].all > 0)
                b->vertices[i].hidden =
                    1 - least(brightness(sums[s].open) / (sums[s].all * brightness(full)), 1);
        }
    }
}

bool visibility_bake(struct maker *maker, const struct visibility_desc *desc)
{
    size_t vertices = 0, largest = 1;
    for (uint32_t m = 0; m < MAKER_MATERIALS; m++) {
        vertices += maker->buckets[m].vertex_count;
        largest = maker->buckets[m].vertex_count > largest ? maker->buckets[m].vertex_count : largest;
    }
    struct depth_map map = {.size = SKY_MAP, .depth = malloc(sizeof(float) * SKY_MAP * SKY_MAP)};
    float *projected = malloc(sizeof(float) * 3 * largest);
    struct light_sum *sums = calloc(vertices + 1, sizeof *sums);
    bool ok = map.depth != NULL && projected != NULL && sums != NULL;
    if (ok) {
        float towards[3];
        for (uint32_t i = 0; i < desc->directions; i++) {
            direction_of(i, desc->directions, towards);
            draw_map(&map, maker, towards, desc->open_material, projected);
            add_sky(sums, maker, &map, desc);
        }
        write_shares(sums, maker, desc);
    }
    free(sums);
    free(projected);
    free(map.depth);
    return ok;
}
