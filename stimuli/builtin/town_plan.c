// Where things stand: ground, blocks and their items.
#include "stimuli/builtin/random.h"
#include "stimuli/builtin/town_parts.h"

#include <math.h>
#include <stdlib.h>

static float smooth(float low, float high, float v)
{
    float t = fminf(fmaxf((v - low) / (high - low), 0), 1);
    return t * t * (3 - 2 * t);
}

// Value noise with cells of `cell` metres, 0..1.
static float hills(uint64_t seed, float x, float z, float cell)
{
    float fx = x / cell, fz = z / cell;
    int32_t ix = (int32_t)floorf(fx), iz = (int32_t)floorf(fz);
    fx -= (float)ix;
    fz -= (float)iz;
    fx = fx * fx * (3 - 2 * fx);
    fz = fz * fz * (3 - 2 * fz);
    float a = random_unit(seed, random_place(ix, 7, iz)), b = random_unit(seed, random_place(ix + 1, 7, iz));
    float c = random_unit(seed, random_place(ix, 7, iz + 1)),
          d = random_unit(seed, random_place(ix + 1, 7, iz + 1));
    return a + (b - a) * fx + (c - a) * fz + (a - b - c + d) * fx * fz;
}

static bool in_river(float z)
{
    return z > TOWN_RIVER_Z0 && z < TOWN_RIVER_Z1;
}

// Position inside a period, -15..15: within 12 the block, outside the street.
static float in_period(float v)
{
    return v - TOWN_PERIOD * floorf(v / TOWN_PERIOD + 0.5f);
}

float town_ground(const struct town *town, float x, float z)
{
    if (in_river(z))
        return TOWN_WATER_Y - 0.75f;
    float away = hypotf(x, z), rise = smooth(48, 150, away);
    float height = rise * (2.0f + 9.0f * hills(town->seed, x, z, 60)) +
                   16.0f * smooth(150, 260, away) * hills(town->seed + 1, x, z, 45);
    height *= smooth(0, 24, fabsf(z - 0.5f * (TOWN_RIVER_Z0 + TOWN_RIVER_Z1)) - 6);
    // Steps of half a block; streets and blocks alike.
    return 0.5f * floorf(height * 2 + 0.5f);
}

enum block_use { GARDEN, SQUARE, PARK };

static enum block_use block_use(const struct town *town, int32_t i, int32_t j)
{
    if (i == 0 && j == 0)
        return SQUARE;
    if ((i == 1 && j == -1) || (abs(i) + abs(j) > 1 && random_unit(town->seed, random_place(i, 3, j)) > 0.86f))
        return PARK;
    return GARDEN;
}

enum town_kind town_ground_kind(const struct town *town, float x, float z)
{
    if (in_river(z))
        return TOWN_DIRT;
    int32_t i = (int32_t)floorf(x / TOWN_PERIOD + 0.5f), j = (int32_t)floorf(z / TOWN_PERIOD + 0.5f);
    if (hypotf(x, z) > 150)
        return TOWN_GRASS;
    float px = fabsf(in_period(x)), pz = fabsf(in_period(z));
    bool street = px > TOWN_BLOCK / 2 || pz > TOWN_BLOCK / 2;
    if (z > TOWN_RIVER_Z0 && z < 45) // the far bank: a strip of road, then gardens
        street = px > TOWN_BLOCK / 2 || z < TOWN_RIVER_Z1 + 3;
    if (street)
        return hypotf(x, z) > 75 && px < TOWN_BLOCK / 2 ? TOWN_DIRT : TOWN_COBBLE;
    if (block_use(town, i, j) == SQUARE)
        return px < 11 && pz < 11 ? TOWN_PAVING : TOWN_STONE;
    if (block_use(town, i, j) == GARDEN && (px > 11 || pz > 11))
        return TOWN_STONE; // a pavement along the street
    return TOWN_GRASS;
}

static void add(const struct town *town, struct town_block *block, enum town_model model, float x, float z,
                uint32_t quarter)
{
    if (block->item_count == TOWN_ITEMS_PER_BLOCK)
        return;
    float wx = (float)block->i * TOWN_PERIOD + x, wz = (float)block->j * TOWN_PERIOD + z;
    block->items[block->item_count++] =
        (struct town_item){model, wx, model == TOWN_BRIDGE ? 0.0f : town_ground(town, wx, wz), wz, quarter % 4};
}

static uint32_t pick(const struct town *town, const struct town_block *block, uint32_t which, uint32_t n)
{
    return random_below(town->seed, random_place(block->i, (int32_t)which, block->j), n);
}

static enum town_model tree(const struct town *town, const struct town_block *block, uint32_t which)
{
    return TOWN_TREE + pick(town, block, 100 + which, TOWN_TREES);
}

