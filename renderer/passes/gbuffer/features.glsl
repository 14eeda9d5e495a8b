// The material's features, bit by bit (scene_gpu.h): what is not used costs nothing.
layout(constant_id = 0) const bool has_base = false;
layout(constant_id = 1) const bool has_metallic_roughness = false;
layout(constant_id = 2) const bool has_normal = false;
layout(constant_id = 3) const bool has_occlusion = false;
layout(constant_id = 4) const bool has_emissive = false;
layout(constant_id = 5) const bool alpha_mask = false;
layout(constant_id = 6) const bool glows = false;
layout(constant_id = 7) const bool plain_uv = false;
layout(constant_id = 8) const bool sky_in_alpha = false;
