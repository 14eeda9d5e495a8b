// Pixel-art textures of the town's blocks: 32 texels a metre, drawn without filtering when near.
#include "stimuli/builtin/random.h"
#include "stimuli/builtin/texture.h"
#include "stimuli/builtin/town_parts.h"

#include <math.h>

enum { SIZE = 64 };

static float dots(float u, float v, uint64_t salt)
{
    return random_unit(salt, (uint64_t)(int32_t)(v * SIZE) * SIZE + (uint64_t)(int32_t)(u * SIZE));
}

// Larger pixels of 2 x 2 and 4 x 4 texels mixed in, as a painter of small textures would.
static float speckle(float u, float v, uint64_t salt)
{
    return 0.45f * dots(u, v, salt) + 0.3f * dots(floorf(u * 32) / 32, floorf(v * 32) / 32, salt + 1) +
           0.25f * dots(floorf(u * 16) / 16, floorf(v * 16) / 16, salt + 2);
}

static void paint(struct texel *out, float r, float g, float b, float by)
{
    out->colour[0] = r * by;
    out->colour[1] = g * by;
    out->colour[2] = b * by;
}

static void grass(const struct texture_noise *n, float u, float v, struct texel *out)
{
    float s = speckle(u, v, 101), patch = texture_noise_at(n, TEXTURE_COARSE, u, v);
    paint(out, 0.36f + 0.14f * patch, 0.55f + 0.03f * patch, 0.21f, 0.68f + 0.5f * s);
    out->height = 0.02f * s;
    out->roughness = 0.95f;
}

static void dirt(const struct texture_noise *n, float u, float v, struct texel *out)
{
    (void)n;
    float s = speckle(u, v, 111);
    paint(out, 0.50f, 0.37f, 0.26f, 0.65f + 0.5f * s);
    if (dots(u, v, 114) > 0.96f)
        paint(out, 0.62f, 0.58f, 0.52f, 1);
    out->height = 0.02f * s;
    out->roughness = 0.95f;
}

// The cell of an irregular grid of stones: distance to its edge in texels, its number.
static float stones(float u, float v, int across, uint64_t salt, float *out_tone)
{
    float best = 1e9f, second = 1e9f;
    int32_t cx = (int32_t)(u * (float)across), cy = (int32_t)(v * (float)across);
    for (int32_t dy = -1; dy <= 1; dy++) {
        for (int32_t dx = -1; dx <= 1; dx++) {
            int32_t x = cx + dx, y = cy + dy;
            uint64_t id = (uint64_t)((y + across) % across * across + (x + across) % across);
            float px = ((float)x + random_range(salt, id, 0.2f, 0.8f)) / (float)across;
            float py = ((float)y + random_range(salt + 1, id, 0.2f, 0.8f)) / (float)across;
            float d = hypotf(px - u, py - v);
            if (d < best) {
                second = best;
                best = d;
                *out_tone = random_unit(salt + 2, id);
            } else if (d < second) {
                second = d;
            }
        }
    }
    return (second - best) * SIZE;
}

static void cobble(const struct texture_noise *n, float u, float v, struct texel *out)
{
    (void)n;
    float tone, edge = stones(u, v, 9, 121, &tone), s = speckle(u, v, 125);
    float top = texture_smooth(0.6f, 3.0f, edge);
    paint(out, 0.60f + 0.06f * tone, 0.57f + 0.02f * tone, 0.53f,
          (0.62f + 0.38f * top) * (0.72f + 0.3f * tone + 0.16f * s));
    out->height = 0.018f * top + 0.004f * s;
    out->roughness = 0.75f + 0.2f * (1 - top);
}

// Courses of bricks: rows and columns per texture, half shifted; tone per brick.
static float courses(float u, float v, int columns, int rows, uint64_t salt, float *out_tone)
{
    float y = v * (float)rows, row = floorf(y), x = u * (float)columns + 0.5f * fmodf(row, 2);
    int32_t column = (int32_t)floorf(x) % columns;
    *out_tone = random_unit(salt, (uint64_t)(row * 64) + (uint64_t)column);
    float fx = (x - floorf(x)) * (float)(SIZE / columns), fy = (y - row) * (float)(SIZE / rows);
    return fminf(fminf(fx, (float)(SIZE / columns) - fx), fminf(fy, (float)(SIZE / rows) - fy));
}

