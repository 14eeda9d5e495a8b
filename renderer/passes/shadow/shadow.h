// Sun shadows from one map of the static geometry, drawn once: orthographic along the sun over the tight bounds
// of what stands still, so it never swims. Moving objects cast none. Williams, "Casting Curved Shadows on
// Curved Surfaces", SIGGRAPH 1978; how it is read, filtered and kept from shadowing itself:
// shared/sun_shadow.glsl.
//
// Use: shadow_init when the scene is on the GPU -> shadow_constants every frame -> shadow_finish. A scene
// without a sun, or where everything moves, has no map: map.view is null.
#ifndef RENDERER_PASSES_SHADOW_SHADOW_H
#define RENDERER_PASSES_SHADOW_SHADOW_H

#include "renderer/scene/scene_gpu.h"

struct shadow {
    struct gpu *gpu;
    struct gpu_image
        map; // d32, one layer as an array, DEPTH_READ_ONLY_OPTIMAL; 0 is nearest to the sun, 1 farthest
    double texel_m;
    struct dmat4 map_from_world; // texture coordinates and depth
};

bool shadow_init(struct shadow *shadow, struct gpu *gpu, const struct scene_gpu *scene);
void shadow_finish(struct shadow *shadow);
// The part of shared_frame about the map; positions are relative to `origin`.
void shadow_constants(const struct shadow *shadow, struct dvec3 origin, struct shared_frame *out);

#endif
