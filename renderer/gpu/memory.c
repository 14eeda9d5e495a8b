#include "renderer/gpu/gpu.h"

#include <string.h>

static bool allocate(struct gpu *gpu, const VkMemoryRequirements *needs, VkMemoryPropertyFlags flags,
                     const char *name, VkDeviceMemory *out)
{
    for (uint32_t i = 0; i < gpu->memory.memoryTypeCount; i++) {
        if (!(needs->memoryTypeBits & 1u << i) || (gpu->memory.memoryTypes[i].propertyFlags & flags) != flags)
            continue;
        const VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                           .allocationSize = needs->size,
                                           .memoryTypeIndex = i};
        VkResult result = vkAllocateMemory(gpu->device, &info, NULL, out);
        if (result == VK_SUCCESS) {
            gpu->allocated += needs->size;
            return true;
        }
    }
    gpu_say(gpu, GPU_ERROR, "no memory on the device for %s (%.1f MiB)", name, (double)needs->size / 1048576);
    return false;
}

bool gpu_buffer_create(struct gpu *gpu, const char *name, VkDeviceSize size, VkBufferUsageFlags usage,
                       enum gpu_buffer_kind kind, struct gpu_buffer *out)
{
    *out = (struct gpu_buffer){.size = size ? size : 4};
    if (usage & VK_BUFFER_USAGE_STORAGE_BUFFER_BIT &&
        out->size > gpu->properties.limits.maxStorageBufferRange) {
        gpu_say(gpu, GPU_ERROR, "%s needs a storage buffer of %.1f MiB; %s allows %.1f MiB", name,
                (double)size / 1048576, gpu->properties.deviceName,
                (double)gpu->properties.limits.maxStorageBufferRange / 1048576);
        return false;
    }
    const VkBufferCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = out->size, .usage = usage};
    if (!VK(gpu, vkCreateBuffer(gpu->device, &info, NULL, &out->buffer)))
        return false;
    gpu_name(gpu, VK_OBJECT_TYPE_BUFFER, (uint64_t)out->buffer, name);
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(gpu->device, out->buffer, &needs);
    const VkMemoryPropertyFlags flags =
        kind == GPU_HOST ? VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT
                         : VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    if (!allocate(gpu, &needs, flags, name, &out->memory) ||
        !VK(gpu, vkBindBufferMemory(gpu->device, out->buffer, out->memory, 0)) ||
        (kind == GPU_HOST &&
         !VK(gpu, vkMapMemory(gpu->device, out->memory, 0, VK_WHOLE_SIZE, 0, &out->mapped)))) {
        gpu_buffer_destroy(gpu, out);
        return false;
    }
    return true;
}

void gpu_buffer_destroy(struct gpu *gpu, struct gpu_buffer *buffer)
{
    if (buffer->memory) {
        VkMemoryRequirements needs;
        vkGetBufferMemoryRequirements(gpu->device, buffer->buffer, &needs);
        gpu->allocated -= needs.size;
    }
    vkDestroyBuffer(gpu->device, buffer->buffer, NULL);
    vkFreeMemory(gpu->device, buffer->memory, NULL);
    *buffer = (struct gpu_buffer){0};
}

VkCommandBuffer gpu_once_begin(struct gpu *gpu)
{
    const VkCommandBufferAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                              .commandPool = gpu->pool,
                                              .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                              .commandBufferCount = 1};
    VkCommandBuffer cmd = VK_NULL_HANDLE;
    if (!VK(gpu, vkAllocateCommandBuffers(gpu->device, &info, &cmd)))
        return VK_NULL_HANDLE;
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                            .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    return VK(gpu, vkBeginCommandBuffer(cmd, &begin)) ? cmd : VK_NULL_HANDLE;
}

bool gpu_once_end(struct gpu *gpu, VkCommandBuffer cmd)
{
    const VkCommandBufferSubmitInfo commands = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                                .commandBuffer = cmd};
    const VkSubmitInfo2 submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                                  .commandBufferInfoCount = 1,
                                  .pCommandBufferInfos = &commands};
    bool ok = VK(gpu, vkEndCommandBuffer(cmd)) &&
              VK(gpu, vkQueueSubmit2(gpu->queue, 1, &submit, VK_NULL_HANDLE)) &&
              VK(gpu, vkQueueWaitIdle(gpu->queue));
    vkFreeCommandBuffers(gpu->device, gpu->pool, 1, &cmd);
    return ok;
}

bool gpu_buffer_create_filled(struct gpu *gpu, const char *name, const void *data, VkDeviceSize size,
                              VkBufferUsageFlags usage, struct gpu_buffer *out)
{
    struct gpu_buffer staging = {0};
    if (!gpu_buffer_create(gpu, name, size, usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT, GPU_DEVICE, out))
        return false;
    if (size == 0)
        return true;
    bool ok = gpu_buffer_create(gpu, "staging", size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, GPU_HOST, &staging);
    VkCommandBuffer cmd = ok ? gpu_once_begin(gpu) : VK_NULL_HANDLE;
    if (cmd) {
        memcpy(staging.mapped, data, size);
        vkCmdCopyBuffer(cmd, staging.buffer, out->buffer, 1, &(VkBufferCopy){.size = size});
        ok = gpu_once_end(gpu, cmd);
    }
    gpu_buffer_destroy(gpu, &staging);
    if (!ok || !cmd)
        gpu_buffer_destroy(gpu, out);
    return ok && cmd;
}

