#include "renderer/renderer.h"

#include "renderer/gpu/frame.h"
#include "renderer/modes/room.h"
#include "renderer/passes/screen/screen.h"
#include "renderer/passes/shadow/shadow.h"
#include "renderer/scene/scene_gpu.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

struct renderer {
    struct renderer_log log;
    struct renderer_device device;
    uint32_t width, height;
    struct gpu *gpu;
    struct gpu_frame frame;
    struct gpu_present *present; // NULL when headless
    struct screen screen;
};

struct renderer_scene {
    struct renderer *renderer;
    struct scene_gpu *gpu;
    struct shadow shadow; // of the sun; without a map where there is none
};

struct renderer_option {
    struct renderer *renderer;
    struct renderer_scene *scene;
    const struct mode *mode;
    struct mode_state *state;
    struct gpu_buffer constants; // shared_frame
    struct gpu_buffer counters;  // shared_counters
    struct mode_explanation explanation;
    struct mode_result result; // of the last frame
    bool drawn;
    uint64_t last_number;
    double last_animation_s;
    bool last_moving;
    struct frame_eye last_eyes[EYES];
    struct renderer_settings settings;
    struct dvec3 last_origin;
};

static void relay(void *user, int level, const char *sentence)
{
    const struct renderer *r = user;
    if (r->log.write)
        r->log.write(r->log.user, (enum renderer_log_level)level, sentence);
}

struct renderer *renderer_create(const struct renderer_desc *desc)
{
    struct renderer *r = calloc(1, sizeof *r);
    if (!r)
        return NULL;
    r->log = desc->log;
    r->width = desc->width;
    r->height = desc->height;
    if (r->width < 16 || r->height < 16 || r->width > 16384 || r->height > 16384) {
        relay(r, RENDERER_ERROR, "an eye's size must be from 16x16 to 16384x16384 pixels");
        goto error;
    }
    r->gpu = gpu_create(&(struct gpu_desc){.log = {relay, r},
                                           .device = desc->device,
                                           .validation = desc->validation,
                                           .anisotropy = desc->anisotropy,
                                           .create_surface = desc->create_surface,
                                           .surface_user = desc->surface_user,
                                           .instance_extensions = desc->instance_extensions,
                                           .instance_extension_count = desc->instance_extension_count});
    if (!r->gpu)
        goto error;
    snprintf(r->device.name, sizeof r->device.name, "%s", r->gpu->properties.deviceName);
    snprintf(r->device.driver, sizeof r->device.driver, "%s %s", r->gpu->driver.driverName,
             r->gpu->driver.driverInfo);
    r->device.software = r->gpu->properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    if (!gpu_frame_init(&r->frame, r->gpu, desc->pass_times) ||
        !screen_init(&r->screen, r->gpu, r->width, r->height))
        goto error;
    if (desc->create_surface && !(r->present = gpu_present_create(r->gpu)))
        goto error;
    return r;
error:
    renderer_destroy(r);
    return NULL;
}

void renderer_destroy(struct renderer *r)
{
    if (!r)
        return;
    gpu_present_destroy(r->present);
    screen_finish(&r->screen);
    gpu_frame_finish(&r->frame);
    gpu_destroy(r->gpu);
    free(r);
}

const struct renderer_device *renderer_device(const struct renderer *r)
{
    return &r->device;
}

uint32_t renderer_validation_messages(const struct renderer *r)
{
    return r->gpu->validation_messages;
}

struct renderer_scene *renderer_scene_create(struct renderer *r, const struct scene *scene)
{
    struct renderer_scene *s = calloc(1, sizeof *s);
    if (!s)
        return NULL;
    s->renderer = r;
    s->gpu = scene_gpu_create(r->gpu, scene);
    if (s->gpu && shadow_init(&s->shadow, r->gpu, s->gpu))
        return s;
    renderer_scene_destroy(s);
    return NULL;
}

void renderer_scene_destroy(struct renderer_scene *scene)
{
    if (!scene)
        return;
    shadow_finish(&scene->shadow);
    scene_gpu_destroy(scene->gpu);
    free(scene);
}

static void explain_textures(struct renderer_option *o)
{
    const struct scene *scene = o->scene->gpu->scene;
    const double anisotropy = (double)o->renderer->gpu->anisotropy;
    if (scene->texture_count && anisotropy > 1)
        mode_explain(&o->explanation, 0, "textures are filtered anisotropically, %g to 1", anisotropy);
    else if (scene->texture_count)
        mode_explain(
            &o->explanation, 0,
            "textures are filtered isotropically, since the device is a software driver or 1 was asked for");
}

