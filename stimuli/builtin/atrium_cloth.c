// Banners over the balustrades, curtains in some arches: thin sheets with folds.
#include "stimuli/builtin/atrium_parts.h"
#include "stimuli/builtin/random.h"

#include <math.h>

#define PI 3.14159265358979f

struct banner {
    float width, length, folds, depth, phase;
    float over; // hangs over a rail: this much of it lies behind
};

static void banner_surface(const void *shape, float u, float v, float p[3], float uv[2])
{
    const struct banner *b = shape;
    // v from the lower hem to the top; folds fade in below the top.
    float down = (1 - v) * b->length, free = fminf(down / b->length * 1.6f, 1);
    float a = u * b->folds * 2 * PI + b->phase, sway = 0.35f * sinf(down * 1.9f + b->phase);
    float gather = 1 - 0.10f * free;
    p[0] = (u - 0.5f) * b->width * gather + 0.01f * free * sinf(a * 2);
    p[1] = -down + 0.015f * free * cosf(a + 1);
    p[2] = b->depth * free * (0.8f * sinf(a + sway) + 0.25f * sinf(1.7f * a + 2 * sway)) + 0.06f * free * sway;
    // A hem that swings in a little.
    p[2] += 0.05f * powf(fminf(down / b->length, 1), 3);
    uv[0] = u * b->width * 1.15f;
    uv[1] = down;
}

static void add_banner(const struct atrium *atrium, struct solid_place bay, uint32_t number)
{
    if (number % 2 != 1 || (number >= 8 && number <= 10) || number >= 19)
        return;
    static const enum atrium_material colours[3] = {ATRIUM_RED, ATRIUM_GOLD, ATRIUM_BLUE};
    struct solid_brush cloth =
        atrium_brush(atrium, colours[number / 2 % 3], atrium_at(bay, 0, ATRIUM_GALLERY + 0.99f, 0.24f));
    struct banner b = {.width = 1.25f, .length = 2.9f, .folds = 4.5f, .depth = 0.06f};
    b.phase = random_range(61, number, 0, 6);
    solid_patch(&cloth, &b, banner_surface, 38, 20);
}

struct curtain {
    float side; // -1: drawn to the left column, 1: to the right
    float phase;
};

static void curtain_surface(const void *shape, float u, float v, float p[3], float uv[2])
{
    const struct curtain *c = shape;
    // u from the column outwards, v from the floor up to the rod; a cord ties it at a third of its height.
    float length = 2.62f, tie = expf(-powf((v - 0.36f) / 0.16f, 2));
    float spread =
        v > 0.36f ? 0.22f + 0.86f * powf((v - 0.36f) / 0.64f, 1.4f) : 0.22f + 0.25f * (0.36f - v) / 0.36f;
    float folds = u * 5 * 2 * PI + c->phase, depth = (0.045f + 0.02f * v) * (1 - 0.6f * tie);
    float sag = -0.06f * powf(sinf(u * 5 * PI), 2) * powf(fmaxf(v, 0), 12);
    p[0] = c->side * (1.12f - u * spread);
    p[1] = length * v + sag;
    p[2] = depth * sinf(folds + 0.6f * sinf(v * 6)) + 0.008f * sinf(1.6f * folds);
    uv[0] = u * 1.7f;
    uv[1] = length * (1 - v);
}

static void add_curtain(const struct atrium *atrium, struct solid_place bay, uint32_t number)
{
    static const uint32_t hung[] = {1, 3, 5, 12, 14, 16};
    for (uint32_t i = 0; i < sizeof hung / sizeof hung[0]; i++) {
        if (hung[i] != number)
            continue;
        enum atrium_material colour = i % 3 == 0 ? ATRIUM_BLUE : i % 3 == 1 ? ATRIUM_RED : ATRIUM_GOLD;
        struct solid_place foot = atrium_at(bay, 0, ATRIUM_STEP + 0.03f, -ATRIUM_WALL / 2);
        struct solid_brush cloth = atrium_brush(atrium, colour, foot);
        for (int side = -1; side <= 1; side += 2) {
            struct curtain c = {(float)side, random_range(62, number * 2 + (side > 0), 0, 6)};
            solid_patch(&cloth, &c, curtain_surface, 60, 18);
        }
        struct solid_brush rod = atrium_brush(atrium, ATRIUM_BRONZE, atrium_at(foot, 0, 2.66f, 0));
        struct solid_place across = rod.place;
        for (int k = 0; k < 3; k++) { // the lathe's axis lies along the bay
            rod.place.x[k] = -across.y[k];
            rod.place.y[k] = across.x[k];
            rod.place.origin[k] -= 1.2f * across.x[k];
        }
        static const struct solid_corner bar[] = {{0.02f, 0, SOLID_LINE, 4}, {0.02f, 2.4f, SOLID_LINE, 0}};
        solid_lathe(&rod, bar, 2, 10);
    }
}

void atrium_add_cloth(const struct atrium *atrium)
{
    atrium_each_bay(atrium, add_banner);
    atrium_each_bay(atrium, add_curtain);
}
