#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"

layout(local_size_x = SHARED_CULL_GROUP) in;
layout(constant_id = 0) const int bucket_count = 1;
layout(constant_id = 1) const bool both_eyes = false; // one list, and every draw in it goes to both
layout(constant_id = 2) const int instances = 1;

layout(scalar, binding = 0) uniform Frame { shared_frame frame; };
#include "renderer/shared/eye.glsl"
layout(scalar, binding = 1) readonly buffer Items { shared_item items[]; };
layout(scalar, binding = 2) readonly buffer Groups { shared_cull_group groups[]; };
layout(scalar, binding = 3) readonly buffer Visible { uint visible[]; };
layout(scalar, binding = 4) readonly buffer GroupCounts { uint group_counts[]; };
layout(scalar, binding = 5) writeonly buffer Draws { shared_draw draws[]; };
layout(scalar, binding = 6) writeonly buffer DrawCounts { uint draw_counts[]; };
layout(scalar, binding = 7) buffer Counters { shared_counters counters; };

shared uint flags[SHARED_CULL_GROUP], base; // base: the bucket's draws before the group's

// Loops of one turn, or of none in most lanes: the software driver leaves out a loop that no lane enters, but no branch.
void main()
{
    uint eye = gl_WorkGroupID.y, lane = gl_LocalInvocationID.x;
    shared_cull_group group = groups[gl_WorkGroupID.x];
    uint item = group.first_item + lane;
    flags[lane] = lane < group.item_count ? visible[eye * frame.item_count + item] : 0u;
    uint sum = 0;
    for (uint g = lane == 0 ? group.first_group : gl_WorkGroupID.x; g < gl_WorkGroupID.x; g++)
        sum += group_counts[eye * gl_NumWorkGroups.x + g];
    if (lane == 0)
        base = sum;
    barrier();

    for (bool drawn = flags[lane] != 0; drawn; drawn = false) {
        uint before = base;
        for (uint i = 0; i < lane; i++)
            before += flags[i];
        draws[eye * frame.item_count + group.bucket_first_item + before] =
            shared_draw(items[item].index_count, uint(instances), items[item].first_index, 0, item);
    }
    for (bool first = lane == 0; first; first = false) {
        uint triangles = 0, own = 0;
        for (uint i = 0; i < group.item_count; i++) {
            own += flags[i];
            triangles += flags[i] * (items[group.first_item + i].index_count / 3);
        }
        const uint views = both_eyes ? 2u : 1u;
        atomicAdd(counters.triangles, views * triangles);
        atomicAdd(counters.submodels, views * own);
        if (group.last != 0)
            draw_counts[eye * uint(bucket_count) + group.bucket] = base + own;
    }
}
