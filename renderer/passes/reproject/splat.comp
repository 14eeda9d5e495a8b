#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#include "renderer/shared/shared.h"
#include "renderer/shared/view.glsl"

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

layout(scalar, binding = 0) readonly buffer Frame { shared_frame frame; };
layout(scalar, binding = 1) readonly buffer Motions { mat4 motions[]; };
layout(scalar, binding = 2) buffer Keys { uint64_t keys[]; };
layout(binding = 3, rgba32f) uniform readonly image2DArray position_image;
layout(push_constant) uniform Push { float drop_deg; } push;

#include "renderer/passes/reproject/move.glsl"

void main()
{
    ivec3 source = ivec3(gl_GlobalInvocationID);
    if (source.x >= int(frame.width) || source.y >= int(frame.height))
        return;
    vec4 position = imageLoad(position_image, source);
    if (position.w == 0.0)
        return; // a filled hole is never warped again
    uint eye = gl_GlobalInvocationID.z;
    mat4 world_from_eye = frame.eyes[eye].world_from_eye;
    position = move_position(position);
    bool direction = position.w < 0.0;
    vec3 away = direction ? position.xyz : position.xyz - world_from_eye[3].xyz;
    vec3 p = away * mat3(world_from_eye); // the transposed rotation
    // written so that what is not a number is out: the motion of an object once scaled to nothing is none
    if (any(isnan(p)) || any(isinf(p)) || (direction ? p.z >= 0.0 : -p.z < frame.near_m))
        return;
    vec2 size = vec2(frame.width, frame.height);
    vec2 at = floor(view_pixel(frame.eyes[eye], size, p));
    if (!all(greaterThanEqual(at, vec2(0.0))) || !all(lessThan(at, size)))
        return;
    if (view_eccentricity_deg(frame.eyes[eye], view_ray(frame.eyes[eye], size, at + 0.5)) < push.drop_deg)
        return;
    uint depth = direction ? 0u : floatBitsToUint(frame.near_m / -p.z);
    uint index = uint(source.y) * frame.width + uint(source.x);
    uint slot = (eye * frame.height + uint(at.y)) * frame.width + uint(at.x);
    // of equal depths the first source pixel wins; never 0, which is a hole
    atomicMax(keys[slot], uint64_t(depth) << 32 | uint64_t(~index));
}
