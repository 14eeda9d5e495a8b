// A Vulkan 1.3 device, its memory and its pipelines: thin and plain.
//
// Use: gpu_create -> buffers, images, kernels -> gpu_frame_begin ... gpu_frame_end (frame.h) -> gpu_destroy.
// Everything here runs on one thread and one queue; a frame is waited for before the next begins.
// Functions that can fail return false or NULL after one sentence to the log. Destroy functions accept zeroed
// objects.
#ifndef RENDERER_GPU_GPU_H
#define RENDERER_GPU_GPU_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <volk.h>

#define countof(array) ((uint32_t)(sizeof(array) / sizeof((array)[0])))

enum gpu_log_level { GPU_ERROR, GPU_WARNING, GPU_INFO };

struct gpu_log {
    void (*write)(void *user, int level, const char *sentence);
    void *user;
};

struct gpu_desc {
    struct gpu_log log;
    const char *device; // part of the name; NULL: best
    bool validation;
    float anisotropy; // of textures; 0: what suits the device
    int (*create_surface)(void *user, void *instance, void *out_surface);
    void *surface_user;
    const char *const *instance_extensions;
    uint32_t instance_extension_count;
};

// What VK_KHR_fragment_shading_rate offers for a map of rates (an attachment).
struct gpu_shading_rate {
    uint32_t texel;   // pixels a side that one texel of the map stands for; 0: the device cannot
    uint32_t largest; // pixels a side of the coarsest square fragment: 2 or 4
};

struct gpu {
    struct gpu_log log;
    VkInstance instance;
    VkDebugUtilsMessengerEXT messenger;
    VkSurfaceKHR surface; // VK_NULL_HANDLE when headless
    VkPhysicalDevice physical;
    VkPhysicalDeviceProperties properties;
    VkPhysicalDeviceDriverProperties driver;
    VkPhysicalDeviceMemoryProperties memory;
    bool int64_atomics; // 64-bit atomics on storage buffers
    bool multiview;     // one draw goes to several layers, and rightly
    bool output_layer;  // a vertex shader chooses the layer
    struct gpu_shading_rate shading_rate;
    float anisotropy; // of textures, 1: none
    VkDevice device;
    VkQueue queue;
    uint32_t queue_family;
    VkCommandPool pool;
    VkDescriptorPool descriptors;
    uint64_t allocated;           // bytes of device memory now held
    uint32_t validation_messages; // warnings and errors of the validation layer so far
};

struct gpu *gpu_create(const struct gpu_desc *desc);
void gpu_destroy(struct gpu *gpu);

