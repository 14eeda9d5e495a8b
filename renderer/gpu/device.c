#define VOLK_IMPLEMENTATION
#include "renderer/gpu/gpu.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define VALIDATION_LAYER "VK_LAYER_KHRONOS_validation"

void gpu_say(const struct gpu *gpu, enum gpu_log_level level, const char *format, ...)
{
    if (!gpu->log.write)
        return;
    char sentence[2048];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(sentence, sizeof sentence, format, arguments);
    va_end(arguments);
    gpu->log.write(gpu->log.user, (int)level, sentence);
}

static const char *result_name(VkResult result)
{
    switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
        return "out of host memory";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        return "out of device memory";
    case VK_ERROR_DEVICE_LOST:
        return "the device was lost";
    case VK_ERROR_INCOMPATIBLE_DRIVER:
        return "no compatible driver";
    case VK_ERROR_LAYER_NOT_PRESENT:
        return "a layer is not installed";
    case VK_ERROR_EXTENSION_NOT_PRESENT:
        return "an extension is not available";
    case VK_ERROR_SURFACE_LOST_KHR:
        return "the window's surface was lost";
    default:
        return NULL;
    }
}

bool gpu_check(const struct gpu *gpu, VkResult result, const char *call)
{
    if (result >= 0)
        return true;
    const char *name = result_name(result);
    if (name)
        gpu_say(gpu, GPU_ERROR, "%s failed: %s", call, name);
    else
        gpu_say(gpu, GPU_ERROR, "%s failed with VkResult %d", call, (int)result);
    return false;
}

static VKAPI_ATTR VkBool32 VKAPI_CALL heard(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                            VkDebugUtilsMessageTypeFlagsEXT type,
                                            const VkDebugUtilsMessengerCallbackDataEXT *data, void *user)
{
    (void)type;
    struct gpu *gpu = user;
    // The loader speaks here too, about files and layers of this machine; only the layer's own words count.
    if (data->pMessageIdName && strncmp(data->pMessageIdName, "Loader", 6) == 0)
        return VK_FALSE;
    gpu->validation_messages++;
    gpu_say(gpu, severity & VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT ? GPU_ERROR : GPU_WARNING,
            "validation: %s", data->pMessage);
    return VK_FALSE;
}

static bool layer_installed(const char *name)
{
    uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, NULL);
    VkLayerProperties *layers = calloc(count + 1, sizeof *layers);
    if (!layers)
        return false;
    vkEnumerateInstanceLayerProperties(&count, layers);
    bool found = false;
    for (uint32_t i = 0; i < count && !found; i++)
        found = strcmp(layers[i].layerName, name) == 0;
    free(layers);
    return found;
}

static bool create_instance(struct gpu *gpu, const struct gpu_desc *desc)
{
    if (volkInitialize() != VK_SUCCESS) {
        gpu_say(gpu, GPU_ERROR, "no Vulkan loader was found (libvulkan.so.1); install a Vulkan driver");
        return false;
    }
    if (volkGetInstanceVersion() < VK_API_VERSION_1_3) {
        gpu_say(gpu, GPU_ERROR, "the Vulkan loader is older than version 1.3; install a newer one");
        return false;
    }
    if (desc->validation && !layer_installed(VALIDATION_LAYER)) {
        gpu_say(gpu, GPU_ERROR, "the Vulkan validation layer is asked for but not installed");
        return false;
    }
    const char *extensions[16];
    uint32_t extension_count = 0;
    for (uint32_t i = 0; i < desc->instance_extension_count && extension_count < countof(extensions) - 1; i++)
        extensions[extension_count++] = desc->instance_extensions[i];
    if (desc->validation)
        extensions[extension_count++] = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    VkDebugUtilsMessengerCreateInfoEXT messenger = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity =
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType =
            VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT,
        .pfnUserCallback = heard,
        .pUserData = gpu,
    };
    const VkInstanceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
        .pNext = desc->validation ? &messenger : NULL,
        .pApplicationInfo = &(VkApplicationInfo){.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                                 .pApplicationName = "fovstudy",
                                                 .apiVersion = VK_API_VERSION_1_3},
        .enabledLayerCount = desc->validation ? 1 : 0,
        .ppEnabledLayerNames = (const char *const[]){VALIDATION_LAYER},
        .enabledExtensionCount = extension_count,
        .ppEnabledExtensionNames = extensions,
    };
    VkResult result = vkCreateInstance(&info, NULL, &gpu->instance);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER) {
        gpu_say(gpu, GPU_ERROR,
                "no Vulkan driver was found; install one (mesa-vulkan-drivers runs without a GPU)");
        return false;
    }
    if (!gpu_check(gpu, result, "vkCreateInstance"))
        return false;
    volkLoadInstanceOnly(gpu->instance);
    return !desc->validation ||
           VK(gpu, vkCreateDebugUtilsMessengerEXT(gpu->instance, &messenger, NULL, &gpu->messenger));
}

