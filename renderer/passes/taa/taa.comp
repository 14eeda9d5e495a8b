#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/view.glsl"

// REDRAW: pixels and positions of a mode with a redraw map; else the G-buffer's depth, and with ID its moving ids

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

layout(scalar, binding = 0) uniform Frame { shared_frame frame; };
#include "renderer/shared/eye.glsl"
layout(scalar, binding = 1) readonly buffer Motions { mat4 motions[]; };
layout(binding = 2, rgba8) uniform readonly image2DArray colour;
layout(binding = 3) uniform sampler2DArray history;
layout(binding = 4, rgba16f) uniform writeonly image2DArray filtered;
layout(binding = 5, rgba8) uniform writeonly image2DArray shown;
#ifdef REDRAW
layout(binding = 6, rgba32f) uniform readonly image2DArray position_image;
layout(binding = 7, r8ui) uniform readonly uimage2DArray redraw_map;
#else
layout(binding = 8) uniform sampler2DArray depth_image;
#ifdef ID
layout(binding = 9) uniform usampler2DArray id_image;
#endif
#endif
layout(push_constant) uniform Push { uint motion_count; uint has_history; } push;

#include "renderer/shared/kept.glsl"
#include "renderer/shared/last.glsl"

const float blend = 0.1; // of the new frame: Franke et al. 2021, section 6.2

vec3 ycocg(vec3 c)
{
    return vec3(0.25 * (c.r + 2.0 * c.g + c.b), 0.5 * (c.r - c.b), 0.25 * (2.0 * c.g - c.r - c.b));
}

vec3 rgb(vec3 c)
{
    return vec3(c.x + c.y - c.z, c.x + c.z, c.x - c.y - c.z);
}

// The point at a place of the image (pixels) and a reversed depth; as in passes/reproject.
vec4 point_at(uint eye, vec2 place, float depth, float w)
{
    mat4 world_from_eye = frame_eye(eye).world_from_eye;
    vec3 direction = mat3(world_from_eye) * view_ray(frame_eye(eye), vec2(frame.width, frame.height), place);
    return depth > 0.0 ? vec4(world_from_eye[3].xyz + direction * (frame.near_m / depth), w) : vec4(direction, -1.0);
}

// Where in the last frame's picture this pixel's history lies.
vec2 history_place(ivec3 pixel)
{
    uint eye = uint(pixel.z);
    vec2 centre = vec2(pixel.xy) + 0.5, offset = frame.jitter;
    vec4 position;
#ifdef REDRAW
    position = imageLoad(position_image, pixel);
    if (imageLoad(redraw_map, pixel).x == 0u) {
        // Motion smoothing, section 6.2: not the exact position, but the pixel's centre at its depth. A point that is
        // about to change its pixel is off that centre, and so it meets a history between two pixels.
        position = point_at(eye, centre, kept_depth(frame_eye(eye), position, frame.near_m), max(position.w, 1.0));
        offset = vec2(0.0);
    }
#else
    float w = 1.0;
#ifdef ID
    w += float(texelFetch(id_image, pixel, 0).x);
#endif
    position = point_at(eye, centre - offset, texelFetch(depth_image, pixel, 0).x, w);
#endif
    return last_pixel(eye, position).xy + offset;
}

void main()
{
    ivec3 pixel = ivec3(gl_GlobalInvocationID);
    ivec2 size = ivec2(frame.width, frame.height);
    if (pixel.x >= size.x || pixel.y >= size.y)
        return;
    vec3 now = imageLoad(colour, pixel).rgb, result = now;
    vec2 place = push.has_history != 0u ? history_place(pixel) : vec2(-1.0);
    if (all(greaterThanEqual(place, vec2(0.0))) && all(lessThanEqual(place, vec2(size)))) {
        vec3 low = ycocg(now), high = low;
        for (int y = -1; y <= 1; y++) {
            for (int x = -1; x <= 1; x++) {
                ivec2 at = clamp(pixel.xy + ivec2(x, y), ivec2(0), size - 1);
                vec3 c = ycocg(imageLoad(colour, ivec3(at, pixel.z)).rgb);
                low = min(low, c);
                high = max(high, c);
            }
        }
        vec3 before = textureLod(history, vec3(place / vec2(size), pixel.z), 0.0).rgb;
        result = mix(rgb(clamp(ycocg(before), low, high)), now, blend);
    }
    imageStore(filtered, pixel, vec4(result, 1.0));
    imageStore(shown, pixel, vec4(result, 1.0));
}
