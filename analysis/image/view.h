// 8-bit sRGB images as they lie in memory, and how one was seen: frustum and gaze.
#ifndef ANALYSIS_IMAGE_VIEW_H
#define ANALYSIS_IMAGE_VIEW_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct image_pixels {
    const uint8_t *data; // borrowed; rows from the top
    uint32_t width, height;
    uint32_t channels; // 3 (RGB) or 4 (RGBA); alpha is never looked at
    size_t row_bytes;  // 0: width * channels
};

// How one image was seen: its frustum by the tangents of the half angles, each positive away from the axis (the
// fields of struct viewing_fov), and the gaze in that eye's frame, degrees, right and up positive. A gaze that
// is not finite means that there was none.
struct image_view {
    double tan_left, tan_right, tan_down, tan_up;
    double gaze_x_deg, gaze_y_deg;
};

size_t image_row_bytes(const struct image_pixels *image);
bool image_pixels_ok(const struct image_pixels *image); // data, a size, 3 or 4 channels, rows long enough
bool image_pair_ok(const struct image_pixels *a, const struct image_pixels *b); // both, and of one size
bool image_view_ok(const struct image_view *view);                              // finite and open
bool image_view_gazed(const struct image_view *view);                           // there was a gaze

// Angle between the gaze and the direction through a point of the image, degrees; pixel centres are at +0.5.
double image_eccentricity_deg(const struct image_view *view, uint32_t width, uint32_t height, double x,
                              double y);
// Of the centres of `count` pixels of row y from x0 on.
void image_row_eccentricities_deg(const struct image_view *view, uint32_t width, uint32_t height, uint32_t x0,
                                  uint32_t y, uint32_t count, double *out);

// Pixels per degree where the image's middle is seen: on a plane in tangent space a small step dx (dy) from
// (x, y) turns the eye by dx sqrt(1 + y^2) / (1 + x^2 + y^2) (x and y swapped for dy); the geometric mean of
// both directions. A symmetric frustum of square pixels has height / (2 tan(fov / 2)) * pi / 180: 5.272 for 720
// rows over 100 degrees. The gaze does not matter. NaN for a frustum that is not finite and open, or no pixels.
double image_pixels_per_degree(const struct image_view *view, uint32_t width, uint32_t height);

#endif
