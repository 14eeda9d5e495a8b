#include "stimuli/builtin/atrium_parts.h"
#include "stimuli/builtin/random.h"

#include <math.h>

#define PI 3.14159265358979f

static float coarse(const struct texture_noise *n, float u, float v)
{
    return texture_noise_at(n, TEXTURE_COARSE, u, v);
}

static float fine(const struct texture_noise *n, float u, float v)
{
    return texture_noise_at(n, TEXTURE_FINE, u, v);
}

static void set(float colour[3], float r, float g, float b)
{
    colour[0] = r;
    colour[1] = g;
    colour[2] = b;
}

static void scale(float colour[3], float by)
{
    for (int i = 0; i < 3; i++)
        colour[i] *= by;
}

static float fraction(float v)
{
    return v - floorf(v);
}

// 3 m: eight courses, blocks of 0.75 m, every second course shifted by half a block.
static void ashlar(const struct texture_noise *n, float u, float v, struct texel *out)
{
    float wobble = 0.012f * (coarse(n, u, v) - 0.5f);
    float y = (v + wobble) * 8, row = floorf(y);
    float x = (u + wobble) * 4 + 0.5f * fmodf(row + 8, 2);
    float fx = fraction(x) * 0.75f, fy = fraction(y) * 0.375f; // metres inside the block
    float edge = fminf(fminf(fx, 0.75f - fx), fminf(fy, 0.375f - fy));
    int32_t column = ((int32_t)floorf(x) + 4) % 4, line = ((int32_t)row + 8) % 8;
    float tone = random_unit(11, random_place(column, line, 0)),
          tint = random_unit(12, random_place(column, line, 1));
    float block = texture_smooth(0.004f, 0.016f, edge + 0.006f * (fine(n, u, v) - 0.5f));
    float pits = texture_smooth(0.62f, 0.75f, fine(n, u * 2, v * 2));
    set(out->colour, 0.80f + 0.05f * tint, 0.72f + 0.03f * tint, 0.60f);
    scale(out->colour, 0.86f + 0.17f * tone + 0.22f * (coarse(n, u + 0.3f, v) - 0.5f));
    scale(out->colour, 1 - 0.12f * pits - 0.10f * (fine(n, v, u) - 0.5f));
    texture_mix(out->colour, (const float[]){0.58f, 0.53f, 0.46f}, 1 - block);
    out->height = 0.007f * block + 0.004f * (coarse(n, u * 2, v * 2) - 0.5f) + 0.003f * (fine(n, u, v) - 0.5f) -
                  0.002f * pits;
    out->roughness = 0.82f + 0.1f * (1 - block);
}

static void stone(const struct texture_noise *n, float u, float v, struct texel *out)
{
    float vein = 1 - fabsf(2 * coarse(n, u + 0.15f * coarse(n, v, u), v) - 1);
    float pits = texture_smooth(0.66f, 0.76f, fine(n, u, v));
    set(out->colour, 0.86f, 0.80f, 0.70f);
    scale(out->colour, 0.94f + 0.14f * (coarse(n, v, u) - 0.5f) + 0.06f * (fine(n, v, u) - 0.5f));
    texture_mix(out->colour, (const float[]){0.70f, 0.60f, 0.47f}, 0.35f * texture_smooth(0.88f, 1.0f, vein));
    scale(out->colour, 1 - 0.14f * pits);
    out->height = 0.0016f * (fine(n, u, v) - 0.5f) - 0.0012f * pits + 0.003f * coarse(n, u, v);
    out->roughness = 0.62f + 0.2f * coarse(n, v, u);
}

static void plaster(const struct texture_noise *n, float u, float v, struct texel *out)
{
    float stain = texture_smooth(0.45f, 0.75f, coarse(n, u, v));
    set(out->colour, 0.88f, 0.80f, 0.67f);
    texture_mix(out->colour, (const float[]){0.76f, 0.64f, 0.50f}, 0.5f * stain);
    scale(out->colour, 0.96f + 0.08f * (fine(n, u, v) - 0.5f));
    out->height = 0.005f * coarse(n, v, u) + 0.0025f * fine(n, u, v);
    out->roughness = 0.9f;
}

