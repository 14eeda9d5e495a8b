#version 460
#extension GL_GOOGLE_include_directive : require
#include "renderer/passes/shadow/push.glsl"

layout(location = 0) in vec3 in_position;

void main()
{
    gl_Position = push.clip_from_mesh * vec4(in_position, 1.0);
}
