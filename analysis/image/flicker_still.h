// Flicker while camera and gaze stand still: how much more each pixel's luminance varies in time than the
// reference's, plain and weighted by the eye's transient channel.
//
// The series of a pixel is its linear luminance Y = 0.2126 R + 0.7152 G + 0.0722 B (1: display white) over a
// block of N frames at f frames a second. With its discrete Fourier transform X_k, k = 0..N-1, at |frequency|
// f_k = min(k, N - k) f / N,
//
//   deviation^2 = sum over k > 0 of |X_k|^2 / N^2                     (by Parseval the series' variance, over
//   N) weighted^2  = sum over k > 0 of R_trans(f_k)^2 |X_k|^2 / N^2      (its variance after filtering by
//   R_trans)
//
// so weighted <= deviation, equal for a pure 5 Hz flicker, 0.043 of it for one of 45 Hz. The measure of a pixel
// is the test's value minus the reference's, signed: negative where the test is calmer. Means over pixels and
// blocks, which follow one another without overlap (Bartlett's method): the mean of each block, and with it
// drift slower than a block, does not count. Frames after the last whole block do not count.
//
// Use: one object per eye; add every frame after warm-up, with the same sums for both eyes.
// Luminance is kept as 16-bit (error of a deviation below 1e-5), so a block costs 4 N bytes a pixel for the
// pair: 32 frames of 640x720 are 59 MB. Blocks of 32 frames at 90 Hz see 2.8 Hz and up. Does not: see motion,
// or a constant error. One object belongs to one thread at a time.
#ifndef ANALYSIS_IMAGE_FLICKER_STILL_H
#define ANALYSIS_IMAGE_FLICKER_STILL_H

#include "analysis/image/rings.h"

// Transient temporal sensitivity of castleCSF, relative to its maximum 1 at 5 Hz; NaN for a negative or missing
// frequency.
double image_transient_sensitivity(double hz);

struct image_flicker_still_sum { // zero is empty; relative luminance, 1 is display white
    struct image_ring_sum deviation, weighted;
};

struct image_flicker_still; // owned
// NULL without memory, fewer than 4 or more than 256 frames a block, or a frame rate that is not finite and
// positive.
struct image_flicker_still *image_flicker_still_create(uint32_t block_frames, double frames_hz);
void image_flicker_still_destroy(struct image_flicker_still *flicker); // NULL is fine

// Adds a frame; the one that fills a block adds that block's pixels to `sum`, by the rings of that frame. A
// frame of another size begins a new block. False, with sum and block untouched, for images of different or
// zero size, rings of another size, or no memory.
bool image_flicker_still_add(struct image_flicker_still *flicker, const struct image_pixels *test,
                             const struct image_pixels *reference, const struct image_rings *rings,
                             struct image_flicker_still_sum *sum);

#endif
