#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/view.glsl"
#include "renderer/modes/vrs/bindings.glsl"
#include "renderer/passes/shade/lighting.glsl"

void main()
{
    write_radiance(sky(normalize(fragment_direction())));
}