static void paving(const struct texture_noise *n, float u, float v, struct texel *out)
{
    (void)n;
    float tone, edge = courses(u, v, 4, 4, 131, &tone), s = speckle(u, v, 132), joint = edge < 1 ? 0.0f : 1.0f;
    paint(out, 0.74f, 0.69f, 0.60f + 0.04f * tone,
          (0.6f + 0.4f * joint) * (0.78f + 0.22f * tone + 0.16f * (s - 0.5f)));
    out->height = 0.012f * joint + 0.003f * s;
    out->roughness = 0.7f + 0.15f * s;
}

static void brick(const struct texture_noise *n, float u, float v, struct texel *out)
{
    (void)n;
    float tone, edge = courses(u, v, 4, 8, 141, &tone), s = speckle(u, v, 142);
    if (edge < 1)
        paint(out, 0.70f, 0.66f, 0.60f, 0.8f + 0.2f * s);
    else
        paint(out, 0.64f + 0.08f * tone, 0.33f + 0.04f * tone, 0.25f,
              0.72f + 0.32f * tone + 0.16f * (s - 0.5f));
    out->height = edge < 1 ? 0 : 0.02f + 0.004f * s;
    out->roughness = 0.85f;
}

static void wall(float u, float v, uint64_t salt, const float colour[3], struct texel *out)
{
    float s = speckle(u, v, salt), patch = dots(floorf(u * 8) / 8, floorf(v * 8) / 8, salt + 7);
    paint(out, colour[0], colour[1], colour[2], 0.90f + 0.10f * s + 0.05f * (patch - 0.5f));
    out->height = 0.006f * s;
    out->roughness = 0.9f;
}

static void plaster(const struct texture_noise *n, float u, float v, struct texel *out)
{
    (void)n;
    wall(u, v, 151, (const float[]){0.90f, 0.86f, 0.77f}, out);
}

static void ochre(const struct texture_noise *n, float u, float v, struct texel *out)
{
    (void)n;
    wall(u, v, 161, (const float[]){0.86f, 0.68f, 0.40f}, out);
}

static void rose(const struct texture_noise *n, float u, float v, struct texel *out)
{
    (void)n;
    wall(u, v, 171, (const float[]){0.82f, 0.54f, 0.47f}, out);
}

static void sage(const struct texture_noise *n, float u, float v, struct texel *out)
{
    (void)n;
    wall(u, v, 181, (const float[]){0.58f, 0.68f, 0.66f}, out);
}

static void boards(float u, float v, uint64_t salt, const float colour[3], struct texel *out)
{
    float row = floorf(v * 8), tone = random_unit(salt, (uint64_t)row), line = v * 8 - row;
    float grain = dots(floorf(u * 16 + row * 3) / 16, v, salt + 1), s = speckle(u, v, salt + 2);
    bool end = fabsf(u * SIZE - floorf(random_unit(salt + 5, (uint64_t)row) * SIZE)) < 0.7f;
    bool gap = line * 8 < 1 || end;
    paint(out, colour[0], colour[1], colour[2],
          (gap ? 0.6f : 1.0f) * (0.78f + 0.2f * tone + 0.16f * grain + 0.08f * s));
    out->height = gap ? 0 : 0.015f + 0.004f * grain;
    out->roughness = 0.8f;
}

static void timber(const struct texture_noise *n, float u, float v, struct texel *out)
{
    (void)n;
    boards(u, v, 191, (const float[]){0.36f, 0.25f, 0.17f}, out);
}

static void planks(const struct texture_noise *n, float u, float v, struct texel *out)
{
    (void)n;
    boards(u, v, 201, (const float[]){0.68f, 0.49f, 0.30f}, out);
}

static void shingles(float u, float v, uint64_t salt, const float colour[3], struct texel *out)
{
    float y = v * 8, row = floorf(y), x = u * 8 + 0.5f * fmodf(row, 2), fx = x - floorf(x), fy = y - row;
    float tone = random_unit(salt, (uint64_t)(row * 16) + (uint64_t)floorf(x) % 8), s = speckle(u, v, salt + 1);
    float gap = fy * 8 < 1 || fx * 8 < 1 ? 0.62f : 1.0f;
    paint(out, colour[0], colour[1], colour[2], gap * (0.72f + 0.30f * tone + 0.14f * (s - 0.5f)));
    out->height = 0.02f * fy * (gap < 1 ? 0.4f : 1.0f);
    out->roughness = 0.75f;
}

static void roof_red(const struct texture_noise *n, float u, float v, struct texel *out)
{
    (void)n;
    shingles(u, v, 211, (const float[]){0.76f, 0.35f, 0.24f}, out);
}

