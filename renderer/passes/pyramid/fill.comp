#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/tiles.glsl"
#include "renderer/shared/view.glsl"

// Holes, as listed (of all pixels without a list), that the redraw map does not hold yet: filled, or redrawn after all where their confidence is too low.

layout(local_size_x = 64) in;

layout(scalar, binding = 0) uniform Frame { shared_frame frame; };
#include "renderer/shared/eye.glsl"
layout(binding = 1, rgba8) uniform writeonly image2DArray colour;
layout(binding = 2, rgba32f) uniform image2DArray position;
layout(binding = 3) uniform sampler2DArray pyramid; // mip m - 1 is level m
layout(binding = 4) uniform sampler2DArray depths;
layout(binding = 5, r8ui) uniform uimage2DArray redraw_map;
layout(scalar, binding = 6) readonly buffer Holes { uint holes[]; };
#include "renderer/passes/pyramid/confidence.glsl"

// Texels of level m of a pyramid as deep as is asked for; its image may be made deeper, and so larger.
ivec2 level_size(int m)
{
    ivec2 whole = ivec2(frame.width, frame.height) + (1 << push.levels) - 1;
    return (whole >> push.levels << push.levels) >> m;
}

// Level m around a pixel: the four nearest texels, weighted bilinearly, of those with a value and of the kind (surface
// or background) of the texel over the pixel itself; alpha is their contrast confidence, 0 where that texel has
// nothing.
vec4 level_value(ivec3 pixel, int m, out float depth)
{
    int mip = m - 1;
    vec2 at = (vec2(pixel.xy) + 0.5) / float(1 << m) - 0.5;
    ivec2 over = pixel.xy >> m, corner = ivec2(floor(at)), last = level_size(m) - 1;
    vec2 f = at - vec2(corner);
    vec4 values[4];
    float depths_of[4];
    float contrast = 0.0;
    depth = 0.0;
    for (int i = 0; i < 4; i++) {
        ivec2 to = corner + ivec2(i & 1, i >> 1);
        ivec3 texel = ivec3(clamp(to, ivec2(0), last), pixel.z);
        values[i] = texelFetch(pyramid, texel, mip);
        depths_of[i] = texelFetch(depths, texel, mip).x;
        if (to == over) { // always one of the four
            contrast = values[i].a;
            depth = depths_of[i];
        }
    }
    if (contrast == 0.0)
        return vec4(0.0);
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int i = 0; i < 4; i++) {
        vec2 w = mix(1.0 - f, f, vec2(i & 1, i >> 1));
        if (values[i].a > 0.0 && (depths_of[i] > 0.0) == (depth > 0.0)) {
            sum += w.x * w.y * values[i];
            weights += w.x * w.y;
        }
    }
    return sum / weights; // the texel over the pixel weighs at least 1/4
}

void fill(ivec3 pixel)
{
    vec4 filled = vec4(0.0);
    float depth = 0.0;
    int m = 0;
    while (filled.a == 0.0 && m < int(push.levels))
        filled = level_value(pixel, ++m, depth);
    // c_e c_c c_s(m)
    float confidence =
        eccentricity_confidence(pixel, vec2(pixel.xy) + 0.5) * filled.a * pow(push.hole_decay, float(m));
    if (confidence < push.epsilon) {
        imageStore(redraw_map, pixel, uvec4(1u));
    } else {
        imageStore(colour, pixel, vec4(filled.rgb, 1.0));
        imageStore(position, pixel, vec4(depth, 0.0, 0.0, 0.0)); // still a hole; its depth is for smoothing
    }
}

void main()
{
    uint index = TILE_INDEX * 64u + gl_LocalInvocationIndex;
    uvec3 pixel = uvec3(index % frame.width, index / frame.width % frame.height, index / frame.width / frame.height);
    if (push.listed != 0u) {
        if (index >= holes[SHARED_TILES_FIRST - 1])
            return;
        pixel = uvec3(tile_of(holes[SHARED_TILES_FIRST + index]));
    }
    if (pixel.z > 1u)
        return;
    ivec3 at = ivec3(pixel);
    bool hole = imageLoad(redraw_map, at).x == 0u && imageLoad(position, at).w == 0.0;
    for (; hole; hole = false) // the software driver leaves out a loop that no lane enters, but no branch
        fill(at);
}
