// Looks into every float image that the renderer's passes write, by standing between renderer and driver: each
// image made in between can be copied from, and starts at zero wherever its old contents are given up, so that
// what no pass wrote is zero on every device.
//
// Use: float_images_watch after renderer_create -> options and frames -> float_images_check after each frame ->
//      float_images_finish before renderer_destroy. One at a time.
#ifndef TESTS_RENDERER_FLOAT_IMAGES_H
#define TESTS_RENDERER_FLOAT_IMAGES_H

#include "renderer/renderer.h"

#include <stdbool.h>
#include <stdint.h>

void float_images_watch(struct renderer *renderer);
// Fails the test with the image's name and the place of the first value that is not finite.
void float_images_check(const char *when);
// Texels so far of images with this debug name that held anything but zero.
uint64_t float_images_used(const char *name);
float float_images_largest(const char *name); // absolute value so far
void float_images_finish(void);

#endif
