// Our own measure, defined in flicker_still.h. R_trans is the transient channel of castleCSF: Ashraf, M.,
// Mantiuk, R., Chapiro, A. & Wuerger, S., "castleCSF - A contrast sensitivity function of color, area,
// spatiotemporal frequency, luminance and eccentricity", Journal of Vision 24(4):5 (2024); constants as in the
// authors' program.
#include "analysis/image/flicker_still.h"

#include "analysis/image/luma.h"

#include <math.h>
#include <stdlib.h>

enum { MIN_FRAMES = 4, MAX_FRAMES = 256, BLOCK_PX = 64 };

static const double pi = 3.14159265358979323846;

double image_transient_sensitivity(double hz)
{
    const double exponent = 0.1898, peak_hz = 5, width = 0.156257; // castleCSF, transient achromatic channel
    if (!(hz >= 0))
        return (double)NAN;
    double d = pow(hz, exponent) - pow(peak_hz, exponent);
    return exp(-d * d / width);
}

struct image_flicker_still {
    uint32_t block_frames, begun; // frames of the block that are there
    uint32_t width, height;
    float table[256];
    float *cosine, *sine;     // owned; (k - 1) * block_frames + t, k = 1 .. block_frames / 2
    float *plain, *transient; // owned; shares of |X_k|^2 in the two variances
    uint16_t *frames;         // owned; test then reference of each frame, 16-bit luminance
    float *row;               // owned; width
};

static bool set_tables(struct image_flicker_still *flicker, double frames_hz)
{
    uint32_t n = flicker->block_frames, half = n / 2;
    flicker->cosine = malloc((size_t)half * n * sizeof(float));
    flicker->sine = malloc((size_t)half * n * sizeof(float));
    flicker->plain = malloc(half * sizeof(float));
    flicker->transient = malloc(half * sizeof(float));
    if (!flicker->cosine || !flicker->sine || !flicker->plain || !flicker->transient)
        return false;
    for (uint32_t k = 1; k <= half; k++) {
        for (uint32_t t = 0; t < n; t++) {
            double angle = 2 * pi * (double)((uint64_t)k * t % n) / n;
            flicker->cosine[(k - 1) * n + t] = (float)cos(angle);
            flicker->sine[(k - 1) * n + t] = (float)sin(angle);
        }
        // X_k and X_(n - k) of a real series are equally large; at k = n / 2 they are the same one.
        double twice = 2 * k == n ? 1 : 2, r = image_transient_sensitivity(k * frames_hz / n);
        flicker->plain[k - 1] = (float)(twice / ((double)n * n));
        flicker->transient[k - 1] = (float)(r * r * twice / ((double)n * n));
    }
    return true;
}

struct image_flicker_still *image_flicker_still_create(uint32_t block_frames, double frames_hz)
{
    if (block_frames < MIN_FRAMES || block_frames > MAX_FRAMES || !(frames_hz > 0) || !isfinite(frames_hz))
        return NULL;
    struct image_flicker_still *flicker = calloc(1, sizeof *flicker);
    if (!flicker)
        return NULL;
    flicker->block_frames = block_frames;
    image_linear_table(flicker->table);
    if (!set_tables(flicker, frames_hz)) {
        image_flicker_still_destroy(flicker);
        return NULL;
    }
    return flicker;
}

void image_flicker_still_destroy(struct image_flicker_still *flicker)
{
    if (!flicker)
        return;
    free(flicker->cosine);
    free(flicker->sine);
    free(flicker->plain);
    free(flicker->transient);
    free(flicker->frames);
    free(flicker->row);
    free(flicker);
}

static bool reserve(struct image_flicker_still *flicker, uint32_t width, uint32_t height)
{
    if (width == flicker->width && height == flicker->height)
        return true;
    uint16_t *frames = malloc(2 * (size_t)flicker->block_frames * width * height * sizeof *frames);
    float *row = malloc(width * sizeof *row);
    if (!frames || !row) {
        free(frames);
        free(row);
        return false;
    }
    free(flicker->frames);
    free(flicker->row);
    flicker->frames = frames;
    flicker->row = row;
    flicker->width = width;
    flicker->height = height;
    flicker->begun = 0;
    return true;
}

