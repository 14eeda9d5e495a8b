// A fragment's material, for the fragment shaders under gbuffer.vert. Needs shared.h.
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

vec4 material_base(shared_material m)
{
    vec4 base = m.base_colour * vec4(in_colour.rgb, sky_in_alpha ? 1.0 : in_colour.a);
    return has_base ? base * texture(base_texture, in_uv[plain_uv ? 0 : 0]) : base;
}

vec3 material_normal(shared_material m)
{
    vec3 normal = normalize(in_normal);
    if (has_normal) {
        vec3 t = texture(normal_texture, in_uv[plain_uv ? 0 : 2]).xyz * 2.0 - 1.0;
        t.xy *= m.normal_scale;
        vec3 tangent = normalize(in_tangent.xyz - normal * dot(normal, in_tangent.xyz));
        vec3 bitangent = cross(normal, tangent) * in_tangent.w;
        normal = normalize(tangent * t.x + bitangent * t.y + normal * t.z);
    }
    return gl_FrontFacing ? normal : -normal;
}

// Roughness, metallic.
vec2 material_surface(shared_material m)
{
    vec2 surface = vec2(m.roughness, m.metallic);
    if (has_metallic_roughness)
        surface *= texture(metallic_roughness_texture, in_uv[plain_uv ? 0 : 1]).gb;
    return surface;
}

float material_occlusion(shared_material m)
{
    float occlusion = sky_in_alpha ? in_colour.a : 1.0;
    if (has_occlusion)
        occlusion *= mix(1.0, texture(occlusion_texture, in_uv[plain_uv ? 0 : 3]).r, m.occlusion_strength);
    return occlusion;
}

vec3 material_emissive(shared_material m)
{
    if (!glows)
        return vec3(0.0);
    return has_emissive ? m.emissive * texture(emissive_texture, in_uv[plain_uv ? 0 : 4]).rgb : m.emissive;
}
