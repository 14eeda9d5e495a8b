// One frame's command buffer and its named timers.
//
// Use: gpu_frame_begin -> (gpu_timer_begin "name" ... commands on frame->cmd ... gpu_timer_end)* ->
// gpu_frame_end, which submits, waits and reads the timers. With pass_times every timed pass is a submission of
// its own, waited for: on software drivers time stamps inside one submission say nothing about single passes.
// frame->cmd changes there, so read it anew after gpu_timer_begin.
#ifndef RENDERER_GPU_FRAME_H
#define RENDERER_GPU_FRAME_H

#include "renderer/gpu/gpu.h"

enum { GPU_TIMERS = 32 };

struct gpu_frame {
    struct gpu *gpu;
    bool pass_times;
    VkCommandBuffer cmd;
    VkFence fence;
    VkQueryPool queries;
    bool failed; // a submission failed; gpu_frame_end reports it
    uint32_t timer_count;
    struct {
        const char *name;
        double ms;
    } timers[GPU_TIMERS]; // valid after gpu_frame_end
    double gpu_ms;        // first to last time stamp; with pass_times the sum of the passes
};

bool gpu_frame_init(struct gpu_frame *frame, struct gpu *gpu, bool pass_times);
void gpu_frame_finish(struct gpu_frame *frame);
bool gpu_frame_begin(struct gpu_frame *frame);
VkCommandBuffer gpu_timer_begin(struct gpu_frame *frame, const char *name);
void gpu_timer_end(struct gpu_frame *frame);
bool gpu_frame_end(struct gpu_frame *frame);

// --- presenting ---

struct gpu_present;

struct gpu_present *gpu_present_create(struct gpu *gpu); // NULL when headless or after a logged sentence
void gpu_present_destroy(struct gpu_present *present);
void gpu_present_resized(struct gpu_present *present);
// Scales `image` (layout GENERAL, sRGB-encoded rgba8) over the window and presents with vertical sync. Waits
// until the copy is done. A window of zero size shows nothing and succeeds.
bool gpu_present_show(struct gpu_present *present, const struct gpu_image *image);

#endif
