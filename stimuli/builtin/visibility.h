// Bakes the visibility of sun and sky into the vertex colours of the mesh in work, since the renderer casts no
// shadows: colour = light that arrives / light the renderer will compute.
//
// Method: many orthographic depth maps, one per direction, as in ambient occlusion from many shadow maps
// (Pharr and Green, GPU Gems, 2004, chapter 17); the sun gets one fine map and a soft edge.
#ifndef STIMULI_BUILTIN_VISIBILITY_H
#define STIMULI_BUILTIN_VISIBILITY_H

#include "stimuli/builtin/maker.h"

struct visibility_desc {
    const struct scene_sun *sun;
    const struct scene_sky *sky;
    uint32_t directions;    // depth maps for the sky, 1..64
    uint32_t open_material; // never blocks (a ground that reflects), MAKER_MATERIALS for none
    float below[3];         // radiance that comes up from an open ground, kcd/m^2
    float bounce[3];        // radiance of blocked directions: light from surfaces around
    float edge_m;           // half width of the sun's shadow edge
    float lift_m;           // vertices are looked up this far in front of their surface
};

// False where memory ran out.
bool visibility_bake(struct maker *maker, const struct visibility_desc *desc);

// Radiance from a direction as scene_sky describes it.
void visibility_sky(const struct scene_sky *sky, float height, float out[3]);

#endif
