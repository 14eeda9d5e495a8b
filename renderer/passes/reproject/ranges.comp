#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"

// The nearest and the farthest point of each tile, as words a tile: the reversed depths' bits, which order like the
// depths. One invocation a tile, without barriers (see passes/redraw/count.comp).

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

layout(scalar, binding = 0) uniform Frame { shared_frame frame; };
layout(scalar, binding = 9) writeonly buffer Ranges { uvec2 ranges[]; }; // greatest, least
#include "renderer/passes/reproject/winner.glsl"

void main()
{
    uvec3 tile = gl_GlobalInvocationID;
    uvec2 size = uvec2(frame.width, frame.height), tiles = (size + SHARED_TILE - 1) / SHARED_TILE;
    if (any(greaterThanEqual(tile.xy, tiles)))
        return;
    uvec2 end = min(SHARED_TILE * (tile.xy + 1u), size);
    uvec2 range = uvec2(0u, 0xffffffffu);
    for (uint y = SHARED_TILE * tile.y; y < end.y; y++) {
        for (uint x = SHARED_TILE * tile.x; x < end.x; x++) {
            ivec3 pixel = ivec3(x, y, tile.z);
            uint depth = floatBitsToUint(depth_at(pixel));
            bool hole = source_at(pixel) == 0u;
            range.x = max(range.x, hole ? 0u : depth);
            range.y = min(range.y, hole ? 0xffffffffu : depth);
        }
    }
    ranges[(tile.z * tiles.y + tile.y) * tiles.x + tile.x] = range;
}
