#include "stimuli/builtin/town_models.h"

#include "stimuli/builtin/random.h"

#include <math.h>

static void fill(struct voxel_model *m, int32_t x0, int32_t y0, int32_t z0, int32_t x1, int32_t y1, int32_t z1,
                 int kind)
{
    voxel_fill(m, (int32_t[]){x0, y0, z0}, (int32_t[]){x1, y1, z1}, (uint8_t)kind);
}

static void add_crown(struct voxel_model *m, float cx, float cy, float cz, float rx, float ry, uint64_t seed,
                      int kind)
{
    for (int32_t z = 0; z < m->size[2]; z++) {
        for (int32_t y = 0; y < m->size[1]; y++) {
            for (int32_t x = 0; x < m->size[0]; x++) {
                float dx = ((float)x + 0.5f - cx) / rx, dy = ((float)y + 0.5f - cy) / ry,
                      dz = ((float)z + 0.5f - cz) / rx;
                float d = dx * dx + dy * dy + dz * dz;
                bool inside =
                    d < 0.8f || (d < 1.15f && random_unit(seed, random_place(x, y, z)) > (d - 0.8f) / 0.35f);
                if (inside && voxel_at(m, x, y, z) == VOXEL_AIR)
                    voxel_put(m, x, y, z, (uint8_t)kind);
            }
        }
    }
}

// Cells of 0.5 m. Even numbers are broad, then slender, blossoming and pine.
bool town_make_tree(struct voxel_model *model, uint32_t number, uint64_t seed)
{
    uint64_t s = random_bits(seed, 800 + number);
    if (!voxel_create(model, 13, 20, 13, 0.5f))
        return false;
    int32_t trunk = 5 + (int32_t)(s % 3);
    if (number == 5) {
        fill(model, 6, 0, 6, 7, 15, 7, TOWN_BARK);
        for (int32_t k = 0; k < 6; k++)
            add_crown(model, 6.5f, 4.5f + 2.2f * (float)k, 6.5f, 5.2f - 0.8f * (float)k, 1.5f, s + (uint64_t)k,
                      TOWN_PINE);
        return true;
    }
    fill(model, 6, 0, 6, 7, trunk + 3, 7, TOWN_BARK);
    int kind = number == 3 ? TOWN_BLOSSOM : TOWN_LEAVES;
    float wide = number % 2 ? 3.6f : 4.6f, tall = number % 2 ? 4.4f : 3.4f;
    voxel_put(model, 7, trunk, 6, TOWN_BARK);
    voxel_put(model, 5, trunk + 1, 6, TOWN_BARK);
    add_crown(model, 6.5f, (float)trunk + tall, 6.5f, wide, tall, s, kind);
    add_crown(model, 8.0f, (float)trunk + tall - 1.5f, 5.5f, wide * 0.6f, tall * 0.6f, s + 1, kind);
    add_crown(model, 4.7f, (float)trunk + tall - 0.8f, 7.6f, wide * 0.6f, tall * 0.6f, s + 2, kind);
    return true;
}

bool town_make_lamp(struct voxel_model *model)
{
    if (!voxel_create(model, 6, 25, 6, 0.125f))
        return false;
    fill(model, 1, 0, 1, 5, 2, 5, TOWN_STONE);
    fill(model, 2, 2, 2, 4, 18, 4, TOWN_IRON);
    fill(model, 1, 17, 1, 5, 18, 5, TOWN_IRON);
    fill(model, 1, 18, 1, 5, 22, 5, TOWN_GLOW);
    for (int32_t i = 0; i < 4; i++)
        fill(model, i & 1 ? 4 : 1, 18, i & 2 ? 4 : 1, i & 1 ? 5 : 2, 22, i & 2 ? 5 : 2, TOWN_IRON);
    fill(model, 0, 22, 0, 6, 23, 6, TOWN_IRON);
    fill(model, 1, 23, 1, 5, 24, 5, TOWN_IRON);
    fill(model, 2, 24, 2, 4, 25, 4, TOWN_IRON);
    return true;
}

