// A device with the validation layer listening (synchronisation too), and what a single pass needs around it:
// two-layer images written and read by the CPU, buffers read back, and the constants of a frame filled from
// poses in double precision.
//
// Use: rig_open (false: no Vulkan device, exit 77) -> rig_image, rig_upload, rig_frame -> rig_begin ... rig_end
//      around a pass's record -> rig_read* -> rig_close, which fails the test if the validation layer spoke.
// Everything here fails the running test instead of returning an error.
#ifndef TESTS_RENDERER_PASSES_RIG_H
#define TESTS_RENDERER_PASSES_RIG_H

#include "renderer/gpu/gpu.h"
#include "renderer/shared/shared.h"
#include "stimuli/viewing.h"

struct rig {
    struct gpu *gpu;
    struct gpu_buffer frame;    // shared_frame
    struct gpu_buffer counters; // shared_counters
    struct gpu_kernel words, texels, single_texels;
    char log[4096]; // every sentence so far
};

bool rig_open(struct rig *rig);
void rig_close(struct rig *rig);

VkCommandBuffer rig_begin(struct rig *rig);
void rig_end(struct rig *rig, VkCommandBuffer cmd); // waits

// Two layers, storage and transfer, layout GENERAL, contents undefined.
struct gpu_image rig_image(struct rig *rig, VkFormat format, uint32_t width, uint32_t height);
// A sampled image of two layers filled once and left in `layout`; depth formats too.
struct gpu_image rig_sampled(struct rig *rig, VkFormat format, uint32_t width, uint32_t height,
                             uint32_t texel_bytes, const void *texels, VkImageLayout layout);
// Both layers, tightly packed; the image stays in GENERAL.
void rig_upload(struct rig *rig, const struct gpu_image *image, uint32_t texel_bytes, const void *texels);
void rig_download(struct rig *rig, const struct gpu_image *image, uint32_t texel_bytes, void *out_texels);
// One mip level of a half-float or r32 float image: the level's width * height * 2 layers, rgba.
void rig_read_level(struct rig *rig, const struct gpu_image *image, uint32_t level, float *out_rgba);
void rig_read_words(struct rig *rig, const struct gpu_buffer *buffer, uint32_t count, void *out_words);

// What the two eyes see.
struct rig_view {
    uint32_t width, height;
    struct rig_eye {
        struct pose pose;
        struct viewing_fov fov;
        double gaze_x_deg, gaze_y_deg; // NaN: none
    } eyes[EYES];
    struct dvec3 origin;      // of the positions that the passes see
    struct dvec3 last_origin; // of the positions kept from the last frame
};

// Symmetric frusta, eyes 63 mm apart around the world's centre, gaze straight ahead.
struct rig_view rig_view_default(uint32_t width, uint32_t height);
void rig_frame(struct rig *rig, const struct rig_view *view);

// Counter-based random numbers (Vigna's splitmix64 finaliser), so that every run draws the same.
uint64_t rig_random(uint64_t *state);
double rig_uniform(uint64_t *state, double low, double high);
struct dquat rig_turn(uint64_t *state, double most_rad); // about a random axis
uint64_t rig_below(uint64_t *state, uint64_t bound);

#endif
