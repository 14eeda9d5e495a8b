#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/kept.glsl"

// Depth 1 (nearer than anything) where a pixel is kept, 0 (infinity) where it is redrawn. KEPT: the kept pixel's own
// depth instead, and redrawn pixels stay as they are.

layout(set = 0, binding = 0, r8ui) uniform readonly uimage2DArray redraw_map;
layout(scalar, set = 0, binding = 1) uniform Frame { shared_frame frame; };
#ifdef KEPT
layout(set = 0, binding = 2, rgba32f) uniform readonly image2DArray position_image;
#endif
layout(push_constant) uniform Push { uint eye; } push;

void main()
{
    ivec3 pixel = ivec3(gl_FragCoord.xy, push.eye);
    bool redrawn = imageLoad(redraw_map, pixel).x != 0u;
#ifdef KEPT
    if (redrawn)
        discard;
    gl_FragDepth = kept_depth(frame.eyes[push.eye], imageLoad(position_image, pixel), frame.near_m);
#else
    gl_FragDepth = redrawn ? 0.0 : 1.0;
#endif
}
