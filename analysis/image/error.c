// Mean absolute error, RMSE and PSNR, plain and weighted by eccentricity: WMSE = sum w d^2 / sum w with
// w(e) = (fc(e) / fc(0))^2, fc after Geisler & Perry 1998 (eccentricity.c). The plain sums are exact integers,
// so they do not depend on the order of pixels, eyes or frames.
#include "analysis/image/error.h"

#include "analysis/image/eccentricity.h"

#include <math.h>

// One row's sums over colour channels into `sum`, and each pixel's weighted square where there is a view.
static void add_row(struct image_error_sum *sum, const uint8_t *a, uint32_t step_a, const uint8_t *b,
                    uint32_t step_b, uint32_t width, const double *weights)
{
    sum->values += 3 * (uint64_t)width;
    for (uint32_t x = 0; x < width; x++, a += step_a, b += step_b) {
        uint32_t square = 0;
        for (int c = 0; c < 3; c++) {
            uint32_t d = a[c] > b[c] ? (uint32_t)(a[c] - b[c]) : (uint32_t)(b[c] - a[c]);
            sum->absolute += d;
            square += d * d;
            if (d > sum->max)
                sum->max = d;
        }
        sum->square += square;
        if (weights) {
            sum->weight += 3 * weights[x];
            sum->weighted_square += weights[x] * square;
        }
    }
}

enum { CHUNK = 256 };

static void chunk_weights(const struct image_view *view, uint32_t width, uint32_t height, uint32_t x0,
                          uint32_t y, uint32_t count, double *out)
{
    bool gazed = image_view_gazed(view);
    if (gazed)
        image_row_eccentricities_deg(view, width, height, x0, y, count, out);
    for (uint32_t i = 0; i < count; i++)
        out[i] = gazed ? eccentricity_weight(out[i]) : 1;
}

bool image_error_add(struct image_error_sum *sum, const struct image_pixels *test,
                     const struct image_pixels *reference, const struct image_view *view)
{
    if (!image_pair_ok(test, reference) || (view && !image_view_ok(view)))
        return false;
    uint32_t width = test->width, height = test->height;
    double weights[CHUNK];
    for (uint32_t y = 0; y < height; y++) {
        const uint8_t *a = test->data + y * image_row_bytes(test);
        const uint8_t *b = reference->data + y * image_row_bytes(reference);
        for (uint32_t x = 0; x < width; x += CHUNK) {
            uint32_t count = width - x < CHUNK ? width - x : CHUNK;
            if (view)
                chunk_weights(view, width, height, x, y, count, weights);
            add_row(sum, a + (size_t)x * test->channels, test->channels, b + (size_t)x * reference->channels,
                    reference->channels, count, view ? weights : NULL);
        }
    }
    return true;
}

static void join(struct image_error_sum *sum, const struct image_error_sum *other)
{
    sum->values += other->values;
    sum->absolute += other->absolute;
    sum->square += other->square;
    sum->max = other->max > sum->max ? other->max : sum->max;
    sum->weight += other->weight;
    sum->weighted_square += other->weighted_square;
}

bool image_error_rings_add(struct image_error_rings *sums, const struct image_pixels *test,
                           const struct image_pixels *reference, const struct image_rings *rings)
{
    if (!image_pair_ok(test, reference) || !image_rings_fit(rings, test->width, test->height))
        return false;
    for (uint32_t y = 0; y < test->height; y++) {
        const uint8_t *a = test->data + y * image_row_bytes(test);
        const uint8_t *b = reference->data + y * image_row_bytes(reference);
        const double *weights = image_rings_weights(rings, y);
        uint32_t count;
        const struct image_ring_run *run = image_rings_runs(rings, y, &count);
        for (const struct image_ring_run *end = run + count; run < end; run++) {
            struct image_error_sum part = {0};
            add_row(&part, a + (size_t)run->begin * test->channels, test->channels,
                    b + (size_t)run->begin * reference->channels, reference->channels, run->end - run->begin,
                    weights + run->begin);
            join(&sums->region[IMAGE_WHOLE], &part);
            if (run->region != IMAGE_WHOLE)
                join(&sums->region[run->region], &part);
        }
    }
    return true;
}

static double psnr_db(double rmse)
{
    return rmse == 0 ? (double)INFINITY : 20 * log10(255 / rmse);
}

struct image_error image_error_result(const struct image_error_sum *sum)
{
    double nan_value = (double)NAN;
    struct image_error error = {nan_value, nan_value, nan_value, nan_value, nan_value, nan_value};
    if (sum->values == 0)
        return error;
    double count = (double)sum->values;
    error.mean_abs = (double)sum->absolute / count;
    error.max_abs = sum->max;
    error.rmse = sqrt((double)sum->square / count);
    error.psnr_db = psnr_db(error.rmse);
    if (sum->weight > 0) {
        error.weighted_rmse = sqrt(sum->weighted_square / sum->weight);
        error.weighted_psnr_db = psnr_db(error.weighted_rmse);
    }
    return error;
}

struct image_error image_error_pair(const struct image_pixels *test, const struct image_pixels *reference,
                                    const struct image_view *view)
{
    struct image_error_sum sum = {0};
    image_error_add(&sum, test, reference, view);
    return image_error_result(&sum);
}
