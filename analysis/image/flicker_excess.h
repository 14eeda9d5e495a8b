// Flicker while things move: by how much more a rendering changes along the reference's motion than the
// reference itself does.
//
//   E_t = |I_t - warp(I_(t-1))|,   flicker excess = mean over unmasked pixels of max(0, E_t(test) -
//   E_t(reference))
//
// I is luma in levels of 0..255 (BT.601, as in ssim.h): at display rates the eye follows luminance, chromatic
// flicker fuses several times earlier. warp() takes the previous frame's value at the place the reference's
// motion names, bilinearly. A pixel is masked
//   - where that place, or one of the pixels the bilinear weights touch, is outside the image, or not finite;
//   - where something else was seen there (disocclusion): the previous frame's own present distances give
//     1 / distance bilinearly (exact on planes, since 1 / distance is linear in the image; background has 0),
//     and it differs from 1 / the expected distance by more than IMAGE_FLICKER_TOLERANCE of the larger of both.
//
// Use: one object per eye and sequence; image_flicker_excess_add() each frame in order with the same sum for
// both eyes; the first frame adds nothing. image_flicker_excess_cut() before a jump (another scene, a new
// trial).
//
// Does not: see a steady error (use error.h) or flicker of pixels that were just uncovered. One object belongs
// to one thread at a time.
#ifndef ANALYSIS_IMAGE_FLICKER_EXCESS_H
#define ANALYSIS_IMAGE_FLICKER_EXCESS_H

#include "analysis/image/rings.h"

// Two surfaces less than 2 % of their distance apart are not told apart: our choice, above the error of 1 /
// distance on curved, tessellated surfaces and of 16-bit distances (0.05 %), below the gaps between objects of
// a room.
#define IMAGE_FLICKER_TOLERANCE 0.02f

struct image_flicker_excess; // owned; one eye's previous luma (test and reference) and distance
struct image_flicker_excess *image_flicker_excess_create(void);          // NULL without memory
void image_flicker_excess_destroy(struct image_flicker_excess *flicker); // NULL is fine
void image_flicker_excess_cut(struct image_flicker_excess *flicker);

// `motion`: width * height times four floats, rows from the top: where this pixel's surface was one frame ago,
// x and y in pixels (the first pixel's centre is 0.5, 0.5), the distance in front of the eye expected there
// then, and its present distance; distance 0 is background. Adds each unmasked pixel's excess to `sum`. A frame
// of another size than the one before starts a new sequence. False, with sum and sequence untouched, for images
// of different or zero size, no motion, rings of another size, or no memory.
bool image_flicker_excess_add(struct image_flicker_excess *flicker, const struct image_pixels *test,
                              const struct image_pixels *reference, const float *motion,
                              const struct image_rings *rings, struct image_ring_sum *sum);

#endif