static void roof_slate(const struct texture_noise *n, float u, float v, struct texel *out)
{
    (void)n;
    shingles(u, v, 221, (const float[]){0.42f, 0.47f, 0.55f}, out);
}

static void thatch(const struct texture_noise *n, float u, float v, struct texel *out)
{
    (void)n;
    float straw = dots(u, floorf(v * 8 + dots(u, 0, 232) * 3) / 8, 231), s = speckle(u, v, 233);
    paint(out, 0.80f, 0.66f, 0.36f, 0.62f + 0.32f * straw + 0.14f * s);
    out->height = 0.02f * straw;
    out->roughness = 0.95f;
}

static void stone(const struct texture_noise *n, float u, float v, struct texel *out)
{
    (void)n;
    float tone, edge = courses(u, v, 4, 8, 241, &tone), s = speckle(u, v, 242), joint = edge < 1 ? 0.72f : 1.0f;
    paint(out, 0.62f, 0.61f, 0.59f - 0.03f * tone, joint * (0.74f + 0.26f * tone + 0.18f * (s - 0.5f)));
    out->height = (joint < 1 ? 0 : 0.02f) + 0.005f * s;
    out->roughness = 0.85f;
}

static void glass(const struct texture_noise *n, float u, float v, struct texel *out)
{
    (void)n;
    float fx = u * 8 - floorf(u * 8), fy = v * 8 - floorf(v * 8), shine = fx + fy;
    bool lead = fx * 8 < 1 || fy * 8 < 1;
    paint(out, 0.30f, 0.42f, 0.52f, shine > 0.8f && shine < 1.1f ? 1.5f : 0.9f + 0.2f * dots(u, v, 251));
    if (lead)
        paint(out, 0.22f, 0.20f, 0.19f, 1);
    out->height = lead ? 0.01f : 0;
    out->roughness = lead ? 0.7f : 0.22f;
}

static void foliage(float u, float v, uint64_t salt, const float dark[3], const float light[3],
                    struct texel *out)
{
    float s = dots(u, v, salt), clump = dots(floorf(u * 32) / 32, floorf(v * 32) / 32, salt + 1);
    for (int i = 0; i < 3; i++)
        out->colour[i] = (dark[i] + (light[i] - dark[i]) * (0.55f * s + 0.45f * clump));
    out->alpha = 0.5f * s + 0.5f * clump > 0.36f ? 1.0f : 0.0f;
    out->roughness = 0.85f;
}

static void leaves(const struct texture_noise *n, float u, float v, struct texel *out)
{
    (void)n;
    foliage(u, v, 261, (const float[]){0.17f, 0.33f, 0.10f}, (const float[]){0.50f, 0.66f, 0.25f}, out);
}

static void blossom(const struct texture_noise *n, float u, float v, struct texel *out)
{
    (void)n;
    foliage(u, v, 271, (const float[]){0.62f, 0.36f, 0.46f}, (const float[]){0.97f, 0.80f, 0.84f}, out);
}

static void pine(const struct texture_noise *n, float u, float v, struct texel *out)
{
    (void)n;
    foliage(u, v, 281, (const float[]){0.10f, 0.24f, 0.15f}, (const float[]){0.28f, 0.46f, 0.28f}, out);
}

static void bark(const struct texture_noise *n, float u, float v, struct texel *out)
{
    (void)n;
    float ridge = dots(u, floorf(v * 8 + 4 * dots(u, 0, 292)) / 8, 291), s = speckle(u, v, 293);
    paint(out, 0.42f, 0.31f, 0.21f, 0.6f + 0.4f * ridge + 0.15f * s);
    out->height = 0.025f * ridge;
    out->roughness = 0.95f;
}

static void glow(const struct texture_noise *n, float u, float v, struct texel *out)
{
    (void)n;
    paint(out, 1.0f, 0.80f, 0.45f, 0.85f + 0.15f * dots(u, v, 301));
    out->roughness = 0.5f;
}

static void iron(const struct texture_noise *n, float u, float v, struct texel *out)
{
    (void)n;
    paint(out, 0.23f, 0.23f, 0.25f, 0.8f + 0.4f * speckle(u, v, 311));
    out->roughness = 0.55f;
}

