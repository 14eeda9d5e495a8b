#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/tiles.glsl"
#include "renderer/shared/view.glsl"

// Obscurance of 32 samples: McGuire, Osman, Bukowski and Hennessy, "The Alchemy Screen-Space Ambient Obscurance
// Algorithm", HPG 2011, equation 10, with the spiral of McGuire, Mara and Luebke, "Scalable Ambient Obscurance", HPG
// 2012, section 2.2.

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

layout(scalar, binding = 0) uniform Frame { shared_frame frame; };
#include "renderer/shared/eye.glsl"
layout(binding = 1) uniform sampler2DArray distances;
layout(binding = 2, r8) uniform writeonly image2DArray occlusion;
#include "renderer/passes/ssao/half_pixel.glsl"

const int samples = 32;         // Franke et al. 2021, section 8.4
const float turns = 7.0;        // of the spiral: a prime that gives 32 samples a low discrepancy (2012, section 2.2)
const float radius_m = 0.5;     // how far a surface occludes: ours, about a person's reach in a room
const float intensity = 1.0;    // sigma
const float bias_m = 0.01;      // beta: per metre of distance, against the rounding of a plane's own texels
const float epsilon_m2 = 1e-4;  // keeps the quotient finite: 1 cm
const float most_texels = 64.0; // of the radius on the screen; nearer surfaces get a smaller radius

// View-space point of a texel; the projection's jitter, half a pixel at most, is left out.
vec3 point_of(ivec3 texel, float distance)
{
    return distance * view_ray(frame_eye(uint(texel.z)), vec2(frame.width, frame.height), 2.0 * vec2(texel.xy) + 0.5);
}

// The surface's change from one texel to the next along an axis, on the flatter side.
vec3 slope(ivec3 texel, ivec2 axis, vec3 here, ivec2 size)
{
    ivec3 a = ivec3(max(texel.xy - axis, ivec2(0)), texel.z), b = ivec3(min(texel.xy + axis, size - 1), texel.z);
    float before = texelFetch(distances, a, 0).x, after = texelFetch(distances, b, 0).x;
    bool has_before = before > 0.0 && a != texel, has_after = after > 0.0 && b != texel;
    if (has_before && (!has_after || abs(before + here.z) < abs(after + here.z)))
        return here - point_of(a, before);
    return has_after ? point_of(b, after) - here : vec3(axis.x, -axis.y, 0.0);
}

void main()
{
    ivec2 size = imageSize(occlusion).xy;
    ivec3 texel;
    if (!half_pixel(size, texel))
        return;
    float distance = texelFetch(distances, texel, 0).x;
    if (distance == 0.0) {
        imageStore(occlusion, texel, vec4(1.0));
        return;
    }
    vec3 here = point_of(texel, distance);
    vec3 normal = cross(slope(texel, ivec2(0, 1), here, size), slope(texel, ivec2(1, 0), here, size));
    normal *= inversesqrt(max(dot(normal, normal), 1e-20));
    shared_eye eye = frame_eye(uint(texel.z));
    float texels_per_m = 0.5 * float(frame.width) / ((eye.tangents.x + eye.tangents.y) * distance);
    float reach = min(radius_m * texels_per_m, most_texels), sum = 0.0;
    if (reach < 1.0) {
        imageStore(occlusion, texel, vec4(1.0)); // nothing within the radius is resolved
        return;
    }
    // sixteen rotations in a 4x4 pattern that the blur averages; fixed, so that a still picture stays still
    float start = 6.2831853 / 16.0 * float((texel.x & 3) * 4 + (texel.x + texel.y & 3));
    for (int i = 0; i < samples; i++) {
        float share = (float(i) + 0.5) / float(samples), angle = start + share * turns * 6.2831853;
        ivec2 at = texel.xy + ivec2(round(share * reach * vec2(cos(angle), sin(angle))));
        if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size)))
            continue;
        float there = texelFetch(distances, ivec3(at, texel.z), 0).x;
        if (there == 0.0)
            continue;
        vec3 v = point_of(ivec3(at, texel.z), there) - here;
        float v2 = dot(v, v);
        // beyond the radius an occluder counts for nothing
        if (v2 < radius_m * radius_m)
            sum += max(0.0, dot(v, normal) - bias_m * distance) / (v2 + epsilon_m2) * (1.0 - v2 / (radius_m * radius_m));
    }
    imageStore(occlusion, texel, vec4(max(0.0, 1.0 - 2.0 * intensity * radius_m / float(samples) * sum)));
}
