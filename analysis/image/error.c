// Mean absolute error, RMSE and PSNR, plain and weighted by eccentricity: WMSE = sum w d^2 / sum w with
// w(e) = (fc(e) / fc(0))^2, fc after Geisler & Perry 1998 (eccentricity.c). The plain sums are exact integers,
// so they do not depend on the order of pixels, eyes or frames.
#include "analysis/image/error.h"

#include "analysis/image/eccentricity.h"

#include <math.h>

static const double rad_per_deg = 0.017453292519943295769;

struct direction {
    double x, y, z;
};

// As viewing_direction(): x and y are longitude and latitude, -z is ahead.
static struct direction gaze_direction(const struct image_view *view)
{
    double x = view->gaze_x_deg * rad_per_deg, y = view->gaze_y_deg * rad_per_deg;
    return (struct direction){sin(x) * cos(y), sin(y), -cos(x) * cos(y)};
}

// By atan2 of cross and dot products: acos loses half the digits near the gaze.
static double angle_deg(struct direction a, struct direction b)
{
    double cx = a.y * b.z - a.z * b.y, cy = a.z * b.x - a.x * b.z, cz = a.x * b.y - a.y * b.x;
    return atan2(sqrt(cx * cx + cy * cy + cz * cz), a.x * b.x + a.y * b.y + a.z * b.z) / rad_per_deg;
}

static struct direction pixel_direction(const struct image_view *view, uint32_t width, uint32_t height,
                                        double x, double y)
{
    return (struct direction){x / width * (view->tan_left + view->tan_right) - view->tan_left,
                              view->tan_up - y / height * (view->tan_down + view->tan_up), -1};
}

double image_eccentricity_deg(const struct image_view *view, uint32_t width, uint32_t height, double x,
                              double y)
{
    return angle_deg(gaze_direction(view), pixel_direction(view, width, height, x, y));
}

static size_t row_bytes(const struct image_pixels *image)
{
    return image->row_bytes ? image->row_bytes : (size_t)image->width * image->channels;
}

static bool pixels_ok(const struct image_pixels *image)
{
    return image->data && image->width && image->height && (image->channels == 3 || image->channels == 4) &&
           row_bytes(image) >= (size_t)image->width * image->channels;
}

static bool view_ok(const struct image_view *view)
{
    return isfinite(view->tan_left) && isfinite(view->tan_right) && isfinite(view->tan_down) &&
           isfinite(view->tan_up) && view->tan_left + view->tan_right > 0 && view->tan_down + view->tan_up > 0;
}

// One row's sums over colour channels into `sum`, and each pixel's weighted square where there is a view.
static void add_row(struct image_error_sum *sum, const uint8_t *a, uint32_t step_a, const uint8_t *b,
                    uint32_t step_b, uint32_t width, const double *weights)
{
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

static void chunk_weights(const struct image_view *view, struct direction gaze, bool gazed, uint32_t width,
                          uint32_t height, uint32_t x0, uint32_t y, uint32_t count, double *out)
{
    for (uint32_t i = 0; i < count; i++)
        out[i] = gazed ? eccentricity_weight(
                             angle_deg(gaze, pixel_direction(view, width, height, x0 + i + 0.5, y + 0.5)))
                       : 1;
}

bool image_error_add(struct image_error_sum *sum, const struct image_pixels *test,
                     const struct image_pixels *reference, const struct image_view *view)
{
    if (!pixels_ok(test) || !pixels_ok(reference) || test->width != reference->width ||
        test->height != reference->height || (view && !view_ok(view)))
        return false;
    uint32_t width = test->width, height = test->height;
    bool gazed = view && isfinite(view->gaze_x_deg) && isfinite(view->gaze_y_deg);
    struct direction gaze = gazed ? gaze_direction(view) : (struct direction){0, 0, -1};
    double weights[CHUNK];
    for (uint32_t y = 0; y < height; y++) {
        const uint8_t *a = test->data + y * row_bytes(test), *b = reference->data + y * row_bytes(reference);
        for (uint32_t x = 0; x < width; x += CHUNK) {
            uint32_t count = width - x < CHUNK ? width - x : CHUNK;
            if (view)
                chunk_weights(view, gaze, gazed, width, height, x, y, count, weights);
            add_row(sum, a + (size_t)x * test->channels, test->channels, b + (size_t)x * reference->channels,
                    reference->channels, count, view ? weights : NULL);
        }
    }
    sum->values += 3 * (uint64_t)width * height;
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
