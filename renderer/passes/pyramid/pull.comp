#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/colour.glsl"
#include "renderer/shared/kept.glsl"

// One level of the pyramid from the one below. Franke et al. 2021, section 5.2: the alpha of a mip-mapped pixel is its
// contrast confidence c_c = 1 - 0.5 (max L - min L) over the valid inputs, L their tone-mapped luminance in [0, 1]; 0
// marks a pixel without any valid input. Its depth is the farthest of the inputs. The background (depth 0) counts for
// the contrast, but for colour and depth only where there is nothing else, so that it does not bleed into surfaces.
//
// One invocation a texel and one dispatch a level, without barriers: on the software driver three levels from one tile
// in shared memory cost four times as much (measured 2026-11-24: 43 against 10 ms at twice 640x720).

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

layout(scalar, binding = 0) uniform Frame { shared_frame frame; };
#include "renderer/shared/eye.glsl"
#ifdef FIRST
layout(binding = 1, rgba8) uniform readonly image2DArray colour;
layout(binding = 2, rgba32f) uniform readonly image2DArray position;
#else
layout(binding = 3, rgba16f) uniform readonly image2DArray level_in;
layout(binding = 4, r32f) uniform readonly image2DArray depth_in;
#endif
layout(binding = 5, rgba16f) uniform writeonly image2DArray level_out;
layout(binding = 6, r32f) uniform writeonly image2DArray depth_out;

// rgb, and whether there is a value.
vec4 load(ivec3 pixel, out float depth)
{
    depth = 0.0;
#ifdef FIRST
    if (pixel.x >= int(frame.width) || pixel.y >= int(frame.height))
        return vec4(0.0);
    vec4 p = imageLoad(position, pixel);
    if (p.w == 0.0)
        return vec4(0.0);
    depth = kept_depth(frame_eye(uint(pixel.z)), p, frame.near_m);
    return vec4(imageLoad(colour, pixel).rgb, 1.0);
#else
    depth = imageLoad(depth_in, pixel).x;
    return imageLoad(level_in, pixel);
#endif
}

void main()
{
    ivec3 to = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(to.xy, imageSize(level_out).xy)))
        return;
    vec4 surface = vec4(0.0), background = vec4(0.0); // sums and counts
    float low = 1.0, high = 0.0, farthest = 1.0;
    for (int i = 0; i < 4; i++) {
        float depth;
        vec4 p = load(ivec3(2 * to.xy + ivec2(i & 1, i >> 1), to.z), depth);
        if (p.a == 0.0)
            continue;
        float l = colour_luminance(p.rgb);
        low = min(low, l);
        high = max(high, l);
        if (depth > 0.0) {
            surface += vec4(p.rgb, 1.0);
            farthest = min(farthest, depth);
        } else
            background += vec4(p.rgb, 1.0);
    }
    vec4 sum = surface.a > 0.0 ? surface : background;
    float contrast = 1.0 - 0.5 * max(high - low, 0.0);
    imageStore(level_out, to, sum.a > 0.0 ? vec4(sum.rgb / sum.a, contrast) : vec4(0.0));
    imageStore(depth_out, to, vec4(surface.a > 0.0 ? farthest : 0.0));
}
