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

// The highest height in the scene's lower half with 40 % or more of the upward-facing area that any height
// there has; bounds_min.y where none faces up. (Not the one with most: buildings stand on slabs wider than
// their floors.)
double clearance_floor(const struct scene *scene, const struct dmat4 *world);

// What static instances put between 0.4 and 1.3 times the eye's height above the floor is an obstacle, and so
// is a place without a floor. False: out of memory.
bool clearance_make(struct clearance *map, const struct scene *scene, const struct dmat4 *world, double floor_y,
                    double eye_m);
void clearance_finish(struct clearance *map);

// Metres to the nearest obstacle, 0 on one and outside the map.
double clearance_at(const struct clearance *map, double x, double z);

#endif