// Logs one formatted sentence.
void gpu_say(const struct gpu *gpu, enum gpu_log_level level, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

// True on success; otherwise logs the call's text and the result's name.
bool gpu_check(const struct gpu *gpu, VkResult result, const char *call);
#define VK(gpu, call) gpu_check((gpu), (call), #call)

void gpu_name(const struct gpu *gpu, VkObjectType type, uint64_t handle, const char *name);

// --- variable rate shading ---

struct gpu_shading_rate gpu_shading_rate_of(VkPhysicalDevice physical);
// A map's value for fragments of width x height, powers of two: log2(width) << 2 | log2(height).
uint32_t gpu_shading_rate_code(uint32_t width, uint32_t height);
// 4 where 4x4 is offered without multisampling, else 2.
uint32_t gpu_shading_rate_largest(const VkPhysicalDeviceFragmentShadingRateKHR *rates, uint32_t count);
// The texel's side nearest to 8 that lies in the device's range; 0: there is no square one.
uint32_t gpu_shading_rate_texel(VkExtent2D least, VkExtent2D most);

// --- memory ---

struct gpu_buffer {
    VkBuffer buffer;
    VkDeviceMemory memory;
    VkDeviceSize size;
    void *mapped; // NULL for device memory
};

enum gpu_buffer_kind { GPU_DEVICE, GPU_HOST }; // GPU_HOST: mapped, coherent

bool gpu_buffer_create(struct gpu *gpu, const char *name, VkDeviceSize size, VkBufferUsageFlags usage,
                       enum gpu_buffer_kind kind, struct gpu_buffer *out);
void gpu_buffer_destroy(struct gpu *gpu, struct gpu_buffer *buffer);
// Device memory filled from the CPU through a staging buffer; waits.
bool gpu_buffer_create_filled(struct gpu *gpu, const char *name, const void *data, VkDeviceSize size,
                              VkBufferUsageFlags usage, struct gpu_buffer *out);

struct gpu_image {
    VkImage image;
    VkDeviceMemory memory;
    VkDeviceSize bytes;
    VkFormat format;
    uint32_t width, height, levels, layers;
    VkImageView view;           // all levels and layers; 2D, or 2D array where `array`
    VkImageView layer_views[2]; // level 0 of one layer, for attachments; null for other images
};

struct gpu_image_desc {
    const char *name;
    VkFormat format;
    uint32_t width, height;
    uint32_t levels; // 0: 1
    uint32_t layers; // 0: 1; at most 2
    bool array;      // view as 2D array
    VkImageUsageFlags usage;
};

bool gpu_image_create(struct gpu *gpu, const struct gpu_image_desc *desc, struct gpu_image *out);
void gpu_image_destroy(struct gpu *gpu, struct gpu_image *image);
// Fills all levels of a single-layer rgba8 image from tightly packed levels and leaves it readable by shaders.
bool gpu_image_fill(struct gpu *gpu, struct gpu_image *image, const uint8_t *rgba);
// A view of one mip level of all layers; destroyed by the caller.
VkImageView gpu_image_level_view(struct gpu *gpu, const struct gpu_image *image, uint32_t level);

// --- one-off commands, outside a frame ---

VkCommandBuffer gpu_once_begin(struct gpu *gpu);
bool gpu_once_end(struct gpu *gpu, VkCommandBuffer cmd); // submits and waits

// --- pipelines ---

enum { GPU_BINDINGS = 16, GPU_ATTACHMENTS = 8 };

struct gpu_code {
    const uint32_t *words;
    size_t bytes;
};

struct gpu_binding {
    VkDescriptorType type;
    VkShaderStageFlags stages; // 0: compute
    bool absent;               // this variant of the shader has no such binding
};

// A compute pipeline with one descriptor set; bindings are numbered from 0.
struct gpu_kernel {
    VkPipeline pipeline;
    VkPipelineLayout layout;
    VkDescriptorSetLayout set_layout;
};

struct gpu_kernel_desc {
    const char *name;
    struct gpu_code code;
    const struct gpu_binding *bindings;
    uint32_t binding_count;
    uint32_t push_bytes;
    const int32_t *constants; // specialisation constants 0, 1, ... (int, or bool as 0 and 1)
    uint32_t constant_count;
};

bool gpu_kernel_create(struct gpu *gpu, const struct gpu_kernel_desc *desc, struct gpu_kernel *out);
void gpu_kernel_destroy(struct gpu *gpu, struct gpu_kernel *kernel);

// One resource of a descriptor set, in binding order: a buffer, or a view (with a sampler). All zero: left
// unset, for a binding that the shader's variant does not have.
struct gpu_resource {
    const struct gpu_buffer *buffer;
    VkImageView view;
    VkSampler sampler;
    VkImageLayout layout; // 0: GENERAL
};

// A descriptor set of a layout; freed with the pool or by gpu_set_free. Null on failure.
VkDescriptorSet gpu_set_create(struct gpu *gpu, VkDescriptorSetLayout layout,
                               const struct gpu_binding *bindings, const struct gpu_resource *resources,
                               uint32_t count);
void gpu_set_free(struct gpu *gpu, VkDescriptorSet set);
VkDescriptorSetLayout gpu_set_layout_create(struct gpu *gpu, const struct gpu_binding *bindings,
                                            uint32_t count);

void gpu_dispatch(VkCommandBuffer cmd, const struct gpu_kernel *kernel, VkDescriptorSet set, const void *push,
                  uint32_t push_bytes, uint32_t groups_x, uint32_t groups_y, uint32_t groups_z);
// The group counts are the buffer's first three words.
void gpu_dispatch_indirect(VkCommandBuffer cmd, const struct gpu_kernel *kernel, VkDescriptorSet set,
                           const void *push, uint32_t push_bytes, const struct gpu_buffer *groups);

struct gpu_raster_desc {
    const char *name;
    struct gpu_code vertex, fragment; // fragment.words NULL: depth only
    VkPipelineLayout layout;
    bool points;                                           // instead of triangles
    const VkVertexInputBindingDescription *vertex_binding; // NULL: no vertex input
    const VkVertexInputAttributeDescription *attributes;
    uint32_t attribute_count;
    const VkFormat *colour_formats;
    uint32_t colour_count;
    VkFormat depth_format; // 0: none
    VkCompareOp depth_compare;
    uint32_t view_mask;       // layers that every draw goes to, gl_ViewIndex by gl_ViewIndex; 0: no multiview
    bool keep_depth;          // tested, not written
    bool shading_rate;        // drawn with a map of rates attached, which decides alone
    float slope_bias;         // depth added per depth slope a pixel; 0: none
    const int32_t *constants; // for both stages
    uint32_t constant_count;
};

// Viewport, scissor, cull mode and front face are dynamic.
VkPipeline gpu_raster_create(struct gpu *gpu, const struct gpu_raster_desc *desc);

// Mip levels are blended where `min` is linear. anisotropy 1: none.
VkSampler gpu_sampler_create(struct gpu *gpu, VkFilter min, VkFilter mag, VkSamplerAddressMode u,
                             VkSamplerAddressMode v, float anisotropy);
// Compares depths, LESS_OR_EQUAL, and blends the four answers where the device can; beyond the image everything
// passes.
VkSampler gpu_sampler_create_compare(struct gpu *gpu);
// Unfiltered and clamped, for images read pixel by pixel.
VkSampler gpu_sampler_create_plain(struct gpu *gpu);

// --- barriers ---

// Everything before, of any kind, is finished and visible to everything after. Layouts stay as they are.
void gpu_barrier(VkCommandBuffer cmd, VkPipelineStageFlags2 from, VkPipelineStageFlags2 to);
void gpu_image_layout(VkCommandBuffer cmd, const struct gpu_image *image, VkImageLayout from, VkImageLayout to);

#endif
