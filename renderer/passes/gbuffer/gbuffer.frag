#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/normal.glsl"

// EMISSIVE and ID: the scene has those targets; DEPTH: and no other

#include "renderer/passes/gbuffer/material.glsl"

#ifndef DEPTH
layout(location = 0) out vec4 out_base;
layout(location = 1) out uint out_normal;
layout(location = 2) out vec4 out_surface;
#endif
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
    vec4 base = material_base(m);
    if (alpha_mask && base.a < m.alpha_cutoff)
        discard;
#ifndef DEPTH
    vec3 normal = material_normal(m);
    out_base = vec4(base.rgb, material_occlusion(m));
    out_normal = packSnorm2x16(normal_encode(normal));
    out_surface = vec4(material_surface(m), 0.0, 0.0);
#endif
#ifdef EMISSIVE
    out_emissive = vec4(material_emissive(m), 0.0);
#endif
#ifdef ID
    out_id = in_ids.y;
#endif
}
