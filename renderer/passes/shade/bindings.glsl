// What the shading kernels read and write (shade.c). What a scene does not have is specialised away; its binding then
// holds another image of the same kind.

layout(constant_id = 0) const bool has_emissive = false;
layout(constant_id = 1) const bool has_occlusion = false;
layout(constant_id = 2) const bool every_light = false; // no light lists: what they must equal
layout(constant_id = 3) const bool has_shadow = false;
layout(constant_id = 4) const uint light_words = 1u; // a tile's in `light_masks`

layout(scalar, binding = 0) uniform Frame { shared_frame frame; };
#include "renderer/shared/eye.glsl"
layout(scalar, binding = 1) readonly buffer Lights { shared_light lights[]; };
layout(binding = 2) uniform sampler2DArray base_image;
layout(binding = 3) uniform usampler2DArray normal_image;
layout(binding = 4) uniform sampler2DArray surface_image;
layout(binding = 5) uniform sampler2DArray depth_image;
layout(binding = 6, rgba16f) uniform writeonly image2DArray hdr;
layout(binding = 7) uniform sampler2DArray emissive_image;
layout(binding = 8) uniform sampler2DArray occlusion_image;
layout(binding = 9) uniform sampler2DArray occlusion_distance;
layout(binding = 10) uniform sampler2DArrayShadow shadow_map;
layout(scalar, binding = 14) buffer LightMasks { uint light_masks[]; }; // a bit a light, `light_words` a tile

// The first word of a pixel's tile in `light_masks`.
uint light_mask_of(uvec3 pixel)
{
    uvec2 tiles = (uvec2(frame.width, frame.height) + SHARED_TILE - 1) / SHARED_TILE, tile = pixel.xy / SHARED_TILE;
    return ((pixel.z * tiles.y + tile.y) * tiles.x + tile.x) * light_words;
}