// 2.4 m: an 8-pointed star of dark stone in each 1.2 m square, cream field, terracotta diamonds between.
static void court(const struct texture_noise *n, float u, float v, struct texel *out)
{
    float cx = fraction(u * 2) - 0.5f, cy = fraction(v * 2) - 0.5f;
    float ax = fabsf(cx), ay = fabsf(cy);
    float square = fmaxf(ax, ay), diamond = (ax + ay) * 0.70711f;
    float star = fminf(square, diamond);            // within both squares' union
    float frame = 0.5f - square;                    // distance to the tile's edge
    float corner = 0.70711f - (ax + ay) * 0.70711f; // distance from the tile's corner along the diagonal
    float grout = fminf(fminf(fabsf(star - 0.27f), fabsf(star - 0.17f)), fminf(frame, fabsf(corner - 0.14f)));
    // Slabs of the field are also cut along the axes.
    if (star > 0.27f && corner > 0.14f)
        grout = fminf(grout, fminf(fminf(ax, ay), fabsf(ax - ay) * 0.7071f));
    int32_t tile_x = (int32_t)(u * 2), tile_y = (int32_t)(v * 2);
    int32_t sector = (int32_t)floorf((atan2f(cy, cx) + PI) / PI * 4);
    float marble = 0.5f * coarse(n, u, v) + 0.5f * coarse(n, u + 0.4f * coarse(n, v, u), v);
    int32_t kind = star < 0.17f ? 0 : star < 0.27f ? 1 : corner < 0.14f ? 2 : 3;
    float tone = random_unit(31, random_place(tile_x * 8 + sector, tile_y, kind));
    static const float colours[4][3] = {
        {0.78f, 0.70f, 0.58f}, {0.36f, 0.37f, 0.38f}, {0.62f, 0.34f, 0.24f}, {0.83f, 0.77f, 0.66f}};
    set(out->colour, colours[kind][0], colours[kind][1], colours[kind][2]);
    scale(out->colour, 0.84f + 0.14f * tone + 0.30f * (marble - 0.5f) + 0.06f * (fine(n, u, v) - 0.5f));
    float joint = texture_smooth(0.0025f, 0.006f, grout);
    texture_mix(out->colour, (const float[]){0.42f, 0.38f, 0.33f}, 1 - joint);
    scale(out->colour, 1 - 0.15f * texture_smooth(0.5f, 0.8f, coarse(n, v + 0.3f, u)));
    out->height = 0.004f * joint + 0.0012f * (fine(n, u, v) - 0.5f) + 0.002f * tone;
    out->roughness = 0.55f + 0.25f * coarse(n, u + 0.5f, v) + 0.2f * (1 - joint);
}

// 1.6 m: 0.4 m squares, cream and red-brown in turn, laid straight.
static void arcade(const struct texture_noise *n, float u, float v, struct texel *out)
{
    float x = u * 4, y = v * 4;
    int32_t ix = (int32_t)x, iy = (int32_t)y;
    float edge = fminf(fminf(fraction(x), 1 - fraction(x)), fminf(fraction(y), 1 - fraction(y))) * 0.4f;
    float tone = random_unit(41, random_place(ix, iy, 0));
    if ((ix + iy) % 2 == 0)
        set(out->colour, 0.80f, 0.72f, 0.60f);
    else
        set(out->colour, 0.58f, 0.33f, 0.25f);
    scale(out->colour, 0.84f + 0.16f * tone + 0.3f * (coarse(n, u, v) - 0.5f) + 0.08f * (fine(n, u, v) - 0.5f));
    float joint = texture_smooth(0.003f, 0.007f, edge);
    texture_mix(out->colour, (const float[]){0.40f, 0.36f, 0.31f}, 1 - joint);
    out->height = 0.004f * joint + 0.0012f * fine(n, u, v) + 0.002f * tone;
    out->roughness = 0.5f + 0.3f * coarse(n, v, u) + 0.2f * (1 - joint);
}

// 1 m of woven cloth: twill threads of 6 mm, a damask pattern and border stripes; white, tinted by the
// material.
static void cloth(const struct texture_noise *n, float u, float v, struct texel *out)
{
    float threads = 128, twill = fraction((u + v) * threads / 2);
    float weave = 0.5f + 0.25f * sinf(u * threads * 2 * PI) + 0.25f * sinf(v * threads * 2 * PI);
    float px = fraction(u * 4) - 0.5f, py = fraction(v * 4 + 0.5f * fmodf(floorf(u * 4), 2)) - 0.5f;
    float r = hypotf(px, py), a = atan2f(py, px);
    float flower = r - 0.24f - 0.10f * cosf(4 * a) - 0.03f * cosf(8 * a);
    float damask = texture_smooth(0.02f, -0.02f, flower) - texture_smooth(0.02f, -0.02f, r - 0.08f);
    float bright = 0.80f + 0.10f * weave + 0.05f * twill - 0.16f * damask + 0.10f * (coarse(n, u, v) - 0.5f);
    set(out->colour, bright, bright, bright);
    out->height = 0.0006f * weave + 0.0004f * damask;
    out->roughness = 0.9f - 0.25f * damask;
}

