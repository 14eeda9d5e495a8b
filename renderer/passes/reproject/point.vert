#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/view.glsl"

// One point a source pixel, drawn in their order: of equal depths the first stays, as in splat.comp.

layout(scalar, binding = 0) uniform Frame { shared_frame frame; };
#include "renderer/shared/eye.glsl"
layout(scalar, binding = 1) readonly buffer Motions { mat4 motions[]; };
layout(binding = 2, rgba32f) uniform readonly image2DArray position_image;
layout(push_constant) uniform Push { float drop_cosine; uint drop_moving; uint eye; } push;

#include "renderer/passes/reproject/move.glsl"
#include "renderer/passes/reproject/land.glsl"

layout(location = 0) flat out uint out_source;

void main()
{
    uint index = uint(gl_VertexIndex);
    landing l = land(ivec3(index % frame.width, index / frame.width, push.eye));
    vec2 centre = (l.at + 0.5) / vec2(frame.width, frame.height) * 2.0 - 1.0;
    // the background lies behind every surface (near / 1e30 m is 5e-32) and before the cleared depth, 0
    float depth = max(l.depth, 1e-37);
    gl_Position = l.lands ? vec4(centre, depth, 1.0) : vec4(0.0, 0.0, -2.0, 1.0); // clipped
    gl_PointSize = 1.0;
    out_source = ~index;
}
