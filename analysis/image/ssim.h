// Structural similarity (SSIM) of 8-bit sRGB images, over the image and its rings.
//
// Luma is 0.299 R' + 0.587 G' + 0.114 B' of the stored values (ITU-R BT.601, as in the authors' program, but
// not rounded). The window is 11x11, Gaussian of sigma 1.5, normalised; K1 0.01, K2 0.03, L 255. One scale, no
// downsampling first. Borders: only pixels whose window lies inside the image have a value, so the outer five
// rows and columns count nowhere, neither in the mean nor in a ring.
//
// Does not: look at colour, resize, or use several scales. One image_ssim belongs to one thread at a time.
#ifndef ANALYSIS_IMAGE_SSIM_H
#define ANALYSIS_IMAGE_SSIM_H

#include "analysis/image/rings.h"

enum { IMAGE_SSIM_WINDOW = 11 };

struct image_ssim;                                // owned; working rows, grown as images need them
struct image_ssim *image_ssim_create(void);       // NULL without memory
void image_ssim_destroy(struct image_ssim *ssim); // NULL is fine

// Adds each pixel's SSIM, in (-1, 1], to `sum`: equal images have 1. False, with the sum untouched, for images
// of different or zero size, smaller than the window, rings of another size, or no memory.
bool image_ssim_add(struct image_ssim *ssim, const struct image_pixels *test,
                    const struct image_pixels *reference, const struct image_rings *rings,
                    struct image_ring_sum *sum);

#endif
