#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/colour.glsl"
#include "renderer/shared/leaders.glsl"
#include "renderer/shared/tiles.glsl"

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

layout(scalar, binding = 0) uniform Frame { shared_frame frame; };
layout(binding = 1, rgba16f) uniform readonly image2DArray hdr;
layout(binding = 2, rgba8) uniform writeonly image2DArray target;
#ifdef REDRAW
layout(binding = 3, r8ui) uniform readonly uimage2DArray redraw_map;
layout(scalar, binding = 4) readonly buffer Tiles { uint tiles[]; };
layout(push_constant) uniform Push { uint listed; } push;
#endif
#ifdef LEADERS
layout(scalar, binding = 5) readonly buffer Leaders { uint leaders[]; };
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
    if (pixel.x >= int(frame.width) || pixel.y >= int(frame.height))
        return;
#ifdef REDRAW
    if (imageLoad(redraw_map, pixel).x == 0u)
        return;
#endif
    ivec3 from = pixel;
#ifdef LEADERS
    uint word = leaders_word(uvec2(pixel.xy) / 4u, uint(pixel.z), uvec2(frame.width, frame.height));
    from = leaders_pixel(leaders[word + uint(pixel.y >> 1 & 1)], pixel);
#endif
    vec3 scaled = imageLoad(hdr, from).rgb * frame.exposure;
    vec3 display = scaled / (1.0 + colour_luminance(scaled));
    imageStore(target, pixel, vec4(colour_encode(clamp(display, 0.0, 1.0)), 1.0));
}
