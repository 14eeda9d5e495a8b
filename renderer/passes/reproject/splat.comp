#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#include "renderer/shared/shared.h"
#include "renderer/shared/view.glsl"

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

layout(scalar, binding = 0) uniform Frame { shared_frame frame; };
#include "renderer/shared/eye.glsl"
layout(scalar, binding = 1) readonly buffer Motions { mat4 motions[]; };
layout(binding = 2, rgba32f) uniform readonly image2DArray position_image;
layout(scalar, binding = 3) buffer Keys { uint64_t keys[]; };
layout(push_constant) uniform Push { float drop_cosine; uint drop_moving; uint eye; } push;

#include "renderer/passes/reproject/move.glsl"
#include "renderer/passes/reproject/land.glsl"

void main()
{
    ivec3 source = ivec3(gl_GlobalInvocationID);
    if (source.x >= int(frame.width) || source.y >= int(frame.height))
        return;
    landing l = land(source);
    if (!l.lands)
        return;
    uint index = uint(source.y) * frame.width + uint(source.x);
    uint slot = (uint(source.z) * frame.height + uint(l.at.y)) * frame.width + uint(l.at.x);
    // of equal depths the first source pixel wins; never 0, which is a hole
    atomicMax(keys[slot], uint64_t(floatBitsToUint(l.depth)) << 32 | uint64_t(~index));
}
