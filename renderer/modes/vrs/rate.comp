#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/view.glsl"

// The map of shading rates: rings around the gaze by the eccentricity of the middle of a texel's pixels.

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

layout(scalar, binding = 0) uniform Frame { shared_frame frame; };
#include "renderer/shared/eye.glsl"
layout(binding = 1, r8ui) uniform writeonly uimage2DArray rates;
layout(push_constant) uniform Push {
    float inner_deg;
    float outer_deg;
    uint texel;     // pixels a side
    uint middle;    // between the rings
    uint outermost; // beyond both
} push;

void main()
{
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(at.xy, imageSize(rates).xy)))
        return;
    vec2 centre = (vec2(at.xy) + 0.5) * float(push.texel);
    float off = view_eccentricity_deg(EYE(uint(at.z), gaze),
                                      view_ray(EYE(uint(at.z), tangents), vec2(frame.width, frame.height), centre));
    uint rate = off > push.outer_deg ? push.outermost : off > push.inner_deg ? push.middle : 0u; // 0: every pixel
    imageStore(rates, at, uvec4(rate));
}
