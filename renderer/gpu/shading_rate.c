#include "renderer/gpu/gpu.h"

#include <stdlib.h>
#include <string.h>

uint32_t gpu_shading_rate_code(uint32_t width, uint32_t height)
{
    uint32_t code = 0;
    for (; width > 1; width /= 2)
        code += 4;
    for (; height > 1; height /= 2)
        code++;
    return code;
}

uint32_t gpu_shading_rate_largest(const VkPhysicalDeviceFragmentShadingRateKHR *rates, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        if (rates[i].fragmentSize.width == 4 && rates[i].fragmentSize.height == 4 &&
            rates[i].sampleCounts & VK_SAMPLE_COUNT_1_BIT)
            return 4;
    }
    return 2; // every device with attachments has 2x2
}

uint32_t gpu_shading_rate_texel(VkExtent2D least, VkExtent2D most)
{
    uint32_t side = 8;
    side = side < least.width ? least.width : side;
    side = side < least.height ? least.height : side;
    return side <= most.width && side <= most.height ? side : 0;
}

static bool has_extension(VkPhysicalDevice physical, const char *name)
{
    uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(physical, NULL, &count, NULL);
    VkExtensionProperties *list = calloc(count + 1, sizeof *list);
    if (!list)
        return false;
    vkEnumerateDeviceExtensionProperties(physical, NULL, &count, list);
    bool found = false;
    for (uint32_t i = 0; i < count && !found; i++)
        found = strcmp(list[i].extensionName, name) == 0;
    free(list);
    return found;
}

struct gpu_shading_rate gpu_shading_rate_of(VkPhysicalDevice physical)
{
    if (!has_extension(physical, VK_KHR_FRAGMENT_SHADING_RATE_EXTENSION_NAME) ||
        !vkGetPhysicalDeviceFragmentShadingRatesKHR)
        return (struct gpu_shading_rate){0};
    VkPhysicalDeviceFragmentShadingRateFeaturesKHR rate = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FRAGMENT_SHADING_RATE_FEATURES_KHR};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                          .pNext = &rate};
    vkGetPhysicalDeviceFeatures2(physical, &features);
    VkPhysicalDeviceFragmentShadingRatePropertiesKHR limits = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FRAGMENT_SHADING_RATE_PROPERTIES_KHR};
    VkPhysicalDeviceProperties2 properties = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                              .pNext = &limits};
    vkGetPhysicalDeviceProperties2(physical, &properties);
    // the map is written by a kernel, and pixels are counted in the fragment shader
    VkFormatProperties format;
    vkGetPhysicalDeviceFormatProperties(physical, VK_FORMAT_R8_UINT, &format);
    if (!rate.attachmentFragmentShadingRate || !features.features.fragmentStoresAndAtomics ||
        !(format.optimalTilingFeatures & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT))
        return (struct gpu_shading_rate){0};
    VkPhysicalDeviceFragmentShadingRateKHR rates[32];
    uint32_t count = countof(rates);
    for (uint32_t i = 0; i < count; i++)
        rates[i] = (VkPhysicalDeviceFragmentShadingRateKHR){
            .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FRAGMENT_SHADING_RATE_KHR};
    if (vkGetPhysicalDeviceFragmentShadingRatesKHR(physical, &count, rates) < 0)
        count = 0;
    return (struct gpu_shading_rate){
        .texel = gpu_shading_rate_texel(limits.minFragmentShadingRateAttachmentTexelSize,
                                        limits.maxFragmentShadingRateAttachmentTexelSize),
        .largest = gpu_shading_rate_largest(rates, count)};
}