struct features {
    VkPhysicalDeviceFeatures2 core;
    VkPhysicalDeviceVulkan11Features v11;
    VkPhysicalDeviceVulkan12Features v12;
    VkPhysicalDeviceVulkan13Features v13;
};

static void link_features(struct features *f)
{
    f->core =
        (VkPhysicalDeviceFeatures2){.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &f->v11};
    f->v11 = (VkPhysicalDeviceVulkan11Features){.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES,
                                                .pNext = &f->v12};
    f->v12 = (VkPhysicalDeviceVulkan12Features){.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
                                                .pNext = &f->v13};
    f->v13 = (VkPhysicalDeviceVulkan13Features){.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
}

// The name of the first thing a device lacks that every mode needs, or NULL.
static const char *first_lack(VkPhysicalDevice physical, const VkPhysicalDeviceProperties *properties)
{
    if (properties->apiVersion < VK_API_VERSION_1_3)
        return "Vulkan 1.3";
    struct features has;
    link_features(&has);
    vkGetPhysicalDeviceFeatures2(physical, &has.core);
    const struct {
        VkBool32 has;
        const char *name;
    } needs[] = {
        {has.core.features.multiDrawIndirect, "multiDrawIndirect"},
        {has.core.features.drawIndirectFirstInstance, "drawIndirectFirstInstance"},
        {has.core.features.samplerAnisotropy, "samplerAnisotropy"},
        {has.v11.shaderDrawParameters, "shaderDrawParameters"},
        {has.v12.drawIndirectCount, "drawIndirectCount"},
        {has.v12.scalarBlockLayout, "scalarBlockLayout"},
        {has.v12.hostQueryReset, "hostQueryReset"},
        {has.core.features.shaderStorageImageExtendedFormats, "shaderStorageImageExtendedFormats"},
        {has.v13.dynamicRendering, "dynamicRendering"},
        {has.v13.maintenance4, "maintenance4"},
        {has.v13.synchronization2, "synchronization2"},
    };
    for (size_t i = 0; i < countof(needs); i++) {
        if (!needs[i].has)
            return needs[i].name;
    }
    return NULL;
}

static bool find_queue(const struct gpu *gpu, VkPhysicalDevice physical, uint32_t *out_family)
{
    VkQueueFamilyProperties families[32];
    uint32_t count = countof(families);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families);
    for (uint32_t i = 0; i < count; i++) {
        const VkQueueFlags needed = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
        VkBool32 presents = VK_TRUE;
        if (gpu->surface)
            vkGetPhysicalDeviceSurfaceSupportKHR(physical, i, gpu->surface, &presents);
        if ((families[i].queueFlags & needed) == needed && families[i].timestampValidBits && presents) {
            *out_family = i;
            return true;
        }
    }
    return false;
}

static int rank(VkPhysicalDeviceType type)
{
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return 4;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return 3;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return 2;
    default:
        return 1;
    }
}

