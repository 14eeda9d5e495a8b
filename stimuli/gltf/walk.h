// A closed walk through a large model at eye height, clear of walls and columns where the model leaves room.
#ifndef STIMULI_GLTF_WALK_H
#define STIMULI_GLTF_WALK_H

#include "stimuli/scene.h"

// Writes scene->path's knots; nothing without memory.
void gltf_walk(struct scene *scene, const struct dmat4 *world);

#endif
