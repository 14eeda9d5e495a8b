#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/view.glsl"
#include "renderer/shared/colour.glsl"
#include "renderer/modes/vrs/bindings.glsl"
#include "renderer/passes/gbuffer/material.glsl"
#include "renderer/passes/shade/lighting.glsl"
#include "renderer/passes/shade/occlusion.glsl"
#include "renderer/shared/sun_shadow.glsl"

// The light of shade.comp without its lists of lights. Alpha is not tested: the depths were, pixel by pixel.

void main()
{
    vec3 direction = fragment_direction();
    float distance = frame.near_m / gl_FragCoord.z;
    vec3 position = EYE(push.eye, world_from_eye)[3].xyz + direction * distance;
    shared_material m = materials[in_ids.x];
    surface_point s = surface_of(material_base(m).rgb, material_surface(m), material_normal(m), -normalize(direction));
    float occlusion = material_occlusion(m);
    if (has_occlusion_image)
        occlusion *= occlusion_at(occlusion_image, occlusion_distance, ivec3(gl_FragCoord.xy, push.eye), distance);
    vec3 sun = sun_light(s);
    if (has_shadow && sun != vec3(0.0))
        sun *= sun_share(shadow_map, position, s.normal);
    vec3 radiance = ambient(s, occlusion) + sun;
    for (uint i = 0u; i < frame.light_count; i++)
        radiance += point_light(s, position, lights[i]);
    write_radiance(radiance + material_emissive(m));
}
