#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"

// POINTS: the winners were drawn as points and lie in images; else their keys lie in a buffer.

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

layout(scalar, binding = 0) uniform Frame { shared_frame frame; };
#include "renderer/shared/eye.glsl"
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

// A kept point's reversed depth in this frame, 0 for the background.
float depth_now(vec4 position, int eye)
{
    if (position.w < 0.0)
        return 0.0;
    vec4 forward = frame_eye(uint(eye)).forward;
    return frame.near_m / (dot(forward.xyz, move_position(position).xyz) + forward.w);
}

// What shows between the spread pixels of a nearer surface: in one of the four directions across the pixel there are
// pixels with more than 1.1 times its reversed depth on both sides, at most REACH away, and the last frame held nothing
// as far off between the nearest two of them, where what is seen through a real gap was. Looked at there are the one or
// two pixels of the line between their sources that divide it as the pixel divides them; sources that touch have none
// between them.
const int REACH = 3;

// The steps to the next pixel nearer than `depth`, 0 where there is none.
int next_nearer(ivec3 pixel, ivec2 direction, float depth)
{
    for (int i = 1; i <= REACH; i++) {
        ivec3 at = ivec3(pixel.xy + i * direction, pixel.z);
        if (any(lessThan(at.xy, ivec2(0))) || at.x >= int(frame.width) || at.y >= int(frame.height))
            return 0;
        if (depth_at(at) > depth)
            return i;
    }
    return 0;
}

bool was_gap(ivec3 a, ivec3 b, int part, int whole)
{
    ivec2 from = source_pixel(source_at(a)), way = source_pixel(source_at(b)) - from;
    int steps = max(abs(way.x), abs(way.y));
    float nearest = min(depth_at(a), depth_at(b));
    for (int i = max(part * steps / whole, 1); i <= min((part * steps + whole - 1) / whole, steps - 1); i++) {
        ivec2 at = from + (2 * way * i + sign(way) * steps) / (2 * steps); // rounded
        vec4 p = imageLoad(position_from, ivec3(at, a.z));
        if (p.w != 0.0 && 1.1 * depth_now(p, a.z) < nearest)
            return true;
    }
    return false;
}

bool shows_through(ivec3 pixel)
{
    const ivec2 across[4] = ivec2[4](ivec2(1, 0), ivec2(0, 1), ivec2(1, 1), ivec2(1, -1));
    float nearer = max(1.1 * depth_at(pixel), 1e-36);
    ivec2 rest = min(pixel.xy, ivec2(frame.width, frame.height) - 1 - pixel.xy);
    if (min(rest.x, rest.y) >= REACH) { // plain loads tell soonest that most pixels have nothing nearer on both sides
        float nearest[4] = float[4](0.0, 0.0, 0.0, 0.0);
        for (int k = 0; k < 4; k++)
            for (int i = 1; i <= REACH; i++)
                nearest[k] = max(nearest[k], depth_at(pixel + ivec3(i * across[k], 0)));
        if (max(max(nearest[0], nearest[1]), max(nearest[2], nearest[3])) <= nearer)
            return false;
        bool pair = false;
        for (int k = 0; k < 4; k++) {
            float other = 0.0;
            for (int i = 1; i <= REACH; i++)
                other = max(other, depth_at(pixel - ivec3(i * across[k], 0)));
            pair = pair || min(nearest[k], other) > nearer;
        }
        if (!pair)
            return false;
    }
    for (int k = 0; k < 4; k++) {
        int i = next_nearer(pixel, across[k], nearer);
        int j = i > 0 ? next_nearer(pixel, -across[k], nearer) : 0;
        if (j > 0 && !was_gap(pixel + ivec3(i * across[k], 0), pixel - ivec3(j * across[k], 0), i, i + j))
            return true;
    }
    return false;
}

void main()
{
    ivec3 pixel = ivec3(gl_GlobalInvocationID);
    if (pixel.x >= int(frame.width) || pixel.y >= int(frame.height))
        return;
    uint inverted = source_at(pixel);
    vec4 position = vec4(0.0), colour = vec4(0.0);
    ivec3 source = ivec3(source_pixel(inverted), pixel.z);
    if (inverted != 0u && !shows_through(pixel)) {
        position = move_position(imageLoad(position_from, source));
        colour = imageLoad(colour_from, source);
        // one frame older, up to 63
        if (position.w >= 2.0 && fract(position.w) < 62.5 / 64.0)
            position.w += 1.0 / 64.0;
    }
    imageStore(position_to, pixel, position);
    imageStore(colour_to, pixel, colour);
}
