// The ground as columns of cells, with the sky that houses and trees leave it.
#include "stimuli/builtin/random.h"
#include "stimuli/builtin/town_parts.h"

#include <math.h>
#include <stdlib.h>

#define PI 3.14159265f

enum { TOPS = 2 * (2 * TOWN_RINGS + 1) * 30 }; // cells of 0.5 m a side
#define TOPS_HALF ((float)TOPS * 0.25f)        // metres

static float *top_at(const struct town *town, float x, float z)
{
    int32_t i = (int32_t)floorf((x + TOPS_HALF) * 2), j = (int32_t)floorf((z + TOPS_HALF) * 2);
    if (i < 0 || j < 0 || i >= TOPS || j >= TOPS)
        return NULL;
    return &town->tops[j * TOPS + i];
}

static void stamp(struct town *town, const struct town_item *item, const float *columns)
{
    const struct voxel_model *m = &town->models[item->model];
    static const float cosine[4] = {1, 0, -1, 0}, sine[4] = {0, 1, 0, -1};
    float c = cosine[item->quarter], s = sine[item->quarter];
    for (int32_t z = 0; z < m->size[2]; z++) {
        for (int32_t x = 0; x < m->size[0]; x++) {
            float height = columns[z * m->size[0] + x];
            float px = m->origin[0] + ((float)x + 0.5f) * m->cell_m,
                  pz = m->origin[2] + ((float)z + 0.5f) * m->cell_m;
            float *top = top_at(town, item->x + px * c + pz * s, item->z - px * s + pz * c);
            if (top != NULL && height > -1e3f)
                *top = fmaxf(*top, item->y + height);
        }
    }
}

bool town_make_tops(struct town *town)
{
    town->tops = malloc(sizeof(float) * TOPS * TOPS);
    if (town->tops == NULL)
        return false;
    for (int32_t j = 0; j < TOPS; j++)
        for (int32_t i = 0; i < TOPS; i++)
            town->tops[j * TOPS + i] = -1e4f;
    for (int k = 0; k < TOWN_MODELS; k++) {
        const struct voxel_model *m = &town->models[k];
        float *columns = malloc(sizeof(float) * (size_t)m->size[0] * (size_t)m->size[2]);
        if (columns == NULL)
            return false;
        for (int32_t z = 0; z < m->size[2]; z++) {
            for (int32_t x = 0; x < m->size[0]; x++) {
                int32_t y = m->size[1];
                while (y > 0 && voxel_at(m, x, y - 1, z) == VOXEL_AIR)
                    y--;
                columns[z * m->size[0] + x] = y > 0 ? m->origin[1] + (float)y * m->cell_m : -1e4f;
            }
        }
        for (uint32_t b = 0; b < town->built; b++)
            for (uint32_t i = 0; i < town->blocks[b].shown; i++)
                if (town->blocks[b].items[i].model == (enum town_model)k)
                    stamp(town, &town->blocks[b].items[i], columns);
        free(columns);
    }
    return true;
}

static float sky_share(const struct town *town, float x, float y, float z)
{
    static const float reach[5] = {0.4f, 0.9f, 1.8f, 3.6f, 7.0f};
    float open = 0;
    for (int k = 0; k < 8; k++) {
        float a = ((float)k + 0.25f) * PI / 4, steepest = 0;
        for (int i = 0; i < 5; i++) {
            const float *top = top_at(town, x + reach[i] * cosf(a), z + reach[i] * sinf(a));
            if (top != NULL)
                steepest = fmaxf(steepest, (*top - y) / reach[i]);
        }
        open += 1 / (1 + steepest * steepest); // cos^2 of the horizon's height
    }
    return open / 8;
}

// Share of the sky that does not reach a level surface; a quarter of its light comes back from what hides it.
static float hidden_share(const struct town *town, float x, float y, float z)
{
    return 0.75f * (1 - sky_share(town, x, y, z));
}

struct lattice {
    float height;
    uint32_t material, vertex; // vertex + 1
    float hidden;
    bool lit;
};

