// What the forward shaders read (forward.c); set 0 begins as gbuffer.vert's does.

// after the scene's own constants (features.glsl)
layout(constant_id = 9) const bool has_occlusion_image = false;
layout(constant_id = 10) const bool has_shadow = false;

layout(scalar, set = 0, binding = 0) uniform Frame { shared_frame frame; };
#include "renderer/shared/eye.glsl"
layout(scalar, set = 0, binding = 4) readonly buffer Lights { shared_light lights[]; };
layout(scalar, set = 0, binding = 5) buffer Counters { shared_counters counters; };
layout(set = 0, binding = 6) uniform sampler2DArray occlusion_image;
layout(set = 0, binding = 7) uniform sampler2DArray occlusion_distance;
layout(set = 0, binding = 8) uniform sampler2DArrayShadow shadow_map;
layout(push_constant) uniform Push { uint eye; } push;

layout(early_fragment_tests) in; // or counting would shade what is hidden

layout(location = 0) out vec4 out_hdr;

// Through the middle of the fragment, however many pixels it covers.
vec3 fragment_direction()
{
    vec2 size = vec2(frame.width, frame.height);
    return mat3(EYE(push.eye, world_from_eye)) *
           view_ray(EYE(push.eye, tangents), size, gl_FragCoord.xy - frame.jitter);
}

void write_radiance(vec3 radiance)
{
    atomicAdd(counters.shaded_px, 1u); // without effect in helper invocations
    out_hdr = vec4(min(radiance, vec3(65504.0)), 1.0); // the largest half float
}
