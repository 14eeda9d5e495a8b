// Houses of 0.25 m cells. Each stands on a footing that reaches 1 m below its ground level and faces z+.
#include "stimuli/builtin/random.h"
#include "stimuli/builtin/town_models.h"

#include <stdlib.h>

enum { FOOTING = 4, SIDE = 46, TALL = 76 };

struct house {
    struct voxel_model *m;
    uint64_t seed;
    int32_t x0, x1, z0, z1;  // of the ground floor, in cells
    int32_t storeys, storey; // cells a storey
    uint8_t ground, wall, frame, roof;
    bool timbered, gable_x; // the ridge runs along x
};

static void fill(const struct house *h, int32_t x0, int32_t y0, int32_t z0, int32_t x1, int32_t y1, int32_t z1,
                 int kind)
{
    voxel_fill(h->m, (int32_t[]){x0, y0, z0}, (int32_t[]){x1, y1, z1}, (uint8_t)kind);
}

// A wall seen from outside: `along` runs to the right, `out` is how far before the wall (negative: inside it).
struct face {
    const struct house *h;
    int32_t x0, x1, z0, z1; // the storey's outline
    int side;               // 0: z+, 1: x+, 2: z-, 3: x-
};

static int32_t face_width(const struct face *f)
{
    return f->side % 2 ? f->z1 - f->z0 : f->x1 - f->x0;
}

static void face_fill(const struct face *f, int32_t along0, int32_t along1, int32_t y0, int32_t y1, int32_t out,
                      int kind)
{
    for (int32_t a = along0; a < along1; a++) {
        int32_t x = f->side == 0   ? f->x0 + a
                    : f->side == 2 ? f->x1 - 1 - a
                    : f->side == 1 ? f->x1 + out
                                   : f->x0 - 1 - out;
        int32_t z = f->side == 0   ? f->z1 + out
                    : f->side == 2 ? f->z0 - 1 - out
                    : f->side == 1 ? f->z1 - 1 - a
                                   : f->z0 + a;
        for (int32_t y = y0; y < y1; y++)
            voxel_put(f->h->m, x, y, z, (uint8_t)kind);
    }
}

static void add_window(const struct face *f, int32_t middle, int32_t y, bool shutters)
{
    int32_t a = middle - 2, b = middle + 2;
    face_fill(f, a - 1, b + 1, y - 1, y + 6, -1, f->h->frame);
    face_fill(f, a, b, y, y + 5, -1, TOWN_AIR);
    face_fill(f, a, b, y, y + 5, -2, TOWN_GLASS);
    face_fill(f, a - 1, b + 1, y - 1, y, 0, f->h->frame);
    if (shutters) {
        int kind = f->h->roof == TOWN_ROOF_SLATE ? TOWN_SAGE : TOWN_PLANKS;
        face_fill(f, a - 3, a - 1, y, y + 5, 0, kind);
        face_fill(f, b + 1, b + 3, y, y + 5, 0, kind);
    } else if (random_unit(f->h->seed, (uint64_t)(middle * 64 + y)) > 0.55f) {
        // A flower box on the sill.
        face_fill(f, a, b, y, y + 1, 0, TOWN_BLOSSOM);
    }
}

static void add_door(const struct face *f, int32_t middle)
{
    int32_t y = FOOTING;
    face_fill(f, middle - 3, middle + 3, y, y + 10, -1, f->h->frame);
    face_fill(f, middle - 2, middle + 2, y, y + 9, -1, TOWN_AIR);
    face_fill(f, middle - 2, middle + 2, y, y + 9, -2, TOWN_PLANKS);
    face_fill(f, middle - 2, middle + 2, y + 7, y + 8, -2, TOWN_GLASS);
    face_fill(f, middle - 3, middle + 3, y + 11, y + 12, 0, f->h->roof);
    face_fill(f, middle - 3, middle + 3, y + 11, y + 12, 1, f->h->roof);
    face_fill(f, middle - 3, middle + 3, y - 4, y, 0, TOWN_STONE);
    face_fill(f, middle - 3, middle + 3, y - 4, y - 1, 1, TOWN_STONE);
}

