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

#include "analysis/image/rings.h"
#include "analysis/image/view.h"

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

// The same over the rings of eccentricity: region[r] of each ring, region[IMAGE_WHOLE] of the whole image, and
// weights from the rings' map, so that a frame costs no trigonometry.
struct image_error_rings {
    struct image_error_sum region[IMAGE_REGIONS];
};

// False, with the sums untouched, where image_error_add() would refuse, or for rings of another size. Read
// image_error_result(&sums->region[r]); a ring without pixels is all NaN.
bool image_error_rings_add(struct image_error_rings *sums, const struct image_pixels *test,
                           const struct image_pixels *reference, const struct image_rings *rings);

#endif
