#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/view.glsl"
#include "renderer/passes/shade/bindings.glsl"
#include "renderer/passes/shade/surface.glsl"

// Every pixel up to `inner_deg` from the gaze, one of each 2x2 block up to `outer_deg`, one of each 4x4 block beyond,
// by the block's centre: as hardware does (VK_KHR_fragment_shading_rate), but in compute, where it does not reach. Like
// hardware, which shades a block once for every primitive in it, a block is shaded once for every surface in it. The
// pixels to shade are gathered first, so that the work items that shade lie side by side.

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

layout(scalar, binding = 11) buffer Counters { shared_counters counters; };
layout(push_constant) uniform Push {
    float inner_deg;
    float outer_deg;
} push;

const uint lanes = SHARED_TILE * SHARED_TILE;
// Reversed depth is linear over a plane's image; 1 % covers a curved surface's bend across a block.
const float depth_tolerance = 0.01;
const float least_cosine = 0.5; // of normals 60 degrees apart: bump maps do not split a surface, edges do
// The pixels of a 4x4 block, row by row, from the nearest to its centre to the farthest, and the other way round.
const uint nearness[16] = uint[16](5, 6, 9, 10, 1, 2, 4, 7, 8, 11, 13, 14, 0, 3, 12, 15);
const uint rank_of[16] = uint[16](12, 4, 5, 13, 6, 0, 1, 7, 8, 2, 3, 9, 14, 10, 11, 15);

shared float depths[lanes];
shared vec3 normals[lanes];
shared uint list[lanes];
shared uint list_length;
shared vec3 colours[lanes];
// By round modulo 3: who of each block (numbered by 2x2) has no leader yet, a bit per rank; whether anybody has none.
shared uint waiting[3][lanes / 4];
shared uint anybody[3];

float eccentricity_of(uvec2 block, uint size, uint eye)
{
    vec2 centre = (vec2(block) + 0.5) * float(size);
    return view_eccentricity_deg(EYE(eye, gaze), view_ray(EYE(eye, tangents), vec2(frame.width, frame.height), centre));
}

uint block_size(uvec2 pixel, uint eye)
{
    if (eccentricity_of(pixel / 4u, 4u, eye) > push.outer_deg)
        return 4u;
    return eccentricity_of(pixel / 2u, 2u, eye) > push.inner_deg ? 2u : 1u;
}

// The gentler of the slopes to either side along a row (stride 1) or a column.
float slope(uint at, uint place, uint stride)
{
    float own = depths[at];
    float up = place + 1u < SHARED_TILE ? depths[at + stride] - own : 1.0;
    float down = place > 0u ? own - depths[at - stride] : 1.0;
    return abs(up) < abs(down) ? up : down;
}

bool same_surface(uint leader, uint other)
{
    float d = depths[leader];
    if (d == 0.0 || depths[other] == 0.0)
        return d == depths[other]; // background
    uvec2 from = uvec2(leader % SHARED_TILE, leader / SHARED_TILE), to = uvec2(other % SHARED_TILE, other / SHARED_TILE);
    vec2 way = vec2(to) - vec2(from);
    float expected = d + way.x * slope(leader, from.x, 1u) + way.y * slope(leader, from.y, SHARED_TILE);
    return abs(depths[other] - expected) <= depth_tolerance * d && dot(normals[leader], normals[other]) >= least_cosine;
}

// Surface by surface, all blocks of the tile at once: the waiting pixel nearest its block's centre leads those of its
// surface. Returns who shades for this work item. Of the three sets of masks a round fills one, and clears the one that
// nobody reads any more.
uint choose_leader(uint at, bool inside, uint size)
{
    uvec2 lane = uvec2(at % SHARED_TILE, at / SHARED_TILE), corner = lane - lane % size, part = lane - corner;
    uint block = corner.y / 2u * (SHARED_TILE / 2u) + corner.x / 2u;
    uint place = part.y * size + part.x, rank = size == 4u ? rank_of[place] : place;
    bool waits = inside && size > 1u;
    uint leads = at;
    for (uint surfaces = 0u; surfaces < 16u; surfaces++) {
        uint now = surfaces % 3u, old = (surfaces + 2u) % 3u;
        if (waits) {
            atomicOr(waiting[now][block], 1u << rank);
            anybody[now] = 1u;
        }
        barrier();
        if (anybody[now] == 0u)
            break;
        if (waits) {
            uint first = uint(findLSB(waiting[now][block]));
            first = size == 4u ? nearness[first] : first;
            uint leader = (corner.y + first / size) * SHARED_TILE + corner.x + first % size;
            if (leader == at || same_surface(leader, at)) {
                leads = leader;
                waits = false;
            }
        }
        if (at < lanes / 4u)
            waiting[old][at] = 0u;
        if (at == 0u)
            anybody[old] = 0u;
    }
    return leads;
}

void main()
{
    ivec3 pixel = ivec3(gl_GlobalInvocationID);
    uint at = gl_LocalInvocationIndex, eye = gl_GlobalInvocationID.z;
    bool inside = pixel.x < int(frame.width) && pixel.y < int(frame.height);
    uint size = block_size(uvec2(pixel.xy), eye);
    depths[at] = inside ? texelFetch(depth_image, pixel, 0).x : 0.0;
    normals[at] = inside ? normal_decode(unpackSnorm2x16(texelFetch(normal_image, pixel, 0).x)) : vec3(0.0);
    if (at < 3u * lanes / 4u)
        waiting[at % 3u][at / 3u] = 0u;
    if (at < 3u)
        anybody[at] = 0u;
    if (at == 0u)
        list_length = 0u;
    barrier();
    uint leader = choose_leader(at, inside, size);
    if (inside && leader == at)
        list[atomicAdd(list_length, 1u)] = at;
    barrier();
    uint length = list_length, shaded = at < length ? list[at] : 0u;
    uvec2 corner = SHARED_TILE * gl_WorkGroupID.xy;
    ivec3 place = ivec3(corner + uvec2(shaded % SHARED_TILE, shaded / SHARED_TILE), eye);
    vec3 colour = shade_pixel(place, at < length, corner);
    if (at < length)
        colours[shaded] = colour;
    if (at == 0u)
        atomicAdd(counters.shaded_px, length);
    barrier();
    if (inside)
        imageStore(hdr, pixel, vec4(colours[leader], 1.0));
}