struct ground {
    struct town *town;
    const struct town_block *block;
    float cell, x0, z0;
    int32_t cells;
    bool fine, count_only;
    struct lattice *lattice;
    uint32_t quads;
};

static uint32_t top_vertex(struct ground *g, int32_t i, int32_t j, float height, const struct voxel_kind *kind)
{
    struct lattice *l = &g->lattice[j * (g->cells + 1) + i];
    float x = g->x0 + (float)i * g->cell, z = g->z0 + (float)j * g->cell;
    bool same = l->lit && fabsf(l->height - height) < 1e-4f;
    if (same && l->vertex > 0 && l->material == kind->top)
        return l->vertex - 1;
    if (!same) {
        l->height = height;
        l->hidden = g->fine ? hidden_share(g->town, x, height, z) : 0;
        l->lit = true;
    }
    struct maker_vertex v = {.position = {x, height, z},
                             .normal = {0, 1, 0},
                             .tangent = {1, 0, 0, 1},
                             .uv = {x / kind->tile_m, z / kind->tile_m},
                             .colour = {1, 1, 1},
                             .hidden = l->hidden};
    l->material = kind->top;
    l->vertex = maker_vertex(g->town->maker, kind->top, &v) + 1;
    return l->vertex - 1;
}

static void add_top(struct ground *g, int32_t i, int32_t j, float height, const struct voxel_kind *kind)
{
    g->quads++;
    if (g->count_only)
        return;
    uint32_t a = top_vertex(g, i, j + 1, height, kind), b = top_vertex(g, i + 1, j + 1, height, kind);
    uint32_t c = top_vertex(g, i + 1, j, height, kind), d = top_vertex(g, i, j, height, kind);
    maker_triangle(g->town->maker, kind->top, a, b, c);
    maker_triangle(g->town->maker, kind->top, a, c, d);
}

// The wall of a cell towards (di, dj), from `low` to `high`.
static void add_side(struct ground *g, int32_t i, int32_t j, int32_t di, int32_t dj, float low, float high,
                     uint32_t material)
{
    g->quads++;
    if (g->count_only)
        return;
    float mx = g->x0 + ((float)i + 0.5f + 0.5f * (float)di) * g->cell,
          mz = g->z0 + ((float)j + 0.5f + 0.5f * (float)dj) * g->cell;
    float rx = (float)dj, rz = -(float)di, half = 0.5f * g->cell; // to the right, seen from outside
    uint32_t corner[4];
    for (int k = 0; k < 4; k++) {
        float side = k & 1 ? half : -half, y = k & 2 ? high : low, light = k & 2 ? 0.85f : 0.6f;
        float x = mx + rx * side, z = mz + rz * side;
        struct maker_vertex v = {.position = {x, y, z},
                                 .normal = {(float)di, 0, (float)dj},
                                 .tangent = {rx, 0, rz, 1},
                                 .uv = {(x * rx + z * rz) / 2, -y / 2},
                                 .colour = {1, 1, 1},
                                 .hidden = 1 - light};
        corner[k] = maker_vertex(g->town->maker, material, &v);
    }
    maker_triangle(g->town->maker, material, corner[0], corner[1], corner[3]);
    maker_triangle(g->town->maker, material, corner[0], corner[3], corner[2]);
}

