#version 460
#extension GL_EXT_scalar_block_layout : require

// A storage buffer's words to one that the CPU reads: the passes' own buffers cannot be sources of a transfer.

layout(local_size_x = 64) in;

layout(scalar, binding = 0) readonly buffer From { uint from[]; };
layout(scalar, binding = 1) writeonly buffer To { uint to[]; };
layout(push_constant) uniform Push { uint count; } push;

void main()
{
    if (gl_GlobalInvocationID.x < push.count)
        to[gl_GlobalInvocationID.x] = from[gl_GlobalInvocationID.x];
}