static void add_timbers(const struct face *f, int32_t y0, int32_t y1)
{
    int32_t width = face_width(f);
    face_fill(f, 0, width, y0, y0 + 1, -1, f->h->frame);
    face_fill(f, 0, width, y1 - 1, y1, -1, f->h->frame);
    for (int32_t a = 0; a < width; a += 6)
        face_fill(f, a, a + 1, y0, y1, -1, f->h->frame);
    face_fill(f, width - 1, width, y0, y1, -1, f->h->frame);
    // Braces in the outer fields.
    for (int32_t k = 0; k < 5; k++) {
        face_fill(f, 1 + k, 2 + k, y0 + 1 + k, y0 + 3 + k, -1, f->h->frame);
        face_fill(f, width - 2 - k, width - 1 - k, y0 + 1 + k, y0 + 3 + k, -1, f->h->frame);
    }
}

static void add_storey(const struct house *h, int32_t number)
{
    int32_t jetty = number > 0 && h->timbered ? 2 : 0, y0 = FOOTING + number * h->storey, y1 = y0 + h->storey;
    struct face f = {h, h->x0 - jetty, h->x1 + jetty, h->z0 - jetty, h->z1 + jetty, 0};
    bool timbered = h->timbered && number > 0;
    fill(h, f.x0, y0, f.z0, f.x1, y1, f.z1, number == 0 ? h->ground : h->wall);
    if (number > 0 && !timbered) // a string course
        fill(h, f.x0 - 1, y0, f.z0 - 1, f.x1 + 1, y0 + 1, f.z1 + 1, TOWN_STONE);
    for (f.side = 0; f.side < 4; f.side++) {
        int32_t width = face_width(&f), windows = (width - 4) / 9;
        if (timbered)
            add_timbers(&f, y0, y1);
        bool door = number == 0 && f.side == 0;
        for (int32_t i = 0; i < windows; i++) {
            int32_t middle = width * (2 * i + 1) / (2 * windows);
            bool here = door && i == windows / 2;
            if (here)
                add_door(&f, middle);
            else
                add_window(&f, middle, y0 + 3, !timbered && (h->seed >> 3) % 2 == 0);
        }
        if (!timbered) // quoins
            for (int32_t y = y0; y < y1; y++) {
                int32_t reach = y / 2 % 2 ? 2 : 1;
                face_fill(&f, 0, reach, y, y + 1, -1, TOWN_STONE);
                face_fill(&f, width - reach, width, y, y + 1, -1, TOWN_STONE);
            }
    }
}

static void add_roof(const struct house *h)
{
    int32_t jetty = h->storeys > 1 && h->timbered ? 2 : 0, y = FOOTING + h->storeys * h->storey;
    int32_t x0 = h->x0 - jetty, x1 = h->x1 + jetty, z0 = h->z0 - jetty, z1 = h->z1 + jetty;
    int32_t across = h->gable_x ? z1 - z0 : x1 - x0, half = (across + 1) / 2;
    for (int32_t k = -2; k < half; k++) {
        int32_t level = y + k, over = 2;
        for (int32_t flip = 0; flip < 2; flip++) {
            int32_t a = flip ? across - 1 - k : k;
            if (h->gable_x)
                fill(h, x0 - over, level, z0 + a, x1 + over, level + 2, z0 + a + 1, h->roof);
            else
                fill(h, x0 + a, level, z0 - over, x0 + a + 1, level + 2, z1 + over, h->roof);
        }
        if (k < 0 || across - 1 - 2 * k <= 0)
            continue;
        // The gable and all below the roof's skin.
        if (h->gable_x)
            fill(h, x0, level, z0 + k + 1, x1, level + 1, z0 + across - 1 - k, h->wall);
        else
            fill(h, x0 + k + 1, level, z0, x0 + across - 1 - k, level + 1, z1, h->wall);
    }
    struct face f = {h, x0, x1, z0, z1, h->gable_x ? 1 : 0};
    for (int i = 0; i < 2; i++, f.side += 2)
        if (half > 11)
            add_window(&f, face_width(&f) / 2, y + 2, false);
}

static void add_chimney(const struct house *h)
{
    int32_t ridge = FOOTING + h->storeys * h->storey + (h->gable_x ? h->z1 - h->z0 : h->x1 - h->x0) / 2;
    int32_t x = h->gable_x ? h->x0 + 4 : (h->x0 + h->x1) / 2 + 4,
            z = h->gable_x ? (h->z0 + h->z1) / 2 + 3 : h->z0 + 5;
    fill(h, x, FOOTING + h->storey, z, x + 4, ridge + 5, z + 4, TOWN_BRICK);
    fill(h, x - 1, ridge + 5, z - 1, x + 5, ridge + 6, z + 5, TOWN_STONE);
    fill(h, x + 1, ridge + 6, z + 1, x + 3, ridge + 8, z + 3, TOWN_BRICK);
}

