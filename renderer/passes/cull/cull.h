// Culling of submodels on the GPU, for both eyes, by the frustum and, where there is one, by the redraw map:
// writes compacted indirect draws bucket by bucket, a list for each eye or one for both.
//
// The order of the draws is the order of the items, whatever the device's timing, so that equal depths resolve
// alike in every run. Compaction after Blelloch's scan, one level: groups of SHARED_CULL_GROUP items count,
// then place.
#ifndef RENDERER_PASSES_CULL_CULL_H
#define RENDERER_PASSES_CULL_CULL_H

#include "renderer/scene/scene_gpu.h"

struct cull {
    struct gpu *gpu;
    const struct scene_gpu *scene;
    struct gpu_kernel count, emit;
    VkDescriptorSet count_set, emit_set;
    struct gpu_buffer visible;      // per list and item: 1 where it may be seen
    struct gpu_buffer group_counts; // per list and group
    struct gpu_buffer draws; // shared_draw, per list and item slot; a bucket's draws start at its first item
    struct gpu_buffer draw_counts; // per list and bucket
    uint32_t lists;                // 2: one of what each eye sees; 1: of what either sees
    bool by_redraw_map;
    uint32_t tiles_x, tiles_y, levels;
};

struct cull_desc {
    struct gpu *gpu;
    const struct scene_gpu *scene;
    const struct gpu_buffer *frame, *counters;
    bool both_eyes; // one list, whose draws go to both eyes; without a redraw map only
    bool instanced; // by two instances
    // the or-pyramid of passes/redraw and its shape; NULL: the frustum alone
    const struct gpu_buffer *pyramid;
    uint32_t tiles_x, tiles_y, levels;
};

bool cull_init(struct cull *cull, const struct cull_desc *desc);
void cull_finish(struct cull *cull);
uint64_t cull_memory(const struct cull *cull);
// Leaves draws and draw_counts ready for indirect drawing. moving_everywhere: the redraw map does not count for
// moving objects.
void cull_record(const struct cull *cull, VkCommandBuffer cmd, bool moving_everywhere);

#endif
