// What runs around the court or fills openings: string courses, cornice, roof edge, balustrades, doors, court
// floor.
#include "stimuli/builtin/atrium_parts.h"

#include <math.h>

#define PI 3.14159265358979f
#define COUNT(a) (sizeof(a) / sizeof(a)[0])

static void add_mouldings(const struct atrium *atrium)
{
    struct solid_brush stone = atrium_brush(atrium, ATRIUM_STONE, solid_place(0, 0, 0, 0));
    static const struct solid_corner course[] = {
        {0, 4.44f, SOLID_LINE, 1},     {0.05f, 4.44f, SOLID_LINE, 1},  {0.05f, 4.50f, SOLID_COVE, 4},
        {0.13f, 4.58f, SOLID_LINE, 1}, {0.16f, 4.58f, SOLID_TORUS, 5}, {0.16f, 4.66f, SOLID_LINE, 1},
        {0.16f, 4.72f, SOLID_LINE, 3}, {-0.52f, 4.72f, SOLID_LINE, 0},
    };
    static const struct solid_corner cornice[] = {
        {0, 8.59f, SOLID_LINE, 1},     {0.05f, 8.59f, SOLID_LINE, 1}, {0.05f, 8.66f, SOLID_COVE, 5},
        {0.14f, 8.78f, SOLID_LINE, 1}, {0.14f, 8.98f, SOLID_LINE, 2}, {0.40f, 8.98f, SOLID_LINE, 1},
        {0.40f, 9.08f, SOLID_COVE, 5}, {0.50f, 9.20f, SOLID_LINE, 1}, {0.50f, 9.24f, SOLID_LINE, 4},
        {-2.9f, 10.0f, SOLID_LINE, 0},
    };
    solid_frame(&stone, course, COUNT(course), ATRIUM_HALF_X, ATRIUM_HALF_Z, 0.6f);
    solid_frame(&stone, cornice, COUNT(cornice), ATRIUM_HALF_X, ATRIUM_HALF_Z, 0.6f);
    static const struct solid_corner riser[] = {
        {0.22f, 0, SOLID_LINE, 1},      {0.22f, 0.09f, SOLID_LINE, 1},   {0.24f, 0.09f, SOLID_TORUS, 5},
        {0.24f, 0.166f, SOLID_LINE, 1}, {-0.02f, 0.166f, SOLID_LINE, 1}, {-0.02f, 0.158f, SOLID_LINE, 0}};
    solid_frame(&stone, riser, COUNT(riser), ATRIUM_HALF_X, ATRIUM_HALF_Z, 0.6f);
}

static void add_dentils(const struct atrium *atrium, struct solid_place bay, uint32_t number)
{
    (void)number;
    struct solid_brush stone = atrium_brush(atrium, ATRIUM_STONE, bay);
    const unsigned faces = SOLID_ALL & ~(unsigned)(SOLID_BACK | SOLID_TOP);
    for (int i = 0; i < 10; i++) {
        float x = -1.5f + 0.3f * ((float)i + 0.5f);
        solid_box(&stone, (float[]){x - 0.08f, 8.82f, 0.13f}, (float[]){x + 0.08f, 8.985f, 0.34f}, faces, 1);
    }
    // Rounded roof tiles over the cornice: half cylinders that rise away from the court.
    struct solid_brush tile = atrium_brush(atrium, ATRIUM_ROOF, bay);
    for (int i = 0; i < 10; i++) {
        float x = -1.5f + 0.3f * ((float)i + 0.5f), slope = 0.76f / 3.4f;
        for (int row = 0; row < 3; row++) {
            float z = 0.56f - 0.55f * (float)row;
            tile.place = atrium_at(bay, x, 9.25f + slope * (0.56f - z) + 0.01f, z);
            for (int k = 0; k < 3; k++) {
                tile.place.z[k] = (bay.z[k] - slope * bay.y[k]) / sqrtf(1 + slope * slope);
                tile.place.y[k] = (bay.y[k] + slope * bay.z[k]) / sqrtf(1 + slope * slope);
            }
            const struct solid_corner half[] = {
                {0.10f, 0, SOLID_LINE, 1}, {0.13f, 0, SOLID_LINE, 1}, {0.115f, -0.6f, SOLID_LINE, 0}};
            solid_arch(&tile, half, COUNT(half), 6);
        }
    }
}

