#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/tiles.glsl"

// One invocation a tile, without barriers: on the software driver a barrier costs more than 64 loads.

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

layout(binding = 0, r8ui) uniform readonly uimage2DArray redraw_map;
layout(scalar, binding = 1) writeonly buffer Pyramid { uint pyramid[]; };
layout(scalar, binding = 2) buffer Tiles { uint words[]; } tiles;
layout(scalar, binding = 3) buffer Counters { shared_counters counters; };
layout(push_constant) uniform Push { uint tiles_x, tiles_y, levels, last; } push;

void main()
{
    uvec2 tile = gl_GlobalInvocationID.xy;
    uint eye = gl_GlobalInvocationID.z;
    if (tile.x >= push.tiles_x || tile.y >= push.tiles_y)
        return;
    ivec2 size = imageSize(redraw_map).xy, first = SHARED_TILE * ivec2(tile);
    ivec2 end = min(first + SHARED_TILE, size);
    uint sum = 0;
    for (int y = first.y; y < end.y; y++)
        for (int x = first.x; x < end.x; x++)
            sum += imageLoad(redraw_map, ivec3(x, y, eye)).x;
    pyramid[(eye * push.tiles_y + tile.y) * push.tiles_x + tile.x] = sum;
    if (sum == 0u)
        return;
    TILE_APPEND(tiles.words, tile_code(tile, eye))
    if (push.last != 0u)
        atomicAdd(counters.shaded_px, sum);
}