static void explain_shadow(struct renderer_option *o)
{
    const struct shadow *s = &o->scene->shadow;
    if (s->map.view)
        mode_explain(&o->explanation, s->map.bytes,
                     "sun shadows of what stands still, drawn once with the scene, %ux%u texels of %.1f cm",
                     s->map.width, s->map.height, 100 * s->texel_m);
    else
        mode_explain(&o->explanation, 0, "no sun shadows, there is no sun or nothing stands still");
}

struct renderer_option *renderer_option_create(struct renderer *r, struct renderer_scene *scene,
                                               const struct mode_choice *choice,
                                               const struct renderer_settings *settings)
{
    char why[512];
    if ((choice->mode->supported && !choice->mode->supported(r->gpu, choice->values, why, sizeof why)) ||
        !mode_check(choice, why, sizeof why)) {
        relay(r, RENDERER_ERROR, why);
        return NULL;
    }
    struct renderer_option *o = calloc(1, sizeof *o);
    if (!o)
        return NULL;
    o->renderer = r;
    o->scene = scene;
    o->mode = choice->mode;
    o->settings = settings ? *settings : (struct renderer_settings){0};
    const VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    const struct mode_setup setup = {.gpu = r->gpu,
                                     .scene = scene->gpu,
                                     .shadow_map = scene->shadow.map.view,
                                     .width = r->width,
                                     .height = r->height,
                                     .values = choice->values,
                                     .settings = o->settings,
                                     .frame = &o->constants,
                                     .counters = &o->counters,
                                     .explanation = &o->explanation};
    explain_shadow(o);
    explain_textures(o);
    if (gpu_buffer_create(r->gpu, "frame constants", sizeof(struct shared_frame),
                          usage | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, GPU_HOST, &o->constants) &&
        gpu_buffer_create(r->gpu, "counters", sizeof(struct shared_counters), usage, GPU_HOST, &o->counters) &&
        (o->state = choice->mode->create(&setup)))
        return o;
    renderer_option_destroy(o);
    return NULL;
}

void renderer_option_destroy(struct renderer_option *o)
{
    if (!o)
        return;
    vkDeviceWaitIdle(o->renderer->gpu->device);
    o->mode->destroy(o->state);
    gpu_buffer_destroy(o->renderer->gpu, &o->constants);
    gpu_buffer_destroy(o->renderer->gpu, &o->counters);
    free(o);
}

bool renderer_option_explain(const struct renderer_option *o, char *out, size_t out_size)
{
    int n = snprintf(out, out_size, "%s%9.2f MiB  in all, %s\n", o->explanation.text,
                     (double)o->explanation.bytes / 1048576, o->mode->name);
    return n >= 0 && (size_t)n < out_size;
}

uint64_t renderer_option_memory(const struct renderer_option *o)
{
    return o->explanation.bytes;
}

uint64_t renderer_memory(const struct renderer *r)
{
    return r->gpu->allocated;
}

const char *renderer_redraw_name(enum frame_redraw redraw)
{
    static const char *const names[FRAME_REDRAW_CAUSES] = {[FRAME_REDRAW_FIRST] = "first",
                                                           [FRAME_REDRAW_CUT] = "cut",
                                                           [FRAME_REDRAW_GAP] = "gap",
                                                           [FRAME_REDRAW_MOTION] = "motion",
                                                           [FRAME_REDRAW_GAZE] = "gaze"};
    return names[redraw];
}

static void store3(float *out, struct dvec3 v)
{
    out[0] = (float)v.x;
    out[1] = (float)v.y;
    out[2] = (float)v.z;
}

// Inward normals of the four side planes and their distances; all pass through the eye.
static void fill_planes(struct shared_eye *out, const struct frame_eye *eye, struct dvec3 position)
{
    const struct viewing_fov *f = &eye->fov;
    const struct dvec3 normals[4] = {
        {1, 0, -f->tan_left}, {-1, 0, -f->tan_right}, {0, 1, -f->tan_down}, {0, -1, -f->tan_up}};
    for (int i = 0; i < 4; i++) {
        struct dvec3 n = dquat_rotate(eye->pose.orientation, dvec3_normalise(normals[i]));
        store3(out->planes[i], n);
        out->planes[i][3] = (float)-dvec3_dot(n, position);
    }
    struct dvec3 forward = dquat_rotate(eye->pose.orientation, (struct dvec3){0, 0, -1});
    store3(out->forward, forward);
    out->forward[3] = (float)-dvec3_dot(forward, position);
}