// Two crossed sheets, each with both its sides, under the sky of the ground they stand on.
static void add_tuft(struct ground *g, float x, float y, float z, uint64_t id, float sparse)
{
    struct town *town = g->town;
    uint64_t seed = town->seed * 7 + 3;
    if (random_unit(seed, id) > sparse)
        return;
    x += random_range(seed + 1, id, -0.4f, 0.4f);
    z += random_range(seed + 2, id, -0.4f, 0.4f);
    const float *top = g->count_only ? NULL : top_at(town, x, z);
    bool flower = random_unit(seed + 3, id) > 0.72f;
    g->quads += 4;
    if (g->count_only)
        return;
    float size = top != NULL && *top > y + 0.2f ? 0.18f : random_range(seed + 4, id, 0.4f, 0.75f);
    float turn = random_range(seed + 5, id, 0, PI);
    uint32_t material = town->kinds[flower ? TOWN_FLOWER : TOWN_TUFT].side;
    float hidden = hidden_share(town, x, y, z);
    for (int sheet = 0; sheet < 4; sheet++) {
        float a = turn + (float)sheet * PI / 2, dx = 0.5f * size * cosf(a), dz = 0.5f * size * sinf(a);
        uint32_t corner[4];
        for (int k = 0; k < 4; k++) {
            float side = k & 1 ? 1.0f : -1.0f, up = k & 2 ? 1.0f : 0.0f, shade = 0.65f + 0.35f * up;
            struct maker_vertex v = {.position = {x + dx * side, y + up * size * 0.8f, z + dz * side},
                                     .normal = {0, 1, 0},
                                     .tangent = {cosf(a), 0, sinf(a), 1},
                                     .uv = {0.5f + 0.5f * side, 1 - up},
                                     .colour = {shade, shade, shade},
                                     .hidden = hidden};
            corner[k] = maker_vertex(town->maker, material, &v);
        }
        maker_triangle(town->maker, material, corner[0], corner[1], corner[3]);
        maker_triangle(town->maker, material, corner[0], corner[3], corner[2]);
    }
}

static void add_cell(struct ground *g, int32_t i, int32_t j)
{
    const struct town *town = g->town;
    float x = g->x0 + ((float)i + 0.5f) * g->cell, z = g->z0 + ((float)j + 0.5f) * g->cell;
    float height = town_ground(town, x, z);
    enum town_kind kind = g->fine ? town_ground_kind(town, x, z) : TOWN_GRASS;
    bool wet = height < TOWN_WATER_Y;
    add_top(g, i, j, wet ? TOWN_WATER_Y : height, &town->kinds[wet ? TOWN_WATER : kind]);
    static const int32_t steps[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    for (int k = 0; k < 4 && !wet; k++) {
        int32_t ni = i + steps[k][0], nj = j + steps[k][1];
        float low = town_ground(town, x + (float)steps[k][0] * g->cell, z + (float)steps[k][1] * g->cell);
        bool border = ni < 0 || nj < 0 || ni >= g->cells || nj >= g->cells;
        // Blocks of another cell size sample other heights: close any gap between them.
        if (border && (height > 0.1f || !g->fine))
            low = fminf(low, height) - 2;
        if (low < height - 0.01f) {
            bool bank = z > TOWN_RIVER_Z0 - 3 && z < TOWN_RIVER_Z1 + 3 && low < TOWN_WATER_Y;
            enum town_kind side = bank || kind == TOWN_COBBLE || kind == TOWN_STONE ? TOWN_STONE : TOWN_DIRT;
            add_side(g, i, j, steps[k][0], steps[k][1], low, height, town->kinds[side].side);
        }
    }
    if (g->fine && kind == TOWN_GRASS && town->wanted >= 100000)
        add_tuft(g, x, height, z, random_place(i + g->block->i * 128, 11, j + g->block->j * 128),
                 0.3f * g->cell * g->cell);
}

uint32_t town_add_ground(struct town *town, const struct town_block *block, bool fine, bool count_only)
{
    int32_t far_i = abs(block->i), far_j = abs(block->j);
    float cell = fine ? town->ground_cell : town->country_cell;
    if (fine && town->wanted >= 1000000 && far_i <= 1 && far_j <= 1)
        cell = 0.5f; // finer light where the camera goes
    struct ground g = {.town = town, .block = block, .cell = cell, .fine = fine, .count_only = count_only};
    g.cells = (int32_t)lrintf(TOWN_PERIOD / cell);
    g.x0 = ((float)block->i - 0.5f) * TOWN_PERIOD;
    g.z0 = ((float)block->j - 0.5f) * TOWN_PERIOD;
    g.lattice = calloc((size_t)(g.cells + 1) * (size_t)(g.cells + 1), sizeof *g.lattice);
    if (g.lattice == NULL) {
        town->maker->failed = true;
        return 0;
    }
    for (int32_t j = 0; j < g.cells; j++)
        for (int32_t i = 0; i < g.cells; i++)
            add_cell(&g, i, j);
    free(g.lattice);
    return 2 * g.quads;
}
