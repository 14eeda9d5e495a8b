// The light of one pixel of the G-buffer. Needs shared.h, view.glsl and bindings.glsl.
#include "renderer/shared/colour.glsl"
#include "renderer/shared/normal.glsl"
#include "renderer/shared/sun_shadow.glsl"
#include "renderer/passes/shade/lighting.glsl"
#include "renderer/passes/shade/occlusion.glsl"

vec3 shade_pixel(ivec3 pixel)
{
    vec3 ray = view_ray(EYE(uint(pixel.z), tangents), vec2(frame.width, frame.height), vec2(pixel.xy) + 0.5 - frame.jitter);
    mat4 world_from_eye = EYE(uint(pixel.z), world_from_eye);
    vec3 direction = mat3(world_from_eye) * ray;
    float depth = texelFetch(depth_image, pixel, 0).x;
    float distance = frame.near_m / depth;
    vec3 position = world_from_eye[3].xyz + direction * distance;
    bool lit = depth != 0.0;
    vec3 radiance = vec3(0.0);
    surface_point s;
    if (lit) {
        vec4 base = texelFetch(base_image, pixel, 0);
        s = surface_of(base.rgb, texelFetch(surface_image, pixel, 0).xy,
                       normal_decode(unpackSnorm2x16(texelFetch(normal_image, pixel, 0).x)), -normalize(direction));
        float occlusion = base.a;
        if (has_occlusion)
            occlusion *= occlusion_at(occlusion_image, occlusion_distance, pixel, distance);
        vec3 sun = sun_light(s);
        if (has_shadow && sun != vec3(0.0))
            sun *= sun_share(shadow_map, position, s.normal);
        radiance = ambient(s, occlusion) + sun;
    } else {
        radiance = sky(normalize(direction));
    }
    if (every_light) {
        for (uint i = 0u; lit && i < frame.light_count; i++)
            radiance += point_light(s, position, lights[i]);
    } else {
        uint first = light_mask_of(uvec3(pixel));
        for (uint word = 0u; lit && 32u * word < frame.light_count; word++) {
            for (uint bits = light_masks[first + word]; bits != 0u; bits &= bits - 1u)
                radiance += point_light(s, position, lights[32u * word + uint(findLSB(bits))]);
        }
    }
    if (has_emissive && lit)
        radiance += texelFetch(emissive_image, pixel, 0).rgb;
    return min(radiance, vec3(65504.0)); // the largest half float
}
