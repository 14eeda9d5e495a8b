// Rings at 5, 15 and 30 degrees around the gaze: the fovea and its surround, the parafovea and near periphery
// where the modes of this program change their quality (their borders lie between 10 and 30 degrees), and the
// rest. Weights are eccentricity.h's, after Geisler & Perry 1998.
#include "analysis/image/rings.h"

#include "analysis/image/eccentricity.h"

#include <math.h>
#include <stdlib.h>

const double image_ring_limits_deg[IMAGE_RINGS + 1] = {0, 5, 15, 30, (double)INFINITY};

// A row is a plane through the eye; it cuts each cone narrower than a right angle at most twice, so three
// limits make at most seven runs.
enum { MAX_RUNS = 2 * IMAGE_RINGS };

struct row_runs {
    struct image_ring_run run[MAX_RUNS];
    uint32_t count;
};

struct image_rings {
    uint32_t width, height;
    struct image_view view;
    size_t capacity; // pixels
    double *weights; // width * height, owned
    struct row_runs *rows;
    uint32_t rows_capacity;
};

struct image_rings *image_rings_create(void)
{
    return calloc(1, sizeof(struct image_rings));
}

void image_rings_destroy(struct image_rings *rings)
{
    if (!rings)
        return;
    free(rings->weights);
    free(rings->rows);
    free(rings);
}

static bool reserve(struct image_rings *rings, uint32_t width, uint32_t height)
{
    size_t pixels = (size_t)width * height;
    if (pixels > rings->capacity) {
        double *weights = realloc(rings->weights, pixels * sizeof *weights);
        if (!weights)
            return false;
        rings->weights = weights;
        rings->capacity = pixels;
    }
    if (height > rings->rows_capacity) {
        struct row_runs *rows = realloc(rings->rows, height * sizeof *rows);
        if (!rows)
            return false;
        rings->rows = rows;
        rings->rows_capacity = height;
    }
    return true;
}

static uint32_t region_of(double e_deg)
{
    uint32_t region = 0;
    while (e_deg >= image_ring_limits_deg[region + 1])
        region++;
    return region;
}

static void set_row(struct image_rings *rings, uint32_t y)
{
    double *weights = rings->weights + (size_t)y * rings->width;
    struct row_runs *row = &rings->rows[y];
    bool gazed = image_view_gazed(&rings->view);
    if (gazed)
        image_row_eccentricities_deg(&rings->view, rings->width, rings->height, 0, y, rings->width, weights);
    row->count = 0;
    for (uint32_t x = 0; x < rings->width; x++) {
        uint32_t region = gazed ? region_of(weights[x]) : IMAGE_WHOLE;
        weights[x] = gazed ? eccentricity_weight(weights[x]) : 1;
        if (row->count == 0 || (row->run[row->count - 1].region != region && row->count < MAX_RUNS))
            row->run[row->count++] = (struct image_ring_run){x, x, region};
        row->run[row->count - 1].end = x + 1;
    }
}

static bool same_number(double a, double b)
{
    return a == b || (isnan(a) && isnan(b));
}

static bool same_view(const struct image_view *a, const struct image_view *b)
{
    return a->tan_left == b->tan_left && a->tan_right == b->tan_right && a->tan_down == b->tan_down &&
           a->tan_up == b->tan_up && same_number(a->gaze_x_deg, b->gaze_x_deg) &&
           same_number(a->gaze_y_deg, b->gaze_y_deg);
}

bool image_rings_set(struct image_rings *rings, uint32_t width, uint32_t height, const struct image_view *view)
{
    if (image_rings_fit(rings, width, height) && same_view(&rings->view, view))
        return true;
    rings->width = rings->height = 0;
    if (width == 0 || height == 0 || !image_view_ok(view) || !reserve(rings, width, height))
        return false;
    rings->width = width;
    rings->height = height;
    rings->view = *view;
    for (uint32_t y = 0; y < height; y++)
        set_row(rings, y);
    return true;
}

bool image_rings_fit(const struct image_rings *rings, uint32_t width, uint32_t height)
{
    return rings->width == width && rings->height == height && width > 0;
}

const struct image_ring_run *image_rings_runs(const struct image_rings *rings, uint32_t y, uint32_t *out_count)
{
    *out_count = rings->rows[y].count;
    return rings->rows[y].run;
}

const double *image_rings_weights(const struct image_rings *rings, uint32_t y)
{
    return rings->weights + (size_t)y * rings->width;
}

// Four sums side by side, so that a processor need not wait for each addition; in double, since a frame's half
// a million floats summed in float would lose three digits.
static double sum_all(const float *values, uint32_t count)
{
    double sums[4] = {0};
    uint32_t i = 0;
    for (; i + 4 <= count; i += 4)
        for (uint32_t k = 0; k < 4; k++)
            sums[k] += (double)values[i + k];
    for (; i < count; i++)
        sums[0] += (double)values[i];
    return sums[0] + sums[1] + sums[2] + sums[3];
}

static double sum_unmasked(const float *values, const uint8_t *mask, uint32_t count, uint32_t *out_counted)
{
    double sum = 0;
    uint32_t counted = 0;
    for (uint32_t i = 0; i < count; i++) {
        sum += mask[i] ? (double)values[i] : 0;
        counted += mask[i] != 0;
    }
    *out_counted = counted;
    return sum;
}

void image_ring_sum_row(struct image_ring_sum *sum, const struct image_rings *rings, uint32_t y, uint32_t x0,
                        uint32_t count, const float *values, const uint8_t *mask)
{
    const struct row_runs *row = &rings->rows[y];
    for (uint32_t i = 0; i < row->count; i++) {
        const struct image_ring_run *run = &row->run[i];
        uint32_t begin = run->begin > x0 ? run->begin : x0;
        uint32_t end = run->end < x0 + count ? run->end : x0 + count;
        if (begin >= end)
            continue;
        uint32_t counted = end - begin;
        double part = mask ? sum_unmasked(values + (begin - x0), mask + (begin - x0), end - begin, &counted)
                           : sum_all(values + (begin - x0), end - begin);
        sum->sum[IMAGE_WHOLE] += part;
        sum->count[IMAGE_WHOLE] += counted;
        if (run->region != IMAGE_WHOLE) {
            sum->sum[run->region] += part;
            sum->count[run->region] += counted;
        }
    }
}

double image_ring_mean(const struct image_ring_sum *sum, int region)
{
    return sum->count[region] ? sum->sum[region] / (double)sum->count[region] : (double)NAN;
}
