// The basin with its armillary sphere, potted trees and shrubs.
#include "stimuli/builtin/atrium_parts.h"
#include "stimuli/builtin/random.h"

#include <math.h>

#define PI 3.14159265358979f
#define COUNT(a) (sizeof(a) / sizeof(a)[0])

static void add_sphere(const struct atrium *atrium, struct solid_place centre)
{
    struct solid_brush bronze = atrium_brush(atrium, ATRIUM_BRONZE, centre);
    static const float tilts[4] = {0, 1.1f, 2.2f, 0.5f};
    for (int i = 0; i < 4; i++) {
        struct solid_place p = solid_place(0, 0, 0, tilts[i]);
        float c = cosf(0.41f * (float)i), s = sinf(0.41f * (float)i);
        for (int k = 0; k < 3; k++) {
            bronze.place.x[k] = c * p.x[k] + s * p.y[k];
            bronze.place.y[k] = c * p.y[k] - s * p.x[k];
            bronze.place.z[k] = p.z[k];
        }
        solid_ring(&bronze, 0.52f - 0.035f * (float)i, 0.017f, 48, 8);
    }
    // A level ring: the horizon.
    const float level[3][3] = {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}};
    for (int k = 0; k < 3; k++) {
        bronze.place.x[k] = level[0][k];
        bronze.place.y[k] = level[1][k];
        bronze.place.z[k] = level[2][k];
    }
    solid_ring(&bronze, 0.56f, 0.022f, 48, 8);
    bronze.place = centre;
    static const struct solid_corner globe[] = {
        {0.001f, -0.56f, SOLID_LINE, 1},
        {0.014f, -0.55f, SOLID_LINE, 4},
        {0.014f, -0.14f, SOLID_OVOLO, 12},
        {0.15f, 0, SOLID_COVE, 0},
    };
    static const struct solid_corner cap[] = {{0.15f, 0, SOLID_COVE, 12},
                                              {0.014f, 0.14f, SOLID_LINE, 4},
                                              {0.014f, 0.60f, SOLID_LINE, 2},
                                              {0.001f, 0.68f, SOLID_LINE, 0}};
    solid_lathe(&bronze, globe, COUNT(globe), 40);
    solid_lathe(&bronze, cap, COUNT(cap), 40);
}

void atrium_add_fountain(const struct atrium *atrium)
{
    struct solid_place centre = solid_place(0, 0, 0, 0);
    struct solid_brush stone = atrium_brush(atrium, ATRIUM_STONE, centre);
    static const struct solid_corner basin[] = {
        {1.75f, 0, SOLID_LINE, 1},     {1.75f, 0.14f, SOLID_LINE, 2},  {1.45f, 0.14f, SOLID_TORUS, 6},
        {1.45f, 0.24f, SOLID_COVE, 6}, {1.38f, 0.30f, SOLID_LINE, 2},  {1.38f, 0.46f, SOLID_COVE, 6},
        {1.55f, 0.58f, SOLID_LINE, 1}, {1.55f, 0.64f, SOLID_OVOLO, 4}, {1.52f, 0.67f, SOLID_LINE, 2},
        {1.30f, 0.67f, SOLID_LINE, 2}, {1.28f, 0.40f, SOLID_LINE, 0},
    };
    solid_lathe(&stone, basin, COUNT(basin), 64);
    static const struct solid_corner surface[] = {{1.29f, 0.58f, SOLID_LINE, 10}, {0.1f, 0.58f, SOLID_LINE, 0}};
    struct solid_brush water = atrium_brush(atrium, ATRIUM_WATER, centre);
    solid_lathe(&water, surface, COUNT(surface), 64);
    static const struct solid_corner stem[] = {
        {0.42f, 0.5f, SOLID_LINE, 1},   {0.42f, 0.66f, SOLID_COVE, 6},  {0.20f, 0.84f, SOLID_TORUS, 6},
        {0.20f, 0.92f, SOLID_SHAFT, 8}, {0.16f, 1.22f, SOLID_OVOLO, 8}, {0.74f, 1.46f, SOLID_LINE, 1},
        {0.76f, 1.50f, SOLID_LINE, 1},  {0.70f, 1.52f, SOLID_LINE, 3},  {0.24f, 1.42f, SOLID_LINE, 1},
        {0.24f, 1.56f, SOLID_COVE, 6},  {0.12f, 1.72f, SOLID_TORUS, 5}, {0.12f, 1.78f, SOLID_LINE, 1},
        {0.16f, 1.86f, SOLID_LINE, 2},  {0.02f, 1.88f, SOLID_LINE, 0},
    };
    solid_lathe(&stone, stem, COUNT(stem), 40);
    static const struct solid_corner pool[] = {{0.71f, 1.495f, SOLID_LINE, 5}, {0.2f, 1.495f, SOLID_LINE, 0}};
    solid_lathe(&water, pool, COUNT(pool), 48);
    add_sphere(atrium, solid_place(0, 2.42f, 0, 0.4f));
}

struct blade {
    float foot[3], along[3], side[3], normal[3];
    float length, width, bend;
};

static void blade_surface(const void *shape, float u, float v, float p[3], float uv[2])
{
    const struct blade *b = shape;
    float out = b->bend * v * v * b->length, fold = 0.25f * b->width * fabsf(u - 0.5f);
    for (int i = 0; i < 3; i++)
        p[i] = b->foot[i] + b->along[i] * b->length * v + b->side[i] * b->width * (u - 0.5f) +
               b->normal[i] * (fold - out);
    uv[0] = u;
    uv[1] = 1 - v;
}

