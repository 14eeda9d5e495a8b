// What moves: animals that walk, a cart, a boat, ducks and gliders, each on a closed curve that repeats with
// the scene.
#include "stimuli/builtin/town_parts.h"

#include <math.h>
#include <stdlib.h>

#define PI 3.14159265358979
#define LOOP_S 48.0

enum { KEYS = 96, STEPS = 8 }; // keys of a round; of one leg's swing

// An oval: rounded rectangle for power > 2, circle for 2.
struct oval {
    double x, z, half_x, half_z, y;
    double wave_m; // up and down
    int waves;     // per round
    double phase;  // rounds
    int rounds;    // per loop; negative: the other way
    double bank;   // radians of roll into the bend
};

struct part {
    struct voxel_model model;
    uint32_t mesh;
};

static double squash(double c)
{
    return copysign(pow(fabs(c), 0.55), c); // a superellipse: straight sides and round corners
}

static struct dvec3 oval_at(const struct oval *o, double turn)
{
    double a = 2 * PI * turn;
    bool square = o->half_x > 6 && o->bank == 0;
    double c = square ? squash(cos(a)) : cos(a), s = square ? squash(sin(a)) : sin(a);
    return (struct dvec3){o->x + o->half_x * c, o->y + o->wave_m * sin(a * o->waves), o->z + o->half_z * s};
}

static struct dquat turn_about(double x, double y, double z, double angle)
{
    double s = sin(angle / 2);
    return (struct dquat){x * s, y * s, z * s, cos(angle / 2)};
}