// 1 m: five planks, grain along v.
static void wood(const struct texture_noise *n, float u, float v, struct texel *out)
{
    float x = u * 5, plank = floorf(x), edge = fminf(fraction(x), 1 - fraction(x)) * 0.2f;
    float shift = random_unit(51, (uint64_t)plank);
    float bend = 0.06f * coarse(n, u + shift, v);
    float grain = 0.5f + 0.5f * sinf((u + bend) * 2 * PI * 40 + 6 * coarse(n, u, v + shift));
    float fibre = fine(n, u * 2, v * 0.0f + floorf(v * 8) / 8);
    set(out->colour, 0.46f, 0.30f, 0.18f);
    scale(out->colour, 0.75f + 0.3f * shift + 0.20f * (grain - 0.5f) + 0.25f * (fibre - 0.5f));
    float gap = texture_smooth(0.002f, 0.006f, edge);
    scale(out->colour, 0.3f + 0.7f * gap);
    out->height = 0.006f * gap + 0.0012f * grain;
    out->roughness = 0.65f + 0.2f * grain;
}

static void terracotta(const struct texture_noise *n, float u, float v, struct texel *out)
{
    set(out->colour, 0.70f, 0.40f, 0.27f);
    float lime = texture_smooth(0.55f, 0.8f, coarse(n, u, v));
    texture_mix(out->colour, (const float[]){0.80f, 0.66f, 0.55f}, 0.5f * lime);
    scale(out->colour, 0.95f + 0.15f * (fine(n, u, v) - 0.5f) + 0.15f * (coarse(n, v, u) - 0.5f));
    out->height = 0.0015f * fine(n, u, v) + 0.0008f * sinf(v * 2 * PI * 40);
    out->roughness = 0.85f;
}

// A pointed leaf with a midrib from bottom to top; the colour runs on outside, where alpha is 0.
static void leaf(const struct texture_noise *n, float u, float v, struct texel *out)
{
    float along = 1 - v, side = fabsf(u - 0.5f);
    float width = 0.36f * powf(fmaxf(sinf(PI * powf(along, 0.8f)), 0), 0.9f);
    float rib = texture_smooth(0.018f, 0.006f, side) +
                0.5f * texture_smooth(0.06f, 0.02f, fabsf(fraction((along - side * 0.7f) * 9) - 0.5f) * 0.3f);
    set(out->colour, 0.27f, 0.42f, 0.15f);
    texture_mix(out->colour, (const float[]){0.45f, 0.56f, 0.22f},
                0.5f * rib + 0.5f * coarse(n, u * 0.5f, v * 0.5f));
    scale(out->colour, 0.9f + 0.2f * (fine(n, u, v) - 0.5f));
    out->alpha = side < width && along > 0.02f && along < 0.985f ? 1.0f : 0.0f;
    if (along < 0.10f && side < 0.02f)
        out->alpha = 1;
    out->height = 0.002f * rib;
    out->roughness = 0.95f;
}

static void soil(const struct texture_noise *n, float u, float v, struct texel *out)
{
    set(out->colour, 0.24f, 0.17f, 0.11f);
    scale(out->colour, 0.6f + 0.9f * fine(n, u, v));
    out->height = 0.02f * fine(n, u, v);
    out->roughness = 0.95f;
}

static void water(const struct texture_noise *n, float u, float v, struct texel *out)
{
    set(out->colour, 0.14f, 0.30f, 0.32f);
    scale(out->colour, 0.9f + 0.3f * coarse(n, u, v));
    out->height = 0.02f * coarse(n, u, v) + 0.004f * fine(n, v, u);
    out->roughness = 0.16f;
}

