// Bakes how much of the sky reaches the vertices of the mesh in work: light that arrives, from the open sky and
// from surfaces around, over the light of the whole sky.
//
// Method: many orthographic depth maps, one per direction, as in ambient occlusion from many shadow maps
// (Pharr and Green, GPU Gems, 2004, chapter 17).
#ifndef STIMULI_BUILTIN_VISIBILITY_H
#define STIMULI_BUILTIN_VISIBILITY_H

#include "stimuli/builtin/maker.h"

struct visibility_desc {
    const struct scene_sky *sky;
    uint32_t directions;    // depth maps for the sky, 1..64
    uint32_t open_material; // never blocks (a ground that reflects), MAKER_MATERIALS for none
    float below[3];         // radiance that comes up from an open ground, kcd/m^2
    float bounce[3];        // radiance of blocked directions: light from surfaces around
    float lift_m;           // vertices are looked up this far in front of their surface
};

// False where memory ran out.
bool visibility_bake(struct maker *maker, const struct visibility_desc *desc);

// Radiance from a direction as scene_sky describes it.
void visibility_sky(const struct scene_sky *sky, float height, float out[3]);

#endif
