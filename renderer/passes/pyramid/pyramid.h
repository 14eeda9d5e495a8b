// Hole filling and confidence: Franke et al. 2021, sections 5.1 and 5.2.
//
// Pull: a mip pyramid of the valid reprojected colours, whose alpha is the contrast confidence of the four
// inputs (0: none valid), and of their farthest depths. Fill: a hole takes the finest level that has a value
// there; the confidence of every pixel decides whether it is redrawn. A kept hole's position becomes (depth, 0,
// 0, 0), reversed depth, 0 for the background.
#ifndef RENDERER_PASSES_PYRAMID_PYRAMID_H
#define RENDERER_PASSES_PYRAMID_PYRAMID_H

#include "renderer/gpu/gpu.h"

enum { PYRAMID_LEVELS = 15 };

struct pyramid_confidence {
    float epsilon;
    float fovea_deg, periphery_deg; // phi_F, phi_0
    float hole_decay;               // A
    float dynamic_decay;            // D
    uint32_t levels;                // set by pyramid_init and pyramid_set
    uint32_t turn;                  // set by pyramid_fill
    float trusted_cosine;           // set by pyramid_fill
    uint32_t listed;                // set by pyramid_fill
};

struct pyramid {
    struct gpu *gpu;
    uint32_t width, height;
    struct pyramid_confidence confidence;
    uint32_t made_levels; // of the images: those of the confidence, or all that pyramid_set may need
    bool moving;
    struct gpu_image image; // level m of the pyramid is its mip m - 1
    struct gpu_image depth; // its farthest depths, reversed; 0: the background, or nothing
    VkImageView level_views[PYRAMID_LEVELS], depth_views[PYRAMID_LEVELS];
    VkSampler sampler;
    struct gpu_kernel pull_first, pull, decide[2], fill; // decide[1]: objects move
    const struct gpu_buffer *holes;
    VkDescriptorSet pull_sets[2][PYRAMID_LEVELS]; // by target, then by level
    VkDescriptorSet decide_sets[2], fill_sets[2];
};

struct pyramid_desc {
    struct gpu *gpu;
    const struct gpu_buffer *frame;
    uint32_t width, height;
    VkImageView colour[2], position[2]; // rgba8, rgba32f
    VkImageView redraw_map;             // r8 uint, written
    bool moving;                        // objects move: what the map already holds is redrawn too
    // Made for pyramid_set: with levels for any confidence, with kernels for both kinds of `moving`.
    bool all_levels, may_move;
    const struct gpu_buffer *holes; // a list of pixels (tiles.glsl); NULL: all are looked at
    struct pyramid_confidence confidence;
};

bool pyramid_init(struct pyramid *pyramid, const struct pyramid_desc *desc);
// Other numbers from the next frame on; of a pyramid made for it.
void pyramid_set(struct pyramid *pyramid, const struct pyramid_confidence *confidence, bool moving);
void pyramid_finish(struct pyramid *pyramid);
uint64_t pyramid_memory(const struct pyramid *pyramid);
// The deepest level that can matter: beyond it A^m < epsilon, and the hole is redrawn whatever its colour.
uint32_t pyramid_levels(uint32_t width, uint32_t height, float epsilon, float hole_decay);
void pyramid_pull(const struct pyramid *pyramid, VkCommandBuffer cmd, uint32_t target);
// Fills holes of colour `target` and writes the redraw map. turn: counts up by one a frame; decides whose tiles
// redraw their moving pixels (fill.comp).
void pyramid_fill(const struct pyramid *pyramid, VkCommandBuffer cmd, uint32_t target, uint32_t turn);

#endif
