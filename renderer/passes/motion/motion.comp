#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/view.glsl"

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

layout(scalar, binding = 0) uniform Frame { shared_frame frame; };
#include "renderer/shared/eye.glsl"
layout(scalar, binding = 1) readonly buffer Motions { mat4 motions[]; };
layout(binding = 2) uniform sampler2DArray depth_image;
#ifdef ID
layout(binding = 3) uniform usampler2DArray id_image;
#endif
layout(binding = 4, rgba32f) uniform writeonly image2DArray motion;
layout(scalar, binding = 5) buffer Counters { shared_counters counters; };
layout(push_constant) uniform Push { uint motion_count; } push;

#include "renderer/shared/last.glsl"

void main()
{
    ivec3 pixel = ivec3(gl_GlobalInvocationID);
    if (pixel.x >= int(frame.width) || pixel.y >= int(frame.height))
        return;
    uint eye = uint(pixel.z);
    mat4 world_from_eye = EYE(eye, world_from_eye);
    vec2 place = vec2(pixel.xy) + 0.5 - frame.jitter;
    vec3 direction = mat3(world_from_eye) * view_ray(EYE(eye, tangents), vec2(frame.width, frame.height), place);
    float depth = texelFetch(depth_image, pixel, 0).x, distance = depth > 0.0 ? frame.near_m / depth : 0.0;
    vec4 position = vec4(direction, -1.0);
    if (depth > 0.0) {
        position = vec4(world_from_eye[3].xyz + direction * distance, 1.0);
#ifdef ID
        position.w += float(texelFetch(id_image, pixel, 0).x);
        if (position.w >= 2.0 && frame.moving != 0u)
            atomicAdd(counters.moving_px, 1u);
#endif
    }
    vec3 last = last_pixel(eye, position);
    imageStore(motion, pixel, vec4(last.xy + frame.jitter, last.z, distance));
}
