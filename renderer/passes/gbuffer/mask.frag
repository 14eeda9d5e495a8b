#version 460

// Depth 1 (nearer than anything) where a pixel is kept, 0 (infinity) where it is redrawn.

layout(set = 0, binding = 0, r8ui) uniform readonly uimage2DArray redraw_map;
layout(push_constant) uniform Push { uint eye; } push;

void main()
{
    gl_FragDepth = imageLoad(redraw_map, ivec3(gl_FragCoord.xy, push.eye)).x != 0u ? 0.0 : 1.0;
}
