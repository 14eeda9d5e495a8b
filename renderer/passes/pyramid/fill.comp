#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/view.glsl"

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

layout(scalar, binding = 0) readonly buffer Frame { shared_frame frame; };
layout(scalar, binding = 1) buffer Counters { shared_counters counters; };
layout(binding = 2, rgba8) uniform image2DArray colour;
layout(binding = 3, rgba32f) uniform readonly image2DArray position;
layout(binding = 4) uniform sampler2DArray pyramid; // mip m - 1 is level m
layout(binding = 5, r8ui) uniform writeonly uimage2DArray redraw_map;
layout(push_constant) uniform Push {
    float epsilon, fovea_deg, periphery_deg, hole_decay, dynamic_decay;
    uint levels;
} push;

shared uint redrawn;

// Level m around a pixel: the valid ones of the four nearest texels, weighted bilinearly; alpha is their contrast
// confidence, 0 where the texel over the pixel itself has nothing.
vec4 level_value(ivec3 pixel, int m)
{
    int mip = m - 1;
    if (texelFetch(pyramid, ivec3(pixel.xy >> m, pixel.z), mip).a == 0.0)
        return vec4(0.0);
    vec2 at = (vec2(pixel.xy) + 0.5) / float(1 << m) - 0.5;
    ivec2 corner = ivec2(floor(at)), last = textureSize(pyramid, mip).xy - 1;
    vec2 f = at - vec2(corner);
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int i = 0; i < 4; i++) {
        ivec2 step = ivec2(i & 1, i >> 1);
        vec4 p = texelFetch(pyramid, ivec3(clamp(corner + step, ivec2(0), last), pixel.z), mip);
        vec2 w = mix(1.0 - f, f, vec2(step));
        if (p.a > 0.0) {
            sum += w.x * w.y * p;
            weights += w.x * w.y;
        }
    }
    return sum / weights; // the texel over the pixel weighs at least 1/4
}

bool decide(ivec3 pixel)
{
    const shared_eye eye = frame.eyes[pixel.z];
    vec3 ray = view_ray(eye, vec2(frame.width, frame.height), vec2(pixel.xy) + 0.5);
    float ecc = view_eccentricity_deg(eye, ray);
    // c_e = S_1((phi - phi_F) / (phi_0 - phi_F)), section 5.2
    float confidence = smoothstep(push.fovea_deg, max(push.periphery_deg, push.fovea_deg + 1e-3), ecc);
    float w = imageLoad(position, pixel).w;
    vec4 filled = vec4(0.0);
    if (w == 0.0) {
        int m = 0;
        while (filled.a == 0.0 && m < int(push.levels))
            filled = level_value(pixel, ++m);
        confidence *= filled.a * pow(push.hole_decay, float(m)); // c_c c_s(m)
    } else if (w >= 2.0) {
        confidence *= pow(push.dynamic_decay, round(fract(w) * 64.0)); // c_d(t), section 7
    }
    bool redraw = push.epsilon >= 1.0 || confidence < push.epsilon;
    if (!redraw && w == 0.0)
        imageStore(colour, pixel, vec4(filled.rgb, 1.0));
    imageStore(redraw_map, pixel, uvec4(redraw ? 1u : 0u));
    return redraw;
}

void main()
{
    if (gl_LocalInvocationIndex == 0)
        redrawn = 0u;
    barrier();
    ivec3 pixel = ivec3(gl_GlobalInvocationID);
    if (pixel.x < int(frame.width) && pixel.y < int(frame.height) && decide(pixel))
        atomicAdd(redrawn, 1u);
    barrier();
    if (gl_LocalInvocationIndex == 0 && redrawn > 0u)
        atomicAdd(counters.shaded_px, redrawn);
}