static void bronze(const struct texture_noise *n, float u, float v, struct texel *out)
{
    float patina = texture_smooth(0.50f, 0.70f, coarse(n, u, v));
    set(out->colour, 0.80f, 0.58f, 0.32f);
    texture_mix(out->colour, (const float[]){0.30f, 0.50f, 0.42f}, 0.8f * patina);
    scale(out->colour, 0.9f + 0.2f * fine(n, u, v));
    out->metallic = 1 - patina;
    out->roughness = 0.34f + 0.4f * patina;
    out->height = 0.001f * fine(n, u, v) + 0.001f * patina;
}

static void roof(const struct texture_noise *n, float u, float v, struct texel *out)
{
    terracotta(n, u, v, out);
    scale(out->colour, 0.85f + 0.3f * (coarse(n, v, u) - 0.5f));
}

struct rule {
    const char *name;
    texel_fn texel;
    uint32_t size;
    float tile_m;
    float colour[3]; // linear factor; zero: white
    bool masked, double_sided;
    enum atrium_material shares; // textures of this earlier material, where texel is NULL
};

static const struct rule rules[ATRIUM_MATERIALS] = {
    [ATRIUM_ASHLAR] = {.name = "ashlar", .texel = ashlar, .size = 1024, .tile_m = 3},
    [ATRIUM_STONE] = {.name = "stone", .texel = stone, .size = 512, .tile_m = 1.5f},
    [ATRIUM_PLASTER] = {.name = "plaster", .texel = plaster, .size = 512, .tile_m = 2},
    [ATRIUM_COURT] = {.name = "court tiles", .texel = court, .size = 1024, .tile_m = 2.4f},
    [ATRIUM_ARCADE] = {.name = "arcade tiles", .texel = arcade, .size = 512, .tile_m = 1.6f},
    [ATRIUM_RED] = {.name = "red cloth",
                    .texel = cloth,
                    .size = 512,
                    .tile_m = 1,
                    .colour = {0.52f, 0.035f, 0.03f},
                    .double_sided = true},
    [ATRIUM_BLUE] = {.name = "blue cloth",
                     .tile_m = 1,
                     .colour = {0.03f, 0.09f, 0.34f},
                     .double_sided = true,
                     .shares = ATRIUM_RED},
    [ATRIUM_GOLD] = {.name = "gold cloth",
                     .tile_m = 1,
                     .colour = {0.62f, 0.32f, 0.04f},
                     .double_sided = true,
                     .shares = ATRIUM_RED},
    [ATRIUM_WOOD] = {.name = "wood", .texel = wood, .size = 512, .tile_m = 1},
    [ATRIUM_TERRACOTTA] = {.name = "terracotta", .texel = terracotta, .size = 256, .tile_m = 0.8f},
    [ATRIUM_LEAF] =
        {.name = "leaf", .texel = leaf, .size = 256, .tile_m = 1, .masked = true, .double_sided = true},
    [ATRIUM_SOIL] = {.name = "soil", .texel = soil, .size = 256, .tile_m = 0.6f},
    [ATRIUM_BRONZE] = {.name = "bronze", .texel = bronze, .size = 512, .tile_m = 1},
    [ATRIUM_WATER] = {.name = "water", .texel = water, .size = 512, .tile_m = 1.5f},
    [ATRIUM_ROOF] = {.name = "roof tiles", .texel = roof, .size = 256, .tile_m = 0.8f},
};

float atrium_tile_m(enum atrium_material material)
{
    return rules[material].tile_m;
}

bool atrium_make_materials(struct atrium *atrium)
{
    struct texture_noise noise;
    if (!texture_noise_create(&noise, 1))
        return false;
    struct texture_set sets[ATRIUM_MATERIALS];
    for (int i = 0; i < ATRIUM_MATERIALS; i++) {
        const struct rule *r = &rules[i];
        struct texture_desc desc = {
            .texel = r->texel, .size = r->size, .tile_m = r->tile_m, .masked = r->masked};
        sets[i] = r->texel != NULL ? texture_make(atrium->maker, &noise, &desc) : sets[r->shares];
        atrium->material[i] =
            maker_material(atrium->maker, &(struct maker_material_desc){
                                              .name = r->name,
                                              .colour = {r->colour[0], r->colour[1], r->colour[2]},
                                              .roughness = 1,
                                              .metallic = 1,
                                              .base = sets[i].base,
                                              .surface = sets[i].surface,
                                              .normal = sets[i].normal,
                                              .alpha_mask = r->masked,
                                              .double_sided = r->double_sided,
                                          });
    }
    texture_noise_destroy(&noise);
    return true;
}
