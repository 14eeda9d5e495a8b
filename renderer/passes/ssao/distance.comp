#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/kept.glsl"

// Half-resolution distances along the view axis, 0 for the background: the upper left pixel of each four, unfiltered,
// since a mean of two surfaces' distances lies on neither.

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

layout(scalar, binding = 0) uniform Frame { shared_frame frame; };
#include "renderer/shared/eye.glsl"
layout(binding = 1, r32f) uniform writeonly image2DArray distances;
#ifdef REDRAW
layout(binding = 2, rgba32f) uniform readonly image2DArray position_image;
layout(binding = 4, r8ui) uniform readonly uimage2DArray redraw_map;
#endif
layout(binding = 3) uniform sampler2DArray depth_image;

void main()
{
    ivec3 to = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(to.xy, imageSize(distances).xy)))
        return;
    ivec3 pixel = ivec3(2 * to.xy, to.z);
    float depth;
#ifdef REDRAW
    // a redrawn pixel has a position too, but it was rounded in the world, and slopes of 1e-5 m show
    if (imageLoad(redraw_map, pixel).x == 0u)
        depth = kept_depth(EYE(uint(to.z), forward), imageLoad(position_image, pixel), frame.near_m);
    else
#endif
        depth = texelFetch(depth_image, pixel, 0).x;
    imageStore(distances, to, vec4(depth > 0.0 ? frame.near_m / depth : 0.0));
}
