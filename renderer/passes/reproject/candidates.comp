#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/tiles.glsl"

// Lists the tiles where something may show through: a point of theirs is farther than 1.1 times the nearest point of
// theirs or of a neighbour.

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

layout(scalar, binding = 0) uniform Frame { shared_frame frame; };
layout(scalar, binding = 9) readonly buffer Ranges { uvec2 ranges[]; };
layout(scalar, binding = 10) buffer Near { uint near_tiles[]; };

void main()
{
    ivec3 tile = ivec3(gl_GlobalInvocationID);
    ivec2 tiles = (ivec2(frame.width, frame.height) + SHARED_TILE - 1) / SHARED_TILE;
    if (any(greaterThanEqual(tile.xy, tiles)))
        return;
    uint nearest = 0u;
    for (int y = max(tile.y - 1, 0); y <= min(tile.y + 1, tiles.y - 1); y++)
        for (int x = max(tile.x - 1, 0); x <= min(tile.x + 1, tiles.x - 1); x++)
            nearest = max(nearest, ranges[(tile.z * tiles.y + y) * tiles.x + x].x);
    uvec2 range = ranges[(tile.z * tiles.y + tile.y) * tiles.x + tile.x];
    bool may_show = range.y != 0xffffffffu && uintBitsToFloat(nearest) > 1.1 * uintBitsToFloat(range.y);
    if (may_show)
        TILE_APPEND(near_tiles, tile_code(uvec2(tile.xy), uint(tile.z)))
}
