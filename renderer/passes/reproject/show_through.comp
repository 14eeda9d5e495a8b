#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/tiles.glsl"

// Makes holes of what shows through, in the tiles where something may.

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

layout(scalar, binding = 0) uniform Frame { shared_frame frame; };
#include "renderer/shared/eye.glsl"
layout(scalar, binding = 1) readonly buffer Motions { mat4 motions[]; };
layout(binding = 2, rgba32f) uniform readonly image2DArray position_from;
layout(binding = 5, rgba32f) uniform writeonly image2DArray position_to;
layout(binding = 6, rgba8) uniform writeonly image2DArray colour_to;
layout(scalar, binding = 10) readonly buffer Near { uint tiles[]; };
layout(scalar, binding = 11) buffer Holes { uint holes[]; };
#include "renderer/passes/reproject/winner.glsl"
#include "renderer/passes/reproject/move.glsl"

// A kept point's reversed depth in this frame, 0 for the background.
float depth_now(vec4 position, int eye)
{
    if (position.w < 0.0)
        return 0.0;
    vec4 forward = EYE(uint(eye), forward);
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

const ivec2 across[4] = ivec2[4](ivec2(1, 0), ivec2(0, 1), ivec2(1, 1), ivec2(1, -1));

// The greatest depth of the pixels up to REACH away; near the image's edge a value that says nothing.
float nearest_along(ivec3 pixel, ivec2 direction)
{
    ivec2 rest = min(pixel.xy, ivec2(frame.width, frame.height) - 1 - pixel.xy);
    float nearest = min(rest.x, rest.y) < REACH ? 2.0 : 0.0;
    for (int i = 1; i <= REACH && nearest < 2.0; i++)
        nearest = max(nearest, depth_at(pixel + ivec3(i * direction, 0)));
    return nearest;
}

// Plain loads tell soonest that most pixels have nothing nearer on both sides.
bool may_show_through(ivec3 pixel, float nearer)
{
    bool pair = false;
    for (int k = 0; k < 4; k++) {
        bool one = nearest_along(pixel, across[k]) > nearer;
        for (; one; one = false)
            pair = pair || nearest_along(pixel, -across[k]) > nearer;
    }
    return pair;
}

bool shows_through(ivec3 pixel, float nearer)
{
    for (int k = 0; k < 4; k++) {
        int i = next_nearer(pixel, across[k], nearer);
        int j = i > 0 ? next_nearer(pixel, -across[k], nearer) : 0;
        if (j > 0 && !was_gap(pixel + ivec3(i * across[k], 0), pixel - ivec3(j * across[k], 0), i, i + j))
            return true;
    }
    return false;
}

void remove(ivec3 pixel)
{
    imageStore(position_to, pixel, vec4(0.0));
    imageStore(colour_to, pixel, vec4(0.0));
    PIXEL_APPEND(holes, pixel)
}

void main()
{
    uint index = TILE_INDEX;
    if (index >= tiles[SHARED_TILES_FIRST - 1])
        return;
    ivec3 pixel = tile_pixel(tiles[SHARED_TILES_FIRST + index], gl_LocalInvocationID.xy);
    if (pixel.x >= int(frame.width) || pixel.y >= int(frame.height))
        return;
    float nearer = max(1.1 * depth_at(pixel), 1e-36);
    bool candidate = source_at(pixel) != 0u && may_show_through(pixel, nearer);
    for (; candidate; candidate = false) { // the software driver leaves out a loop that no lane enters, but no branch
        if (shows_through(pixel, nearer))
            remove(pixel);
    }
}
