// Two storeys of bays around the court: columns, arches, vaults, walls and floors.
#include "stimuli/builtin/atrium_parts.h"

#include <math.h>

#define PI 3.14159265358979f
#define CELL_M 0.3f // of flat surfaces: fine enough for the baked light

enum { ARC = 20 }; // segments of a half circle; arches and vaults share it, so that their edges meet

static const struct storey {
    float floor, spring, top, shaft_radius;
} storeys[2] = {
    {ATRIUM_STEP, 2.9f, 4.45f, 0.235f},
    {ATRIUM_GALLERY, 6.95f, 8.6f, 0.19f},
};

#define COUNT(a) (sizeof(a) / sizeof(a)[0])

struct spandrel {
    float radius, half_width, height; // of the wall around the arch
    float from, to;                   // angles
};

static void spandrel_surface(const void *shape, float u, float v, float p[3], float uv[2])
{
    const struct spandrel *s = shape;
    float a = s->from + (s->to - s->from) * u, c = cosf(a), n = sinf(a);
    float reach = fminf(s->half_width / fmaxf(fabsf(c), 1e-6f), s->height / fmaxf(fabsf(n), 1e-6f));
    float r = s->radius + (reach - s->radius) * v;
    p[0] = r * c;
    p[1] = r * n;
    p[2] = 0;
    uv[0] = p[0];
    uv[1] = -p[1];
}

static void add_arch(const struct atrium *atrium, struct solid_place bay, const struct storey *s)
{
    static const struct solid_corner archivolt[] = {
        {1.2f, -ATRIUM_WALL, SOLID_LINE, 3}, {1.2f, 0.05f, SOLID_LINE, 1},   {1.26f, 0.05f, SOLID_LINE, 1},
        {1.26f, 0.025f, SOLID_LINE, 1},      {1.34f, 0.025f, SOLID_COVE, 4}, {1.40f, 0.09f, SOLID_LINE, 1},
        {1.44f, 0.09f, SOLID_LINE, 1},       {1.44f, 0.0f, SOLID_LINE, 0},
    };
    struct solid_brush stone = atrium_brush(atrium, ATRIUM_STONE, atrium_at(bay, 0, s->spring, 0));
    solid_arch(&stone, archivolt, COUNT(archivolt), ARC);
    float height = s->top - s->spring, corner = atan2f(height, ATRIUM_BAY / 2);
    const float angles[4] = {PI, PI - corner, corner, 0};
    struct solid_brush wall = atrium_brush(atrium, ATRIUM_ASHLAR, atrium_at(bay, 0, s->spring, 0));
    for (int i = 0; i < 3; i++) {
        struct spandrel shape = {1.43f, ATRIUM_BAY / 2, height, angles[i], angles[i + 1]};
        solid_patch(&wall, &shape, spandrel_surface, 12, 3);
    }
    // A keystone.
    struct solid_brush key = atrium_brush(atrium, ATRIUM_STONE, atrium_at(bay, 0, s->spring, 0));
    solid_box(&key, (float[]){-0.10f, 1.17f, -0.02f}, (float[]){0.10f, 1.52f, 0.13f},
              SOLID_ALL & ~(unsigned)SOLID_BACK, 0.2f);
}

static void vault_surface(const void *shape, float u, float v, float p[3], float uv[2])
{
    (void)shape;
    // One of four webs: a part of the barrel along z, up to the groins at |x| = z.
    float widest = v * PI / 2, a = (2 * u - 1) * widest;
    p[0] = ATRIUM_RADIUS * sinf(a);
    p[1] = ATRIUM_RADIUS * cosf(a);
    p[2] = ATRIUM_RADIUS * sinf(fminf(widest, PI / 2)) + fmaxf(widest - PI / 2, 0);
    uv[0] = a * ATRIUM_RADIUS;
    uv[1] = p[2];
}

// Centred on the bay's middle at springing height.
static void add_vault(const struct atrium *atrium, struct solid_place middle)
{
    for (int i = 0; i < 4; i++) {
        struct solid_brush web = atrium_brush(atrium, ATRIUM_PLASTER, middle);
        struct solid_place turn = solid_place(0, 0, 0, (float)i * PI / 2);
        for (int k = 0; k < 3; k++) {
            web.place.x[k] = turn.x[0] * middle.x[k] + turn.x[2] * middle.z[k];
            web.place.z[k] = turn.z[0] * middle.x[k] + turn.z[2] * middle.z[k];
        }
        solid_patch(&web, NULL, vault_surface, ARC, 5);
    }
}

