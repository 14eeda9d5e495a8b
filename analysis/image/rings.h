// Rings of eccentricity around the gaze, and means of per-pixel values over them.
//
// Use: image_rings_create() once per eye, image_rings_set() before each frame (cheap while size and view stay
// the same, 0.04 us a pixel where the gaze moved, 17 ms for 640x720), then hand the rings to the measures. A
// measure adds to a struct image_ring_sum (zero is empty; frames and eyes add up), image_ring_mean() reads it.
//
// A pixel belongs to the ring that holds its centre's eccentricity, lower limit included. Without a gaze there
// are no rings: values count in the whole only, weights are 1.
//
// Does not: know which measure it serves. Safe from any thread as long as each object has one owner.
#ifndef ANALYSIS_IMAGE_RINGS_H
#define ANALYSIS_IMAGE_RINGS_H

#include "analysis/image/view.h"

// Regions are the rings and, last, the whole image.
enum { IMAGE_RINGS = 4, IMAGE_WHOLE = IMAGE_RINGS, IMAGE_REGIONS };

extern const double image_ring_limits_deg[IMAGE_RINGS + 1]; // 0, 5, 15, 30, infinity

// Neighbouring pixels of a row in one ring; region IMAGE_WHOLE without a gaze.
struct image_ring_run {
    uint32_t begin, end;
    uint32_t region;
};

struct image_rings;                                  // owned; the map of one eye
struct image_rings *image_rings_create(void);        // NULL without memory
void image_rings_destroy(struct image_rings *rings); // NULL is fine

// False, with the rings empty (size 0), for no pixels, a frustum that is not finite and open, or no memory.
bool image_rings_set(struct image_rings *rings, uint32_t width, uint32_t height, const struct image_view *view);

bool image_rings_fit(const struct image_rings *rings, uint32_t width, uint32_t height); // set for this size
// A row's runs from left to right, at most IMAGE_RINGS * 2 of them; and its pixels' weights (fc(e) / fc(0))^2.
const struct image_ring_run *image_rings_runs(const struct image_rings *rings, uint32_t y, uint32_t *out_count);
const double *image_rings_weights(const struct image_rings *rings, uint32_t y);

// Sums over regions. Private but for zeroing and copying.
struct image_ring_sum {
    double sum[IMAGE_REGIONS];
    uint64_t count[IMAGE_REGIONS];
};

// A row's values; `mask` (NULL: all count) is 0 where a pixel does not count. values[0] and mask[0] belong to
// pixel x0, `count` pixels follow one another.
void image_ring_sum_row(struct image_ring_sum *sum, const struct image_rings *rings, uint32_t y, uint32_t x0,
                        uint32_t count, const float *values, const uint8_t *mask);
double image_ring_mean(const struct image_ring_sum *sum, int region); // NaN where nothing was added

#endif
