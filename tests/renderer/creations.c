#include "tests/renderer/creations.h"

#include <volk.h>

// Vulkan hands no user pointer to its functions.
static struct creations seen;
static struct {
    PFN_vkCreateGraphicsPipelines graphics;
    PFN_vkCreateComputePipelines compute;
    PFN_vkCreateShaderModule shader;
    PFN_vkCreateImage image;
    PFN_vkCreateImageView view;
    PFN_vkCreateBuffer buffer;
    PFN_vkAllocateMemory memory;
} driver;

static VkResult graphics(VkDevice device, VkPipelineCache cache, uint32_t count,
                         const VkGraphicsPipelineCreateInfo *info, const VkAllocationCallbacks *allocator,
                         VkPipeline *out)
{
    seen.pipelines += count;
    return driver.graphics(device, cache, count, info, allocator, out);
}

static VkResult compute(VkDevice device, VkPipelineCache cache, uint32_t count,
                        const VkComputePipelineCreateInfo *info, const VkAllocationCallbacks *allocator,
                        VkPipeline *out)
{
    seen.pipelines += count;
    return driver.compute(device, cache, count, info, allocator, out);
}

static VkResult shader(VkDevice device, const VkShaderModuleCreateInfo *info,
                       const VkAllocationCallbacks *allocator, VkShaderModule *out)
{
    seen.shaders++;
    return driver.shader(device, info, allocator, out);
}

static VkResult image(VkDevice device, const VkImageCreateInfo *info, const VkAllocationCallbacks *allocator,
                      VkImage *out)
{
    seen.images++;
    return driver.image(device, info, allocator, out);
}

static VkResult view(VkDevice device, const VkImageViewCreateInfo *info, const VkAllocationCallbacks *allocator,
                     VkImageView *out)
{
    seen.views++;
    return driver.view(device, info, allocator, out);
}

static VkResult buffer(VkDevice device, const VkBufferCreateInfo *info, const VkAllocationCallbacks *allocator,
                       VkBuffer *out)
{
    seen.buffers++;
    return driver.buffer(device, info, allocator, out);
}

static VkResult memory(VkDevice device, const VkMemoryAllocateInfo *info,
                       const VkAllocationCallbacks *allocator, VkDeviceMemory *out)
{
    seen.allocations++;
    return driver.memory(device, info, allocator, out);
}

void creations_begin(void)
{
    seen = (struct creations){0};
    driver.graphics = vkCreateGraphicsPipelines;
    driver.compute = vkCreateComputePipelines;
    driver.shader = vkCreateShaderModule;
    driver.image = vkCreateImage;
    driver.view = vkCreateImageView;
    driver.buffer = vkCreateBuffer;
    driver.memory = vkAllocateMemory;
    vkCreateGraphicsPipelines = graphics;
    vkCreateComputePipelines = compute;
    vkCreateShaderModule = shader;
    vkCreateImage = image;
    vkCreateImageView = view;
    vkCreateBuffer = buffer;
    vkAllocateMemory = memory;
}

struct creations creations_end(void)
{
    vkCreateGraphicsPipelines = driver.graphics;
    vkCreateComputePipelines = driver.compute;
    vkCreateShaderModule = driver.shader;
    vkCreateImage = driver.image;
    vkCreateImageView = driver.view;
    vkCreateBuffer = driver.buffer;
    vkAllocateMemory = driver.memory;
    return seen;
}

uint32_t creations_total(const struct creations *c)
{
    return c->pipelines + c->shaders + c->images + c->views + c->buffers + c->allocations;
}