// Blades of a tuft or stalks with heads; a texture is one billboard, `up` 0 at its foot.
static void tuft(const struct texture_noise *n, float u, float v, struct texel *out)
{
    (void)n;
    float x = floorf(u * 32), up = 1 - floorf(v * 32) / 32,
          lean = random_range(322, (uint64_t)x, -3, 3) * up * up;
    uint64_t blade = (uint64_t)(int32_t)fmaxf(x - lean, 0);
    float tall = random_range(321, blade, 0.25f, 0.95f) * (1 - fabsf(u - 0.5f) * 0.9f);
    paint(out, 0.40f, 0.60f, 0.22f, 0.6f + 0.5f * up + 0.1f * random_unit(323, blade));
    out->alpha = up < tall && random_unit(324, blade) > 0.3f ? 1.0f : 0.0f;
    out->roughness = 0.9f;
}

static void flower(const struct texture_noise *n, float u, float v, struct texel *out)
{
    tuft(n, u, v, out);
    float up = 1 - v;
    if (up > 0.45f)
        out->alpha = 0;
    static const float heads[5][2] = {
        {0.22f, 0.66f}, {0.50f, 0.84f}, {0.74f, 0.60f}, {0.38f, 0.50f}, {0.62f, 0.42f}};
    for (int i = 0; i < 5; i++) {
        float dx = fabsf(floorf((u - heads[i][0]) * 32 + 0.5f)),
              dy = fabsf(floorf((up - heads[i][1]) * 32 + 0.5f));
        if (dx < 1 && up < heads[i][1])
            out->alpha = 1;
        if (dx + dy > 3)
            continue;
        out->alpha = 1;
        if (dx + dy < 1)
            paint(out, 0.98f, 0.85f, 0.30f, 1);
        else if (i % 2)
            paint(out, 0.90f, 0.25f, 0.22f, 1.0f - 0.06f * dx);
        else
            paint(out, 0.92f, 0.88f, 0.95f, 1.0f - 0.06f * dy);
    }
}

static void water(const struct texture_noise *n, float u, float v, struct texel *out)
{
    float wave = texture_noise_at(n, TEXTURE_COARSE, floorf(u * 32) / 32, floorf(v * 32) / 32);
    paint(out, 0.20f, 0.36f, 0.40f, 0.75f + 0.5f * wave);
    out->height = 0.05f * wave;
    out->roughness = 0.2f;
}

static void wool(const struct texture_noise *n, float u, float v, struct texel *out)
{
    (void)n;
    float s = speckle(u, v, 351);
    paint(out, 0.92f, 0.90f, 0.86f, 0.80f + 0.22f * s);
    out->height = 0.02f * s;
    out->roughness = 1;
}

static void hide(const struct texture_noise *n, float u, float v, struct texel *out)
{
    float s = speckle(u, v, 361);
    bool patch = texture_noise_at(n, TEXTURE_COARSE, floorf(u * 16) / 16, floorf(v * 16) / 16) > 0.53f;
    if (patch)
        paint(out, 0.90f, 0.86f, 0.80f, 0.9f + 0.1f * s);
    else
        paint(out, 0.42f, 0.27f, 0.18f, 0.85f + 0.2f * s);
    out->height = 0.004f * s;
    out->roughness = 0.9f;
}

static void pig(const struct texture_noise *n, float u, float v, struct texel *out)
{
    (void)n;
    paint(out, 0.92f, 0.64f, 0.62f, 0.86f + 0.16f * speckle(u, v, 371));
    out->roughness = 0.85f;
}

static void paper(const struct texture_noise *n, float u, float v, struct texel *out)
{
    (void)n;
    bool line = (int32_t)(v * SIZE) % 8 == 0;
    paint(out, line ? 0.62f : 0.95f, line ? 0.74f : 0.94f, 0.92f, 0.96f + 0.04f * dots(u, v, 381));
    out->roughness = 0.9f;
}

static void stripes(const struct texture_noise *n, float u, float v, struct texel *out)
{
    (void)n;
    bool red = (int32_t)(u * 8) % 2 == 0;
    float s = 0.9f + 0.1f * speckle(u, v, 391);
    if (red)
        paint(out, 0.78f, 0.20f, 0.17f, s);
    else
        paint(out, 0.93f, 0.89f, 0.80f, s);
    out->roughness = 0.9f;
}

static void fruit(const struct texture_noise *n, float u, float v, struct texel *out)
{
    (void)n;
    float tone, edge = stones(u, v, 14, 401, &tone), top = texture_smooth(0.2f, 2.0f, edge);
    static const float colours[3][3] = {{0.86f, 0.22f, 0.15f}, {0.95f, 0.62f, 0.16f}, {0.48f, 0.66f, 0.18f}};
    const float *c = colours[(int)(tone * 2.999f)];
    paint(out, c[0], c[1], c[2], 0.45f + 0.55f * top);
    out->height = 0.04f * top;
    out->roughness = 0.5f;
}

