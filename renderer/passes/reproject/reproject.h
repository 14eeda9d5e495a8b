// Forward reprojection of the last frame's colours and exact world positions to the new eyes.
//
// Franke, Fink, Martschinke, Selgrad and Stamminger, "Time-Warped Foveated Rendering for Virtual Reality
// Headsets", Computer Graphics Forum 40(1), 2021, section 4. There every pixel is a point sprite resolved by
// the depth test; that is `points`. The other way is a 64-bit atomic maximum over (reversed depth, source
// pixel) in a storage buffer, which gives the same nearest-wins result and needs no rasteriser (Schuetz, Kerbl
// and Wimmer 2021, "Rendering Point Clouds with Compute Shaders and Vertex Order Optimization"). Both give the
// same pixels.
//
// Points land on the unjittered pixel grid, or a still camera's picture would swirl. A pixel that shows through
// between the spread pixels of a nearer surface is made a hole (show_through.comp).
//
// A position's w says what it is: 0 a hole, -1 the background (xyz a direction), 1 the static scene, and
// 1 + moving id + age / 64 a moving object, age in frames since its pixel was redrawn.
#ifndef RENDERER_PASSES_REPROJECT_REPROJECT_H
#define RENDERER_PASSES_REPROJECT_REPROJECT_H

#include "renderer/gpu/gpu.h"

struct reproject {
    struct gpu *gpu;
    uint32_t width, height;
    struct gpu_buffer keys;              // one uint64 a pixel and eye
    struct gpu_buffer ranges;            // of depths, per tile
    struct gpu_buffer near_tiles, holes; // lists (renderer/shared/tiles.glsl), the holes of pixels
    struct gpu_kernel splat, resolve, measure, candidates, show_through;
    VkPipeline points; // null: the atomic splat
    VkPipelineLayout point_layout;
    VkDescriptorSetLayout point_set_layout;
    struct gpu_image source, depth; // what the points draw
    VkSampler sampler;
    VkDescriptorSet sets[2], point_sets[2]; // by the index of the history that is read
};

struct reproject_desc {
    struct gpu *gpu;
    const struct gpu_buffer *frame, *motions;
    uint32_t width, height;
    bool points;             // the rasteriser's points instead of the atomic splat
    bool still;              // nothing ever moves: motions are not read
    VkImageView colour[2];   // rgba8, tone-mapped
    VkImageView position[2]; // rgba32f
};

bool reproject_init(struct reproject *reproject, const struct reproject_desc *desc);
void reproject_finish(struct reproject *reproject);
uint64_t reproject_memory(const struct reproject *reproject);
// Reads history `from`, writes colour and position `1 - from`, and lists what is a hole in `holes`.
// Points that land less than drop_deg from the gaze are dropped: that hole is redrawn anyway
// (section 4); 0 keeps all. drop_moving: those of moving objects too.
void reproject_record(const struct reproject *reproject, VkCommandBuffer cmd, uint32_t from, float drop_deg,
                      bool drop_moving);

#endif