bool town_make_house(struct voxel_model *model, uint32_t number, uint64_t seed)
{
    if (!voxel_create(model, SIDE, TALL, SIDE, TOWN_CELL))
        return false;
    model->origin[1] = -FOOTING * TOWN_CELL;
    uint64_t s = random_bits(seed, 900 + number);
    static const uint8_t walls[] = {TOWN_PLASTER, TOWN_OCHRE, TOWN_BRICK, TOWN_ROSE, TOWN_PLASTER, TOWN_SAGE};
    static const uint8_t roofs[] = {TOWN_ROOF_RED, TOWN_ROOF_SLATE, TOWN_ROOF_RED,
                                    TOWN_THATCH,   TOWN_ROOF_RED,   TOWN_ROOF_SLATE};
    struct house h = {.m = model, .seed = s, .storey = 11, .frame = TOWN_TIMBER};
    h.wall = walls[number % 6];
    h.roof = roofs[(number + number / 6 + random_below(seed, 950, 3) * 2) % 6];
    h.timbered = h.wall != TOWN_BRICK && (number % 3 != 1);
    h.ground = h.timbered ? (number % 2 ? TOWN_STONE : h.wall) : h.wall;
    h.storeys = h.roof == TOWN_THATCH ? 1 + (int32_t)(s % 2) : 2 + (int32_t)(s % 5 == 0) + (number % 4 == 3);
    if (h.storeys > 3)
        h.storeys = 3;
    h.gable_x = s >> 8 & 1;
    int32_t wide = 26 + (int32_t)(s >> 10 & 3) * 3, deep = 24 + (int32_t)(s >> 14 & 3) * 3;
    if (h.storeys == 3) // keep the roof inside the model
        deep = wide = 26;
    h.x0 = (SIDE - wide) / 2;
    h.x1 = h.x0 + wide;
    h.z0 = (SIDE - deep) / 2;
    h.z1 = h.z0 + deep;
    fill(&h, h.x0, 0, h.z0, h.x1, FOOTING, h.z1, TOWN_STONE);
    fill(&h, h.x0 - 1, 0, h.z0 - 1, h.x1 + 1, FOOTING + 1, h.z1 + 1, TOWN_STONE);
    for (int32_t i = 0; i < h.storeys; i++)
        add_storey(&h, i);
    add_roof(&h);
    add_chimney(&h);
    return true;
}

// A gate tower of a church's height with a steep slate roof.
bool town_make_tower(struct voxel_model *model)
{
    const int32_t side = 36, wall = 60, x0 = 5, x1 = 31;
    if (!voxel_create(model, side, 104, side, TOWN_CELL))
        return false;
    model->origin[1] = -FOOTING * TOWN_CELL;
    struct house h = {.m = model, .seed = 5, .frame = TOWN_STONE, .wall = TOWN_STONE, .roof = TOWN_ROOF_SLATE};
    fill(&h, x0 - 2, 0, x0 - 2, x1 + 2, FOOTING + 3, x1 + 2, TOWN_STONE);
    fill(&h, x0, 0, x0, x1, wall, x1, TOWN_STONE);
    struct face f = {&h, x0, x1, x0, x1, 0};
    for (f.side = 0; f.side < 4; f.side++) {
        face_fill(&f, 0, 4, FOOTING, wall, 0, TOWN_STONE); // corner buttresses
        face_fill(&f, x1 - x0 - 4, x1 - x0, FOOTING, wall - 6, 0, TOWN_STONE);
        for (int32_t y = 16; y < wall - 20; y += 14)
            add_window(&f, 13, y, false);
        face_fill(&f, 8, 18, wall - 14, wall - 3, -1, TOWN_AIR); // the belfry
        face_fill(&f, 8, 18, wall - 14, wall - 3, -2, TOWN_TIMBER);
        face_fill(&f, 12, 14, wall - 14, wall - 3, -1, TOWN_STONE);
        if (f.side == 0)
            add_door(&f, 13);
    }
    fill(&h, x0 - 2, wall, x0 - 2, x1 + 2, wall + 2, x1 + 2, TOWN_STONE);
    for (int32_t k = 0; k < 15; k++)
        fill(&h, x0 - 2 + k, wall + 2 + 2 * k, x0 - 2 + k, x1 + 2 - k, wall + 4 + 2 * k, x1 + 2 - k,
             TOWN_ROOF_SLATE);
    fill(&h, 17, wall + 32, 17, 19, wall + 40, 19, TOWN_IRON);
    return true;
}