struct rule {
    const char *name;
    texel_fn texel;
    float tile_m;
    bool masked, plain;
    float emissive; // kcd/m^2
};

static const struct rule rules[TOWN_KINDS] = {
    [TOWN_GRASS] = {"grass", grass, 2, false, false, 0},
    [TOWN_DIRT] = {"dirt", dirt, 2, false, false, 0},
    [TOWN_COBBLE] = {"cobble", cobble, 2, false, false, 0},
    [TOWN_PAVING] = {"paving", paving, 2, false, false, 0},
    [TOWN_BRICK] = {"brick", brick, 2, false, false, 0},
    [TOWN_PLASTER] = {"plaster", plaster, 2, false, false, 0},
    [TOWN_OCHRE] = {"ochre", ochre, 2, false, false, 0},
    [TOWN_ROSE] = {"rose", rose, 2, false, false, 0},
    [TOWN_SAGE] = {"sage", sage, 2, false, false, 0},
    [TOWN_TIMBER] = {"timber", timber, 2, false, false, 0},
    [TOWN_PLANKS] = {"planks", planks, 2, false, false, 0},
    [TOWN_ROOF_RED] = {"red roof", roof_red, 2, false, false, 0},
    [TOWN_ROOF_SLATE] = {"slate roof", roof_slate, 2, false, false, 0},
    [TOWN_THATCH] = {"thatch", thatch, 2, false, false, 0},
    [TOWN_STONE] = {"stone", stone, 2, false, false, 0},
    [TOWN_GLASS] = {"glass", glass, 2, false, false, 0},
    [TOWN_LEAVES] = {"leaves", leaves, 2, true, true, 0},
    [TOWN_BLOSSOM] = {"blossom", blossom, 2, true, true, 0},
    [TOWN_PINE] = {"pine", pine, 2, true, true, 0},
    [TOWN_BARK] = {"bark", bark, 2, false, false, 0},
    [TOWN_GLOW] = {"lantern", glow, 2, false, true, 14},
    [TOWN_IRON] = {"iron", iron, 2, false, true, 0},
    [TOWN_TUFT] = {"grass tuft", tuft, 1, true, true, 0},
    [TOWN_FLOWER] = {"flower", flower, 1, true, true, 0},
    [TOWN_WATER] = {"water", water, 4, false, false, 0},
    [TOWN_WOOL] = {"wool", wool, 1, false, false, 0},
    [TOWN_HIDE] = {"hide", hide, 2, false, false, 0},
    [TOWN_PIG] = {"pig", pig, 1, false, true, 0},
    [TOWN_PAPER] = {"paper", paper, 2, false, true, 0},
    [TOWN_STRIPES] = {"striped cloth", stripes, 2, false, true, 0},
    [TOWN_FRUIT] = {"fruit", fruit, 2, false, false, 0},
};

bool town_make_kinds(struct town *town)
{
    struct texture_noise noise;
    if (!texture_noise_create(&noise, 2))
        return false;
    for (int i = TOWN_AIR + 1; i < TOWN_KINDS; i++) {
        const struct rule *r = &rules[i];
        struct texture_desc desc = {.texel = r->texel,
                                    .size = SIZE,
                                    .tile_m = r->tile_m,
                                    .plain = r->plain,
                                    .masked = r->masked,
                                    .nearest = true};
        struct texture_set set = texture_make(town->maker, &noise, &desc);
        struct maker_material_desc material = {
            .name = r->name,
            .roughness = r->plain ? 0.85f : 1.0f,
            .metallic = 0,
            .base = set.base,
            .surface = set.surface,
            .normal = set.normal,
            .emissive = {r->emissive, r->emissive * 0.72f, r->emissive * 0.38f},
            .emission = r->emissive > 0 ? set.base : 0,
            .alpha_mask = r->masked,
            .double_sided = r->masked,
        };
        uint32_t m = maker_material(town->maker, &material);
        bool leafy = i == TOWN_LEAVES || i == TOWN_BLOSSOM || i == TOWN_PINE;
        town->kinds[i] = (struct voxel_kind){m, m, m, r->tile_m, leafy};
    }
    town->kinds[TOWN_GRASS].side = town->kinds[TOWN_GRASS].bottom = town->kinds[TOWN_DIRT].side;
    texture_noise_destroy(&noise);
    return true;
}
