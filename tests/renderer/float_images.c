#include "tests/renderer/float_images.h"

#include "renderer/renderer_private.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

enum { IMAGES = 256, NAMES = 64 };

struct watched {
    VkImage image; // null: free
    VkFormat format;
    uint32_t width, height, levels, layers;
    VkImageLayout layout; // UNDEFINED: never used
    char name[64];
};

struct seen {
    char name[64];
    uint64_t used;
    float largest;
};

// Vulkan hands no user pointer to its functions.
static struct renderer *renderer;
static struct watched images[IMAGES];
static struct seen names[NAMES];
static struct {
    PFN_vkCreateImage create;
    PFN_vkDestroyImage destroy;
    PFN_vkSetDebugUtilsObjectNameEXT name;
    PFN_vkCmdPipelineBarrier2 barrier;
} driver;

struct format {
    VkFormat format;
    uint32_t channels, channel_bytes;
};
static const struct format formats[] = {{VK_FORMAT_R16G16B16A16_SFLOAT, 4, 2},
                                        {VK_FORMAT_R32G32B32A32_SFLOAT, 4, 4},
                                        {VK_FORMAT_R32_SFLOAT, 1, 4},
                                        {VK_FORMAT_D32_SFLOAT, 1, 4}};

static const struct format *format_of(VkFormat format)
{
    for (uint32_t i = 0; i < countof(formats); i++)
        if (formats[i].format == format)
            return &formats[i];
    return NULL;
}

static struct watched *find(VkImage image)
{
    for (int i = 0; i < IMAGES; i++)
        if (images[i].image == image)
            return &images[i];
    return NULL;
}

static bool is_depth(const struct watched *w)
{
    return w->format == VK_FORMAT_D32_SFLOAT;
}

static VkResult create(VkDevice device, const VkImageCreateInfo *info, const VkAllocationCallbacks *allocator,
                       VkImage *out)
{
    VkImageCreateInfo open = *info;
    struct watched *w = format_of(info->format) ? find(VK_NULL_HANDLE) : NULL;
    if (w)
        open.usage |= VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    const VkResult result = driver.create(device, &open, allocator, out);
    if (w && result == VK_SUCCESS)
        *w = (struct watched){.image = *out,
                              .format = info->format,
                              .width = info->extent.width,
                              .height = info->extent.height,
                              .levels = info->mipLevels,
                              .layers = info->arrayLayers};
    return result;
}

static void destroy(VkDevice device, VkImage image, const VkAllocationCallbacks *allocator)
{
    struct watched *w = image ? find(image) : NULL;
    if (w)
        *w = (struct watched){0};
    driver.destroy(device, image, allocator);
}

static VkResult name_object(VkDevice device, const VkDebugUtilsObjectNameInfoEXT *info)
{
    struct watched *w =
        info->objectType == VK_OBJECT_TYPE_IMAGE ? find((VkImage)info->objectHandle) : NULL; // NOLINT
    if (w)
        snprintf(w->name, sizeof w->name, "%s", info->pObjectName);
    return driver.name(device, info);
}

static void go_to(VkCommandBuffer cmd, const struct watched *w, VkImageLayout from, VkImageLayout to)
{
    const VkImageMemoryBarrier2 barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
        .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
        .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
        .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
        .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
        .oldLayout = from,
        .newLayout = to,
        .image = w->image,
        .subresourceRange = {is_depth(w) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT, 0, w->levels,
                             0, w->layers}};
    driver.barrier(cmd, &(VkDependencyInfo){.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                            .imageMemoryBarrierCount = 1,
                                            .pImageMemoryBarriers = &barrier});
}