static bool choose_device(struct gpu *gpu, const char *wanted)
{
    VkPhysicalDevice devices[16];
    uint32_t count = countof(devices);
    if (!VK(gpu, vkEnumeratePhysicalDevices(gpu->instance, &count, devices)))
        return false;
    if (count == 0) {
        gpu_say(gpu, GPU_ERROR,
                "no Vulkan device was found; install a driver (mesa-vulkan-drivers runs without a GPU)");
        return false;
    }
    char lacks[512] = "";
    int best = 0;
    for (uint32_t i = 0; i < count; i++) {
        VkPhysicalDeviceProperties properties;
        vkGetPhysicalDeviceProperties(devices[i], &properties);
        if (wanted && !strstr(properties.deviceName, wanted))
            continue;
        uint32_t family = 0;
        const char *lack = first_lack(devices[i], &properties);
        if (!lack && !find_queue(gpu, devices[i], &family))
            lack = "a queue that draws, computes, keeps time and presents";
        if (lack) {
            size_t used = strlen(lacks);
            snprintf(lacks + used, sizeof lacks - used, "%s%s lacks %s", used ? "; " : "",
                     properties.deviceName, lack);
        } else if (rank(properties.deviceType) > best) {
            best = rank(properties.deviceType);
            gpu->physical = devices[i];
            gpu->queue_family = family;
        }
    }
    if (best)
        return true;
    if (lacks[0])
        gpu_say(gpu, GPU_ERROR, "no Vulkan device has all that is needed: %s", lacks);
    else
        gpu_say(gpu, GPU_ERROR, "no Vulkan device's name contains '%s'", wanted);
    return false;
}

static bool create_device(struct gpu *gpu)
{
    struct features has, use;
    link_features(&has);
    link_features(&use);
    vkGetPhysicalDeviceFeatures2(gpu->physical, &has.core);
    use.core.features = (VkPhysicalDeviceFeatures){
        .multiDrawIndirect = VK_TRUE,
        .drawIndirectFirstInstance = VK_TRUE,
        .samplerAnisotropy = VK_TRUE,
        .shaderStorageImageExtendedFormats = VK_TRUE,
        .shaderInt64 = has.core.features.shaderInt64,
        .fragmentStoresAndAtomics = has.core.features.fragmentStoresAndAtomics,
    };
    use.v11.shaderDrawParameters = VK_TRUE;
    use.v11.multiview = has.v11.multiview;
    use.v12.drawIndirectCount = VK_TRUE;
    use.v12.shaderOutputLayer = has.v12.shaderOutputLayer;
    use.v12.scalarBlockLayout = VK_TRUE;
    use.v12.hostQueryReset = VK_TRUE;
    use.v12.shaderBufferInt64Atomics = has.v12.shaderBufferInt64Atomics;
    use.v13.dynamicRendering = VK_TRUE;
    use.v13.synchronization2 = VK_TRUE;
    use.v13.maintenance4 = VK_TRUE;
    // Mesa's software driver puts triangles that it clips for the second view into the first view's layer: it
    // collects clipped triangles beyond the change of the view (its draw_pipe_vbuf.c; seen in 22.3.6).
    gpu->multiview = has.v11.multiview && gpu->driver.driverID != VK_DRIVER_ID_MESA_LLVMPIPE;
    gpu->output_layer = has.v12.shaderOutputLayer;
    gpu->int64_atomics = has.core.features.shaderInt64 && has.v12.shaderBufferInt64Atomics;
    VkPhysicalDeviceFragmentShadingRateFeaturesKHR rate = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FRAGMENT_SHADING_RATE_FEATURES_KHR,
        .attachmentFragmentShadingRate = VK_TRUE};
    const char *extensions[2];
    uint32_t extension_count = 0;
    if (gpu->surface)
        extensions[extension_count++] = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    gpu->shading_rate = gpu_shading_rate_of(gpu->physical);
    if (gpu->shading_rate.texel) {
        extensions[extension_count++] = VK_KHR_FRAGMENT_SHADING_RATE_EXTENSION_NAME;
        use.v13.pNext = &rate;
    }
    const VkDeviceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
        .pNext = &use.core,
        .queueCreateInfoCount = 1,
        .pQueueCreateInfos = &(VkDeviceQueueCreateInfo){.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                                        .queueFamilyIndex = gpu->queue_family,
                                                        .queueCount = 1,
                                                        .pQueuePriorities = (const float[]){1}},
        .enabledExtensionCount = extension_count,
        .ppEnabledExtensionNames = extensions,
    };
    if (!VK(gpu, vkCreateDevice(gpu->physical, &info, NULL, &gpu->device)))
        return false;
    volkLoadDevice(gpu->device);
    vkGetDeviceQueue(gpu->device, gpu->queue_family, 0, &gpu->queue);
    return true;
}

