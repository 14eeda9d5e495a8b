// Wang, Z., Bovik, A. C., Sheikh, H. R. & Simoncelli, E. P., "Image quality assessment: from error visibility
// to structural similarity", IEEE Transactions on Image Processing 13(4) (2004), 600-612. With local means m,
// variances s^2 and covariance under a Gaussian window (equations 14-16),
//
//   SSIM = (2 m_x m_y + C1)(2 s_xy + C2) / ((m_x^2 + m_y^2 + C1)(s_x^2 + s_y^2 + C2))    (equation 13)
//
// The window is separable: each row is filtered along x once and kept for the eleven output rows that need it.
// Of the five filtered signals x, y, x^2, y^2, xy the denominator needs only the sum of the squares, so there
// are four. In float, with lumas around 0 (variances do not change, and less is lost in E[x^2] - m^2).
#include "analysis/image/ssim.h"

#include "analysis/image/luma.h"

#include <math.h>
#include <stdlib.h>

enum { RADIUS = IMAGE_SSIM_WINDOW / 2, TAPS = RADIUS + 1, SIGNALS = 4 };

static const double sigma_px = 1.5;                  // Wang et al. 2004, section III.C
static const float c1 = 0.01f * 255 * (0.01f * 255); // (K1 L)^2, K1 0.01, same
static const float c2 = 0.03f * 255 * (0.03f * 255); // (K2 L)^2, K2 0.03, same
static const float middle = 127.5f;                  // what is subtracted from luma

struct image_ssim {
    float taps[TAPS]; // taps[0] the window's middle
    uint32_t width;   // room for rows this wide
    float *memory;    // owned; the rows below
    float *test, *reference, *products[2];
    float *filtered[IMAGE_SSIM_WINDOW][SIGNALS]; // row y in y % IMAGE_SSIM_WINDOW
    float *columns[SIGNALS], *values;
};

struct image_ssim *image_ssim_create(void)
{
    struct image_ssim *ssim = calloc(1, sizeof *ssim);
    if (!ssim)
        return NULL;
    double taps[TAPS], sum = 0;
    for (int i = 0; i < TAPS; i++) {
        taps[i] = exp(-i * i / (2 * sigma_px * sigma_px));
        sum += i ? 2 * taps[i] : taps[i];
    }
    for (int i = 0; i < TAPS; i++)
        ssim->taps[i] = (float)(taps[i] / sum);
    return ssim;
}

void image_ssim_destroy(struct image_ssim *ssim)
{
    if (!ssim)
        return;
    free(ssim->memory);
    free(ssim);
}

static bool reserve(struct image_ssim *ssim, uint32_t width)
{
    if (width <= ssim->width)
        return true;
    enum { ROWS = 4 + IMAGE_SSIM_WINDOW * SIGNALS + SIGNALS + 1 };
    float *memory = malloc((size_t)width * ROWS * sizeof *memory);
    if (!memory)
        return false;
    free(ssim->memory);
    ssim->memory = memory;
    ssim->width = width;
    float **rows[] = {&ssim->test, &ssim->reference, &ssim->products[0], &ssim->products[1], &ssim->values};
    for (int i = 0; i < 5; i++, memory += width)
        *rows[i] = memory;
    for (int s = 0; s < SIGNALS; s++, memory += width)
        ssim->columns[s] = memory;
    for (int y = 0; y < IMAGE_SSIM_WINDOW; y++)
        for (int s = 0; s < SIGNALS; s++, memory += width)
            ssim->filtered[y][s] = memory;
    return true;
}

// out[i] of the window that begins at in[i].
static void filter_along(const float *restrict in, const float *taps, uint32_t count, float *restrict out)
{
    for (uint32_t i = 0; i < count; i++) {
        const float *m = in + i + RADIUS;
        out[i] = taps[0] * m[0] + taps[1] * (m[-1] + m[1]) + taps[2] * (m[-2] + m[2]) +
                 taps[3] * (m[-3] + m[3]) + taps[4] * (m[-4] + m[4]) + taps[5] * (m[-5] + m[5]);
    }
}

static void add_input_row(struct image_ssim *ssim, const struct image_pixels *test,
                          const struct image_pixels *reference, uint32_t y)
{
    uint32_t width = test->width;
    image_luma_row(test, y, middle, ssim->test);
    image_luma_row(reference, y, middle, ssim->reference);
    float *restrict squares = ssim->products[0], *restrict product = ssim->products[1];
    const float *restrict a = ssim->test, *restrict b = ssim->reference;
    for (uint32_t x = 0; x < width; x++) {
        squares[x] = a[x] * a[x] + b[x] * b[x];
        product[x] = a[x] * b[x];
    }
    const float *inputs[SIGNALS] = {a, b, squares, product};
    for (int s = 0; s < SIGNALS; s++)
        filter_along(inputs[s], ssim->taps, width - 2 * RADIUS, ssim->filtered[y % IMAGE_SSIM_WINDOW][s]);
}

// `y`: the last input row of the window.
static void filter_across(const struct image_ssim *ssim, uint32_t y, int signal, uint32_t count)
{
    const float *r[IMAGE_SSIM_WINDOW];
    for (uint32_t i = 0; i < IMAGE_SSIM_WINDOW; i++)
        r[i] = ssim->filtered[(y - i) % IMAGE_SSIM_WINDOW][signal];
    const float *taps = ssim->taps;
    float *restrict out = ssim->columns[signal];
    for (uint32_t x = 0; x < count; x++)
        out[x] = taps[0] * r[5][x] + taps[1] * (r[4][x] + r[6][x]) + taps[2] * (r[3][x] + r[7][x]) +
                 taps[3] * (r[2][x] + r[8][x]) + taps[4] * (r[1][x] + r[9][x]) + taps[5] * (r[0][x] + r[10][x]);
}

// Equation 13. Means get the middle back; variances do not need it.
static void combine(const struct image_ssim *ssim, uint32_t count)
{
    const float *restrict mx = ssim->columns[0], *restrict my = ssim->columns[1];
    const float *restrict squares = ssim->columns[2], *restrict product = ssim->columns[3];
    float *restrict out = ssim->values;
    for (uint32_t x = 0; x < count; x++) {
        float variances = squares[x] - (mx[x] * mx[x] + my[x] * my[x]);
        float covariance = product[x] - mx[x] * my[x];
        float a = mx[x] + middle, b = my[x] + middle;
        out[x] = (2 * a * b + c1) * (2 * covariance + c2) / ((a * a + b * b + c1) * (variances + c2));
    }
}

bool image_ssim_add(struct image_ssim *ssim, const struct image_pixels *test,
                    const struct image_pixels *reference, const struct image_rings *rings,
                    struct image_ring_sum *sum)
{
    if (!image_pair_ok(test, reference) || !image_rings_fit(rings, test->width, test->height) ||
        test->width < IMAGE_SSIM_WINDOW || test->height < IMAGE_SSIM_WINDOW || !reserve(ssim, test->width))
        return false;
    uint32_t count = test->width - 2 * RADIUS;
    for (uint32_t y = 0; y < test->height; y++) {
        add_input_row(ssim, test, reference, y);
        if (y < 2 * RADIUS)
            continue;
        for (int s = 0; s < SIGNALS; s++)
            filter_across(ssim, y, s, count);
        combine(ssim, count);
        image_ring_sum_row(sum, rings, y - RADIUS, RADIUS, count, ssim->values, NULL);
    }
    return true;
}
