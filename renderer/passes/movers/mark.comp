#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/tiles.glsl"

// One work group a listed rectangle (list.comp). A large one is marked by strips of tiles in their turns, the same as those
// of moving pixels (passes/pyramid), so that no frame has all the work and no pixel is redrawn twice for it.

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

layout(scalar, binding = 0) uniform Frame { shared_frame frame; };
layout(scalar, binding = 1) readonly buffer List { uint words[]; } list;
layout(scalar, binding = 2) readonly buffer Rectangles { uvec2 rectangles[]; };
layout(binding = 3, r8ui) uniform writeonly uimage2DArray redraw_map;
layout(push_constant) uniform Push { uint count, turn, period, motion_count; } push;

#include "renderer/shared/turn.glsl"

void main()
{
    uint slot = TILE_INDEX;
    if (slot >= list.words[SHARED_TILES_FIRST - 1])
        return;
    uint index = list.words[SHARED_TILES_FIRST + slot];
    uvec2 r = rectangles[index];
    ivec2 first = ivec2(r.x & 0xffffu, r.x >> 16), last = ivec2(r.y & 0x7fffu, r.y >> 16);
    bool whole = (r.y & 0x8000u) != 0u;
    int eye = int(index >> 1 & 1u);
    ivec2 start = first / SHARED_TILE * SHARED_TILE + ivec2(gl_LocalInvocationID.xy);
    for (int x = start.x; x <= last.x; x += SHARED_TILE) {
        bool marked = x >= first.x && (whole || tile_has_turn(uint(x) / SHARED_TILE, frame.width, push.turn, push.period));
        for (int y = marked ? start.y : last.y + 1; y <= last.y; y += SHARED_TILE)
            if (y >= first.y)
                imageStore(redraw_map, ivec3(x, y, eye), uvec4(1u));
    }
}