static VkImageAspectFlags aspect_of(VkFormat format)
{
    return format == VK_FORMAT_D32_SFLOAT ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

static VkImageView make_view(struct gpu *gpu, const struct gpu_image *image, VkImageViewType type,
                             uint32_t level, uint32_t levels, uint32_t layer, uint32_t layers)
{
    const VkImageViewCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .image = image->image,
        .viewType = type,
        .format = image->format,
        .subresourceRange = {aspect_of(image->format), level, levels, layer, layers},
    };
    VkImageView view = VK_NULL_HANDLE;
    return VK(gpu, vkCreateImageView(gpu->device, &info, NULL, &view)) ? view : VK_NULL_HANDLE;
}

bool gpu_image_create(struct gpu *gpu, const struct gpu_image_desc *desc, struct gpu_image *out)
{
    *out = (struct gpu_image){.format = desc->format,
                              .width = desc->width,
                              .height = desc->height,
                              .levels = desc->levels ? desc->levels : 1,
                              .layers = desc->layers ? desc->layers : 1};
    const VkImageCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
        .imageType = VK_IMAGE_TYPE_2D,
        .format = desc->format,
        .extent = {desc->width, desc->height, 1},
        .mipLevels = out->levels,
        .arrayLayers = out->layers,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .tiling = VK_IMAGE_TILING_OPTIMAL,
        .usage = desc->usage,
    };
    if (!VK(gpu, vkCreateImage(gpu->device, &info, NULL, &out->image)))
        return false;
    gpu_name(gpu, VK_OBJECT_TYPE_IMAGE, (uint64_t)out->image, desc->name);
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(gpu->device, out->image, &needs);
    if (!allocate(gpu, &needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, desc->name, &out->memory))
        goto error;
    out->bytes = needs.size;
    if (!VK(gpu, vkBindImageMemory(gpu->device, out->image, out->memory, 0)))
        goto error;
    const VkImageViewType type = desc->array ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
    out->view = make_view(gpu, out, type, 0, out->levels, 0, out->layers);
    if (!out->view)
        goto error;
    const VkImageUsageFlags attachment = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                         VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
                                         VK_IMAGE_USAGE_FRAGMENT_SHADING_RATE_ATTACHMENT_BIT_KHR;
    for (uint32_t layer = 0; desc->usage & attachment && layer < out->layers; layer++) {
        out->layer_views[layer] = make_view(gpu, out, VK_IMAGE_VIEW_TYPE_2D, 0, 1, layer, 1);
        if (!out->layer_views[layer])
            goto error;
    }
    return true;
error:
    gpu_image_destroy(gpu, out);
    return false;
}

void gpu_image_destroy(struct gpu *gpu, struct gpu_image *image)
{
    vkDestroyImageView(gpu->device, image->layer_views[0], NULL);
    vkDestroyImageView(gpu->device, image->layer_views[1], NULL);
    vkDestroyImageView(gpu->device, image->view, NULL);
    vkDestroyImage(gpu->device, image->image, NULL);
    vkFreeMemory(gpu->device, image->memory, NULL);
    gpu->allocated -= image->bytes;
    *image = (struct gpu_image){0};
}

VkImageView gpu_image_level_view(struct gpu *gpu, const struct gpu_image *image, uint32_t level)
{
    return make_view(gpu, image, VK_IMAGE_VIEW_TYPE_2D_ARRAY, level, 1, 0, image->layers);
}

bool gpu_image_fill(struct gpu *gpu, struct gpu_image *image, const uint8_t *rgba)
{
    VkBufferImageCopy copies[16];
    VkDeviceSize size = 0;
    for (uint32_t level = 0; level < image->levels && level < countof(copies); level++) {
        uint32_t width = image->width >> level ? image->width >> level : 1;
        uint32_t height = image->height >> level ? image->height >> level : 1;
        copies[level] = (VkBufferImageCopy){.bufferOffset = size,
                                            .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, 0, 1},
                                            .imageExtent = {width, height, 1}};
        size += (VkDeviceSize)width * height * 4;
    }
    struct gpu_buffer staging;
    if (!gpu_buffer_create(gpu, "texture staging", size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, GPU_HOST, &staging))
        return false;
    memcpy(staging.mapped, rgba, size);
    VkCommandBuffer cmd = gpu_once_begin(gpu);
    bool ok = cmd;
    if (cmd) {
        gpu_image_layout(cmd, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        vkCmdCopyBufferToImage(cmd, staging.buffer, image->image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                               image->levels, copies);
        gpu_image_layout(cmd, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                         VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
        ok = gpu_once_end(gpu, cmd);
    }
    gpu_buffer_destroy(gpu, &staging);
    return ok;
}

void gpu_barrier(VkCommandBuffer cmd, VkPipelineStageFlags2 from, VkPipelineStageFlags2 to)
{
    const VkMemoryBarrier2 barrier = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                      .srcStageMask = from,
                                      .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
                                      .dstStageMask = to,
                                      .dstAccessMask =
                                          VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT};
    vkCmdPipelineBarrier2(cmd, &(VkDependencyInfo){.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                                   .memoryBarrierCount = 1,
                                                   .pMemoryBarriers = &barrier});
}

void gpu_image_layout(VkCommandBuffer cmd, const struct gpu_image *image, VkImageLayout from, VkImageLayout to)
{
    const VkImageMemoryBarrier2 barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
        .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
        .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
        .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
        .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
        .oldLayout = from,
        .newLayout = to,
        .image = image->image,
        .subresourceRange = {aspect_of(image->format), 0, VK_REMAINING_MIP_LEVELS, 0,
                             VK_REMAINING_ARRAY_LAYERS},
    };
    vkCmdPipelineBarrier2(cmd, &(VkDependencyInfo){.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                                   .imageMemoryBarrierCount = 1,
                                                   .pImageMemoryBarriers = &barrier});
}
