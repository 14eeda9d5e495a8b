#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/tiles.glsl"

// One invocation a moving item and eye: lists the rectangles of its box, now and a frame ago, that mark.comp marks in this
// turn. A small one is marked whole, so that it is seen whole however fast it moves, when the strip of its centre has its
// turn, so that what a frame redraws of it and beside it lies together. A large one is listed in every frame.

layout(local_size_x = SHARED_CULL_GROUP) in;

layout(scalar, binding = 0) uniform Frame { shared_frame frame; };
#include "renderer/shared/eye.glsl"
layout(scalar, binding = 1) readonly buffer Items { shared_item items[]; };
layout(scalar, binding = 2) readonly buffer Objects { shared_object objects[]; };
layout(scalar, binding = 3) readonly buffer Motions { mat4 motions[]; };
layout(scalar, binding = 4) readonly buffer Moving { uint moving[]; };
layout(scalar, binding = 5) buffer List { uint words[]; } list;
layout(scalar, binding = 6) writeonly buffer Rectangles { uvec2 rectangles[]; };
layout(push_constant) uniform Push { uint count, turn, period, motion_count; } push;

#include "renderer/shared/box.glsl"
#include "renderer/shared/turn.glsl"

const float small = 1.0 / 64.0; // of the image: what a whole box may add to one frame

struct area {
    uvec2 first, last; // pixels
    bool seen;
};

area area_of(shared_item item, mat4 clip_from_mesh)
{
    rectangle r = project(item, clip_from_mesh);
    vec2 size = vec2(frame.width, frame.height);
    // a pixel more: half for the jitter, half for rounding
    vec2 low = (r.low * 0.5 + 0.5) * size - 1.0, high = (r.high * 0.5 + 0.5) * size + 1.0;
    return area(uvec2(clamp(low, vec2(0.0), size - 1.0)), uvec2(clamp(high, vec2(0.0), size - 1.0)),
                all(lessThan(low, size)) && all(greaterThan(high, vec2(0.0))));
}

uint centre_strip(area a)
{
    return strip_of((a.first.x + a.last.x) / 2u / SHARED_TILE, frame.width, push.period);
}

void add(area a, bool has_turn, uint index)
{
    uvec2 extent = a.last - a.first + 1u;
    bool whole = float(extent.x) * float(extent.y) <= small * float(frame.width) * float(frame.height);
    if (!a.seen || whole && !has_turn)
        return;
    rectangles[index] = uvec2(a.first.x | a.first.y << 16, a.last.x | a.last.y << 16 | (whole ? 1u << 15 : 0u));
    TILE_APPEND(list.words, index)
}

void consider(uint index, uint eye, shared_item item)
{
    shared_object object = objects[item.object];
    mat4 clip = EYE(eye, clip_from_world);
    area now = area_of(item, clip * object.world_from_mesh);
    area before = area_of(item, clip * motions[push.motion_count + object.moving_id] * object.world_from_mesh);
    // also the strips that its centre crossed: it could go on jumping over the one that has its turn
    uint a = centre_strip(now), b = centre_strip(before), low = min(a, b);
    uint next = low + (push.period - (push.turn + low) % push.period) % push.period;
    bool has_turn = next <= max(a, b);
    add(now, has_turn, 4u * index + 2u * eye);
    add(before, has_turn, 4u * index + 2u * eye + 1u);
}

void main()
{
    uint index = gl_GlobalInvocationID.x, eye = gl_GlobalInvocationID.y;
    if (index >= push.count || frame.moving == 0u)
        return;
    shared_item item = items[moving[index]];
    // what the camera uncovers of an object that has long stood leaves holes, as of all that stands
    bool moved = objects[item.object].moved != 0u;
    for (; moved; moved = false) // the software driver leaves out a loop that no lane enters, but no branch
        consider(index, eye, item);
}
