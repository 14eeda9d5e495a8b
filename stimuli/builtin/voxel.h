// Models made of equal cubes, and their surfaces as quads.
//
// Use: voxel_create -> voxel_fill, voxel_put -> voxel_mesh into the maker's mesh in work -> voxel_destroy.
// Faces between two full cells are left out. The vertices know how much of the sky reaches them: contact
// shading at the corners of each face and the share of open sky above it within the model.
#ifndef STIMULI_BUILTIN_VOXEL_H
#define STIMULI_BUILTIN_VOXEL_H

#include "stimuli/builtin/maker.h"

#include <stdbool.h>
#include <stdint.h>

enum { VOXEL_AIR = 0 };

// What a cell of one kind looks like.
struct voxel_kind {
    uint32_t side, top, bottom; // materials
    float tile_m;               // metres covered by one texture
    bool leafy;                 // seen through: faces towards its own kind are drawn as well, once
};

struct voxel_model {
    int32_t size[3];
    uint8_t *cells; // x fastest, then y, then z; owned
    float cell_m;
    float origin[3]; // of cell (0,0,0)'s lower corner in mesh space, metres
};

bool voxel_create(struct voxel_model *model, int32_t x, int32_t y, int32_t z, float cell_m);
void voxel_destroy(struct voxel_model *model);
// Cells from a to before b; what lies outside the model is ignored.
void voxel_fill(struct voxel_model *model, const int32_t a[3], const int32_t b[3], uint8_t kind);
void voxel_put(struct voxel_model *model, int32_t x, int32_t y, int32_t z, uint8_t kind);
uint8_t voxel_at(const struct voxel_model *model, int32_t x, int32_t y, int32_t z); // air outside

struct voxel_style {
    const struct voxel_kind *kinds; // by cell value
    int32_t span;  // faces of one kind and shading are merged into rectangles up to this many cells
    bool plain;    // no contact shading, so that more faces merge
    bool floating; // draw the lowest cells' bottom faces too
};

// Returns the number of triangles. With maker NULL only counts.
uint32_t voxel_mesh(struct maker *maker, const struct voxel_model *model, const struct voxel_style *style);

#endif
