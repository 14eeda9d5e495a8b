// The rasteriser's way of reprojection: one point a source pixel, resolved by the depth test. Private to the
// room.
#ifndef RENDERER_PASSES_REPROJECT_POINTS_H
#define RENDERER_PASSES_REPROJECT_POINTS_H

#include "renderer/passes/reproject/reproject.h"

struct reproject_push {
    float drop_cosine; // above 1: none are dropped
    uint32_t drop_moving, eye;
};

bool points_create(struct reproject *reproject, const struct gpu_binding *bindings, uint32_t binding_count,
                   int32_t has_motion);
void points_destroy(struct reproject *reproject);
void points_draw(const struct reproject *reproject, VkCommandBuffer cmd, uint32_t from,
                 struct reproject_push push);

#endif
