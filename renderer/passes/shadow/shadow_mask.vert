#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/passes/shadow/push.glsl"

layout(scalar, set = 0, binding = 0) readonly buffer Materials { shared_material materials[]; };

layout(location = 0) in vec3 in_position;
layout(location = 3) in vec2 in_uv0;
layout(location = 4) in vec2 in_uv1;
layout(location = 5) in vec4 in_colour;

layout(location = 0) out vec2 out_uv;
layout(location = 1) out float out_alpha; // all but the texture's

void main()
{
    gl_Position = push.clip_from_mesh * vec4(in_position, 1.0);
    shared_material m = materials[push.material];
    vec3 uv = vec3((m.uv_sets & 1u) != 0u ? in_uv1 : in_uv0, 1.0);
    out_uv = vec2(dot(uv, vec3(m.transforms[0], m.transforms[1], m.transforms[2])),
                  dot(uv, vec3(m.transforms[3], m.transforms[4], m.transforms[5])));
    out_alpha = m.base_colour.a * (push.sky_in_alpha != 0u ? 1.0 : in_colour.a);
}
