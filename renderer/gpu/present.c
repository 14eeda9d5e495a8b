#include "renderer/gpu/frame.h"

#include <stdlib.h>

enum { IMAGES = 8 };

struct gpu_present {
    struct gpu *gpu;
    VkSwapchainKHR swapchain;
    VkFormat format;
    VkExtent2D extent;
    uint32_t image_count;
    VkImage images[IMAGES];
    VkSemaphore acquired;
    VkSemaphore drawn[IMAGES]; // one per image: a present may still read the last one's semaphore
    VkFence fence;
    VkCommandBuffer cmd;
    bool stale;
};

static bool choose_format(struct gpu_present *p, VkSurfaceFormatKHR *out)
{
    VkSurfaceFormatKHR formats[64];
    uint32_t count = countof(formats);
    if (!VK(p->gpu, vkGetPhysicalDeviceSurfaceFormatsKHR(p->gpu->physical, p->gpu->surface, &count, formats)))
        return false;
    // The image is already sRGB-encoded, so the swapchain must store it as it is.
    for (uint32_t i = 0; i < count; i++) {
        if (formats[i].colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR &&
            (formats[i].format == VK_FORMAT_B8G8R8A8_UNORM || formats[i].format == VK_FORMAT_R8G8B8A8_UNORM)) {
            *out = formats[i];
            return true;
        }
    }
    gpu_say(p->gpu, GPU_ERROR, "the window offers no 8-bit format for sRGB colours");
    return false;
}

// Builds the swapchain for the window's present size; a window of zero size gets none.
static bool rebuild(struct gpu_present *p)
{
    struct gpu *gpu = p->gpu;
    VkSurfaceCapabilitiesKHR caps;
    VkSurfaceFormatKHR format;
    vkDeviceWaitIdle(gpu->device);
    if (!VK(gpu, vkGetPhysicalDeviceSurfaceCapabilitiesKHR(gpu->physical, gpu->surface, &caps)) ||
        !choose_format(p, &format))
        return false;
    VkSwapchainKHR old = p->swapchain;
    p->swapchain = VK_NULL_HANDLE;
    p->extent = caps.currentExtent;
    bool ok = true;
    if (p->extent.width && p->extent.height) {
        const VkSwapchainCreateInfoKHR info = {
            .sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
            .surface = gpu->surface,
            .minImageCount = caps.minImageCount > 2 ? caps.minImageCount : 2,
            .imageFormat = format.format,
            .imageColorSpace = format.colorSpace,
            .imageExtent = p->extent,
            .imageArrayLayers = 1,
            .imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT,
            .preTransform = caps.currentTransform,
            .compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR,
            .presentMode = VK_PRESENT_MODE_FIFO_KHR,
            .clipped = VK_TRUE,
            .oldSwapchain = old,
        };
        p->image_count = IMAGES;
        ok = VK(gpu, vkCreateSwapchainKHR(gpu->device, &info, NULL, &p->swapchain)) &&
             VK(gpu, vkGetSwapchainImagesKHR(gpu->device, p->swapchain, &p->image_count, p->images));
    }
    vkDestroySwapchainKHR(gpu->device, old, NULL);
    p->stale = false;
    return ok;
}

struct gpu_present *gpu_present_create(struct gpu *gpu)
{
    struct gpu_present *p = calloc(1, sizeof *p);
    if (!p)
        return NULL;
    p->gpu = gpu;
    const VkSemaphoreCreateInfo semaphore = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    const VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    const VkCommandBufferAllocateInfo commands = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                  .commandPool = gpu->pool,
                                                  .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                  .commandBufferCount = 1};
    bool ok = VK(gpu, vkCreateSemaphore(gpu->device, &semaphore, NULL, &p->acquired)) &&
              VK(gpu, vkCreateFence(gpu->device, &fence, NULL, &p->fence)) &&
              VK(gpu, vkAllocateCommandBuffers(gpu->device, &commands, &p->cmd));
    for (uint32_t i = 0; i < IMAGES && ok; i++)
        ok = VK(gpu, vkCreateSemaphore(gpu->device, &semaphore, NULL, &p->drawn[i]));
    if (ok && rebuild(p))
        return p;
    gpu_present_destroy(p);
    return NULL;
}

