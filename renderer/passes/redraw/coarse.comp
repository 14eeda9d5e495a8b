#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"

// The coarser levels of the pyramid, each straight from the finest.

layout(local_size_x = 64) in;

layout(scalar, binding = 0) buffer Pyramid { uint pyramid[]; };
layout(push_constant) uniform Push { uint tiles_x, tiles_y, levels, last; } push;

void main()
{
    uint index = gl_GlobalInvocationID.x;
    uint base = 2u * push.tiles_x * push.tiles_y;
    for (uint level = 1u; level < push.levels; level++) {
        uint width = max(push.tiles_x >> level, 1u), height = max(push.tiles_y >> level, 1u);
        if (index < 2u * width * height) {
            uint eye = index / (width * height), x = index % width, y = index / width % height, any_redrawn = 0u;
            uint x_end = min((x + 1u) << level, push.tiles_x), y_end = min((y + 1u) << level, push.tiles_y);
            for (uint v = y << level; v < y_end; v++)
                for (uint u = x << level; u < x_end; u++)
                    any_redrawn |= pyramid[(eye * push.tiles_y + v) * push.tiles_x + u];
            pyramid[base + index] = any_redrawn;
            return;
        }
        index -= 2u * width * height;
        base += 2u * width * height;
    }
}
