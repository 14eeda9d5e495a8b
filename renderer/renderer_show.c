// Screen, overlay, and what the CPU reads back.
#include "renderer/renderer_private.h"
#include "renderer/shared/shared.h"

#include <math.h>
#include <string.h>

bool renderer_set_overlay(struct renderer *r, const struct renderer_overlay *overlay)
{
    if (!overlay)
        return screen_set_overlay(&r->screen, NULL, 0, 0, NULL, NULL);
    return screen_set_overlay(&r->screen, overlay->rgba, overlay->width, overlay->height, overlay->left,
                              overlay->top);
}

_Static_assert((int)RENDERER_MARKS == (int)SCREEN_MARKS, "the screen takes as many");

static bool fill_mark(const struct renderer_mark *mark, struct shared_mark *out)
{
    *out =
        (struct shared_mark){.kind = mark->kind == RENDERER_MARK_BALL ? SHARED_MARK_BALL : SHARED_MARK_CROSS};
    memcpy(out->colour, mark->colour, sizeof out->colour);
    out->fade = (float)fmin(fmax(mark->fade, 0), 1);
    for (int eye = 0; eye < EYES; eye++) {
        const struct viewing_disc *d = &mark->place[eye];
        if (!(mark->opacity[eye] > 0))
            continue;
        if (!isfinite(d->x_px + d->y_px + d->unit_from_px[0][0] + d->unit_from_px[0][1] +
                      d->unit_from_px[1][0] + d->unit_from_px[1][1]))
            return false;
        out->eyes[eye] = (struct shared_mark_eye){
            .centre = {(float)d->x_px, (float)d->y_px},
            .unit_from_x = {(float)d->unit_from_px[0][0], (float)d->unit_from_px[1][0]},
            .unit_from_y = {(float)d->unit_from_px[0][1], (float)d->unit_from_px[1][1]},
            .opacity = (float)fmin(mark->opacity[eye], 1)};
    }
    return true;
}

bool renderer_set_marks(struct renderer *r, const struct renderer_mark *marks, uint32_t count)
{
    struct shared_mark filled[RENDERER_MARKS];
    for (uint32_t i = 0; i < count && i < RENDERER_MARKS; i++)
        if (!fill_mark(&marks[i], &filled[i])) {
            renderer_relay(r, RENDERER_ERROR, "a mark's place is not finite");
            return false;
        }
    if (count > RENDERER_MARKS) {
        renderer_relay(r, RENDERER_ERROR, "more marks are asked for than RENDERER_MARKS");
        return false;
    }
    screen_set_marks(&r->screen, filled, count);
    return true;
}

bool renderer_show(struct renderer *r, struct renderer_option *option, double fade)
{
    return gpu_frame_begin(&r->frame) &&
           renderer_show_image(r, option && option->drawn ? option->result.colour : NULL, fade);
}

bool renderer_show_image(struct renderer *r, const struct gpu_image *colour, double fade)
{
    VkCommandBuffer cmd = gpu_timer_begin(&r->frame, "screen");
    screen_record(&r->screen, cmd, colour, (float)fade);
    gpu_timer_end(&r->frame);
    return gpu_frame_end(&r->frame) && (!r->present || gpu_present_show(r->present, &r->screen.image));
}

void renderer_resized(struct renderer *r)
{
    if (r->present)
        gpu_present_resized(r->present);
}

// Copies a rectangle of one layer to the CPU.
static bool read_image(struct renderer *r, const struct gpu_image *image, uint32_t layer, uint32_t left,
                       uint32_t bytes, uint8_t *out)
{
    struct gpu_buffer staging;
    const VkDeviceSize size = (VkDeviceSize)r->width * r->height * bytes;
    if (!gpu_buffer_create(r->gpu, "read back", size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, GPU_HOST, &staging))
        return false;
    VkCommandBuffer cmd = gpu_once_begin(r->gpu);
    bool ok = cmd;
    if (cmd) {
        const VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, layer, 1},
                                        .imageOffset = {(int32_t)left, 0, 0},
                                        .imageExtent = {r->width, r->height, 1}};
        gpu_barrier(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_2_COPY_BIT);
        vkCmdCopyImageToBuffer(cmd, image->image, VK_IMAGE_LAYOUT_GENERAL, staging.buffer, 1, &copy);
        gpu_barrier(cmd, VK_PIPELINE_STAGE_2_COPY_BIT, VK_PIPELINE_STAGE_2_HOST_BIT);
        ok = gpu_once_end(r->gpu, cmd);
    }
    if (ok)
        memcpy(out, staging.mapped, size);
    gpu_buffer_destroy(r->gpu, &staging);
    return ok;
}

bool renderer_read(struct renderer_option *o, int eye, uint8_t *out_rgba)
{
    return o->drawn && read_image(o->renderer, o->result.colour, (uint32_t)eye, 0, 4, out_rgba);
}

bool renderer_read_screen(struct renderer *r, int eye, uint8_t *out_rgba)
{
    return r->screen.used && read_image(r, &r->screen.image, 0, (uint32_t)eye * r->width, 4, out_rgba);
}

bool renderer_read_motion(struct renderer_option *o, int eye, float *out_xyzw)
{
    return o->drawn && o->result.motion &&
           read_image(o->renderer, o->result.motion, (uint32_t)eye, 0, 4 * sizeof(float), (uint8_t *)out_xyzw);
}

bool renderer_read_redraw_map(struct renderer_option *o, int eye, uint8_t *out)
{
    const size_t count = (size_t)o->renderer->width * o->renderer->height;
    if (!o->drawn)
        return false;
    if (!o->result.redraw_map) {
        memset(out, 255, count);
        return true;
    }
    if (!read_image(o->renderer, o->result.redraw_map, (uint32_t)eye, 0, 1, out))
        return false;
    for (size_t i = 0; i < count; i++)
        out[i] = out[i] ? 255 : 0;
    return true;
}