static void plan_square(const struct town *town, struct town_block *b)
{
    add(town, b, TOWN_WELL, 0, 0, 0);
    for (uint32_t k = 0; k < 4; k++) {
        float x = k & 1 ? 1.0f : -1.0f, z = k & 2 ? 1.0f : -1.0f;
        add(town, b, TOWN_LAMP, 10.5f * x, 10.5f * z, 0);
        add(town, b, TOWN_TREE + k % 4, 7.75f * x, 8.25f * z, k);
    }
    add(town, b, TOWN_STALL, -8.5f, -2.6f, 1);
    add(town, b, TOWN_STALL, -8.5f, 1.8f, 1);
    add(town, b, TOWN_STALL, 8.9f, 5.2f, 3);
    add(town, b, TOWN_STALL, 1.5f, -9.0f, 0);
    add(town, b, TOWN_STALL, -3.0f, -9.2f, 0);
    add(town, b, TOWN_HAY, -2.6f, 9.2f, 1);
    add(town, b, TOWN_LAMP, -10.4f, -0.4f, 0);
    add(town, b, TOWN_LAMP, 10.4f, 1.2f, 0);
    add(town, b, TOWN_LAMP, -0.7f, -10.4f, 0);
    add(town, b, TOWN_LAMP, 0.5f, 10.4f, 0);
}

static void plan_park(const struct town *town, struct town_block *b)
{
    for (uint32_t k = 0; k < 9; k++) {
        float x = -8.0f + 8.0f * (float)(k % 3), z = -8.0f + 8.0f * (float)(k / 3);
        if (k != 4)
            add(town, b, tree(town, b, k), x + 0.5f * (float)pick(town, b, 20 + k, 4) - 1,
                z + 0.5f * (float)pick(town, b, 40 + k, 4) - 1, k);
    }
    add(town, b, TOWN_HAY, 0.5f, 1.0f, pick(town, b, 60, 4));
    add(town, b, TOWN_LAMP, -10.5f, -10.5f, 0);
    add(town, b, TOWN_LAMP, 10.5f, 10.5f, 0);
}

static void plan_houses(const struct town *town, struct town_block *b)
{
    bool far_bank = b->j == 1;
    // Four houses, each towards a different street around the block; at the far bank only the row away from the
    // river.
    for (uint32_t k = 0; k < 4; k++) {
        float x = k & 1 ? 5.75f : -5.75f, z = k & 2 ? 5.75f : -5.75f;
        if (far_bank && z < 0)
            continue;
        static const uint32_t front[4] = {2, 1, 3, 0}; // quarter turns of the door, from z+
        uint32_t turn = far_bank ? 2 : front[k],
                 which = (pick(town, b, k, 3) * 4 + k + 3 * (uint32_t)abs(b->i) + 5 * (uint32_t)abs(b->j)) %
                         TOWN_HOUSES;
        // At the distance only towers may break the row.
        bool tower = b->i == -1 && b->j == -1 && k == 3;
        add(town, b, tower ? TOWN_TOWER : TOWN_HOUSE + which, x, z, turn);
    }
    static const float trees[5][2] = {{0, 0}, {0.5f, -10.0f}, {-0.5f, 10.0f}, {10.2f, 0.2f}, {-10.2f, 0}};
    for (uint32_t k = 0; k < 5; k++)
        if (pick(town, b, 30 + k, 3) > 0 && (!far_bank || trees[k][1] > 1))
            add(town, b, tree(town, b, k), trees[k][0], trees[k][1], k);
    add(town, b, TOWN_LAMP, 11.5f, far_bank ? 1.25f : -11.5f, 0);
    add(town, b, TOWN_LAMP, -11.5f, 11.5f, 0);
}

static int by_distance(const void *a, const void *b)
{
    const struct town_block *p = a, *q = b;
    int32_t dp = p->i * p->i + p->j * p->j, dq = q->i * q->i + q->j * q->j;
    if (dp != dq)
        return dp < dq ? -1 : 1;
    int32_t ip = p->i * 64 + p->j, iq = q->i * 64 + q->j; // a fixed order among equals
    return (ip > iq) - (ip < iq);
}

void town_plan(struct town *town)
{
    struct town_block *b = town->blocks;
    for (int32_t j = -TOWN_RINGS; j <= TOWN_RINGS; j++)
        for (int32_t i = -TOWN_RINGS; i <= TOWN_RINGS; i++)
            *b++ = (struct town_block){.i = i, .j = j};
    qsort(town->blocks, TOWN_BLOCKS, sizeof *town->blocks, by_distance);
    for (int32_t k = 0; k < TOWN_BLOCKS; k++) {
        b = &town->blocks[k];
        enum block_use use = block_use(town, b->i, b->j);
        if (b->j == 1 && b->i == 0) {
            plan_houses(town, b);
            continue;
        }
        if (b->j == 1 && abs(b->i) <= 1) // bridges carry the streets beside the square over the river
            add(town, b, TOWN_BRIDGE, b->i < 0 ? 15.0f : -15.0f,
                0.5f * (TOWN_RIVER_Z0 + TOWN_RIVER_Z1) - TOWN_PERIOD, 0);
        if (use == SQUARE)
            plan_square(town, b);
        else if (use == PARK && b->j != 1)
            plan_park(town, b);
        else
            plan_houses(town, b);
    }
}