void gpu_present_destroy(struct gpu_present *p)
{
    if (!p)
        return;
    VkDevice device = p->gpu->device;
    vkDeviceWaitIdle(device);
    for (uint32_t i = 0; i < IMAGES; i++)
        vkDestroySemaphore(device, p->drawn[i], NULL);
    vkDestroySemaphore(device, p->acquired, NULL);
    vkDestroyFence(device, p->fence, NULL);
    if (p->cmd)
        vkFreeCommandBuffers(device, p->gpu->pool, 1, &p->cmd);
    vkDestroySwapchainKHR(device, p->swapchain, NULL);
    free(p);
}

void gpu_present_resized(struct gpu_present *p)
{
    p->stale = true;
}

static void swap_layout(VkCommandBuffer cmd, VkImage image, VkImageLayout from, VkImageLayout to)
{
    const struct gpu_image wrapped = {.image = image, .format = VK_FORMAT_B8G8R8A8_UNORM};
    gpu_image_layout(cmd, &wrapped, from, to);
}

static bool record(struct gpu_present *p, const struct gpu_image *image, VkImage target)
{
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                            .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    if (!VK(p->gpu, vkBeginCommandBuffer(p->cmd, &begin)))
        return false;
    swap_layout(p->cmd, target, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    const VkImageBlit blit = {
        .srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
        .srcOffsets = {{0, 0, 0}, {(int32_t)image->width, (int32_t)image->height, 1}},
        .dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
        .dstOffsets = {{0, 0, 0}, {(int32_t)p->extent.width, (int32_t)p->extent.height, 1}},
    };
    vkCmdBlitImage(p->cmd, image->image, VK_IMAGE_LAYOUT_GENERAL, target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                   1, &blit, VK_FILTER_LINEAR);
    swap_layout(p->cmd, target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
    return VK(p->gpu, vkEndCommandBuffer(p->cmd));
}

// VK_SUBOPTIMAL_KHR and VK_ERROR_OUT_OF_DATE_KHR are no failures: the window changed, and the images with it.
static bool out_of_date(VkResult result)
{
    return result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR;
}

bool gpu_present_show(struct gpu_present *p, const struct gpu_image *image)
{
    struct gpu *gpu = p->gpu;
    uint32_t index = 0;
    if (p->stale && !rebuild(p))
        return false;
    if (!p->swapchain) {
        p->stale = true;
        return true;
    }
    VkResult acquired =
        vkAcquireNextImageKHR(gpu->device, p->swapchain, UINT64_MAX, p->acquired, VK_NULL_HANDLE, &index);
    if (acquired == VK_ERROR_OUT_OF_DATE_KHR) {
        p->stale = true;
        return true; // this frame is lost to the resize; the next one is shown
    }
    if (!gpu_check(gpu, acquired, "vkAcquireNextImageKHR") || !record(p, image, p->images[index]))
        return false;
    const VkSubmitInfo2 submit = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
        .waitSemaphoreInfoCount = 1,
        .pWaitSemaphoreInfos = &(VkSemaphoreSubmitInfo){.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                                        .semaphore = p->acquired,
                                                        .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT},
        .commandBufferInfoCount = 1,
        .pCommandBufferInfos =
            &(VkCommandBufferSubmitInfo){.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                         .commandBuffer = p->cmd},
        .signalSemaphoreInfoCount = 1,
        .pSignalSemaphoreInfos = &(VkSemaphoreSubmitInfo){.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                                          .semaphore = p->drawn[index],
                                                          .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT},
    };
    if (!VK(gpu, vkQueueSubmit2(gpu->queue, 1, &submit, p->fence)))
        return false;
    const VkPresentInfoKHR present = {.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
                                      .waitSemaphoreCount = 1,
                                      .pWaitSemaphores = &p->drawn[index],
                                      .swapchainCount = 1,
                                      .pSwapchains = &p->swapchain,
                                      .pImageIndices = &index};
    VkResult presented = vkQueuePresentKHR(gpu->queue, &present);
    if (!VK(gpu, vkWaitForFences(gpu->device, 1, &p->fence, VK_TRUE, UINT64_MAX)) ||
        !VK(gpu, vkResetFences(gpu->device, 1, &p->fence)))
        return false;
    p->stale = p->stale || out_of_date(presented) || acquired == VK_SUBOPTIMAL_KHR;
    return out_of_date(presented) || gpu_check(gpu, presented, "vkQueuePresentKHR");
}