// The frustum that shows what the unjittered one has at a pixel, `jitter` pixels further right and down.
static struct viewing_fov jittered(const struct viewing_fov *f, const double jitter[2], uint32_t width,
                                   uint32_t height)
{
    const double x = jitter[0] * (f->tan_left + f->tan_right) / width,
                 y = jitter[1] * (f->tan_down + f->tan_up) / height;
    return (struct viewing_fov){f->tan_left + x, f->tan_right - x, f->tan_down - y, f->tan_up + y};
}

static struct fmat4 clip_from_world(const struct pose *pose, const struct viewing_fov *f, struct dvec3 origin)
{
    struct fmat4 projection =
        geometry_projection(f->tan_left, f->tan_right, f->tan_down, f->tan_up, VIEWING_NEAR_M);
    struct fmat4 view = geometry_view(pose, origin);
    return fmat4_multiply(&projection, &view);
}

static void fill_eye(struct shared_eye *out, const struct frame_eye *eye, const struct frame_eye *last,
                     const struct viewing_fov *drawn, struct dvec3 origin)
{
    const struct viewing_fov *f = &eye->fov;
    struct fmat4 clip = clip_from_world(&eye->pose, drawn, origin);
    struct fmat4 last_clip = clip_from_world(&last->pose, &last->fov, origin);
    struct dmat4 world_from_eye =
        dmat4_compose(eye->pose.position, eye->pose.orientation, (struct dvec3){1, 1, 1});
    struct fmat4 relative = geometry_relative(&world_from_eye, origin);
    memcpy(out->clip_from_world, clip.m, sizeof clip.m);
    memcpy(out->last_clip_from_world, last_clip.m, sizeof last_clip.m);
    memcpy(out->world_from_eye, relative.m, sizeof relative.m);
    const double tangents[4] = {f->tan_left, f->tan_right, f->tan_down, f->tan_up};
    for (int i = 0; i < 4; i++)
        out->tangents[i] = (float)tangents[i];
    if (isfinite(eye->gaze_x_deg) && isfinite(eye->gaze_y_deg)) {
        store3(out->gaze, viewing_direction(eye->gaze_x_deg, eye->gaze_y_deg));
        out->gaze[3] = 1;
    }
    struct frame_eye seen = *eye;
    seen.fov = *drawn;
    fill_planes(out, &seen, dvec3_sub(eye->pose.position, origin));
}

// Halton's points of bases 2 and 3, eight in turn (Karis 2014), around the pixel's centre.
static double halton(uint64_t index, uint64_t base)
{
    double value = 0, share = 1;
    for (; index; index /= base) {
        share /= (double)base;
        value += share * (double)(index % base);
    }
    return value;
}

static void fill_constants(struct renderer_option *o, const struct frame *frame)
{
    const struct scene_gpu *scene = o->scene->gpu;
    struct shared_frame *out = o->constants.mapped;
    *out = (struct shared_frame){.width = o->renderer->width,
                                 .height = o->renderer->height,
                                 .near_m = (float)VIEWING_NEAR_M,
                                 .moving = frame->moving};
    scene_gpu_constants(scene, out);
    shadow_constants(&o->scene->shadow, scene->origin, out);
    double jitter[2] = {0, 0};
    for (int axis = 0; o->settings.taa && axis < 2; axis++)
        jitter[axis] = halton(frame->number % 8 + 1, axis ? 3 : 2) - 0.5;
    for (int eye = 0; eye < EYES; eye++) {
        const struct frame_eye *last = o->drawn ? &o->last_eyes[eye] : &frame->eyes[eye];
        const struct viewing_fov drawn =
            jittered(&frame->eyes[eye].fov, jitter, o->renderer->width, o->renderer->height);
        fill_eye(&out->eyes[eye], &frame->eyes[eye], last, &drawn, scene->origin);
    }
    for (int axis = 0; axis < 2; axis++)
        out->jitter[axis] = (float)jitter[axis];
    store3(out->origin_shift, dvec3_sub(o->last_origin, scene->origin));
}