static struct dquat multiply(struct dquat a, struct dquat b)
{
    return (struct dquat){
        a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
        a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

static void store_rotation(float *to, struct dquat q, const float *before)
{
    double sign =
        before != NULL && before[0] * q.x + before[1] * q.y + before[2] * q.z + before[3] * q.w < 0 ? -1 : 1;
    to[0] = (float)(sign * q.x);
    to[1] = (float)(sign * q.y);
    to[2] = (float)(sign * q.z);
    to[3] = (float)(sign * q.w);
}

// A node that travels once around its oval per round, facing where it goes (its z axis).
static uint32_t add_traveller(struct maker *maker, const struct oval *o)
{
    static const struct dquat none = {0, 0, 0, 1};
    uint32_t node = maker_node(maker, -1, oval_at(o, o->phase), none);
    float times[KEYS + 1], places[(KEYS + 1) * 3], turns[(KEYS + 1) * 4];
    for (int i = 0; i <= KEYS; i++) {
        // The last key repeats the first, so that the loop closes.
        double turn = o->phase + (double)o->rounds * (double)(i % KEYS) / KEYS,
               step = o->rounds < 0 ? -1e-3 : 1e-3;
        struct dvec3 p = oval_at(o, turn), next = oval_at(o, turn + step), before = oval_at(o, turn - step);
        double dx = next.x - before.x, dy = next.y - before.y, dz = next.z - before.z;
        struct dquat yaw = turn_about(0, 1, 0, atan2(dx, dz));
        struct dquat pitch = turn_about(1, 0, 0, -atan2(dy, hypot(dx, dz)));
        struct dquat roll = turn_about(0, 0, 1, o->rounds < 0 ? o->bank : -o->bank);
        times[i] = (float)(LOOP_S * i / KEYS);
        places[i * 3] = (float)p.x;
        places[i * 3 + 1] = (float)p.y;
        places[i * 3 + 2] = (float)p.z;
        store_rotation(&turns[i * 4], multiply(multiply(yaw, pitch), roll), i > 0 ? &turns[i * 4 - 4] : NULL);
    }
    maker_channel(maker, node, SCENE_TRANSLATION, KEYS + 1, times, places);
    maker_channel(maker, node, SCENE_ROTATION, KEYS + 1, times, turns);
    return node;
}

// A node that swings (angle > 0) or turns on (angle 0) about its x axis `cycles` times a loop.
static uint32_t add_swing(struct maker *maker, uint32_t parent, struct dvec3 hinge, double angle, int cycles,
                          double phase)
{
    static const struct dquat none = {0, 0, 0, 1};
    uint32_t node = maker_node(maker, (int32_t)parent, hinge, none), count = (uint32_t)(cycles * STEPS) + 1;
    float *times = malloc(count * sizeof *times), *turns = malloc(count * 4 * sizeof *turns);
    if (times == NULL || turns == NULL) {
        maker->failed = true;
        count = 0;
    }
    for (uint32_t i = 0; i < count; i++) {
        double at = (double)(i % STEPS) / STEPS + phase;
        double turn = angle > 0 ? angle * sin(2 * PI * at) : 2 * PI * at;
        times[i] = (float)(LOOP_S * i / (count - 1));
        store_rotation(&turns[i * 4], turn_about(1, 0, 0, turn), i > 0 ? &turns[i * 4 - 4] : NULL);
    }
    if (count > 0)
        maker_channel(maker, node, SCENE_ROTATION, count, times, turns);
    free(times);
    free(turns);
    return node;
}

// A box of cells as a mesh of its own; its middle at (0, 0), its foot at `foot` metres, moved forward by
// `ahead`.
static bool box_begin(struct voxel_model *m, int32_t x, int32_t y, int32_t z, float cell, float foot,
                      float ahead, int kind)
{
    if (!voxel_create(m, x, y, z, cell))
        return false;
    m->origin[1] = foot;
    m->origin[2] += ahead;
    voxel_fill(m, (int32_t[]){0, 0, 0}, m->size, (uint8_t)kind);
    return true;
}

static uint32_t box_end(const struct town *town, struct voxel_model *m)
{
    maker_mesh_begin(town->maker);
    voxel_mesh(town->maker, m, &(struct voxel_style){.kinds = town->kinds, .span = 64, .floating = true});
    voxel_destroy(m);
    return maker_mesh_end(town->maker);
}

struct animal {
    uint32_t body, leg;
    double leg_x, leg_z, hip;
    int cycles; // steps of a leg per loop
};

// Sizes in cells of 0.125 m: body wide, tall, long; leg length; head.
static bool make_animal(const struct town *town, struct animal *out, const int32_t body[3], int32_t leg,
                        const int32_t head[3], int kind, int face)
{
    const float cell = 0.125f;
    struct voxel_model m;
    if (!voxel_create(&m, body[0] + 2, body[1] + 4, body[2] + 2 * head[2], cell))
        return false;
    m.origin[1] = (float)leg * cell;
    int32_t z = head[2];
    voxel_fill(&m, (int32_t[]){1, 0, z}, (int32_t[]){body[0] + 1, body[1], z + body[2]}, (uint8_t)kind);
    int32_t x = (m.size[0] - head[0]) / 2, y = body[1] + 3 - head[1], front = z + body[2];
    voxel_fill(&m, (int32_t[]){x, y, front - 1}, (int32_t[]){x + head[0], y + head[1], front + head[2]},
               (uint8_t)kind);
    voxel_fill(&m, (int32_t[]){x, y, front + head[2] - 1},
               (int32_t[]){x + head[0], y + head[1] - 1, front + head[2]}, (uint8_t)face);
    for (int side = 0; side < 2; side++) // eyes and ears
    {
        int32_t edge = side ? x + head[0] - 1 : x;
        voxel_put(&m, edge, y + head[1] - 2, front + head[2] - 1, TOWN_IRON);
        voxel_put(&m, side ? x + head[0] : x - 1, y + head[1] - 1, front, (uint8_t)face);
    }
    voxel_put(&m, m.size[0] / 2, body[1] - 2, z - 1, (uint8_t)kind); // a tail
    out->body = box_end(town, &m);
    if (!box_begin(&m, 2, leg, 2, cell, -(float)leg * cell, 0, face))
        return false;
    out->leg = box_end(town, &m);
    out->hip = leg * (double)cell;
    out->leg_x = (body[0] / 2.0 - 1) * (double)cell;
    out->leg_z = (body[2] / 2.0 - 1) * (double)cell;
    return true;
}

static uint32_t add_animal(const struct town *town, const struct animal *a, const struct oval *o)
{
    uint32_t node = add_traveller(town->maker, o);
    maker_instance(town->maker, a->body, node);
    for (int i = 0; i < 4; i++) {
        struct dvec3 hip = {i & 1 ? a->leg_x : -a->leg_x, a->hip, i & 2 ? a->leg_z : -a->leg_z};
        double phase = (i == 0 || i == 3) ? 0 : 0.5;
        maker_instance(town->maker, a->leg, add_swing(town->maker, node, hip, 0.5, a->cycles, phase));
    }
    return node;
}

static bool add_animals(const struct town *town)
{
    struct animal sheep = {.cycles = 44}, cow = {.cycles = 36}, pig = {.cycles = 52};
    if (!make_animal(town, &sheep, (int32_t[]){5, 5, 8}, 4, (int32_t[]){3, 4, 3}, TOWN_WOOL, TOWN_PLANKS) ||
        !make_animal(town, &cow, (int32_t[]){6, 6, 11}, 6, (int32_t[]){4, 5, 3}, TOWN_HIDE, TOWN_HIDE) ||
        !make_animal(town, &pig, (int32_t[]){5, 4, 8}, 3, (int32_t[]){4, 4, 3}, TOWN_PIG, TOWN_PIG))
        return false;
    const struct oval walks[] = {
        {.x = 30, .z = -30, .half_x = 4, .half_z = 5, .rounds = 1},
        {.x = 30.5, .z = -29.5, .half_x = 5.5, .half_z = 3, .rounds = -1, .phase = 0.4},
        {.x = 3.2, .z = -6.2, .half_x = 1.7, .half_z = 1.2, .rounds = 2, .phase = 0.5},
        {.x = 0, .z = -14.8, .half_x = 11, .half_z = 1.6, .rounds = 1},
        {.x = 0.5, .z = -15.2, .half_x = 10, .half_z = 1.6, .rounds = 1, .phase = 0.45},
        {.x = 5.4, .z = 3.6, .half_x = 1.9, .half_z = 1.5, .rounds = 2},
        {.x = 3.2, .z = 7.0, .half_x = 1.5, .half_z = 1.2, .rounds = -2},
    };
    const struct animal *who[] = {&sheep, &sheep, &sheep, &cow, &cow, &pig, &pig};
    for (size_t i = 0; i < sizeof walks / sizeof walks[0]; i++) {
        struct oval o = walks[i];
        o.y = (double)town_ground(town, (float)o.x, (float)o.z);
        add_animal(town, who[i], &o);
    }
    return true;
}

static bool add_cart(const struct town *town)
{
    struct voxel_model m;
    struct maker *maker = town->maker;
    if (!voxel_create(&m, 12, 10, 30, 0.125f))
        return false;
    m.origin[1] = 0.45f;
    voxel_fill(&m, (int32_t[]){1, 0, 0}, (int32_t[]){11, 1, 20}, TOWN_PLANKS);
    for (int side = 0; side < 2; side++) {
        voxel_fill(&m, (int32_t[]){side ? 10 : 1, 1, 0}, (int32_t[]){side ? 11 : 2, 4, 20}, TOWN_PLANKS);
        voxel_fill(&m, (int32_t[]){side ? 9 : 2, 1, 20}, (int32_t[]){side ? 10 : 3, 2, 30}, TOWN_TIMBER);
    }
    voxel_fill(&m, (int32_t[]){2, 1, 19}, (int32_t[]){10, 4, 20}, TOWN_PLANKS);
    voxel_fill(&m, (int32_t[]){2, 1, 1}, (int32_t[]){10, 6, 16}, TOWN_THATCH);
    voxel_fill(&m, (int32_t[]){3, 6, 3}, (int32_t[]){9, 8, 13}, TOWN_THATCH);
    uint32_t body = box_end(town, &m);
    if (!voxel_create(&m, 1, 8, 8, 0.125f))
        return false;
    m.origin[1] = -0.5f;
    for (int32_t z = 0; z < 8; z++)
        for (int32_t y = 0; y < 8; y++) {
            double r = hypot(y - 3.5, z - 3.5);
            if (r < 4.2 && (r > 2.9 || r < 1.2 || y == z || y == 7 - z))
                voxel_put(&m, 0, y, z, TOWN_TIMBER);
        }
    uint32_t wheel = box_end(town, &m);
    struct oval road = {.x = 0, .z = -30, .half_x = 14.5, .half_z = 14.5, .rounds = 1, .phase = 0.3};
    uint32_t node = add_traveller(maker, &road);
    maker_instance(maker, body, node);
    for (int i = 0; i < 4; i++) {
        struct dvec3 axle = {i & 1 ? 0.82 : -0.82, 0.5, i & 2 ? 0.15 : -1.35};
        maker_instance(maker, wheel, add_swing(maker, node, axle, 0, 36, 0));
    }
    return true;
}

static bool add_floating(const struct town *town)
{
    struct voxel_model m;
    struct maker *maker = town->maker;
    if (!voxel_create(&m, 12, 6, 26, 0.125f))
        return false;
    m.origin[1] = -0.2f;
    for (int32_t z = 0; z < 26; z++) {
        int32_t in = z < 4 ? 2 - z / 2 : z > 17 ? (z - 17) / 2 : 0;
        voxel_fill(&m, (int32_t[]){in, 0, z}, (int32_t[]){12 - in, 5, z + 1}, TOWN_PLANKS);
        if (z > 1 && z < 23)
            voxel_fill(&m, (int32_t[]){in + 1, 1, z}, (int32_t[]){11 - in, 5, z + 1}, TOWN_AIR);
        if (z % 8 == 6)
            voxel_fill(&m, (int32_t[]){in, 3, z}, (int32_t[]){12 - in, 4, z + 2}, TOWN_TIMBER);
    }
    uint32_t boat = box_end(town, &m);
    struct oval trip = {.x = 0,
                        .z = 23,
                        .half_x = 9.5,
                        .half_z = 2.6,
                        .y = TOWN_WATER_Y,
                        .wave_m = 0.04,
                        .waves = 7,
                        .rounds = 1,
                        .bank = 1e-6};
    maker_instance(maker, boat, add_traveller(maker, &trip));
    if (!voxel_create(&m, 4, 6, 7, 0.1f))
        return false;
    m.origin[1] = -0.1f;
    voxel_fill(&m, (int32_t[]){0, 0, 0}, (int32_t[]){4, 3, 6}, TOWN_WOOL);
    voxel_fill(&m, (int32_t[]){1, 3, 4}, (int32_t[]){3, 6, 6}, TOWN_ROOF_SLATE);
    voxel_fill(&m, (int32_t[]){1, 4, 6}, (int32_t[]){3, 5, 7}, TOWN_STRIPES);
    uint32_t duck = box_end(town, &m);
    for (int i = 0; i < 3; i++) {
        struct oval swim = {.x = 4.0 - 5 * i,
                            .z = 20.6 + 0.4 * i,
                            .half_x = 2.2,
                            .half_z = 1.0,
                            .y = TOWN_WATER_Y,
                            .rounds = i % 2 ? 1 : -1,
                            .phase = 0.3 * i};
        maker_instance(maker, duck, add_traveller(maker, &swim));
    }
    return true;
}

// A folded sheet: two wings and a keel in steps of cells.
static bool add_gliders(const struct town *town)
{
    struct voxel_model m;
    if (!voxel_create(&m, 23, 5, 20, 0.08f))
        return false;
    for (int32_t z = 0; z < 20; z++) {
        int32_t half = (19 - z) * 11 / 19 + 1;
        for (int32_t x = -half; x <= half; x++)
            voxel_put(&m, 11 + x, 3 + (abs(x) > 7), z, TOWN_PAPER);
        for (int32_t y = 0; y < 3; y++)
            if (z < 19 - 2 * (3 - y) && z > 1)
                voxel_put(&m, 11, y, z, TOWN_STRIPES);
    }
    uint32_t mesh = box_end(town, &m);
    const struct oval flights[] = {
        {.x = 0,
         .z = 0,
         .half_x = 10,
         .half_z = 8,
         .y = 6.0,
         .wave_m = 0.9,
         .waves = 2,
         .rounds = 2,
         .bank = 0.45},
        {.x = 2,
         .z = 4,
         .half_x = 13,
         .half_z = 9,
         .y = 9.0,
         .wave_m = 1.2,
         .waves = 3,
         .rounds = -2,
         .phase = 0.3,
         .bank = 0.4},
        {.x = 0,
         .z = 23,
         .half_x = 12,
         .half_z = 4,
         .y = 4.6,
         .wave_m = 0.6,
         .waves = 2,
         .rounds = 2,
         .phase = 0.6,
         .bank = 0.5},
    };
    for (size_t i = 0; i < sizeof flights / sizeof flights[0]; i++)
        maker_instance(town->maker, mesh, add_traveller(town->maker, &flights[i]));
    return true;
}

uint32_t town_mover_triangles(void)
{
    return 4000;
}

void town_add_movers(struct town *town)
{
    town->maker->scene->animation_s = (float)LOOP_S;
    if (!add_animals(town) || !add_cart(town) || !add_floating(town) || !add_gliders(town))
        town->maker->failed = true;
}
