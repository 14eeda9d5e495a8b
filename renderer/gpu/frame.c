#include "renderer/gpu/frame.h"

bool gpu_frame_init(struct gpu_frame *frame, struct gpu *gpu, bool pass_times)
{
    *frame = (struct gpu_frame){.gpu = gpu, .pass_times = pass_times};
    const VkCommandBufferAllocateInfo commands = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                  .commandPool = gpu->pool,
                                                  .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                  .commandBufferCount = 1};
    const VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    const VkQueryPoolCreateInfo queries = {.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                           .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                           .queryCount = 2 * GPU_TIMERS};
    return VK(gpu, vkAllocateCommandBuffers(gpu->device, &commands, &frame->cmd)) &&
           VK(gpu, vkCreateFence(gpu->device, &fence, NULL, &frame->fence)) &&
           VK(gpu, vkCreateQueryPool(gpu->device, &queries, NULL, &frame->queries));
}

void gpu_frame_finish(struct gpu_frame *frame)
{
    if (!frame->gpu)
        return;
    vkDestroyQueryPool(frame->gpu->device, frame->queries, NULL);
    vkDestroyFence(frame->gpu->device, frame->fence, NULL);
    if (frame->cmd)
        vkFreeCommandBuffers(frame->gpu->device, frame->gpu->pool, 1, &frame->cmd);
    *frame = (struct gpu_frame){0};
}

static bool begin(struct gpu_frame *frame)
{
    const VkCommandBufferBeginInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                           .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    return VK(frame->gpu, vkBeginCommandBuffer(frame->cmd, &info));
}

static bool submit(struct gpu_frame *frame)
{
    struct gpu *gpu = frame->gpu;
    const VkCommandBufferSubmitInfo commands = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                                .commandBuffer = frame->cmd};
    const VkSubmitInfo2 info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                                .commandBufferInfoCount = 1,
                                .pCommandBufferInfos = &commands};
    return VK(gpu, vkEndCommandBuffer(frame->cmd)) &&
           VK(gpu, vkQueueSubmit2(gpu->queue, 1, &info, frame->fence)) &&
           VK(gpu, vkWaitForFences(gpu->device, 1, &frame->fence, VK_TRUE, UINT64_MAX)) &&
           VK(gpu, vkResetFences(gpu->device, 1, &frame->fence));
}

bool gpu_frame_begin(struct gpu_frame *frame)
{
    frame->timer_count = 0;
    frame->failed = false;
    vkResetQueryPool(frame->gpu->device, frame->queries, 0, 2 * GPU_TIMERS);
    return begin(frame);
}

VkCommandBuffer gpu_timer_begin(struct gpu_frame *frame, const char *name)
{
    if (frame->timer_count < GPU_TIMERS) {
        frame->timers[frame->timer_count].name = name;
        vkCmdWriteTimestamp2(frame->cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, frame->queries,
                             2 * frame->timer_count);
    }
    return frame->cmd;
}

void gpu_timer_end(struct gpu_frame *frame)
{
    if (frame->timer_count < GPU_TIMERS) {
        vkCmdWriteTimestamp2(frame->cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, frame->queries,
                             2 * frame->timer_count + 1);
        frame->timer_count++;
    }
    if (frame->pass_times && !(submit(frame) && begin(frame)))
        frame->failed = true;
}

bool gpu_frame_end(struct gpu_frame *frame)
{
    if (!submit(frame) || frame->failed)
        return false;
    frame->gpu_ms = 0;
    if (frame->timer_count == 0)
        return true;
    uint64_t stamps[2 * GPU_TIMERS];
    if (!VK(frame->gpu,
            vkGetQueryPoolResults(frame->gpu->device, frame->queries, 0, 2 * frame->timer_count, sizeof stamps,
                                  stamps, sizeof stamps[0], VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT)))
        return false;
    const double ms_per_tick = (double)frame->gpu->properties.limits.timestampPeriod * 1e-6;
    double sum = 0;
    for (uint32_t i = 0; i < frame->timer_count; i++) {
        frame->timers[i].ms = (double)(stamps[2 * i + 1] - stamps[2 * i]) * ms_per_tick;
        sum += frame->timers[i].ms;
    }
    frame->gpu_ms =
        frame->pass_times ? sum : (double)(stamps[2 * frame->timer_count - 1] - stamps[0]) * ms_per_tick;
    return true;
}
