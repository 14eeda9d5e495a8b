// The atrium's parts; private to the atrium's files.
//
// Ground plan, metres: the court is |x| <= 12, |z| <= 4.5 with y up and its floor at 0; arcades of square bays,
// 3 m from column to column, run around it to the outer walls at |x| = 14.9, |z| = 7.4.
#ifndef STIMULI_BUILTIN_ATRIUM_PARTS_H
#define STIMULI_BUILTIN_ATRIUM_PARTS_H

#include "stimuli/builtin/maker.h"
#include "stimuli/builtin/solid.h"
#include "stimuli/builtin/texture.h"

enum atrium_material {
    ATRIUM_ASHLAR, // wall of stone blocks
    ATRIUM_STONE,  // smooth, for columns and mouldings
    ATRIUM_PLASTER,
    ATRIUM_COURT, // floor tiles
    ATRIUM_ARCADE,
    ATRIUM_RED, // cloth
    ATRIUM_BLUE,
    ATRIUM_GOLD,
    ATRIUM_WOOD,
    ATRIUM_TERRACOTTA,
    ATRIUM_LEAF,
    ATRIUM_SOIL,
    ATRIUM_BRONZE,
    ATRIUM_WATER,
    ATRIUM_ROOF,
    ATRIUM_MATERIALS
};

#define ATRIUM_HALF_X 12.0f
#define ATRIUM_HALF_Z 4.5f
#define ATRIUM_WALL 0.5f    // thickness of the facade
#define ATRIUM_DEPTH 2.4f   // of the arcade, behind the facade
#define ATRIUM_BAY 3.0f     // column to column
#define ATRIUM_RADIUS 1.2f  // of arches and vaults
#define ATRIUM_STEP 0.16f   // the ground arcade's floor above the court
#define ATRIUM_GALLERY 4.7f // the upper arcade's floor

struct atrium {
    struct maker *maker;
    uint32_t material[ATRIUM_MATERIALS];
};

// A brush of one material with the texture's own size.
struct solid_brush atrium_brush(const struct atrium *atrium, enum atrium_material material,
                                struct solid_place place);
// The same place moved by (x, y, z) in its own axes.
struct solid_place atrium_at(struct solid_place place, float x, float y, float z);

bool atrium_make_materials(struct atrium *atrium);
float atrium_tile_m(enum atrium_material material);
void atrium_add_arcades(const struct atrium *atrium); // walls, columns, arches, vaults, floors
void atrium_add_trim(const struct atrium *atrium); // string courses, cornice, balustrades, doors, court floor
void atrium_add_cloth(const struct atrium *atrium);
void atrium_add_fountain(const struct atrium *atrium);
void atrium_add_plants(const struct atrium *atrium);

// Calls place for each bay of the four sides: origin at the facade's foot below the bay's arch, z into the
// court.
typedef void (*atrium_bay_fn)(const struct atrium *atrium, struct solid_place bay, uint32_t number);
void atrium_each_bay(const struct atrium *atrium, atrium_bay_fn place);
enum { ATRIUM_BAYS = 22 }; // 8 + 3 + 8 + 3, counter-clockwise from the side at z = -4.5

#endif
