// The separable filters of FLIP, along rows and across them. Private to analysis/image.
#ifndef ANALYSIS_IMAGE_FLIP_KERNEL_H
#define ANALYSIS_IMAGE_FLIP_KERNEL_H

#include <stdint.h>

enum { FLIP_MAX_RADIUS = 33 }; // the widest filter at 240 pixels per degree: ceil(3 * 0.0450 * 240)

// How the taps on both sides of the middle join:
enum flip_shape {
    FLIP_EVEN, // a Gaussian: middle + sum over k >= 1 of tap[k] (p[-k] + p[k])
    FLIP_ODD,  // its first derivative, mirrored as convolution does: sum of tap[k] (p[k] - p[-k])
    FLIP_FLAT, // its second: taps sum to 0, so sum of tap[k] (p[-k] + p[k] - 2 p[0]), exactly 0 on flat parts
};

struct flip_kernel {
    enum flip_shape shape;
    int radius; // 0: only tap[0]
    float tap[FLIP_MAX_RADIUS + 1];
};

// Gaussian exp(-x^2 / (2 sd^2)) at whole pixels up to `radius`, sum 1. Taps below 1e-9 of the middle one, which
// 32-bit floats would lose, are left off.
struct flip_kernel flip_gaussian(double sd_px, int radius);
// The sum of its values before they are made to sum to 1.
double flip_gaussian_sum(double sd_px, int radius);
// -x exp(...) and (x^2 / sd^2 - 1) exp(...): positive taps sum to 1, negative ones to -1.
struct flip_kernel flip_first_derivative(double sd_px, int radius);
struct flip_kernel flip_second_derivative(double sd_px, int radius);

// in[-radius .. count - 1 + radius] must be readable.
void flip_filter_along(const struct flip_kernel *kernel, const float *in, uint32_t count, float *out);
// rows[-radius .. radius]
void flip_filter_across(const struct flip_kernel *kernel, const float *const *rows, uint32_t count, float *out);

#endif
