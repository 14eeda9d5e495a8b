// A Vulkan layer for the tests: the device below it lacks the feature that POOR_FEATURE names. A small instance
// layer after the loader's "Layer interface" document, version 2: it only intercepts what it must.
#include <stdlib.h>
#include <string.h>
#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

// One instance at a time, as the tests have it.
static PFN_vkGetInstanceProcAddr next_proc;
static PFN_vkGetPhysicalDeviceFeatures2 next_features;
static PFN_vkGetPhysicalDeviceProperties next_properties;

static VKAPI_ATTR VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo *info,
                                                      const VkAllocationCallbacks *allocator, VkInstance *out)
{
    VkLayerInstanceCreateInfo *chain = (VkLayerInstanceCreateInfo *)(uintptr_t)info->pNext;
    while (chain && !(chain->sType == VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO &&
                      chain->function == VK_LAYER_LINK_INFO))
        chain = (VkLayerInstanceCreateInfo *)(uintptr_t)chain->pNext;
    if (!chain)
        return VK_ERROR_INITIALIZATION_FAILED;
    next_proc = chain->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    chain->u.pLayerInfo = chain->u.pLayerInfo->pNext;
    PFN_vkCreateInstance next =
        (PFN_vkCreateInstance)(void (*)(void))next_proc(VK_NULL_HANDLE, "vkCreateInstance");
    VkResult result = next(info, allocator, out);
    if (result == VK_SUCCESS) {
        next_features = (PFN_vkGetPhysicalDeviceFeatures2)next_proc(*out, "vkGetPhysicalDeviceFeatures2");
        next_properties = (PFN_vkGetPhysicalDeviceProperties)next_proc(*out, "vkGetPhysicalDeviceProperties");
    }
    return result;
}

static int lacks(const char *feature)
{
    const char *name = getenv("POOR_FEATURE");
    return name && strcmp(name, feature) == 0;
}

static VKAPI_ATTR void VKAPI_CALL get_features(VkPhysicalDevice device, VkPhysicalDeviceFeatures2 *out)
{
    next_features(device, out);
    if (lacks("shaderInt64"))
        out->features.shaderInt64 = VK_FALSE;
    for (VkBaseOutStructure *s = out->pNext; s; s = s->pNext) {
        if (s->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES && lacks("drawIndirectCount"))
            ((VkPhysicalDeviceVulkan12Features *)s)->drawIndirectCount = VK_FALSE;
        if (s->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES && lacks("shaderOutputLayer"))
            ((VkPhysicalDeviceVulkan12Features *)s)->shaderOutputLayer = VK_FALSE;
        if (s->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES && lacks("multiview"))
            ((VkPhysicalDeviceVulkan11Features *)s)->multiview = VK_FALSE;
    }
}

static VKAPI_ATTR void VKAPI_CALL get_properties(VkPhysicalDevice device, VkPhysicalDeviceProperties *out)
{
    next_properties(device, out);
    if (lacks("Vulkan 1.3"))
        out->apiVersion = VK_API_VERSION_1_2;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_proc(VkInstance instance, const char *name)
{
    if (strcmp(name, "vkGetInstanceProcAddr") == 0)
        return (PFN_vkVoidFunction)get_proc;
    if (strcmp(name, "vkCreateInstance") == 0)
        return (PFN_vkVoidFunction)create_instance;
    if (strcmp(name, "vkGetPhysicalDeviceFeatures2") == 0)
        return (PFN_vkVoidFunction)get_features;
    if (strcmp(name, "vkGetPhysicalDeviceProperties") == 0)
        return (PFN_vkVoidFunction)get_properties;
    return next_proc ? next_proc(instance, name) : NULL;
}

VKAPI_ATTR VkResult VKAPI_CALL vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface *version);

VKAPI_ATTR VkResult VKAPI_CALL vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface *version)
{
    version->loaderLayerInterfaceVersion = 2;
    version->pfnGetInstanceProcAddr = get_proc;
    version->pfnGetDeviceProcAddr = NULL;
    version->pfnGetPhysicalDeviceProcAddr = NULL;
    return VK_SUCCESS;
}
