#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/tiles.glsl"

// Brings the points that won to their pixels, and lists the holes, where none did: they are few and scattered, an
// approaching camera leaves one in about every tile, so that what looks for them tile by tile leaves most lanes idle.

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

layout(scalar, binding = 0) uniform Frame { shared_frame frame; };
layout(scalar, binding = 1) readonly buffer Motions { mat4 motions[]; };
layout(scalar, binding = 11) buffer Holes { uint holes[]; };
layout(binding = 2, rgba32f) uniform readonly image2DArray position_from;
layout(binding = 4, rgba8) uniform readonly image2DArray colour_from;
layout(binding = 5, rgba32f) uniform writeonly image2DArray position_to;
layout(binding = 6, rgba8) uniform writeonly image2DArray colour_to;
#include "renderer/passes/reproject/winner.glsl"
#include "renderer/passes/reproject/move.glsl"

void main()
{
    ivec3 pixel = ivec3(gl_GlobalInvocationID);
    if (pixel.x >= int(frame.width) || pixel.y >= int(frame.height))
        return;
    uint inverted = source_at(pixel);
    vec4 position = vec4(0.0), colour = vec4(0.0);
    if (inverted != 0u) {
        ivec3 source = ivec3(source_pixel(inverted), pixel.z);
        position = move_position(imageLoad(position_from, source));
        colour = imageLoad(colour_from, source);
        // one frame older, up to 63
        if (position.w >= 2.0 && fract(position.w) < 62.5 / 64.0)
            position.w += 1.0 / 64.0;
    }
    imageStore(position_to, pixel, position);
    imageStore(colour_to, pixel, colour);
    bool hole = inverted == 0u;
    for (; hole; hole = false) // the software driver leaves out a loop that no lane enters, but no branch
        PIXEL_APPEND(holes, pixel)
}
