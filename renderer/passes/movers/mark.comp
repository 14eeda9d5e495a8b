#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"

// One work group a moving item and eye: the rectangles of its box now and a frame ago. A small one is marked whole in the
// item's turn, so that it is seen whole however fast it moves. A large one is marked by strips of tiles in their turns, the same as
// those of moving pixels (passes/pyramid), so that no frame has all the work and no pixel is redrawn twice for it.

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
#include "renderer/shared/turn.glsl"

const float small = 1.0 / 64.0; // of the image: what a whole box may add to one frame

void mark(rectangle r, uint eye, bool items_turn)
{
    vec2 size = vec2(frame.width, frame.height);
    // a pixel more: half for the jitter, half for rounding
    vec2 low = (r.low * 0.5 + 0.5) * size - 1.0, high = (r.high * 0.5 + 0.5) * size + 1.0;
    if (!all(lessThan(low, size)) || !all(greaterThan(high, vec2(0.0))))
        return;
    ivec2 first = ivec2(clamp(low, vec2(0.0), size - 1.0)), last = ivec2(clamp(high, vec2(0.0), size - 1.0));
    ivec2 extent = last - first + 1;
    bool whole = float(extent.x) * float(extent.y) <= small * size.x * size.y;
    if (whole && !items_turn)
        return;
    ivec2 start = first / SHARED_TILE * SHARED_TILE + ivec2(gl_LocalInvocationID.xy);
    for (int y = start.y; y <= last.y; y += SHARED_TILE)
        for (int x = start.x; x <= last.x; x += SHARED_TILE)
            if (x >= first.x && y >= first.y &&
                (whole || tile_has_turn(uint(x) / SHARED_TILE, frame.width, push.turn, push.period)))
                imageStore(redraw_map, ivec3(x, y, eye), uvec4(1u));
}

void main()
{
    uint index = gl_WorkGroupID.x, eye = gl_WorkGroupID.y;
    if (index >= push.count || frame.moving == 0u)
        return;
    shared_item item = items[moving[index]];
    shared_object object = objects[item.object];
    if (object.moved == 0u)
        return; // what the camera uncovers of it leaves holes, as of all that stands
    bool items_turn = index % push.period == push.turn % push.period;
    mat4 clip = EYE(eye, clip_from_world);
    mark(project(item, clip * object.world_from_mesh), eye, items_turn);
    mark(project(item, clip * motions[push.motion_count + object.moving_id] * object.world_from_mesh), eye, items_turn);
}
