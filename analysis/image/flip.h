// LDR-FLIP: how different two 8-bit sRGB images look when flipped on one screen; 0 equal, 1 the most.
//
// Borders: images are continued by their edge pixels, so every pixel has a value. Means over frames and rings
// are plain means of the per-pixel values, which is the "mean" the authors' program prints for one image.
//
// Does not: know eccentricity (a pixel in the periphery counts as if looked at) or time; no HDR. One image_flip
// belongs to one thread at a time.
#ifndef ANALYSIS_IMAGE_FLIP_H
#define ANALYSIS_IMAGE_FLIP_H

#include "analysis/image/rings.h"

struct image_flip; // owned; filters for its resolution, working planes grown as images need them
// NULL without memory, or pixels per degree outside [1, 240] (view.h's image_pixels_per_degree() gives them;
// the authors' default is 67.02: 0.7 m from a screen 0.7 m wide of 3840 pixels).
struct image_flip *image_flip_create(double pixels_per_degree);
void image_flip_destroy(struct image_flip *flip); // NULL is fine

// Adds each pixel's FLIP to `sum`, and writes it to `out_map` where that is not NULL: width * height floats,
// rows from the top. False, with the sum untouched, for images of different or zero size, rings of another
// size, or no memory.
bool image_flip_add(struct image_flip *flip, const struct image_pixels *test,
                    const struct image_pixels *reference, const struct image_rings *rings,
                    struct image_ring_sum *sum, float *out_map);

#endif