// A transverse arch across the arcade with its pilaster; x runs along the arcade from `left` to `right`.
static void add_band(const struct atrium *atrium, struct solid_place bay, const struct storey *s, float left,
                     float right)
{
    float half = (right - left) / 2, back = -ATRIUM_WALL - ATRIUM_DEPTH;
    struct solid_place across = atrium_at(bay, (left + right) / 2, s->spring, -ATRIUM_WALL - ATRIUM_DEPTH / 2);
    struct solid_place turned = across;
    for (int k = 0; k < 3; k++) { // the arch's plane holds the arcade's depth
        turned.x[k] = -across.z[k];
        turned.z[k] = across.x[k];
    }
    const struct solid_corner band[] = {{1.205f, -half, SOLID_LINE, 1},
                                        {1.12f, -half, SOLID_LINE, 2},
                                        {1.12f, half, SOLID_LINE, 1},
                                        {1.205f, half, SOLID_LINE, 0}};
    struct solid_brush stone = atrium_brush(atrium, ATRIUM_STONE, turned);
    solid_arch(&stone, band, COUNT(band), ARC);
    struct solid_brush pilaster = atrium_brush(atrium, ATRIUM_STONE, bay);
    const unsigned sides = SOLID_FRONT | SOLID_LEFT | SOLID_RIGHT;
    solid_box(&pilaster, (float[]){left + 0.05f, s->floor, back},
              (float[]){right - 0.05f, s->spring - 0.14f, back + 0.1f}, sides, CELL_M);
    solid_box(&pilaster, (float[]){left, s->spring - 0.14f, back}, (float[]){right, s->spring, back + 0.14f},
              sides | SOLID_TOP | SOLID_BOTTOM, CELL_M);
    solid_box(&pilaster, (float[]){left, s->floor, back}, (float[]){right, s->floor + 0.2f, back + 0.14f},
              sides | SOLID_TOP, CELL_M);
}

struct leaf {
    float radius, height, width, curl, angle;
};

static void capital_leaf(const void *shape, float u, float v, float p[3], float uv[2])
{
    const struct leaf *l = shape;
    // A closed blade: u runs around its section, front then back.
    float around = u * 2 * PI, side = cosf(around), face = sinf(around);
    float taper = sqrtf(1 - 0.9f * fminf(v * v * v * v, 1));
    float bow = l->curl * v * v * v, rise = l->height * (v < 0.85f ? v : 0.85f + 0.3f * (v - 0.85f));
    float half = l->width * taper * (1 + 0.12f * cosf(v * 5 * PI));
    float across = half * side, out = l->radius + 0.01f + bow + 0.012f * taper * face - across * across * 2.5f;
    float a = l->angle, c = cosf(a), s = sinf(a);
    p[0] = c * out - s * across;
    p[1] = rise;
    p[2] = s * out + c * across;
    uv[0] = across;
    uv[1] = -rise;
}

static void add_capital(const struct atrium *atrium, struct solid_place foot, float radius)
{
    struct solid_brush stone = atrium_brush(atrium, ATRIUM_STONE, foot);
    const struct solid_corner bell[] = {
        {radius * 0.86f, 0, SOLID_TORUS, 6},    {radius * 0.86f, 0.05f, SOLID_LINE, 2},
        {radius * 0.86f, 0.22f, SOLID_COVE, 6}, {radius * 1.30f, 0.36f, SOLID_LINE, 1},
        {radius * 1.30f, 0.38f, SOLID_LINE, 0},
    };
    solid_lathe(&stone, bell, COUNT(bell), 16);
    for (int row = 0; row < 2; row++) {
        for (int i = 0; i < 8; i++) {
            float turn = ((float)i + 0.5f * (float)row) * PI / 4;
            struct leaf leaf = {radius * 0.88f, 0.20f + 0.10f * (float)row, 0.075f, 0.07f + 0.03f * (float)row,
                                turn};
            struct solid_brush blade = stone;
            blade.place = atrium_at(foot, 0, 0.06f, 0);
            solid_patch(&blade, &leaf, capital_leaf, 4, 3);
        }
    }
    solid_box(&stone, (float[]){-0.36f, 0.38f, -0.36f}, (float[]){0.36f, 0.46f, 0.36f}, SOLID_ALL, 0.36f);
}