// The plane of one frame, 0 the test's, 1 the reference's.
static uint16_t *plane_of(const struct image_flicker_still *flicker, uint32_t frame, int which)
{
    return flicker->frames + (2 * (size_t)frame + (size_t)which) * flicker->width * flicker->height;
}

static void keep(struct image_flicker_still *flicker, const struct image_pixels *image, int which)
{
    uint16_t *out = plane_of(flicker, flicker->begun, which);
    for (uint32_t y = 0; y < image->height; y++, out += image->width) {
        image_luminance_row(image, y, flicker->table, flicker->row);
        for (uint32_t x = 0; x < image->width; x++)
            out[x] = (uint16_t)(int)(flicker->row[x] * 65535 + 0.5f);
    }
}

// Both variances of BLOCK_PX pixels from `at` on. The first frame's value is taken off first: X_k for k > 0
// does not change, a still pixel is exactly 0, and nothing is lost to a large mean.
static void deviations(const struct image_flicker_still *flicker, int which, size_t at, uint32_t count,
                       float *restrict out_plain, float *restrict out_transient)
{
    float series[MAX_FRAMES][BLOCK_PX] = {{0}}, plain[BLOCK_PX] = {0}, transient[BLOCK_PX] = {0};
    uint32_t n = flicker->block_frames;
    const uint16_t *first = plane_of(flicker, 0, which) + at;
    for (uint32_t t = 1; t < n; t++) {
        const uint16_t *plane = plane_of(flicker, t, which) + at;
        for (uint32_t i = 0; i < count; i++)
            series[t][i] = (float)((int)plane[i] - (int)first[i]);
    }
    for (uint32_t k = 0; k < n / 2; k++) {
        float re[BLOCK_PX] = {0}, im[BLOCK_PX] = {0};
        for (uint32_t t = 1; t < n; t++) {
            float c = flicker->cosine[k * n + t], s = flicker->sine[k * n + t];
            for (uint32_t i = 0; i < BLOCK_PX; i++) {
                re[i] += c * series[t][i];
                im[i] += s * series[t][i];
            }
        }
        for (uint32_t i = 0; i < BLOCK_PX; i++) {
            float power = re[i] * re[i] + im[i] * im[i];
            plain[i] += flicker->plain[k] * power;
            transient[i] += flicker->transient[k] * power;
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        out_plain[i] = sqrtf(plain[i]) / 65535;
        out_transient[i] = sqrtf(transient[i]) / 65535;
    }
}

static void finish_block(const struct image_flicker_still *flicker, const struct image_rings *rings,
                         struct image_flicker_still_sum *sum)
{
    for (uint32_t y = 0; y < flicker->height; y++)
        for (uint32_t x = 0; x < flicker->width; x += BLOCK_PX) {
            uint32_t count = flicker->width - x < BLOCK_PX ? flicker->width - x : BLOCK_PX;
            size_t at = (size_t)y * flicker->width + x;
            float test[2][BLOCK_PX], reference[2][BLOCK_PX];
            deviations(flicker, 0, at, count, test[0], test[1]);
            deviations(flicker, 1, at, count, reference[0], reference[1]);
            for (uint32_t i = 0; i < count; i++) {
                test[0][i] -= reference[0][i];
                test[1][i] -= reference[1][i];
            }
            image_ring_sum_row(&sum->deviation, rings, y, x, count, test[0], NULL);
            image_ring_sum_row(&sum->weighted, rings, y, x, count, test[1], NULL);
        }
}

bool image_flicker_still_add(struct image_flicker_still *flicker, const struct image_pixels *test,
                             const struct image_pixels *reference, const struct image_rings *rings,
                             struct image_flicker_still_sum *sum)
{
    if (!image_pair_ok(test, reference) || !image_rings_fit(rings, test->width, test->height) ||
        !reserve(flicker, test->width, test->height))
        return false;
    keep(flicker, test, 0);
    keep(flicker, reference, 1);
    if (++flicker->begun == flicker->block_frames) {
        finish_block(flicker, rings, sum);
        flicker->begun = 0;
    }
    return true;
}