static bool frame_ok(const struct frame *frame)
{
    for (int eye = 0; eye < EYES; eye++) {
        const struct frame_eye *e = &frame->eyes[eye];
        const struct dvec3 p = e->pose.position;
        const struct dquat q = e->pose.orientation;
        if (!viewing_fov_ok(&e->fov) || !isfinite(p.x + p.y + p.z) || !isfinite(q.x + q.y + q.z + q.w) ||
            fabs(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w - 1) > 1e-6)
            return false;
    }
    return isfinite(frame->animation_s);
}

static double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

static enum frame_redraw redraw_of(const struct renderer_option *o, const struct frame *frame)
{
    if (!o->drawn)
        return FRAME_REDRAW_FIRST;
    if (frame->cut)
        return FRAME_REDRAW_CUT;
    if (frame->number != o->last_number + 1)
        return FRAME_REDRAW_GAP;
    if (frame->moving != o->last_moving)
        return FRAME_REDRAW_MOTION;
    return frame->gaze_returned ? FRAME_REDRAW_GAZE : FRAME_REDRAW_NONE;
}

static void fill_stats(const struct renderer_option *o, enum frame_redraw redraw, double cpu_ms,
                       struct frame_stats *out)
{
    const struct gpu_frame *f = &o->renderer->frame;
    const struct shared_counters *c = o->counters.mapped;
    *out = (struct frame_stats){
        .shaded_px = o->result.counts_shaded ? c->shaded_px : 2ull * o->renderer->width * o->renderer->height,
        .triangles = c->triangles,
        .submodels = c->submodels,
        .gpu_ms = f->gpu_ms,
        .cpu_ms = cpu_ms,
        .frustum_triangles = c->frustum_triangles ? c->frustum_triangles : c->triangles,
        .frustum_submodels = c->frustum_submodels ? c->frustum_submodels : c->submodels,
        .moving_px = c->moving_px,
        .redraw = o->result.redraw_map ? redraw : FRAME_REDRAW_NONE,
        .timer_count = f->timer_count};
    for (uint32_t i = 0; i < f->timer_count && i < FRAME_TIMERS; i++) {
        out->timers[i].name = f->timers[i].name;
        out->timers[i].ms = f->timers[i].ms;
    }
}

bool renderer_draw(struct renderer_option *o, const struct frame *frame, struct frame_stats *out_stats)
{
    struct renderer *r = o->renderer;
    if (!frame_ok(frame)) {
        relay(r, RENDERER_ERROR, "a frame's pose or field of view is not a finite, proper one");
        return false;
    }
    const double start = now_ms();
    const enum frame_redraw redraw = redraw_of(o, frame);
    const bool history = redraw == FRAME_REDRAW_NONE;
    if (!gpu_frame_begin(&r->frame))
        return false;
    scene_gpu_update(o->scene->gpu, r->frame.cmd, frame->eyes[EYE_LEFT].pose.position, frame->animation_s,
                     history ? o->last_animation_s : frame->animation_s);
    fill_constants(o, frame);
    memset(o->counters.mapped, 0, sizeof(struct shared_counters));
    const struct mode_record record = {.gpu_frame = &r->frame,
                                       .number = frame->number,
                                       .history = history,
                                       .moving = frame->moving,
                                       .result = &o->result};
    if (!o->mode->record(o->state, &record))
        return false;
    const double recorded = now_ms();
    if (!gpu_frame_end(&r->frame))
        return false;
    o->drawn = true;
    o->last_number = frame->number;
    o->last_animation_s = frame->animation_s;
    o->last_moving = frame->moving;
    memcpy(o->last_eyes, frame->eyes, sizeof o->last_eyes);
    o->last_origin = o->scene->gpu->origin;
    if (out_stats)
        fill_stats(o, redraw, recorded - start, out_stats);
    return true;
}

bool renderer_set_overlay(struct renderer *r, const struct renderer_overlay *overlay)
{
    if (!overlay)
        return screen_set_overlay(&r->screen, NULL, 0, 0, NULL, NULL);
    return screen_set_overlay(&r->screen, overlay->rgba, overlay->width, overlay->height, overlay->left,
                              overlay->top);
}

bool renderer_show(struct renderer *r, struct renderer_option *option, double fade)
{
    if (!gpu_frame_begin(&r->frame))
        return false;
    VkCommandBuffer cmd = gpu_timer_begin(&r->frame, "screen");
    screen_record(&r->screen, cmd, option && option->drawn ? option->result.colour : NULL, (float)fade);
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