// On the storey's floor, its centre at the place's origin.
static void add_column(const struct atrium *atrium, struct solid_place foot, const struct storey *s)
{
    float r = s->shaft_radius, height = s->spring - s->floor, top = height - 0.46f;
    struct solid_brush stone = atrium_brush(atrium, ATRIUM_STONE, foot);
    solid_box(&stone, (float[]){-r * 1.42f, 0, -r * 1.42f}, (float[]){r * 1.42f, 0.12f, r * 1.42f},
              SOLID_ALL & ~(unsigned)SOLID_BOTTOM, 0.35f);
    const struct solid_corner column[] = {
        {r * 1.22f, 0.12f, SOLID_TORUS, 5}, {r * 1.22f, 0.24f, SOLID_LINE, 1},
        {r * 1.14f, 0.24f, SOLID_COVE, 3},  {r * 1.10f, 0.30f, SOLID_TORUS, 6},
        {r * 1.10f, 0.36f, SOLID_LINE, 1},  {r, 0.36f, SOLID_SHAFT, 10},
        {r * 0.86f, top, SOLID_LINE, 0},
    };
    solid_lathe(&stone, column, COUNT(column), 20);
    add_capital(atrium, atrium_at(foot, 0, top, 0), r);
}

// One arm of a corner pier, from `low` to `high` in plan, both given for the corner at x > 0, z > 0.
static void add_pier_arm(const struct atrium *atrium, float x_sign, float z_sign, const float low[2],
                         const float high[2], const struct storey *s, float grow)
{
    struct solid_brush stone = atrium_brush(atrium, ATRIUM_STONE, solid_place(0, 0, 0, 0));
    const float levels[4] = {s->floor, s->floor + 0.3f, s->spring - 0.16f - grow, s->spring};
    const float wider[3] = {0.05f, 0, 0.06f};
    for (int i = 0; i < 3; i++) {
        float w = wider[i] + grow, x[2] = {x_sign * (low[0] - w), x_sign * (high[0] + w)};
        float z[2] = {z_sign * (low[1] - w), z_sign * (high[1] + w)};
        solid_box(&stone, (float[]){fminf(x[0], x[1]), levels[i], fminf(z[0], z[1])},
                  (float[]){fmaxf(x[0], x[1]), levels[i + 1], fmaxf(z[0], z[1])},
                  i == 2 ? SOLID_ALL : SOLID_ALL & ~(unsigned)SOLID_BOTTOM, CELL_M);
    }
}

static bool first_of_side(uint32_t number)
{
    return number == 0 || number == 8 || number == 11 || number == 19;
}

static bool last_of_side(uint32_t number)
{
    return number == 7 || number == 10 || number == 18 || number == 21;
}

static void add_bay(const struct atrium *atrium, struct solid_place bay, uint32_t number)
{
    for (int i = 0; i < 2; i++) {
        const struct storey *s = &storeys[i];
        add_arch(atrium, bay, s);
        add_vault(atrium, atrium_at(bay, 0, s->spring, -ATRIUM_WALL - ATRIUM_DEPTH / 2));
        if (first_of_side(number))
            add_band(atrium, bay, s, -2.0f, -1.2f);
        else
            add_column(atrium, atrium_at(bay, -ATRIUM_BAY / 2, s->floor, -ATRIUM_WALL / 2), s);
        if (last_of_side(number))
            add_band(atrium, bay, s, 1.2f, 2.0f);
        else
            add_band(atrium, bay, s, 1.2f, 1.8f);
    }
}

