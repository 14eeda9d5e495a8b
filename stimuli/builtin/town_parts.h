// The town's parts; private to the town's files.
//
// Plan, metres: blocks of 24 m with streets of 6 m between, so that everything repeats with 30 m. Block (0, 0)
// is the market square; a river takes the near half of the blocks with j = 1, z = 18..30. Ground level is 0 in
// the middle.
#ifndef STIMULI_BUILTIN_TOWN_PARTS_H
#define STIMULI_BUILTIN_TOWN_PARTS_H

#include "stimuli/builtin/maker.h"
#include "stimuli/builtin/voxel.h"

#define TOWN_PERIOD 30.0f
#define TOWN_BLOCK 24.0f
#define TOWN_RIVER_Z0 18.0f
#define TOWN_RIVER_Z1 28.0f
#define TOWN_WATER_Y -1.25f
#define TOWN_CELL 0.25f // of houses

// Kinds of cells, each with its material(s).
enum town_kind {
    TOWN_AIR,
    TOWN_GRASS,
    TOWN_DIRT,
    TOWN_COBBLE,
    TOWN_PAVING,
    TOWN_BRICK,
    TOWN_PLASTER,
    TOWN_OCHRE,
    TOWN_ROSE,
    TOWN_SAGE,
    TOWN_TIMBER,
    TOWN_PLANKS,
    TOWN_ROOF_RED,
    TOWN_ROOF_SLATE,
    TOWN_THATCH,
    TOWN_STONE,
    TOWN_GLASS,
    TOWN_LEAVES,
    TOWN_BLOSSOM,
    TOWN_PINE,
    TOWN_BARK,
    TOWN_GLOW,
    TOWN_IRON,
    TOWN_TUFT,
    TOWN_FLOWER,
    TOWN_WATER,
    TOWN_WOOL,
    TOWN_HIDE,
    TOWN_PIG,
    TOWN_PAPER,
    TOWN_STRIPES,
    TOWN_FRUIT,
    TOWN_KINDS
};

// Meshes that stand many times.
enum { TOWN_HOUSES = 12, TOWN_TREES = 6 };
enum town_model {
    TOWN_HOUSE,
    TOWN_TREE = TOWN_HOUSE + TOWN_HOUSES,
    TOWN_LAMP = TOWN_TREE + TOWN_TREES,
    TOWN_STALL,
    TOWN_WELL,
    TOWN_BRIDGE,
    TOWN_TOWER,
    TOWN_HAY,
    TOWN_MODELS
};

struct town_item {
    enum town_model model;
    float x, y, z;
    uint32_t quarter; // turns of 90 degrees about y
};

enum { TOWN_ITEMS_PER_BLOCK = 40, TOWN_RINGS = 8, TOWN_BLOCKS = (2 * TOWN_RINGS + 1) * (2 * TOWN_RINGS + 1) };

struct town_block {
    int32_t i, j; // the block's middle is at 30 i, 30 j
    struct town_item items[TOWN_ITEMS_PER_BLOCK];
    uint32_t item_count;
    uint32_t shown; // items drawn; all blocks from `built` on are distant country without items
};

struct town {
    struct maker *maker;
    uint64_t seed;
    uint32_t wanted; // triangles
    struct voxel_kind kinds[TOWN_KINDS];
    struct voxel_model models[TOWN_MODELS];
    int32_t span;
    uint32_t triangles[TOWN_MODELS]; // of each model at this span
    uint32_t mesh[TOWN_MODELS];
    struct town_block *blocks; // TOWN_BLOCKS, nearest first; owned
    uint32_t built;            // blocks with fine ground
    float ground_cell;         // metres, of fine ground
    float country_cell;        // of distant ground
    float *tops;               // the height of everything that stands, on a 0.5 m grid; owned
};

bool town_make_kinds(struct town *town);
bool town_make_models(struct town *town);                     // fills town->models
void town_plan(struct town *town);                            // fills blocks[].items
float town_ground(const struct town *town, float x, float z); // height
enum town_kind town_ground_kind(const struct town *town, float x, float z);

// Triangles of a block's ground; adds them to the mesh in work unless count_only.
uint32_t town_add_ground(struct town *town, const struct town_block *block, bool fine, bool count_only);
bool town_make_tops(struct town *town); // after the choice of what is shown

void town_add_movers(struct town *town); // moving objects, animation_s
uint32_t town_mover_triangles(void);     // an upper bound

#endif
