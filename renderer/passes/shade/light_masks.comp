#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/tiles.glsl"
#include "renderer/shared/view.glsl"
#include "renderer/passes/shade/bindings.glsl"

// Which lights may reach a tile's pixels, a bit each, so that every pixel adds its lights in the order of the scene and
// a run repeats to the last bit. Tiled culling after Andersson, "Parallel Graphics in Frostbite", SIGGRAPH 2009 course
// notes; but one invocation a tile, without barriers (see passes/redraw/count.comp).

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

#ifdef REDRAW
layout(scalar, binding = 13) readonly buffer List { uint list[]; }; // of tiles
layout(push_constant) uniform Push { uint listed; } push;
#endif

// False only where no surface of the tile can lie in the sphere. `low`, `high`: the tile's corners, in the image plane
// at distance 1 (view_ray), y up; `range`: the surfaces' least and greatest distance along the view axis.
bool sphere_meets_tile(vec3 centre, float radius, vec2 low, vec2 high, vec2 range)
{
    vec3 box_min = vec3(min(low * range.x, low * range.y), -range.y);
    vec3 box_max = vec3(max(high * range.x, high * range.y), -range.x);
    vec3 off = centre - clamp(centre, box_min, box_max);
    // signed distances to the four side planes, inside positive
    vec4 inside = vec4(centre.xy + low * centre.z, -centre.xy - high * centre.z) *
                  inversesqrt(1.0 + vec4(low * low, high * high));
    return dot(off, off) <= radius * radius && min(min(inside.x, inside.y), min(inside.z, inside.w)) >= -radius;
}

// The greatest and the least reversed depth of a tile's surfaces; x = 0: it has none.
vec2 depth_range(uvec3 corner)
{
    ivec2 end = min(ivec2(corner.xy) + SHARED_TILE, ivec2(frame.width, frame.height));
    vec2 range = vec2(0.0, 2.0);
    for (int y = int(corner.y); y < end.y; y++) {
        for (int x = int(corner.x); x < end.x; x++) {
            float depth = texelFetch(depth_image, ivec3(x, y, corner.z), 0).x;
            range = vec2(max(range.x, depth), depth == 0.0 ? range.y : min(range.y, depth));
        }
    }
    return range;
}

void write_masks(uvec3 corner)
{
    vec2 size = vec2(frame.width, frame.height), depths = depth_range(corner), range = frame.near_m / depths;
    vec2 upper = view_ray(EYE(corner.z, tangents), size, vec2(corner.xy) - frame.jitter).xy;
    vec2 lower = view_ray(EYE(corner.z, tangents), size, vec2(corner.xy) - frame.jitter + float(SHARED_TILE)).xy;
    mat4 world_from_eye = EYE(corner.z, world_from_eye);
    uint count = depths.x == 0.0 ? 0u : frame.light_count, word = light_mask_of(corner);
    for (uint first = 0u; first < count; first += 32u, word++) {
        uint bits = 0u;
        for (uint i = first; i < min(first + 32u, count); i++) {
            vec3 centre = (lights[i].position - world_from_eye[3].xyz) * mat3(world_from_eye);
            // the margin covers rounding: floats of 10 km from the origin are 1 mm apart
            float radius = lights[i].range_m * 1.0001 + 1e-3 + 1e-6 * length(centre);
            if (sphere_meets_tile(centre, radius, vec2(upper.x, lower.y), vec2(lower.x, upper.y), range))
                bits |= 1u << (i & 31u);
        }
        light_masks[word] = bits;
    }
}

void main()
{
    uvec3 tile = gl_GlobalInvocationID;
    uvec2 tiles = (uvec2(frame.width, frame.height) + SHARED_TILE - 1) / SHARED_TILE;
    bool wanted = tile.x < tiles.x && tile.y < tiles.y && frame.light_count != 0u;
    uvec3 corner = uvec3(SHARED_TILE * tile.xy, tile.z);
#ifdef REDRAW
    if (push.listed != 0u) {
        uint index = (tile.z * tiles.y + tile.y) * tiles.x + tile.x;
        wanted = wanted && index < list[SHARED_TILES_FIRST - 1];
        corner = wanted ? uvec3(tile_pixel(list[SHARED_TILES_FIRST + index], uvec2(0u))) : uvec3(0u);
    }
#endif
    for (; wanted; wanted = false) // the software driver leaves out a loop that no lane enters, but no branch
        write_masks(corner);
}
