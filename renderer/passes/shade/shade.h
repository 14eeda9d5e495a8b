// Lights the G-buffer in compute: GGX with sun, sky and point lights, linear HDR out (cd/m^2, rgba16f).
//
// BRDF after Karis, "Real Shading in Unreal Engine 4", SIGGRAPH 2013 course notes; details in lighting.glsl.
// Local lights by tile (light_masks.comp); with a redraw map only its pixels, from all tiles or from a list of
// them; with blocks only their leaders (choose.comp), whose colour is that of the pixels they lead.
#ifndef RENDERER_PASSES_SHADE_SHADE_H
#define RENDERER_PASSES_SHADE_SHADE_H

#include "renderer/gpu/gpu.h"

struct shade {
    struct gpu *gpu;
    uint32_t width, height;
    uint32_t light_words; // of a tile's mask
    struct gpu_binding bindings[GPU_BINDINGS];
    struct gpu_kernel masks, choose, kernel;
    VkDescriptorSet set;
    bool blocks, redraw;
    float inner_deg, outer_deg;
    const struct gpu_buffer *tiles;
    VkSampler sampler, compare;
    struct gpu_buffer light_masks;
    struct gpu_buffer chosen;  // with blocks: the pixels to shade, coded like tiles (tiles.glsl)
    struct gpu_buffer leaders; // with blocks: whose colour a pixel has (renderer/shared/leaders.glsl)
    struct gpu_image hdr;      // two layers, layout GENERAL while in use; with blocks the leaders' pixels only
};

// One pixel of each 2x2 block beyond inner_deg from the gaze, of each 4x4 block beyond outer_deg; where the
// gaze is not valid, every pixel (choose.comp).
struct shade_blocks {
    const struct gpu_buffer *counters; // shared_counters: shaded_px is added to
    float inner_deg, outer_deg;        // inner_deg <= outer_deg
};

struct shade_desc {
    struct gpu *gpu;
    const struct gpu_buffer *frame, *lights;
    uint32_t width, height;
    // the G-buffer's targets, layouts as gbuffer_record leaves them
    VkImageView base, normal, surface, depth;
    VkImageView emissive; // null: nothing glows
    // Ambient occlusion of half size, rounded up, two layers, sampled, GENERAL: 1 is open. Null: none. Its
    // distances along the view axis are r32f, 0 for background.
    VkImageView ao, ao_depth;
    VkImageView shadow_map;            // of the sun (sun_shadow.glsl), DEPTH_READ_ONLY_OPTIMAL; null: none
    VkImageView redraw_map;            // r8 uint, GENERAL; null: every pixel is shaded
    const struct gpu_buffer *tiles;    // of the redraw map (tiles.glsl); NULL: shade_record_tiles is not used
    const struct shade_blocks *blocks; // not with a redraw map; NULL: every pixel by itself
    bool every_light;                  // no light lists: what they must equal, for tests
};

bool shade_init(struct shade *shade, const struct shade_desc *desc);
void shade_finish(struct shade *shade);
uint64_t shade_memory(const struct shade *shade);
// The whole screen, or of it the redraw map's pixels.
void shade_record(const struct shade *shade, VkCommandBuffer cmd);
// The same pixels from the list of tiles, which must be visible to DRAW_INDIRECT and COMPUTE_SHADER.
void shade_record_tiles(const struct shade *shade, VkCommandBuffer cmd);

#endif
