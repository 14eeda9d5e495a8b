// The light of one pixel of the G-buffer per work item. Needs shared.h, view.glsl and bindings.glsl.
#include "renderer/shared/colour.glsl"
#include "renderer/shared/normal.glsl"
#include "renderer/shared/sun_shadow.glsl"
#include "renderer/passes/shade/light_list.glsl"
#include "renderer/passes/shade/lighting.glsl"
#include "renderer/passes/shade/occlusion.glsl"

// Every work item of a group calls it, `wanted` or not; `corner` is the upper left pixel of the tile that holds all
// wanted pixels of the group.
vec3 shade_pixel(ivec3 pixel, bool wanted, uvec2 corner)
{
    vec3 ray = view_ray(frame_eye(uint(pixel.z)), vec2(frame.width, frame.height), vec2(pixel.xy) + 0.5 - frame.jitter);
    mat4 world_from_eye = frame_eye(uint(pixel.z)).world_from_eye;
    vec3 direction = mat3(world_from_eye) * ray;
    float depth = wanted ? texelFetch(depth_image, pixel, 0).x : 0.0;
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
    } else if (wanted) {
        radiance = sky(normalize(direction));
    }
    if (every_light) {
        for (uint i = 0u; lit && i < frame.light_count; i++)
            radiance += point_light(s, position, lights[i]);
    } else if (frame.light_count != 0u) {
        measure_tile(lit, distance);
        for (uint first = 0u; first < frame.light_count && farthest_bits != 0u; first += light_chunk) {
            list_lights(first, uint(pixel.z), corner);
            uint left = min(light_chunk, frame.light_count - first);
            for (uint word = 0u; lit && 32u * word < left; word++) {
                for (uint bits = light_mask[word]; bits != 0u; bits &= bits - 1u)
                    radiance += point_light(s, position, lights[first + 32u * word + uint(findLSB(bits))]);
            }
        }
    }
    if (has_emissive && lit)
        radiance += texelFetch(emissive_image, pixel, 0).rgb;
    return min(radiance, vec3(65504.0)); // the largest half float
}
