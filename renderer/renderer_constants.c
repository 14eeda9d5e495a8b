// What the shaders know of a frame: matrices, planes and gaze of both eyes.
#include "renderer/renderer_private.h"

#include <math.h>
#include <string.h>

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

void renderer_fill_constants(struct renderer_option *o, const struct frame *frame)
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
