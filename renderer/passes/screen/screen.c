#include "renderer/passes/screen/screen.h"

#include "renderer/shared/shared.h"

#include "screen.comp.h"
#include "screen.comp_colour.h"

#include <string.h>

enum { COLOUR = 3, BINDINGS };

// The colour is absent for gray.
static void fill_bindings(struct gpu_binding out[BINDINGS], bool coloured)
{
    out[0] = (struct gpu_binding){.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};          // screen
    out[1] = (struct gpu_binding){.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}; // overlay
    out[2] = (struct gpu_binding){.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};         // marks
    out[COLOUR] = (struct gpu_binding){.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, .absent = !coloured};
}

struct screen_push {
    uint32_t width, height;
    int32_t left[2], top[2];
    uint32_t overlay_width, overlay_height; // 0: none
    float fade;
    uint32_t mark_count;
};

static bool create_overlay(struct screen *s, uint32_t width, uint32_t height)
{
    const struct gpu_image_desc desc = {.name = "overlay",
                                        .format = VK_FORMAT_R8G8B8A8_UNORM,
                                        .width = width,
                                        .height = height,
                                        .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT};
    s->overlay_used = false;
    return gpu_image_create(s->gpu, &desc, &s->overlay) &&
           gpu_buffer_create(s->gpu, "overlay staging", 4 * (VkDeviceSize)width * height,
                             VK_BUFFER_USAGE_TRANSFER_SRC_BIT, GPU_HOST, &s->staging);
}

static void destroy_overlay(struct screen *s)
{
    gpu_image_destroy(s->gpu, &s->overlay);
    gpu_buffer_destroy(s->gpu, &s->staging);
}

bool screen_init(struct screen *s, struct gpu *gpu, uint32_t width, uint32_t height)
{
    *s = (struct screen){.gpu = gpu, .width = width, .height = height};
    const struct gpu_image_desc image = {.name = "screen",
                                         .format = VK_FORMAT_R8G8B8A8_UNORM,
                                         .width = 2 * width,
                                         .height = height,
                                         .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
    struct gpu_binding bindings[BINDINGS];
    fill_bindings(bindings, false);
    struct gpu_kernel_desc kernel = {.name = "screen",
                                     .code = {screen_comp, sizeof screen_comp},
                                     .bindings = bindings,
                                     .binding_count = BINDINGS,
                                     .push_bytes = sizeof(struct screen_push)};
    s->sampler = gpu_sampler_create_plain(gpu);
    if (!s->sampler || !gpu_image_create(gpu, &image, &s->image) ||
        !gpu_buffer_create(gpu, "marks", SCREEN_MARKS * sizeof(struct shared_mark),
                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, GPU_HOST, &s->marks) ||
        !gpu_kernel_create(gpu, &kernel, &s->gray))
        return false;
    fill_bindings(bindings, true);
    kernel.code = (struct gpu_code){screen_comp_colour, sizeof screen_comp_colour};
    return gpu_kernel_create(gpu, &kernel, &s->coloured) && create_overlay(s, 1, 1);
}

void screen_finish(struct screen *s)
{
    if (!s->gpu)
        return;
    gpu_set_free(s->gpu, s->set);
    gpu_kernel_destroy(s->gpu, &s->gray);
    gpu_kernel_destroy(s->gpu, &s->coloured);
    gpu_image_destroy(s->gpu, &s->image);
    gpu_buffer_destroy(s->gpu, &s->marks);
    destroy_overlay(s);
    vkDestroySampler(s->gpu->device, s->sampler, NULL);
    *s = (struct screen){0};
}

static uint32_t larger(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

// As large as an eye from the first text on, so that nothing is made for those that come during a trial.
static bool make_room(struct screen *s, uint32_t width, uint32_t height)
{
    width = larger(larger(width, s->width), s->overlay.width);
    height = larger(larger(height, s->height), s->overlay.height);
    if (width == s->overlay.width && height == s->overlay.height)
        return true;
    destroy_overlay(s);
    return create_overlay(s, width, height);
}

bool screen_set_overlay(struct screen *s, const uint8_t *rgba, uint32_t width, uint32_t height,
                        const int32_t left[2], const int32_t top[2])
{
    s->overlay_width = s->overlay_height = 0;
    if (!rgba)
        return true;
    if (!make_room(s, width, height))
        return false;
    memcpy(s->staging.mapped, rgba, 4 * (size_t)width * height);
    for (int eye = 0; eye < 2; eye++) {
        s->left[eye] = left[eye];
        s->top[eye] = top[eye];
    }
    s->overlay_width = width;
    s->overlay_height = height;
    s->overlay_new = true;
    return true;
}

void screen_set_marks(struct screen *s, const struct shared_mark *marks, uint32_t count)
{
    s->mark_count = count < SCREEN_MARKS ? count : SCREEN_MARKS;
    if (s->mark_count) // frames are waited for, so none reads them now
        memcpy(s->marks.mapped, marks, s->mark_count * sizeof *marks);
}

static void bring_overlay(struct screen *s, VkCommandBuffer cmd)
{
    if (!s->overlay_used)
        gpu_image_layout(cmd, &s->overlay, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    s->overlay_used = true;
    if (s->overlay_new && s->overlay_width && s->overlay_height) {
        const VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                        .imageExtent = {s->overlay_width, s->overlay_height, 1}};
        vkCmdCopyBufferToImage(cmd, s->staging.buffer, s->overlay.image, VK_IMAGE_LAYOUT_GENERAL, 1, &copy);
    }
    s->overlay_new = false;
}

void screen_record(struct screen *s, VkCommandBuffer cmd, const struct gpu_image *colour, float fade)
{
    // Frames are waited for, so the last set is no longer read; images differ from call to call.
    gpu_set_free(s->gpu, s->set);
    const struct gpu_resource resources[] = {
        {.view = s->image.view},
        {.view = s->overlay.view, .sampler = s->sampler},
        {.buffer = &s->marks},
        {.view = colour ? colour->view : VK_NULL_HANDLE},
    };
    struct gpu_binding bindings[BINDINGS];
    fill_bindings(bindings, colour != NULL);
    const struct gpu_kernel *kernel = colour ? &s->coloured : &s->gray;
    s->set = gpu_set_create(s->gpu, kernel->set_layout, bindings, resources, countof(bindings));
    if (!s->used)
        gpu_image_layout(cmd, &s->image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    s->used = true;
    bring_overlay(s, cmd);
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
    const struct screen_push push = {
        s->width,
        s->height,
        {s->left[0], s->left[1]},
        {s->top[0], s->top[1]},
        s->overlay_width,
        s->overlay_height,
        fade,
        s->mark_count,
    };
    gpu_dispatch(cmd, kernel, s->set, &push, sizeof push, (s->width + SHARED_TILE - 1) / SHARED_TILE,
                 (s->height + SHARED_TILE - 1) / SHARED_TILE, 2);
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
}
