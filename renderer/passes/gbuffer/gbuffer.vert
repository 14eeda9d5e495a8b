#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#ifdef MULTIVIEW
#extension GL_EXT_multiview : require
#endif
#ifdef INSTANCED
#extension GL_ARB_shader_viewport_layer_array : require
#endif
#include "renderer/shared/shared.h"
#include "renderer/shared/normal.glsl"
#include "renderer/passes/gbuffer/features.glsl"

layout(scalar, set = 0, binding = 0) uniform Frame { shared_frame frame; };
layout(scalar, set = 0, binding = 1) readonly buffer Items { shared_item items[]; };
layout(scalar, set = 0, binding = 2) readonly buffer Objects { shared_object objects[]; };
layout(scalar, set = 0, binding = 3) readonly buffer Materials { shared_material materials[]; };

// Every draw goes to one eye, or to both: as its views (MULTIVIEW), or as its two instances (INSTANCED).
#if defined MULTIVIEW
#define DRAWN_EYE gl_ViewIndex
#elif defined INSTANCED
#define DRAWN_EYE (gl_InstanceIndex - gl_BaseInstance)
#else
layout(push_constant) uniform Push { uint eye; } push;
#define DRAWN_EYE push.eye
#endif

layout(location = 0) in vec3 in_position;
layout(location = 1) in vec2 in_normal;
layout(location = 2) in vec4 in_tangent;
layout(location = 3) in vec2 in_uv0;
layout(location = 4) in vec2 in_uv1;
layout(location = 5) in vec4 in_colour;

layout(location = 0) out vec3 out_normal;
layout(location = 1) out vec4 out_tangent;
layout(location = 2) out vec4 out_colour;
layout(location = 3) flat out uvec2 out_ids; // material, moving id
layout(location = 4) out vec2 out_uv[5];     // one per texture slot

// Here and not in the fragment shader: the software driver gives lanes outside a triangle no buffer data, and
// without it the texture level at every triangle's edge is wrong.
vec2 uv_of(shared_material m, uint slot)
{
    vec3 uv = vec3((m.uv_sets >> slot & 1u) != 0u ? in_uv1 : in_uv0, 1.0);
    uint t = 6u * slot;
    return vec2(dot(uv, vec3(m.transforms[t], m.transforms[t + 1], m.transforms[t + 2])),
                dot(uv, vec3(m.transforms[t + 3], m.transforms[t + 4], m.transforms[t + 5])));
}

void main()
{
#ifdef INSTANCED
    gl_Layer = DRAWN_EYE;
#endif
    shared_item item = items[gl_BaseInstance];
    mat4 m = objects[item.object].world_from_mesh;
    // the same to the last bit in every pipeline, so that a later pass over the same depths draws the same pixels
    precise vec4 position = frame.eyes[DRAWN_EYE].clip_from_world * vec4((m * vec4(in_position, 1.0)).xyz, 1.0);
    gl_Position = position;
    // normals go with the cofactor matrix, right for mirrored and unevenly scaled objects alike
    mat3 linear = mat3(m);
    mat3 cofactor = mat3(cross(linear[1], linear[2]), cross(linear[2], linear[0]), cross(linear[0], linear[1]));
    float winding = dot(linear[0], cofactor[0]) < 0.0 ? -1.0 : 1.0;
    out_normal = winding * (cofactor * normal_decode(in_normal));
    if (has_normal)
        out_tangent = vec4(linear * in_tangent.xyz, winding * (in_tangent.w < 0.0 ? -1.0 : 1.0));
    if (plain_uv) {
        out_uv[0] = in_uv0;
    } else {
        const bool used[5] = bool[5](has_base, has_metallic_roughness, has_normal, has_occlusion, has_emissive);
        for (uint slot = 0; slot < 5; slot++) {
            if (used[slot])
                out_uv[slot] = uv_of(materials[item.material], slot);
        }
    }
    out_colour = in_colour;
    out_ids = uvec2(item.material, objects[item.object].moving_id);
}
