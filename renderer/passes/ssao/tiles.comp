#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/tiles.glsl"

// Lists the half-resolution tiles (16x16 pixels) that a redrawn pixel's occlusion depends on: their own redrawn pixels
// and those of the ring of 8-pixel tiles around them. A redrawn pixel's upsampling reads 1 half-resolution texel away
// and the blur 2 more, 6 pixels, so a ring of 8 covers them (Franke et al. 2021, section 7: the redraw map is sampled at
// a lower level "to account for the larger relative screen space area of SSAO pixels").

layout(local_size_x = 64) in;

layout(scalar, binding = 0) readonly buffer Pyramid { uint pyramid[]; }; // passes/redraw
layout(scalar, binding = 1) buffer Tiles { uint words[]; } tiles;
layout(push_constant) uniform Push { uint tiles_x, tiles_y, half_x, half_y; } push;

void main()
{
    uint index = gl_GlobalInvocationID.x, per_eye = push.half_x * push.half_y;
    if (index >= 2u * per_eye)
        return;
    uint eye = index / per_eye;
    uvec2 tile = uvec2(index % push.half_x, index / push.half_x % push.half_y);
    ivec2 first = max(2 * ivec2(tile) - 1, ivec2(0)), last = min(2 * ivec2(tile) + 2, ivec2(push.tiles_x, push.tiles_y) - 1);
    for (int y = first.y; y <= last.y; y++) {
        for (int x = first.x; x <= last.x; x++) {
            if (pyramid[(eye * push.tiles_y + uint(y)) * push.tiles_x + uint(x)] != 0u) {
                uint slot = atomicAdd(tiles.words[3], 1u);
                tiles.words[SHARED_TILES_FIRST + slot] = tile_code(tile, eye);
                // more than 65535 groups, the least that every device allows in one dimension, make rows
                atomicMax(tiles.words[0], min(slot + 1u, 65535u));
                atomicMax(tiles.words[1], slot / 65535u + 1u);
                return;
            }
        }
    }
}
