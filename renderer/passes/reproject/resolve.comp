#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"

// POINTS: the winners were drawn as points and lie in images; else their keys lie in a buffer.

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

layout(scalar, binding = 0) readonly buffer Frame { shared_frame frame; };
layout(scalar, binding = 1) readonly buffer Motions { mat4 motions[]; };
layout(binding = 2, rgba32f) uniform readonly image2DArray position_from;
#ifdef POINTS
layout(binding = 7) uniform usampler2DArray source_image;
layout(binding = 8) uniform sampler2DArray depth_image;
#else
layout(scalar, binding = 3) readonly buffer Keys { uvec2 keys[]; }; // ~source, depth
#endif
layout(binding = 4, rgba8) uniform readonly image2DArray colour_from;
layout(binding = 5, rgba32f) uniform writeonly image2DArray position_to;
layout(binding = 6, rgba8) uniform writeonly image2DArray colour_to;

#include "renderer/passes/reproject/move.glsl"

// ~source of a pixel, 0 for a hole.
uint source_at(ivec3 pixel)
{
#ifdef POINTS
    return texelFetch(source_image, pixel, 0).x;
#else
    return keys[(uint(pixel.z) * frame.height + uint(pixel.y)) * frame.width + uint(pixel.x)].x;
#endif
}

float depth_at(ivec3 pixel)
{
#ifdef POINTS
    return texelFetch(depth_image, pixel, 0).x;
#else
    return uintBitsToFloat(keys[(uint(pixel.z) * frame.height + uint(pixel.y)) * frame.width + uint(pixel.x)].y);
#endif
}

ivec2 source_pixel(uint inverted)
{
    uint index = ~inverted;
    return ivec2(index % frame.width, index / frame.width);
}

// Whether both neighbours across a pixel are nearer, and the pixel did not lie between those two in the last frame
// either, as what is seen through a real gap did.
bool covered(ivec3 pixel, ivec2 source, ivec2 across, float nearer)
{
    ivec3 a = pixel + ivec3(across, 0), b = pixel - ivec3(across, 0);
    if (min(depth_at(a), depth_at(b)) <= nearer)
        return false;
    ivec2 twice_middle = source_pixel(source_at(a)) + source_pixel(source_at(b));
    return any(greaterThan(abs(2 * source - twice_middle), ivec2(2)));
}

// What shows between the spread pixels of a nearer surface: it is covered along a diagonal and along one more of the
// four directions across it, by neighbours more than 10 % nearer. So at least four of the eight are nearer, and seven
// always suffice; an edge or a corner of a nearer surface has them on one side only.
bool shows_through(ivec3 pixel, ivec2 source)
{
    if (any(lessThan(pixel.xy, ivec2(1))) || pixel.x + 1 >= int(frame.width) || pixel.y + 1 >= int(frame.height))
        return false;
    float nearer = max(1.1 * depth_at(pixel), 1e-36);
    bool rising = covered(pixel, source, ivec2(1, -1), nearer), falling = covered(pixel, source, ivec2(1, 1), nearer);
    if (rising && falling)
        return true;
    return (rising || falling) &&
           (covered(pixel, source, ivec2(1, 0), nearer) || covered(pixel, source, ivec2(0, 1), nearer));
}

void main()
{
    ivec3 pixel = ivec3(gl_GlobalInvocationID);
    if (pixel.x >= int(frame.width) || pixel.y >= int(frame.height))
        return;
    uint inverted = source_at(pixel);
    vec4 position = vec4(0.0), colour = vec4(0.0);
    ivec3 source = ivec3(source_pixel(inverted), pixel.z);
    if (inverted != 0u && !shows_through(pixel, source.xy)) {
        position = move_position(imageLoad(position_from, source));
        colour = imageLoad(colour_from, source);
        // one frame older, up to 63
        if (position.w >= 2.0 && fract(position.w) < 62.5 / 64.0)
            position.w += 1.0 / 64.0;
    }
    imageStore(position_to, pixel, position);
    imageStore(colour_to, pixel, colour);
}
