// `regular` with more samples than pixels: every pixel of the wanted size from factor x factor of them,
// averaged in linear light. The reference that no mode of the line-up is.
#ifndef APP_FOVBENCH_SUPERSAMPLE_H
#define APP_FOVBENCH_SUPERSAMPLE_H

#include "app/fovbench/lineup.h"

struct supersample;

// A renderer of its own at the larger size, with the description's first mode and settings less antialiasing.
// The factor is 4 where both eyes then have at most SUPERSAMPLE_PIXELS, else 2. NULL after a sentence on
// stderr.
struct supersample *supersample_create(const struct lineup_desc *desc, const struct scene *scene);
void supersample_destroy(struct supersample *supersample); // NULL is fine
uint32_t supersample_factor(const struct supersample *supersample);

bool supersample_draw(struct supersample *supersample, const struct frame *frame);
// The last frame drawn, rgba8, sRGB-encoded, of the wanted size; valid until the next read. NULL: failed.
const uint8_t *supersample_read(struct supersample *supersample, int eye);

// 40 million: about 3 GB of targets.
#define SUPERSAMPLE_PIXELS 40000000u

// Averages blocks of factor x factor pixels in linear light, alpha 255. `out` has width x height pixels, `in`
// factor times as many each way.
void supersample_box(const uint8_t *in, uint32_t width, uint32_t height, uint32_t factor, uint8_t *out);

#endif
