#include "app/fovbench/motion.h"

#include <stdio.h>
#include <stdlib.h>

struct motion {
    struct renderer_option *option; // owned
    uint32_t width, height;
    float *xyzw[EYES];        // owned
    struct frame_stats stats; // of the last frame
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
    if (!renderer_draw(motion->option, frame, &motion->stats))
        return false;
    for (int eye = 0; eye < EYES; eye++)
        if (!renderer_read_motion(motion->option, eye, motion->xyzw[eye]))
            return false;
    return true;
}

const float *motion_of(const struct motion *motion, int eye)
{
    return motion->xyzw[eye];
}

double motion_share(const struct motion *motion)
{
    return (double)motion->stats.moving_px / (2.0 * motion->width * motion->height);
}
