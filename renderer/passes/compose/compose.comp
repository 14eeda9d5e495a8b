#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/tiles.glsl"
#include "renderer/shared/view.glsl"

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

layout(scalar, binding = 0) uniform Frame { shared_frame frame; };
#include "renderer/shared/eye.glsl"
layout(binding = 1) uniform sampler2DArray depth_image;
layout(binding = 2, r8ui) uniform readonly uimage2DArray redraw_map;
layout(binding = 3, rgba32f) uniform writeonly image2DArray position_image;
#ifdef ID
layout(binding = 4) uniform usampler2DArray id_image;
#endif
layout(scalar, binding = 5) readonly buffer Tiles { uint tiles[]; };

void main()
{
    uint index = TILE_INDEX;
    if (index >= tiles[SHARED_TILES_FIRST - 1])
        return;
    ivec3 pixel = tile_pixel(tiles[SHARED_TILES_FIRST + index], gl_LocalInvocationID.xy);
    if (pixel.x >= int(frame.width) || pixel.y >= int(frame.height) || imageLoad(redraw_map, pixel).x == 0u)
        return;
    vec3 ray = view_ray(EYE(uint(pixel.z), tangents), vec2(frame.width, frame.height), vec2(pixel.xy) + 0.5 - frame.jitter);
    mat4 world_from_eye = EYE(uint(pixel.z), world_from_eye);
    vec3 direction = mat3(world_from_eye) * ray;
    float depth = texelFetch(depth_image, pixel, 0).x;
    vec4 position = vec4(normalize(direction), -1.0);
    if (depth > 0.0) {
        position = vec4(world_from_eye[3].xyz + direction * (frame.near_m / depth), 1.0);
#ifdef ID
        if (frame.moving != 0u)
            position.w += float(texelFetch(id_image, pixel, 0).x);
#endif
    }
    imageStore(position_image, pixel, position);
}