static void normalise(float v[3])
{
    float n = sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++)
        v[i] /= n;
}

static void add_leaf(const struct solid_brush *brush, const float foot[3], float yaw, float rise,
                     float length_m, float bend)
{
    struct blade b = {.length = length_m, .width = length_m * 0.8f, .bend = bend};
    float c = cosf(yaw), s = sinf(yaw), level = cosf(rise), up = sinf(rise);
    for (int i = 0; i < 3; i++)
        b.foot[i] = foot[i];
    b.along[0] = c * level, b.along[1] = up, b.along[2] = s * level;
    b.side[0] = s, b.side[1] = 0, b.side[2] = -c;
    // side x along points outwards-and-up, so that leaves show their upper side.
    b.normal[0] = b.side[1] * b.along[2] - b.side[2] * b.along[1];
    b.normal[1] = b.side[2] * b.along[0] - b.side[0] * b.along[2];
    b.normal[2] = b.side[0] * b.along[1] - b.side[1] * b.along[0];
    normalise(b.normal);
    solid_patch(brush, &b, blade_surface, 2, 2);
}

static void add_pot(const struct atrium *atrium, struct solid_place foot, float size)
{
    const struct solid_corner pot[] = {
        {0.19f * size, 0, SOLID_LINE, 1},
        {0.19f * size, 0.03f * size, SOLID_LINE, 1},
        {0.16f * size, 0.05f * size, SOLID_OVOLO, 8},
        {0.30f * size, 0.36f * size, SOLID_LINE, 1},
        {0.27f * size, 0.42f * size, SOLID_LINE, 1},
        {0.32f * size, 0.44f * size, SOLID_TORUS, 6},
        {0.32f * size, 0.50f * size, SOLID_LINE, 1},
        {0.27f * size, 0.50f * size, SOLID_LINE, 2},
        {0.26f * size, 0.40f * size, SOLID_LINE, 0},
    };
    struct solid_brush clay = atrium_brush(atrium, ATRIUM_TERRACOTTA, foot);
    solid_lathe(&clay, pot, COUNT(pot), 20);
    const struct solid_corner earth[] = {{0.268f * size, 0.45f * size, SOLID_LINE, 2},
                                         {0.001f, 0.47f * size, SOLID_LINE, 0}};
    struct solid_brush soil = atrium_brush(atrium, ATRIUM_SOIL, foot);
    solid_lathe(&soil, earth, COUNT(earth), 24);
}

// A clipped orange tree: a stem and a ball of leaves.
static void add_tree(const struct atrium *atrium, struct solid_place foot, uint64_t seed)
{
    add_pot(atrium, foot, 1.35f);
    float turn = random_range(71, seed, -0.05f, 0.05f), height = random_range(72, seed, 1.65f, 1.95f);
    const struct solid_corner stem[] = {
        {0.05f, 0.6f, SOLID_LINE, 6}, {0.035f, height, SOLID_LINE, 1}, {0.002f, height + 0.02f, SOLID_LINE, 0}};
    struct solid_brush wood = atrium_brush(atrium, ATRIUM_WOOD, foot);
    solid_lathe(&wood, stem, COUNT(stem), 10);
    struct solid_brush leaf = atrium_brush(atrium, ATRIUM_LEAF, foot);
    for (uint32_t i = 0; i < 400; i++) {
        float y = 1 - 2 * ((float)i + 0.5f) / 400, a = (float)i * 2.39996f + turn;
        float r = 0.56f * (0.62f + 0.40f * sqrtf(random_unit(73, seed * 4096 + i)));
        float level = sqrtf(1 - y * y);
        float at[3] = {r * level * cosf(a), height + 0.18f + r * y, r * level * sinf(a)};
        float rise = 1.1f * y + random_range(74, seed * 4096 + i, -0.5f, 0.5f);
        add_leaf(&leaf, at, a + random_range(75, seed * 4096 + i, -0.9f, 0.9f), rise,
                 random_range(76, seed * 4096 + i, 0.14f, 0.22f), 0.25f);
    }
}

// A low plant of long arching leaves.
static void add_shrub(const struct atrium *atrium, struct solid_place foot, uint64_t seed)
{
    add_pot(atrium, foot, 1.0f);
    struct solid_brush leaf = atrium_brush(atrium, ATRIUM_LEAF, foot);
    for (uint32_t i = 0; i < 70; i++) {
        float a = (float)i * 2.39996f, rise = 1.45f - 1.2f * sqrtf((float)i / 70);
        float at[3] = {0.09f * cosf(a), 0.46f, 0.09f * sinf(a)};
        add_leaf(&leaf, at, a, rise, random_range(77, seed * 128 + i, 0.35f, 0.62f), 0.55f);
    }
}

void atrium_add_plants(const struct atrium *atrium)
{
    for (uint32_t i = 0; i < 4; i++) {
        float x = i & 1 ? 1.0f : -1.0f, z = i & 2 ? 1.0f : -1.0f;
        add_tree(atrium, solid_place(x * 10.9f, 0, z * 3.4f, (float)i), i);
        add_tree(atrium, solid_place(x * 3.0f, 0, z * 3.75f, (float)i + 2), i + 4);
        add_shrub(atrium, solid_place(x * 11.1f, 0, z * 2.35f, (float)i), i);
        add_shrub(atrium, solid_place(x * 6.0f, ATRIUM_STEP, z * 7.05f, (float)i), i + 4);
        add_shrub(atrium, solid_place(x * 2.1f, 0, z * 0.9f, (float)i), i + 8);
    }
}
