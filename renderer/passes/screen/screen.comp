#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/colour.glsl"

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

layout(binding = 0, rgba8) uniform writeonly image2D screen;
layout(binding = 1) uniform sampler2D overlay;
layout(scalar, binding = 2) readonly buffer Marks { shared_mark marks[]; };
#ifdef COLOUR
layout(binding = 3, rgba8) uniform readonly image2DArray colour;
#endif
layout(scalar, push_constant) uniform Push {
    uint width, height;
    ivec2 left, top;
    uvec2 overlay; // pixels; 0: none
    float fade;
    uint mark_count;
} push;
#include "renderer/passes/screen/marks.glsl"

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    int eye = int(gl_GlobalInvocationID.z);
    if (pixel.x >= int(push.width) || pixel.y >= int(push.height))
        return;
    vec3 encoded = vec3(0.5); // mid gray, sRGB
#ifdef COLOUR
    if (push.fade < 1.0) {
        encoded = imageLoad(colour, ivec3(pixel, eye)).rgb;
        if (push.fade > 0.0)
            encoded = colour_encode(mix(colour_decode(encoded), colour_decode(vec3(0.5)), push.fade));
    }
#endif
    for (uint i = 0u; i < push.mark_count; i++)
        encoded = mark_over(encoded, i, eye, vec2(pixel) + 0.5);
    ivec2 at = pixel - ivec2(push.left[eye], push.top[eye]);
    if (all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(push.overlay)))) {
        vec4 over = texelFetch(overlay, at, 0);
        encoded = mix(encoded, over.rgb, over.a);
    }
    imageStore(screen, pixel + ivec2(eye * int(push.width), 0), vec4(encoded, 1.0));
}
