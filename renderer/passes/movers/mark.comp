#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"

// One work group a moving item and eye, in its turn: every pixel of the rectangles of its box now and a frame ago.

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

layout(scalar, binding = 0) uniform Frame { shared_frame frame; };
#include "renderer/shared/eye.glsl"
layout(scalar, binding = 1) readonly buffer Items { shared_item items[]; };
layout(scalar, binding = 2) readonly buffer Objects { shared_object objects[]; };
layout(scalar, binding = 3) readonly buffer Motions { mat4 motions[]; };
layout(scalar, binding = 4) readonly buffer Moving { uint moving[]; };
layout(binding = 5, r8ui) uniform writeonly uimage2DArray redraw_map;
layout(push_constant) uniform Push { uint count, turn, period, motion_count; } push;

#include "renderer/shared/box.glsl"

void mark(rectangle r, uint eye)
{
    vec2 size = vec2(frame.width, frame.height);
    // a pixel more: half for the jitter, half for rounding
    vec2 low = (r.low * 0.5 + 0.5) * size - 1.0, high = (r.high * 0.5 + 0.5) * size + 1.0;
    if (!all(lessThan(low, size)) || !all(greaterThan(high, vec2(0.0))))
        return;
    ivec2 first = ivec2(clamp(low, vec2(0.0), size - 1.0)), last = ivec2(clamp(high, vec2(0.0), size - 1.0));
    for (int y = first.y + int(gl_LocalInvocationID.y); y <= last.y; y += SHARED_TILE)
        for (int x = first.x + int(gl_LocalInvocationID.x); x <= last.x; x += SHARED_TILE)
            imageStore(redraw_map, ivec3(x, y, eye), uvec4(1u));
}

void main()
{
    uint index = gl_WorkGroupID.x * push.period + push.turn, eye = gl_WorkGroupID.y;
    if (index >= push.count || frame.moving == 0u)
        return;
    shared_item item = items[moving[index]];
    shared_object object = objects[item.object];
    if (object.moved == 0u)
        return; // what the camera uncovers of it leaves holes, as of all that stands
    mat4 clip = EYE(eye, clip_from_world);
    mark(project(item, clip * object.world_from_mesh), eye);
    mark(project(item, clip * motions[push.motion_count + object.moving_id] * object.world_from_mesh), eye);
}
