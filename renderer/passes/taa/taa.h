// Temporal antialiasing, and the motion smoothing of reprojected pixels on the same path.
//
// Karis, "High-Quality Temporal Supersampling", SIGGRAPH 2014 course notes: the projection is jittered from
// frame to frame, and each pixel mixes a tenth of the new frame into its reprojected history, which is clamped
// to the colours of its 3x3 neighbourhood in YCoCg. Franke et al. 2021, section 6.2, uses it on redrawn pixels
// and, with another place in the history, on reprojected ones. Colours are tone-mapped and encoded.
//
// The history lives here and never goes into the reprojection, whose pictures it would blur.
#ifndef RENDERER_PASSES_TAA_TAA_H
#define RENDERER_PASSES_TAA_TAA_H

#include "renderer/gpu/gpu.h"

struct taa {
    struct gpu *gpu;
    uint32_t width, height, motion_count;
    struct gpu_kernel kernel;
    struct gpu_image filtered[2]; // rgba16f: what was shown, in full precision
    struct gpu_image shown;       // rgba8
    VkSampler linear, plain;
    VkDescriptorSet sets[2][2]; // by the colour that is read and the history that is written
    uint32_t last;              // the history written last
    bool in_use;
};

struct taa_desc {
    struct gpu *gpu;
    const struct gpu_buffer *frame;
    const struct gpu_buffer *motions; // both ways (scene_gpu.h)
    uint32_t motion_count;
    uint32_t width, height;
    VkImageView colour[2];               // rgba8, tone-mapped; the second may be null
    VkImageView position[2], redraw_map; // of a mode with a redraw map, with its colours; else null, and:
    VkImageView depth, id;               // of the G-buffer; id null: nothing moves
};

bool taa_init(struct taa *taa, const struct taa_desc *desc);
void taa_finish(struct taa *taa);
uint64_t taa_memory(const struct taa *taa);
// Reads colour `source`. history false: the new frame alone.
void taa_record(struct taa *taa, VkCommandBuffer cmd, uint32_t source, bool history);

#endif
