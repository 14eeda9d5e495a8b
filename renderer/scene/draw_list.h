// What of a scene can be drawn, sorted into buckets of one pipeline and material.
#ifndef RENDERER_SCENE_DRAW_LIST_H
#define RENDERER_SCENE_DRAW_LIST_H

#include "renderer/scene/scene_gpu.h"

// Fills items, groups, buckets and object_instance of `scene` (its `now` must hold the static transforms).
bool draw_list_create(struct scene_gpu *scene);

#endif
