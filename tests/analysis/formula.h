// Small pictures by a formula of whole numbers, the same as in tests/reference/image_measures.R, and how they
// are seen.
#ifndef TESTS_ANALYSIS_FORMULA_H
#define TESTS_ANALYSIS_FORMULA_H

#include "analysis/image/rings.h"

enum { FORMULA_WIDTH = 48, FORMULA_HEIGHT = 40, FORMULA_PX = FORMULA_WIDTH * FORMULA_HEIGHT };

struct formula_picture {
    uint8_t data[FORMULA_PX * 3];
};

extern const struct image_view formula_view; // asymmetric, gaze at (7, -4) degrees

// The pictures of frame t; they point into `out`.
struct image_pixels formula_reference(struct formula_picture *out, int t);
struct image_pixels formula_test(struct formula_picture *out, int t); // noisier on the left, a red patch
struct image_pixels formula_solid(struct formula_picture *out, uint8_t r, uint8_t g, uint8_t b);
struct image_pixels formula_noisy(struct formula_picture *out, int t, int amplitude); // the reference and noise

// The motion of frame t: a plane, a nearer box that moves over it, a background above.
void formula_motion(float out[FORMULA_PX * 4], int t);

// The reference's name of a region: "0-5", "5-15", "15-30", "30+", "whole".
const char *formula_region_name(int region);
// Pixels of a region in rings of `height` rows, counted run by run.
uint64_t formula_ring_pixels(const struct image_rings *rings, uint32_t height, int region);

#endif
