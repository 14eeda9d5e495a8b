// A block-built town: houses, a market square, a river, trees, lanterns, moving animals, carts and gliders.
#ifndef STIMULI_BUILTIN_TOWN_H
#define STIMULI_BUILTIN_TOWN_H

#include "stimuli/scene.h"

#define TOWN_TRIANGLES_MIN 20000.0
#define TOWN_TRIANGLES_MAX 8000000.0

bool town_path(struct camera_path *out);       // the same whatever the parameters
struct scene *town_make(const double *values); // triangles, seed; NULL: out of memory

#endif
