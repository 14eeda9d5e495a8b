#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/colour.glsl"

// Up to three levels of the pyramid from one 8x8 tile. Franke et al. 2021, section 5.2: the alpha of a mip-mapped
// pixel is its contrast confidence c_c = 1 - 0.5 (max L - min L) over the contributing inputs, L their tone-mapped
// luminance in [0, 1]; 0 marks a pixel without any valid input.

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

layout(scalar, binding = 0) readonly buffer Frame { shared_frame frame; };
layout(binding = 1, rgba8) uniform readonly image2DArray colour;
layout(binding = 2, rgba32f) uniform readonly image2DArray position;
layout(binding = 3, rgba16f) uniform readonly image2DArray level_in;
layout(binding = 4, rgba16f) uniform writeonly image2DArray level_1;
layout(binding = 5, rgba16f) uniform writeonly image2DArray level_2;
layout(binding = 6, rgba16f) uniform writeonly image2DArray level_3;
layout(push_constant) uniform Push { uint first; uint levels; } push;

shared vec4 tile[SHARED_TILE][SHARED_TILE];

vec4 load(ivec3 pixel)
{
    if (push.first == 0u)
        return all(lessThan(pixel.xy, imageSize(level_in).xy)) ? imageLoad(level_in, pixel) : vec4(0.0);
    if (pixel.x >= int(frame.width) || pixel.y >= int(frame.height) || imageLoad(position, pixel).w == 0.0)
        return vec4(0.0);
    return vec4(imageLoad(colour, pixel).rgb, 1.0);
}

vec4 reduce(vec4 p[4])
{
    vec3 sum = vec3(0.0);
    float count = 0.0, low = 1.0, high = 0.0;
    for (int i = 0; i < 4; i++) {
        if (p[i].a > 0.0) {
            float l = colour_luminance(p[i].rgb);
            sum += p[i].rgb;
            count += 1.0;
            low = min(low, l);
            high = max(high, l);
        }
    }
    return count > 0.0 ? vec4(sum / count, 1.0 - 0.5 * max(high - low, 0.0)) : vec4(0.0);
}

void main()
{
    ivec2 lane = ivec2(gl_LocalInvocationID.xy);
    tile[lane.y][lane.x] = load(ivec3(gl_GlobalInvocationID));
    for (uint level = 1; level <= push.levels; level++) {
        int size = SHARED_TILE >> level;
        barrier();
        vec4 reduced = vec4(0.0);
        bool active_lane = lane.x < size && lane.y < size;
        if (active_lane) {
            ivec2 at = 2 * lane;
            reduced = reduce(vec4[4](tile[at.y][at.x], tile[at.y][at.x + 1], tile[at.y + 1][at.x], tile[at.y + 1][at.x + 1]));
        }
        barrier();
        if (active_lane) {
            tile[lane.y][lane.x] = reduced;
            ivec3 out_pixel = ivec3(ivec2(gl_WorkGroupID.xy) * size + lane, gl_WorkGroupID.z);
            if (level == 1)
                imageStore(level_1, out_pixel, reduced);
            else if (level == 2)
                imageStore(level_2, out_pixel, reduced);
            else
                imageStore(level_3, out_pixel, reduced);
        }
    }
}
