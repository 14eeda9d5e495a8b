// Andersson et al. 2020 (see flip.c): a Gaussian in x and y is the product of two in
// one dimension, and so are its derivatives along x, since their signs depend on x alone.
#include "analysis/image/flip_kernel.h"

#include <math.h>

static double gaussian(double sd_px, int x)
{
    return exp(-x * x / (2 * sd_px * sd_px));
}

double flip_gaussian_sum(double sd_px, int radius)
{
    double sum = 1;
    for (int x = 1; x <= radius; x++)
        sum += 2 * gaussian(sd_px, x);
    return sum;
}

struct flip_kernel flip_gaussian(double sd_px, int radius)
{
    const double negligible = 1e-9; // of the middle tap: a 32-bit float has 6e-8
    struct flip_kernel kernel = {.shape = FLIP_EVEN, .radius = 0};
    double sum = flip_gaussian_sum(sd_px, radius);
    for (int x = 0; x <= radius && gaussian(sd_px, x) > negligible; x++) {
        kernel.tap[x] = (float)(gaussian(sd_px, x) / sum);
        kernel.radius = x;
    }
    return kernel;
}

struct flip_kernel flip_first_derivative(double sd_px, int radius)
{
    struct flip_kernel kernel = {.shape = FLIP_ODD, .radius = radius};
    double sum = 0; // of one side
    for (int x = 1; x <= radius; x++)
        sum += x * gaussian(sd_px, x);
    for (int x = 1; x <= radius; x++)
        kernel.tap[x] = (float)(x * gaussian(sd_px, x) / sum);
    return kernel;
}

struct flip_kernel flip_second_derivative(double sd_px, int radius)
{
    struct flip_kernel kernel = {.shape = FLIP_FLAT, .radius = radius};
    double positive = 0, negative = 1; // the middle value is -1
    for (int x = 1; x <= radius; x++) {
        double value = (x * x / (sd_px * sd_px) - 1) * gaussian(sd_px, x);
        *(value > 0 ? &positive : &negative) += 2 * fabs(value);
    }
    for (int x = 1; x <= radius; x++) {
        double value = (x * x / (sd_px * sd_px) - 1) * gaussian(sd_px, x);
        kernel.tap[x] = (float)(value / (value > 0 ? positive : negative));
    }
    return kernel;
}

static void add_even(float tap, const float *restrict a, const float *restrict b, uint32_t count,
                     float *restrict out)
{
    for (uint32_t i = 0; i < count; i++)
        out[i] += tap * (a[i] + b[i]);
}

static void add_odd(float tap, const float *restrict a, const float *restrict b, uint32_t count,
                    float *restrict out)
{
    for (uint32_t i = 0; i < count; i++)
        out[i] += tap * (b[i] - a[i]);
}

static void add_flat(float tap, const float *restrict a, const float *restrict b, const float *restrict middle,
                     uint32_t count, float *restrict out)
{
    for (uint32_t i = 0; i < count; i++)
        out[i] += tap * ((a[i] - middle[i]) + (b[i] - middle[i]));
}

static void begin(const struct flip_kernel *kernel, const float *restrict middle, uint32_t count,
                  float *restrict out)
{
    float tap = kernel->shape == FLIP_EVEN ? kernel->tap[0] : 0;
    for (uint32_t i = 0; i < count; i++)
        out[i] = tap * middle[i];
}

static void add_pair(const struct flip_kernel *kernel, int k, const float *a, const float *b,
                     const float *middle, uint32_t count, float *out)
{
    if (kernel->shape == FLIP_EVEN)
        add_even(kernel->tap[k], a, b, count, out);
    else if (kernel->shape == FLIP_ODD)
        add_odd(kernel->tap[k], a, b, count, out);
    else
        add_flat(kernel->tap[k], a, b, middle, count, out);
}

// A row is short enough for all its passes to stay in the first cache.
void flip_filter_along(const struct flip_kernel *kernel, const float *in, uint32_t count, float *out)
{
    begin(kernel, in, count, out);
    for (int k = 1; k <= kernel->radius; k++)
        add_pair(kernel, k, in - k, in + k, in, count, out);
}

void flip_filter_across(const struct flip_kernel *kernel, const float *const *rows, uint32_t count, float *out)
{
    begin(kernel, rows[0], count, out);
    for (int k = 1; k <= kernel->radius; k++)
        add_pair(kernel, k, rows[-k], rows[k], rows[0], count, out);
}
