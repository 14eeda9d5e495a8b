// What the shading kernels read and write (shade.c). What a scene does not have is specialised away; its binding then
// holds another image of the same kind.

layout(constant_id = 0) const bool has_emissive = false;
layout(constant_id = 1) const bool has_occlusion = false;
layout(constant_id = 2) const bool every_light = false; // no light lists: what they must equal
layout(constant_id = 3) const bool has_shadow = false;

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