static void add_corner(const struct atrium *atrium, float x_sign, float z_sign)
{
    float x = x_sign * (ATRIUM_HALF_X + ATRIUM_WALL + ATRIUM_DEPTH / 2);
    float z = z_sign * (ATRIUM_HALF_Z + ATRIUM_WALL + ATRIUM_DEPTH / 2);
    for (int i = 0; i < 2; i++) {
        add_vault(atrium, solid_place(x, storeys[i].spring, z, 0));
        // An L around the court's corner carries the first arch of either side.
        add_pier_arm(atrium, x_sign, z_sign, (const float[]){11.69f, 4.5f}, (const float[]){12.5f, 5.04f},
                     &storeys[i], 0);
        add_pier_arm(atrium, x_sign, z_sign, (const float[]){12.0f, 4.19f}, (const float[]){12.54f, 5.0f},
                     &storeys[i], 0.01f);
    }
}

static void add_walls_and_floors(const struct atrium *atrium)
{
    float outer_x = ATRIUM_HALF_X + ATRIUM_WALL + ATRIUM_DEPTH,
          outer_z = ATRIUM_HALF_Z + ATRIUM_WALL + ATRIUM_DEPTH;
    for (int i = 0; i < 2; i++) {
        const struct storey *s = &storeys[i];
        float crown = s->spring + ATRIUM_RADIUS + 0.02f, dado = s->floor + 1.0f;
        const struct solid_corner lower[] = {{0, s->floor, SOLID_LINE, 4}, {0, dado, SOLID_LINE, 0}};
        const struct solid_corner upper[] = {{0, dado, SOLID_LINE, 10}, {0, crown, SOLID_LINE, 0}};
        const struct solid_corner rail[] = {{0, dado - 0.05f, SOLID_LINE, 1},
                                            {0.03f, dado - 0.05f, SOLID_TORUS, 4},
                                            {0.03f, dado + 0.03f, SOLID_LINE, 1},
                                            {0, dado + 0.03f, SOLID_LINE, 0}};
        struct solid_brush ashlar = atrium_brush(atrium, ATRIUM_ASHLAR, solid_place(0, 0, 0, 0));
        struct solid_brush plaster = atrium_brush(atrium, ATRIUM_PLASTER, solid_place(0, 0, 0, 0));
        struct solid_brush stone = atrium_brush(atrium, ATRIUM_STONE, solid_place(0, 0, 0, 0));
        solid_frame(&ashlar, lower, COUNT(lower), outer_x, outer_z, CELL_M);
        solid_frame(&plaster, upper, COUNT(upper), outer_x, outer_z, CELL_M);
        solid_frame(&stone, rail, COUNT(rail), outer_x, outer_z, CELL_M);
        // The floor as a ring of depth from the wall to the court's edge; x is measured inwards.
        float front = ATRIUM_WALL + ATRIUM_DEPTH + (i == 0 ? 0.22f : 0.0f);
        const struct solid_corner floor[] = {{0, s->floor, SOLID_LINE, 10}, {front, s->floor, SOLID_LINE, 0}};
        struct solid_brush tiles = atrium_brush(atrium, ATRIUM_ARCADE, solid_place(0, 0, 0, 0));
        // A frame faces inwards for rising profiles; a floor's profile runs from the court to the wall.
        const struct solid_corner reversed[] = {{floor[1].x, s->floor, SOLID_LINE, 10},
                                                {0, s->floor, SOLID_LINE, 0}};
        solid_frame(&tiles, reversed, COUNT(reversed), outer_x, outer_z, CELL_M);
    }
}

// Never seen: keeps light from seeping in where thin walls and floors meet.
static void add_shell(const struct atrium *atrium)
{
    float x = ATRIUM_HALF_X + ATRIUM_WALL + ATRIUM_DEPTH, z = ATRIUM_HALF_Z + ATRIUM_WALL + ATRIUM_DEPTH;
    const struct solid_corner lid[] = {
        {0.3f, 10.02f, SOLID_LINE, 1}, {-0.3f, 10.02f, SOLID_LINE, 1}, {-0.3f, -0.2f, SOLID_LINE, 0}};
    struct solid_brush plaster = atrium_brush(atrium, ATRIUM_PLASTER, solid_place(0, 0, 0, 0));
    solid_frame(&plaster, lid, COUNT(lid), x, z, 4);
}

void atrium_add_arcades(const struct atrium *atrium)
{
    atrium_each_bay(atrium, add_bay);
    for (int i = 0; i < 4; i++)
        add_corner(atrium, i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f);
    add_walls_and_floors(atrium);
    add_shell(atrium);
}
