#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/kept.glsl"

// A kept pixel whose depth is no longer the one that was laid there shows a moving object.

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

layout(scalar, binding = 0) uniform Frame { shared_frame frame; };
#include "renderer/shared/eye.glsl"
layout(binding = 1) uniform sampler2DArray depth_image;
layout(binding = 2, rgba32f) uniform readonly image2DArray position_image;
layout(binding = 3, r8ui) uniform uimage2DArray redraw_map;

void main()
{
    ivec3 pixel = ivec3(gl_GlobalInvocationID);
    if (pixel.x >= int(frame.width) || pixel.y >= int(frame.height) || imageLoad(redraw_map, pixel).x != 0u)
        return;
    float laid = kept_depth(frame_eye(uint(pixel.z)), imageLoad(position_image, pixel), frame.near_m);
    // the same float was written there by the same function; a hair for compilers that fuse it otherwise
    if (texelFetch(depth_image, pixel, 0).x > laid * 1.000001)
        imageStore(redraw_map, pixel, uvec4(1u));
}