bool town_make_stall(struct voxel_model *model)
{
    if (!voxel_create(model, 26, 22, 18, 0.125f))
        return false;
    for (int32_t i = 0; i < 4; i++) {
        int32_t x = i & 1 ? 23 : 1, z = i & 2 ? 15 : 1;
        fill(model, x, 0, z, x + 2, i & 2 ? 17 : 20, z + 2, TOWN_TIMBER);
    }
    fill(model, 1, 5, 3, 25, 7, 15, TOWN_PLANKS);
    fill(model, 2, 0, 12, 24, 5, 13, TOWN_PLANKS);
    for (int32_t k = 0; k < 4; k++) { // crates with fruit
        int32_t x = 2 + 6 * k;
        fill(model, x, 7, 5, x + 5, 9, 13, TOWN_TIMBER);
        fill(model, x + 1, 8, 6, x + 4, 9 + k % 2, 12, TOWN_FRUIT);
    }
    for (int32_t z = 0; z < 18; z++) // the awning falls towards the front
        fill(model, 0, 21 - z / 4, z, 26, 22 - z / 4, z + 1, TOWN_STRIPES);
    fill(model, 0, 15, 17, 26, 17, 18, TOWN_STRIPES);
    return true;
}

bool town_make_well(struct voxel_model *model)
{
    if (!voxel_create(model, 24, 20, 24, 0.25f))
        return false;
    for (int32_t z = 0; z < 24; z++) {
        for (int32_t x = 0; x < 24; x++) {
            float r = hypotf((float)x - 11.5f, (float)z - 11.5f);
            if (r < 12)
                fill(model, x, 0, z, x + 1, 1, z + 1, TOWN_PAVING);
            if (r < 9.6f)
                fill(model, x, 1, z, x + 1, r > 8.2f ? 4 : 3, z + 1, r > 8.2f ? TOWN_STONE : TOWN_WATER);
            if (r < 2.7f)
                fill(model, x, 1, z, x + 1, 9, z + 1, TOWN_STONE);
            if (r < 4.7f)
                fill(model, x, 9, z, x + 1, r > 3.6f ? 11 : 10, z + 1, r > 3.6f ? TOWN_STONE : TOWN_WATER);
            if (r < 1.6f)
                fill(model, x, 10, z, x + 1, 15, z + 1, TOWN_STONE);
        }
    }
    fill(model, 11, 15, 11, 13, 17, 13, TOWN_IRON);
    fill(model, 10, 16, 10, 14, 18, 14, TOWN_IRON);
    return true;
}

// Across the river along z; its roadway at ground level, arches below.
bool town_make_bridge(struct voxel_model *model)
{
    const int32_t length = 48, deck = 10;
    if (!voxel_create(model, 24, deck + 6, length, 0.25f))
        return false;
    // A little above the banks, so that roadway and ground do not fight for the same depth.
    model->origin[1] = -(float)deck * 0.25f + 0.03f;
    for (int32_t z = 0; z < length; z++) {
        float t = ((float)z + 0.5f) / (float)length * 2 - 1, along = fabsf(fmodf((float)z + 0.5f, 24) - 12);
        int32_t top = deck + (int32_t)lrintf(1.6f * (1 - t * t));
        int32_t under = along < 9 ? 1 + (int32_t)sqrtf(81 - along * along) * 7 / 9 : 0;
        fill(model, 1, under, z, 23, top, z + 1, TOWN_STONE);
        fill(model, 3, top - 1, z, 21, top, z + 1, TOWN_COBBLE);
        fill(model, 1, top, z, 3, top + 3, z + 1, TOWN_STONE);
        fill(model, 21, top, z, 23, top + 3, z + 1, TOWN_STONE);
        if (z % 12 == 0) {
            fill(model, 0, top - 2, z, 3, top + 4, z + 2, TOWN_STONE);
            fill(model, 21, top - 2, z, 24, top + 4, z + 2, TOWN_STONE);
        }
    }
    return true;
}

bool town_make_hay(struct voxel_model *model)
{
    if (!voxel_create(model, 10, 9, 8, 0.25f))
        return false;
    fill(model, 0, 0, 0, 6, 4, 4, TOWN_THATCH);
    fill(model, 1, 0, 4, 5, 3, 8, TOWN_THATCH);
    fill(model, 6, 0, 1, 10, 3, 5, TOWN_PLANKS);
    fill(model, 1, 4, 0, 5, 7, 4, TOWN_THATCH);
    return true;
}

bool town_make_models(struct town *town)
{
    struct voxel_model *m = town->models;
    bool ok = true;
    for (uint32_t i = 0; i < TOWN_HOUSES; i++)
        ok = ok && town_make_house(&m[TOWN_HOUSE + i], i, town->seed);
    for (uint32_t i = 0; i < TOWN_TREES; i++)
        ok = ok && town_make_tree(&m[TOWN_TREE + i], i, town->seed);
    return ok && town_make_lamp(&m[TOWN_LAMP]) && town_make_stall(&m[TOWN_STALL]) &&
           town_make_well(&m[TOWN_WELL]) && town_make_bridge(&m[TOWN_BRIDGE]) &&
           town_make_tower(&m[TOWN_TOWER]) && town_make_hay(&m[TOWN_HAY]);
}
