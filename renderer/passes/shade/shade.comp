#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/tiles.glsl"
#include "renderer/shared/view.glsl"
#include "renderer/passes/shade/bindings.glsl"
#include "renderer/passes/shade/surface.glsl"

// REDRAW: only pixels whose redraw map is not 0, from all tiles or from a list of them

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

#ifdef REDRAW
layout(binding = 12, r8ui) uniform readonly uimage2DArray redraw_map;
layout(scalar, binding = 13) readonly buffer Tiles { uint tiles[]; };
layout(push_constant) uniform Push { uint listed; } push;
#endif

void main()
{
    ivec3 pixel = ivec3(gl_GlobalInvocationID);
#ifdef REDRAW
    if (push.listed != 0u) {
        uint index = TILE_INDEX;
        if (index >= tiles[SHARED_TILES_FIRST - 1])
            return;
        pixel = tile_pixel(tiles[SHARED_TILES_FIRST + index], gl_LocalInvocationID.xy);
    }
#endif
    bool wanted = pixel.x < int(frame.width) && pixel.y < int(frame.height);
#ifdef REDRAW
    wanted = wanted && imageLoad(redraw_map, pixel).x != 0u;
#endif
    vec3 radiance = shade_pixel(pixel, wanted, uvec2(pixel.xy) - gl_LocalInvocationID.xy);
    if (wanted)
        imageStore(hdr, pixel, vec4(radiance, 1.0));
}
