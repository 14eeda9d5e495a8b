// Error measures between 8-bit sRGB images of the same size.
//
// Use: zero a struct image_error_sum, image_error_add() each pair (both eyes, any number of frames), then read
// image_error_result(). One pair: image_error_pair(). Differences are taken between the stored sRGB values, in
// levels of 0..255, over the three colour channels; alpha is ignored.
//
// Does not: read files, resize, convert colour spaces, or look at time (flicker). Safe from any thread as long
// as each sum has one owner.
#ifndef ANALYSIS_IMAGE_ERROR_H
#define ANALYSIS_IMAGE_ERROR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct image_pixels {
    const uint8_t *data; // borrowed; rows from the top
    uint32_t width, height;
    uint32_t channels; // 3 (RGB) or 4 (RGBA)
    size_t row_bytes;  // 0: width * channels
};

// How one image was seen: its frustum by the tangents of the half angles, each positive away from the axis (the
// fields of struct viewing_fov), and the gaze in that eye's frame, degrees, right and up positive. A gaze that
// is not finite means that there was none: every pixel then counts as foveal, weight 1.
struct image_view {
    double tan_left, tan_right, tan_down, tan_up;
    double gaze_x_deg, gaze_y_deg;
};

// Zero is the empty sum. Private but for copying.
struct image_error_sum {
    uint64_t values; // channel values compared
    uint64_t absolute, square;
    uint32_t max;
    double weight, weighted_square;
};

struct image_error {
    double mean_abs;      // levels, 0..255
    double max_abs;       // levels, 0..255
    double rmse;          // levels, 0..255
    double psnr_db;       // 20 log10(255 / rmse); infinite for equal images
    double weighted_rmse; // squared errors weighted by eccentricity.h's (fc(e) / fc(0))^2; NaN without a view
    double weighted_psnr_db; // infinite for equal images; NaN without a view
};

// `view` may be NULL: then the pair counts in the plain measures only. False, with the sum untouched, for
// images of different or zero size, other channel counts, rows too short, or a frustum that is not finite and
// open.
bool image_error_add(struct image_error_sum *sum, const struct image_pixels *test,
                     const struct image_pixels *reference, const struct image_view *view);

// All NaN where nothing was added.
struct image_error image_error_result(const struct image_error_sum *sum);

// One pair; all NaN where image_error_add() would refuse it.
struct image_error image_error_pair(const struct image_pixels *test, const struct image_pixels *reference,
                                    const struct image_view *view);

// Angle between the gaze and the direction through a point of the image, degrees; pixel centres are at +0.5.
double image_eccentricity_deg(const struct image_view *view, uint32_t width, uint32_t height, double x,
                              double y);

#endif
