// Where every pixel's surface was one frame ago, for flicker and for the share of moving pixels. An option of
// its own that draws only when asked: `regular` without antialiasing, so that the measured ones pay nothing for
// it.
#ifndef APP_FOVBENCH_MOTION_H
#define APP_FOVBENCH_MOTION_H

#include "renderer/renderer.h"

struct motion;

// `reference` is `regular`. NULL after a sentence on stderr. Before the renderer and the scene it is destroyed.
struct motion *motion_create(struct renderer *renderer, struct renderer_scene *scene,
                             const struct mode_choice *reference, uint32_t width, uint32_t height);
void motion_destroy(struct motion *motion); // NULL is fine

bool motion_draw(struct motion *motion, const struct frame *frame);
// Of the last frame drawn, as renderer_read_motion; valid until the next draw.
const float *motion_of(const struct motion *motion, int eye);
// The share of both eyes' pixels that a moving object covers in the last frame drawn.
double motion_share(const struct motion *motion);

#endif
