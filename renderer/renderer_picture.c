// Pictures that were made earlier: uploaded and shown as if they had been drawn now.
#include "renderer/renderer_private.h"

#include <stdlib.h>

enum { BUFFERS = 16 };

struct renderer_picture {
    struct gpu *gpu;
    struct gpu_image image; // both eyes; as an option's colour
    bool filled;
    struct gpu_buffer buffers[BUFFERS];
    uint32_t buffer_count;
};

struct renderer_picture *renderer_picture_create(struct renderer *r, uint32_t buffers)
{
    struct renderer_picture *p = calloc(1, sizeof *p);
    const struct gpu_image_desc image = {.name = "picture",
                                         .format = VK_FORMAT_R8G8B8A8_UNORM,
                                         .width = r->width,
                                         .height = r->height,
                                         .layers = 2,
                                         .array = true,
                                         .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT};
    const VkDeviceSize size = (VkDeviceSize)8 * r->width * r->height;
    if (!p || buffers < 1 || buffers > BUFFERS) {
        free(p);
        return NULL;
    }
    p->gpu = r->gpu;
    bool ok = gpu_image_create(r->gpu, &image, &p->image);
    for (; ok && p->buffer_count < buffers; p->buffer_count++)
        ok = gpu_buffer_create(r->gpu, "picture buffer", size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, GPU_HOST,
                               &p->buffers[p->buffer_count]);
    if (ok)
        return p;
    renderer_picture_destroy(p);
    return NULL;
}

void renderer_picture_destroy(struct renderer_picture *p)
{
    if (!p)
        return;
    vkDeviceWaitIdle(p->gpu->device);
    gpu_image_destroy(p->gpu, &p->image);
    for (uint32_t i = 0; i < BUFFERS; i++)
        gpu_buffer_destroy(p->gpu, &p->buffers[i]);
    free(p);
}

uint8_t *renderer_picture_buffer(struct renderer_picture *p, uint32_t buffer)
{
    return p->buffers[buffer].mapped;
}

static void upload(struct renderer_picture *p, VkCommandBuffer cmd, uint32_t buffer)
{
    const VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 2},
                                    .imageExtent = {p->image.width, p->image.height, 1}};
    if (!p->filled)
        gpu_image_layout(cmd, &p->image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    p->filled = true;
    vkCmdCopyBufferToImage(cmd, p->buffers[buffer].buffer, p->image.image, VK_IMAGE_LAYOUT_GENERAL, 1, &copy);
}

bool renderer_show_picture(struct renderer *r, struct renderer_picture *p, int buffer, double fade)
{
    if (!gpu_frame_begin(&r->frame))
        return false;
    if (buffer >= 0) {
        VkCommandBuffer cmd = gpu_timer_begin(&r->frame, "upload");
        upload(p, cmd, (uint32_t)buffer); // screen_record's barrier makes it visible
        gpu_timer_end(&r->frame);
    }
    return renderer_show_image(r, p->filled ? &p->image : NULL, fade);
}