static void add_balustrade(const struct atrium *atrium, struct solid_place bay, uint32_t number)
{
    (void)number;
    struct solid_brush stone = atrium_brush(atrium, ATRIUM_STONE, bay);
    const float y = ATRIUM_GALLERY, z = -ATRIUM_WALL / 2;
    const unsigned faces = SOLID_TOP | SOLID_BOTTOM | SOLID_FRONT | SOLID_BACK;
    solid_box(&stone, (float[]){-1.3f, y + 0.02f, z - 0.1f}, (float[]){1.3f, y + 0.14f, z + 0.1f},
              faces & ~(unsigned)SOLID_BOTTOM, 0.3f);
    solid_box(&stone, (float[]){-1.3f, y + 0.86f, z - 0.12f}, (float[]){1.3f, y + 0.93f, z + 0.12f}, faces,
              0.3f);
    solid_box(&stone, (float[]){-1.3f, y + 0.93f, z - 0.09f}, (float[]){1.3f, y + 0.98f, z + 0.09f},
              faces & ~(unsigned)SOLID_BOTTOM, 0.3f);
    static const struct solid_corner baluster[] = {
        {0.065f, 0, SOLID_LINE, 1},      {0.065f, 0.05f, SOLID_LINE, 1}, {0.04f, 0.05f, SOLID_COVE, 2},
        {0.035f, 0.12f, SOLID_OVOLO, 3}, {0.085f, 0.28f, SOLID_LINE, 2}, {0.032f, 0.56f, SOLID_TORUS, 2},
        {0.032f, 0.60f, SOLID_COVE, 2},  {0.065f, 0.67f, SOLID_LINE, 1}, {0.065f, 0.72f, SOLID_LINE, 0},
    };
    for (int i = 0; i < 6; i++) {
        stone.place = atrium_at(bay, -0.95f + 0.38f * (float)i, y + 0.14f, z);
        solid_lathe(&stone, baluster, COUNT(baluster), 8);
    }
}

struct leaf_door {
    float half, spring;
};

static void door_top(const void *shape, float u, float v, float p[3], float uv[2])
{
    const struct leaf_door *d = shape;
    float a = PI * (1 - u);
    p[0] = d->half * cosf(a) * (0.02f + 0.98f * v);
    p[1] = d->spring + d->half * sinf(a) * (0.02f + 0.98f * v);
    p[2] = 0;
    uv[0] = p[0];
    uv[1] = -p[1];
}

// A round-headed wooden door with a stone surround in the outer wall.
static void add_door(const struct atrium *atrium, struct solid_place bay, uint32_t number)
{
    for (int storey = 0; storey < 2; storey++) {
        if ((number + (uint32_t)storey) % 2 != 0)
            continue;
        float floor = storey == 0 ? ATRIUM_STEP : ATRIUM_GALLERY, half = 0.55f, spring = 1.65f;
        struct solid_place wall = atrium_at(bay, 0, floor, -ATRIUM_WALL - ATRIUM_DEPTH);
        struct solid_brush stone = atrium_brush(atrium, ATRIUM_STONE, atrium_at(wall, 0, spring, 0));
        static const struct solid_corner frame[] = {
            {0.55f, 0.0f, SOLID_LINE, 1},  {0.55f, 0.14f, SOLID_LINE, 1}, {0.62f, 0.14f, SOLID_COVE, 3},
            {0.70f, 0.07f, SOLID_LINE, 1}, {0.75f, 0.07f, SOLID_LINE, 1}, {0.75f, 0.0f, SOLID_LINE, 0}};
        solid_arch(&stone, frame, COUNT(frame), 24);
        stone.place = wall;
        const unsigned sides = SOLID_LEFT | SOLID_RIGHT | SOLID_FRONT;
        solid_box(&stone, (float[]){-0.75f, 0, 0}, (float[]){-half, spring, 0.12f}, sides, 0.3f);
        solid_box(&stone, (float[]){half, 0, 0}, (float[]){0.75f, spring, 0.12f}, sides, 0.3f);
        struct solid_brush wood = atrium_brush(atrium, ATRIUM_WOOD, atrium_at(wall, 0, 0, 0.035f));
        solid_quad(&wood, (float[]){-half, 0, 0}, (float[]){2 * half, 0, 0}, (float[]){0, spring, 0}, 0.3f);
        struct leaf_door door = {half, spring};
        solid_patch(&wood, &door, door_top, 16, 2);
        // Iron-bound ledges and a ring handle.
        for (int i = 0; i < 3; i++)
            solid_box(&wood, (float[]){-half, 0.25f + 0.6f * (float)i, 0},
                      (float[]){half, 0.37f + 0.6f * (float)i, 0.03f}, SOLID_TOP | SOLID_BOTTOM | SOLID_FRONT,
                      0.3f);
        struct solid_brush bronze = atrium_brush(atrium, ATRIUM_BRONZE, atrium_at(wall, 0.15f, 1.02f, 0.08f));
        solid_ring(&bronze, 0.06f, 0.012f, 20, 8);
    }
}

void atrium_add_trim(const struct atrium *atrium)
{
    add_mouldings(atrium);
    atrium_each_bay(atrium, add_dentils);
    atrium_each_bay(atrium, add_balustrade);
    atrium_each_bay(atrium, add_door);
    struct solid_brush court = atrium_brush(atrium, ATRIUM_COURT, solid_place(0, 0, 0, 0));
    float x = ATRIUM_HALF_X - 0.22f, z = ATRIUM_HALF_Z - 0.22f;
    solid_quad(&court, (float[]){-x, 0, z}, (float[]){2 * x, 0, 0}, (float[]){0, 0, -2 * z}, 0.16f);
}