static bool create_pools(struct gpu *gpu)
{
    const VkCommandPoolCreateInfo commands = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                              .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                              .queueFamilyIndex = gpu->queue_family};
    const VkDescriptorPoolSize sizes[] = {
        {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 32768},
        {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 8192},
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 16384},
        {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 8192},
    };
    const VkDescriptorPoolCreateInfo descriptors = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                                    .flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT,
                                                    .maxSets = 8192,
                                                    .poolSizeCount = countof(sizes),
                                                    .pPoolSizes = sizes};
    return VK(gpu, vkCreateCommandPool(gpu->device, &commands, NULL, &gpu->pool)) &&
           VK(gpu, vkCreateDescriptorPool(gpu->device, &descriptors, NULL, &gpu->descriptors));
}

// 8 on a GPU; none on a software driver, where 8 makes the G-buffer of Sponza five times as slow (measured
// 2026-11-25, Mesa 22.3, 640x720).
static void choose_anisotropy(struct gpu *gpu, float wanted)
{
    const float most = gpu->properties.limits.maxSamplerAnisotropy;
    const bool software = gpu->properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    const float chosen = wanted > 0 ? wanted : software ? 1 : 8;
    gpu->anisotropy = chosen < most ? chosen : most;
}

struct gpu *gpu_create(const struct gpu_desc *desc)
{
    struct gpu *gpu = calloc(1, sizeof *gpu);
    if (!gpu)
        return NULL;
    gpu->log = desc->log;
    if (!create_instance(gpu, desc))
        goto error;
    if (desc->create_surface &&
        !gpu_check(gpu, (VkResult)desc->create_surface(desc->surface_user, gpu->instance, &gpu->surface),
                   "creating the window's surface"))
        goto error;
    if (!choose_device(gpu, desc->device))
        goto error;
    gpu->driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
    VkPhysicalDeviceProperties2 properties = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                              .pNext = &gpu->driver};
    vkGetPhysicalDeviceProperties2(gpu->physical, &properties);
    gpu->driver.pNext = NULL;
    gpu->properties = properties.properties;
    vkGetPhysicalDeviceMemoryProperties(gpu->physical, &gpu->memory);
    choose_anisotropy(gpu, desc->anisotropy);
    if (!create_device(gpu) || !create_pools(gpu))
        goto error;
    return gpu;
error:
    gpu_destroy(gpu);
    return NULL;
}

void gpu_destroy(struct gpu *gpu)
{
    if (!gpu)
        return;
    if (gpu->device) {
        vkDeviceWaitIdle(gpu->device);
        vkDestroyDescriptorPool(gpu->device, gpu->descriptors, NULL);
        vkDestroyCommandPool(gpu->device, gpu->pool, NULL);
        vkDestroyDevice(gpu->device, NULL);
    }
    if (gpu->instance) {
        if (gpu->surface)
            vkDestroySurfaceKHR(gpu->instance, gpu->surface, NULL);
        if (gpu->messenger)
            vkDestroyDebugUtilsMessengerEXT(gpu->instance, gpu->messenger, NULL);
        vkDestroyInstance(gpu->instance, NULL);
    }
    free(gpu);
}

void gpu_name(const struct gpu *gpu, VkObjectType type, uint64_t handle, const char *name)
{
    if (gpu->messenger && name)
        vkSetDebugUtilsObjectNameEXT(gpu->device,
                                     &(VkDebugUtilsObjectNameInfoEXT){
                                         .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                                         .objectType = type,
                                         .objectHandle = handle,
                                         .pObjectName = name,
                                     });
}
