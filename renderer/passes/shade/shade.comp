#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/tiles.glsl"
#include "renderer/shared/view.glsl"
#include "renderer/passes/shade/bindings.glsl"
#include "renderer/passes/shade/surface.glsl"

// REDRAW: only pixels whose redraw map is not 0, from all tiles or from a list of them. CHOSEN: the pixels of a list
// (choose.comp).

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

#ifdef REDRAW
layout(binding = 12, r8ui) uniform readonly uimage2DArray redraw_map;
layout(push_constant) uniform Push { uint listed; } push;
#endif
#ifdef CHOSEN
layout(scalar, binding = 11) buffer Counters { shared_counters counters; };
#endif
#if defined REDRAW || defined CHOSEN
layout(scalar, binding = 13) readonly buffer List { uint list[]; };
#endif

void main()
{
    ivec3 pixel = ivec3(gl_GlobalInvocationID);
#ifdef CHOSEN
    uint place = 64u * TILE_INDEX + gl_LocalInvocationIndex, count = list[SHARED_TILES_FIRST - 1];
    if (place >= count)
        return;
    if (place == 0u)
        atomicAdd(counters.shaded_px, count);
    pixel = tile_of(list[SHARED_TILES_FIRST + place]);
#endif
#ifdef REDRAW
    if (push.listed != 0u) {
        uint index = TILE_INDEX;
        if (index >= list[SHARED_TILES_FIRST - 1])
            return;
        pixel = tile_pixel(list[SHARED_TILES_FIRST + index], gl_LocalInvocationID.xy);
    }
#endif
    if (pixel.x >= int(frame.width) || pixel.y >= int(frame.height))
        return;
#ifdef REDRAW
    if (imageLoad(redraw_map, pixel).x == 0u)
        return;
#endif
    imageStore(hdr, pixel, vec4(shade_pixel(pixel), 1.0));
}
