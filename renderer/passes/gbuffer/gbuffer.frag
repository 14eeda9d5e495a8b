#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/normal.glsl"

// EMISSIVE and ID: the scene has those targets

#include "renderer/passes/gbuffer/features.glsl"

layout(scalar, set = 0, binding = 3) readonly buffer Materials { shared_material materials[]; };
layout(set = 1, binding = 0) uniform sampler2D base_texture;
layout(set = 1, binding = 1) uniform sampler2D metallic_roughness_texture;
layout(set = 1, binding = 2) uniform sampler2D normal_texture;
layout(set = 1, binding = 3) uniform sampler2D occlusion_texture;
layout(set = 1, binding = 4) uniform sampler2D emissive_texture;

layout(location = 0) in vec3 in_normal;
layout(location = 1) in vec4 in_tangent;
layout(location = 2) in vec4 in_colour;
layout(location = 3) flat in uvec2 in_ids;
layout(location = 4) in vec2 in_uv[5];

layout(location = 0) out vec4 out_base;
layout(location = 1) out uint out_normal;
layout(location = 2) out vec4 out_surface;
#ifdef EMISSIVE
layout(location = 3) out vec4 out_emissive;
#endif
#ifdef ID
#ifdef EMISSIVE
layout(location = 4) out uint out_id;
#else
layout(location = 3) out uint out_id; // no gap: an attachment that nothing writes is undefined
#endif
#endif

void main()
{
    shared_material m = materials[in_ids.x];
    vec4 base = m.base_colour * vec4(in_colour.rgb, sky_in_alpha ? 1.0 : in_colour.a);
    if (has_base)
        base *= texture(base_texture, in_uv[plain_uv ? 0 : 0]);
    if (alpha_mask && base.a < m.alpha_cutoff)
        discard;

    vec3 normal = normalize(in_normal);
    if (has_normal) {
        vec3 t = texture(normal_texture, in_uv[plain_uv ? 0 : 2]).xyz * 2.0 - 1.0;
        t.xy *= m.normal_scale;
        vec3 tangent = normalize(in_tangent.xyz - normal * dot(normal, in_tangent.xyz));
        vec3 bitangent = cross(normal, tangent) * in_tangent.w;
        normal = normalize(tangent * t.x + bitangent * t.y + normal * t.z);
    }
    if (!gl_FrontFacing)
        normal = -normal;

    vec2 surface = vec2(m.roughness, m.metallic);
    if (has_metallic_roughness)
        surface *= texture(metallic_roughness_texture, in_uv[plain_uv ? 0 : 1]).gb;
    float occlusion = sky_in_alpha ? in_colour.a : 1.0;
    if (has_occlusion)
        occlusion *= mix(1.0, texture(occlusion_texture, in_uv[plain_uv ? 0 : 3]).r, m.occlusion_strength);
    out_base = vec4(base.rgb, occlusion);
    out_normal = packSnorm2x16(normal_encode(normal));
    out_surface = vec4(surface, 0.0, 0.0);
#ifdef EMISSIVE
    vec3 emissive = vec3(0.0);
    if (glows) {
        emissive = m.emissive;
        if (has_emissive)
            emissive *= texture(emissive_texture, in_uv[plain_uv ? 0 : 4]).rgb;
    }
    out_emissive = vec4(emissive, 0.0);
#endif
#ifdef ID
    out_id = in_ids.y;
#endif
}
