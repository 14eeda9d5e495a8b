#include "app/fovbench/motion.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define MOVED_PX 0.1
#define MOVED_PART 0.002 // above the error of a 32-bit reversed depth by far

struct motion {
    struct renderer_option *option; // owned
    uint32_t width, height;
    float *xyzw[EYES]; // owned
    struct frame frame, before;
    bool drawn, follows; // follows: `before` is the frame just before `frame`
};

struct motion *motion_create(struct renderer *renderer, struct renderer_scene *scene,
                             const struct mode_choice *reference, uint32_t width, uint32_t height)
{
    const struct renderer_settings settings = {.motion = true};
    struct motion *motion = calloc(1, sizeof *motion);
    if (motion) {
        motion->width = width;
        motion->height = height;
        for (int eye = 0; eye < EYES; eye++)
            motion->xyzw[eye] = malloc((size_t)width * height * 4 * sizeof(float));
    }
    if (!motion || !motion->xyzw[EYE_LEFT] || !motion->xyzw[EYE_RIGHT])
        fprintf(stderr, "fovbench: out of memory\n");
    else if ((motion->option = renderer_option_create(renderer, scene, reference, &settings)))
        return motion;
    motion_destroy(motion);
    return NULL;
}

void motion_destroy(struct motion *motion)
{
    if (!motion)
        return;
    renderer_option_destroy(motion->option);
    for (int eye = 0; eye < EYES; eye++)
        free(motion->xyzw[eye]);
    free(motion);
}

bool motion_draw(struct motion *motion, const struct frame *frame)
{
    if (!renderer_draw(motion->option, frame, NULL))
        return false;
    motion->follows = motion->drawn && frame->number == motion->frame.number + 1;
    motion->before = motion->frame;
    motion->frame = *frame;
    motion->drawn = true;
    for (int eye = 0; eye < EYES; eye++)
        if (!renderer_read_motion(motion->option, eye, motion->xyzw[eye]))
            return false;
    return true;
}

const float *motion_of(const struct motion *motion, int eye)
{
    return motion->xyzw[eye];
}

static struct dvec3 unrotate(struct dquat q, struct dvec3 v)
{
    return dquat_rotate((struct dquat){-q.x, -q.y, -q.z, q.w}, v);
}

static bool moved(const struct motion *m, int eye, double x, double y, const float *is)
{
    const struct frame_eye *now = &m->frame.eyes[eye], *then = &m->before.eyes[eye];
    const struct viewing_fov *f = &then->fov;
    if (!(is[3] > 0))
        return false; // the background
    struct dvec3 ray = viewing_pixel_direction(&now->fov, m->width, m->height, x, y);
    struct dvec3 point = dvec3_scale(ray, is[3] / -ray.z);
    point = dvec3_add(now->pose.position, dquat_rotate(now->pose.orientation, point));
    point = unrotate(then->pose.orientation, dvec3_sub(point, then->pose.position));
    double distance = -point.z;
    if (!(distance > VIEWING_NEAR_M))
        return false;
    double was_x = (point.x / distance + f->tan_left) / (f->tan_left + f->tan_right) * m->width;
    double was_y = (f->tan_up - point.y / distance) / (f->tan_up + f->tan_down) * m->height;
    return hypot(was_x - is[0], was_y - is[1]) > MOVED_PX || fabs(distance - is[2]) > MOVED_PART * distance;
}

double motion_share(const struct motion *motion)
{
    if (!motion->follows)
        return (double)NAN;
    uint64_t count = 0;
    for (int eye = 0; eye < EYES; eye++)
        for (uint32_t y = 0; y < motion->height; y++)
            for (uint32_t x = 0; x < motion->width; x++)
                count += moved(motion, eye, x + 0.5, y + 0.5,
                               motion->xyzw[eye] + 4 * ((size_t)y * motion->width + x));
    return (double)count / (2.0 * motion->width * motion->height);
}
