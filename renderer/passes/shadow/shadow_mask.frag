#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/passes/shadow/push.glsl"

layout(scalar, set = 0, binding = 0) readonly buffer Materials { shared_material materials[]; };
layout(set = 1, binding = 0) uniform sampler2D base_texture;

layout(location = 0) in vec2 in_uv;
layout(location = 1) in float in_alpha;

void main()
{
    if (in_alpha * texture(base_texture, in_uv).a < materials[push.material].alpha_cutoff)
        discard;
}