static void clear(VkCommandBuffer cmd, const struct watched *w, VkImageLayout to)
{
    const VkImageSubresourceRange all = {VK_IMAGE_ASPECT_COLOR_BIT, 0, w->levels, 0, w->layers};
    go_to(cmd, w, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    vkCmdClearColorImage(cmd, w->image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &(VkClearColorValue){{0}}, 1,
                         &all);
    go_to(cmd, w, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, to);
}

// The renderer changes one image's layout at a time (gpu_image_layout).
static void barrier(VkCommandBuffer cmd, const VkDependencyInfo *info)
{
    const VkImageMemoryBarrier2 *change = info->imageMemoryBarrierCount ? info->pImageMemoryBarriers : NULL;
    struct watched *w = change ? find(change->image) : NULL;
    if (w)
        w->layout = change->newLayout;
    if (w && change->oldLayout == VK_IMAGE_LAYOUT_UNDEFINED && !is_depth(w))
        clear(cmd, w, change->newLayout);
    else
        driver.barrier(cmd, info);
}

void float_images_watch(struct renderer *r)
{
    renderer = r;
    memset(images, 0, sizeof images);
    memset(names, 0, sizeof names);
    driver.create = vkCreateImage;
    driver.destroy = vkDestroyImage;
    driver.name = vkSetDebugUtilsObjectNameEXT;
    driver.barrier = vkCmdPipelineBarrier2;
    vkCreateImage = create;
    vkDestroyImage = destroy;
    vkSetDebugUtilsObjectNameEXT = name_object;
    vkCmdPipelineBarrier2 = barrier;
}

void float_images_finish(void)
{
    vkCreateImage = driver.create;
    vkDestroyImage = driver.destroy;
    vkSetDebugUtilsObjectNameEXT = driver.name;
    vkCmdPipelineBarrier2 = driver.barrier;
}

static struct seen *seen_of(const char *name)
{
    int i = 0;
    while (i < NAMES - 1 && names[i].name[0] && strcmp(names[i].name, name) != 0)
        i++;
    snprintf(names[i].name, sizeof names[i].name, "%s", name);
    return &names[i];
}

uint64_t float_images_used(const char *name)
{
    return seen_of(name)->used;
}

float float_images_largest(const char *name)
{
    return seen_of(name)->largest;
}

static float half(uint16_t bits)
{
    const int exponent = bits >> 10 & 31, mantissa = bits & 1023;
    const float sign = bits >> 15 ? -1.0f : 1.0f;
    if (exponent == 31)
        return mantissa ? NAN : sign * INFINITY;
    return sign * (exponent ? ldexpf((float)(1024 + mantissa), exponent - 25) : ldexpf((float)mantissa, -24));
}

static float value_at(const void *values, const struct format *format, size_t i)
{
    if (format->channel_bytes == 2)
        return half(((const uint16_t *)values)[i]);
    return ((const float *)values)[i];
}

static void check_values(const struct watched *w, uint32_t level, uint32_t width, uint32_t height,
                         const void *values, const char *when)
{
    const struct format *format = format_of(w->format);
    struct seen *seen = seen_of(w->name);
    const size_t count = (size_t)width * height * w->layers;
    for (size_t texel = 0; texel < count; texel++) {
        bool used = false;
        for (uint32_t c = 0; c < format->channels; c++) {
            const float value = value_at(values, format, texel * format->channels + c);
            if (!isfinite(value))
                fail_msg("%s: '%s', level %u, layer %u, pixel %u, %u, channel %u is %g", when, w->name, level,
                         (uint32_t)(texel / ((size_t)width * height)), (uint32_t)(texel % width),
                         (uint32_t)(texel / width % height), c, (double)value);
            used |= value != 0.0f;
            seen->largest = fmaxf(seen->largest, fabsf(value));
        }
        seen->used += used;
    }
}

static void check_level(const struct watched *w, uint32_t level, const char *when)
{
    struct gpu_buffer to;
    const struct format *format = format_of(w->format);
    const uint32_t width = w->width >> level ? w->width >> level : 1;
    const uint32_t height = w->height >> level ? w->height >> level : 1;
    const VkDeviceSize bytes =
        (VkDeviceSize)width * height * w->layers * format->channels * format->channel_bytes;
    assert_true(
        gpu_buffer_create(renderer->gpu, "read back", bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, GPU_HOST, &to));
    VkCommandBuffer cmd = gpu_once_begin(renderer->gpu);
    assert_non_null(cmd);
    const VkBufferImageCopy copy = {
        .imageSubresource = {is_depth(w) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT, level, 0,
                             w->layers},
        .imageExtent = {width, height, 1}};
    go_to(cmd, w, w->layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    vkCmdCopyImageToBuffer(cmd, w->image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to.buffer, 1, &copy);
    go_to(cmd, w, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, w->layout);
    assert_true(gpu_once_end(renderer->gpu, cmd));
    check_values(w, level, width, height, to.mapped, when);
    gpu_buffer_destroy(renderer->gpu, &to);
}

void float_images_check(const char *when)
{
    assert_non_null(find(VK_NULL_HANDLE)); // room for all
    for (int i = 0; i < IMAGES; i++)
        for (uint32_t level = 0; images[i].layout != VK_IMAGE_LAYOUT_UNDEFINED && level < images[i].levels;
             level++)
            check_level(&images[i], level, when);
}
