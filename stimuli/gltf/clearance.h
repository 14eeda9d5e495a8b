// Where one can walk in a scene: the height of its floor, and a map of the distance to what stands at eye
// height.
#ifndef STIMULI_GLTF_CLEARANCE_H
#define STIMULI_GLTF_CLEARANCE_H

#include "stimuli/scene.h"

enum { CLEARANCE_CELLS = 384 }; // along the longer side

struct clearance {
    double x, z, cell_m;
    uint32_t columns, rows;
    float *distance_m; // owned
};

// The lowest height that has about as much upward-facing area as any; bounds_min.y where there is none.
double clearance_floor(const struct scene *scene, const struct dmat4 *world);

// Of static instances between two heights. False: out of memory.
bool clearance_make(struct clearance *map, const struct scene *scene, const struct dmat4 *world, double low,
                    double high);
void clearance_finish(struct clearance *map);

// Metres to the nearest obstacle, 0 on one and outside the map.
double clearance_at(const struct clearance *map, double x, double z);

#endif
