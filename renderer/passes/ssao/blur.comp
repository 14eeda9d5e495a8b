#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/tiles.glsl"

// Edge-aware mean over 4x4 texels, the pattern of the rotations, so that each counts once on a surface: those at a
// texel's own distance count (Mittring 2007, "Finding Next Gen: CryEngine 2").

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

layout(scalar, binding = 0) uniform Frame { shared_frame frame; };
#include "renderer/shared/eye.glsl"
layout(binding = 1) uniform sampler2DArray distances;
layout(binding = 2, r8) uniform readonly image2DArray occlusion;
layout(binding = 3, r8) uniform writeonly image2DArray blurred;
#include "renderer/passes/ssao/half_pixel.glsl"

void main()
{
    ivec2 size = imageSize(blurred).xy;
    ivec3 texel;
    if (!half_pixel(size, texel))
        return;
    float distance = texelFetch(distances, texel, 0).x, sum = 0.0, weights = 0.0;
    for (int i = 0; i < 16 && distance > 0.0; i++) {
        ivec3 at = ivec3(clamp(texel.xy + ivec2(i & 3, i >> 2) - 2, ivec2(0), size - 1), texel.z);
        // 5 % of the distance over up to two texels: floors at a slant still count as one surface
        float weight = max(0.0, 1.0 - 20.0 * abs(texelFetch(distances, at, 0).x - distance) / distance);
        sum += weight * imageLoad(occlusion, at).x;
        weights += weight;
    }
    imageStore(blurred, texel, vec4(weights > 0.0 ? sum / weights : 1.0));
}
