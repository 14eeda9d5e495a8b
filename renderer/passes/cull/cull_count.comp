#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"

// REDRAW: what owns no redrawn pixel is out too.

layout(local_size_x = SHARED_CULL_GROUP) in;
layout(constant_id = 0) const bool both_eyes = false; // one list, of what either eye sees

layout(scalar, binding = 0) uniform Frame { shared_frame frame; };
#include "renderer/shared/eye.glsl"
layout(scalar, binding = 1) readonly buffer Items { shared_item items[]; };
layout(scalar, binding = 2) readonly buffer Objects { shared_object objects[]; };
layout(scalar, binding = 3) readonly buffer Groups { shared_cull_group groups[]; };
layout(scalar, binding = 4) writeonly buffer Visible { uint visible[]; };
layout(scalar, binding = 5) writeonly buffer GroupCounts { uint group_counts[]; };
#ifdef REDRAW
layout(scalar, binding = 6) buffer Counters { shared_counters counters; };
layout(scalar, binding = 7) readonly buffer Pyramid { uint pyramid[]; }; // passes/redraw
layout(push_constant) uniform Push {
    uint tiles_x, tiles_y, levels;
    uint moving_everywhere; // 1: moving objects are drawn wherever they are
} push;

shared uint in_frustum, triangles;
#include "renderer/passes/cull/redraw.glsl"
#endif

shared uint count;

// A box is out only when it lies wholly behind one plane; the near plane is the eye's own, so that a box the eye is
// in is always drawn.
bool seen(shared_item item, uint eye)
{
    mat4 m = objects[item.object].world_from_mesh;
    vec3 centre = (m * vec4(0.5 * (item.box_min + item.box_max), 1.0)).xyz;
    vec3 half_size = 0.5 * (item.box_max - item.box_min);
    mat3 extent = mat3(m[0].xyz * half_size.x, m[1].xyz * half_size.y, m[2].xyz * half_size.z);
    for (int i = 0; i < 5; i++) {
        vec4 plane = i < 4 ? EYE(eye, planes[i]) : EYE(eye, forward);
        vec3 along = abs(plane.xyz * extent);
        // the margin covers the rounding of positions up to 200 m from the origin
        if (dot(plane.xyz, centre) + plane.w + along.x + along.y + along.z < -1e-4)
            return false;
    }
    return true;
}

void main()
{
    uint eye = gl_WorkGroupID.y, lane = gl_LocalInvocationID.x;
    shared_cull_group group = groups[gl_WorkGroupID.x];
    if (lane == 0) {
        count = 0;
#ifdef REDRAW
        in_frustum = triangles = 0;
#endif
    }
    barrier();
    if (lane < group.item_count) {
        uint index = group.first_item + lane;
        shared_item item = items[index];
        bool v = seen(item, eye) || (both_eyes && seen(item, 1u));
#ifdef REDRAW
        if (v) {
            atomicAdd(in_frustum, 1);
            atomicAdd(triangles, item.index_count / 3);
            bool everywhere = push.moving_everywhere != 0u && objects[item.object].moving_id != 0u;
            v = everywhere || redrawn(item, eye);
        }
#endif
        visible[eye * frame.item_count + index] = v ? 1u : 0u;
        if (v)
            atomicAdd(count, 1);
    }
    barrier();
    if (lane == 0) {
        group_counts[eye * gl_NumWorkGroups.x + gl_WorkGroupID.x] = count;
#ifdef REDRAW
        atomicAdd(counters.frustum_submodels, in_frustum);
        atomicAdd(counters.frustum_triangles, triangles);
#endif
    }
}
