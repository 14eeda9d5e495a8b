#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/leaders.glsl"
#include "renderer/shared/normal.glsl"
#include "renderer/shared/tiles.glsl"
#include "renderer/shared/view.glsl"
#include "renderer/passes/shade/bindings.glsl"

// Chooses the pixels to shade: every pixel up to `inner_deg` from the gaze, one of each 2x2 block up to `outer_deg`,
// one of each 4x4 block beyond, by the block's centre: as hardware does (VK_KHR_fragment_shading_rate), but in compute,
// where it does not reach. Like hardware, which shades a block once for every primitive in it, a block is shaded once
// for every surface in it. The chosen go to one list, so that the work items that shade lie side by side.
//
// One invocation for 4x4 pixels, without barriers (see passes/redraw/count.comp). Sets of pixels are masks, a bit a
// place (leaders.glsl).

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

layout(scalar, binding = 13) buffer List { uint list[]; }; // of pixels, coded like tiles, 64 a work group
layout(scalar, binding = 15) writeonly buffer Leaders { uint leaders[]; };
layout(push_constant) uniform Push {
    float inner_deg;
    float outer_deg;
} push;

// Reversed depth is linear over a plane's image; 1 % covers a curved surface's bend across a block.
const float depth_tolerance = 0.01;
const float least_cosine = 0.5; // of normals 60 degrees apart: bump maps do not split a surface, edges do

bool beyond(uvec2 block, uint size, uint eye, float limit_deg)
{
    vec2 centre = (vec2(block) + 0.5) * float(size);
    vec3 ray = view_ray(EYE(eye, tangents), vec2(frame.width, frame.height), centre);
    return view_eccentricity_deg(EYE(eye, gaze), ray) > limit_deg;
}

// Those of a 4x4 block that are in coarse blocks: all if it is one itself (`whole`), else its 2x2 blocks that are.
uint in_coarse(uvec2 block, uint eye, bool whole)
{
    uint mask = whole ? 0xffffu : 0u;
    for (uint i = whole ? 4u : 0u; i < 4u; i++) { // the software driver leaves out a loop, but no branch
        uvec2 part = uvec2(i & 1u, i >> 1);
        if (beyond(2u * block + part, 2u, eye, push.inner_deg))
            mask |= 0x33u << 2u * part.x + 8u * part.y;
    }
    return mask;
}

// The one that is nearest to the centre, or the first of a 2x2 block.
uint first_of(uint waiting, bool whole)
{
    uint middle = whole ? waiting & 0x0660u : 0u, sides = whole ? waiting & 0x6996u : 0u;
    return uint(findLSB(middle != 0u ? middle : sides != 0u ? sides : waiting));
}

float depth_at(ivec3 pixel)
{
    bool inside = pixel.x < int(frame.width) && pixel.y < int(frame.height);
    return inside ? texelFetch(depth_image, pixel, 0).x : 0.0;
}

vec3 normal_at(ivec3 pixel)
{
    return normal_decode(unpackSnorm2x16(texelFetch(normal_image, pixel, 0).x));
}

// The gentler of the slopes to either side along a row or a column, within the tile.
float slope(ivec3 pixel, float own, ivec3 way)
{
    int place = (way.x != 0 ? pixel.x : pixel.y) % SHARED_TILE;
    float up = place + 1 < SHARED_TILE ? depth_at(pixel + way) - own : 1.0;
    float down = place > 0 ? own - depth_at(pixel - way) : 1.0;
    return abs(up) < abs(down) ? up : down;
}

// Of `others`, those on the surface of pixel `leader`; `words`: they follow it.
uint same_surface(ivec3 corner, uint leader, uint others, inout uvec2 words)
{
    ivec3 from = corner + ivec3(leader & 3u, leader >> 2, 0);
    vec3 normal = normal_at(from);
    float depth = depth_at(from);
    vec2 slopes = vec2(slope(from, depth, ivec3(1, 0, 0)), slope(from, depth, ivec3(0, 1, 0)));
    uint same = 0u;
    for (; others != 0u; others &= others - 1u) {
        uint place = uint(findLSB(others));
        ivec3 to = corner + ivec3(place & 3u, place >> 2, 0);
        vec2 way = vec2(to.xy) - vec2(from.xy);
        float other = texelFetch(depth_image, to, 0).x, expected = depth + way.x * slopes.x + way.y * slopes.y;
        bool near = abs(other - expected) <= depth_tolerance * depth && dot(normal, normal_at(to)) >= least_cosine;
        bool follows = depth == 0.0 || other == 0.0 ? depth == other : near; // background has no normal
        uint change = follows ? (place ^ leader) << 4u * (place & 7u) : 0u;
        words ^= place < 8u ? uvec2(change, 0u) : uvec2(0u, change);
        same |= follows ? 1u << place : 0u;
    }
    return same;
}

void append(uint chosen, ivec3 corner)
{
    uint count = uint(bitCount(chosen)), slot = atomicAdd(list[SHARED_TILES_FIRST - 1], count);
    uint groups = (slot + count + 63u) / 64u;
    atomicMax(list[0], min(groups, 65535u)); // rows, as in tiles.glsl
    atomicMax(list[1], (groups - 1u) / 65535u + 1u);
    for (uint at = SHARED_TILES_FIRST + slot; chosen != 0u; chosen &= chosen - 1u, at++) {
        uint place = uint(findLSB(chosen));
        list[at] = tile_code(uvec2(corner.xy) + uvec2(place & 3u, place >> 2), uint(corner.z));
    }
}

void main()
{
    uvec2 size = uvec2(frame.width, frame.height), block = gl_GlobalInvocationID.xy;
    uint eye = gl_GlobalInvocationID.z;
    ivec3 corner = ivec3(4u * block, eye);
    if (any(greaterThanEqual(uvec2(corner.xy), size)))
        return;
    uvec2 left = min(size - uvec2(corner.xy), 4u);
    uint inside = (0x1111u * ((1u << left.x) - 1u)) & ((1u << 4u * left.y) - 1u);
    bool whole = beyond(block, 4u, eye, push.outer_deg);
    uint waiting = inside & in_coarse(block, eye, whole), chosen = inside & ~waiting;
    uvec2 words = leaders_alone;
    while (waiting != 0u) { // surface by surface
        uint leader = first_of(waiting, whole);
        uint others = waiting & (whole ? 0xffffu : 0x33u << (leader & 10u)) & ~(1u << leader);
        chosen |= 1u << leader;
        waiting &= ~(same_surface(corner, leader, others, words) | 1u << leader);
    }
    uint word = leaders_word(block, eye, size);
    leaders[word] = words.x;
    leaders[word + 1u] = words.y;
    append(chosen, corner);
}
