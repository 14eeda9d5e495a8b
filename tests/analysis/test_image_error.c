// Error measures between images, by hand-made pictures whose errors are known, and the check values of Geisler
// and Perry's model.
#include "analysis/image/eccentricity.h"
#include "analysis/image/error.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { WIDTH = 40, HEIGHT = 30 };

static void cutoff_has_published_values(void **state)
{
    (void)state;
    // Computed from the published formula with CT0 1/64, alpha 0.106, e2 2.3; two decimals.
    static const double values[][2] = {{0, 39.23}, {1, 27.35}, {2, 20.99}, {5, 12.36}, {10, 7.34},
                                       {20, 4.05}, {30, 2.79}, {40, 2.13}, {60, 1.45}};
    for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
        assert_true(fabs(eccentricity_cutoff_cpd(values[i][0]) - values[i][1]) <= 0.00501);
        double relative = eccentricity_cutoff_cpd(values[i][0]) / eccentricity_cutoff_cpd(0);
        assert_true(fabs(eccentricity_weight(values[i][0]) - relative * relative) < 1e-15);
    }
    assert_true(isnan(eccentricity_cutoff_cpd(-1)) && isnan(eccentricity_weight((double)NAN)));
}

static struct image_pixels picture(uint8_t *data, uint32_t channels, uint8_t level)
{
    memset(data, level, (size_t)WIDTH * HEIGHT * channels);
    return (struct image_pixels){data, WIDTH, HEIGHT, channels, 0};
}

static const struct image_view straight = {1, 1, 0.75, 0.75, 0, 0};

static void equal_images(void **state)
{
    (void)state;
    uint8_t a[WIDTH * HEIGHT * 3], b[WIDTH * HEIGHT * 4];
    struct image_pixels x = picture(a, 3, 77), y = picture(b, 4, 77);
    for (int i = 3; i < WIDTH * HEIGHT * 4; i += 4)
        b[i] = (uint8_t)i; // alpha is not looked at
    struct image_error e = image_error_pair(&x, &y, &straight);
    assert_true(e.mean_abs == 0 && e.max_abs == 0 && e.rmse == 0 && e.weighted_rmse == 0);
    assert_true(isinf(e.psnr_db) && e.psnr_db > 0 && isinf(e.weighted_psnr_db));
}

// A constant difference has the same error whatever the weights.
static void constant_difference(void **state)
{
    (void)state;
    uint8_t a[WIDTH * HEIGHT * 3], b[WIDTH * HEIGHT * 3];
    struct image_pixels x = picture(a, 3, 100), y = picture(b, 3, 110);
    struct image_error e = image_error_pair(&x, &y, &straight);
    assert_true(e.mean_abs == 10 && e.max_abs == 10 && e.rmse == 10);
    assert_true(fabs(e.weighted_rmse - 10) < 1e-12);
    assert_true(fabs(e.psnr_db - 28.1308036) < 1e-6); // 20 log10(25.5)
    e = image_error_pair(&y, &x, NULL);
    assert_true(e.mean_abs == 10 && isnan(e.weighted_rmse) && isnan(e.weighted_psnr_db));
}

static double one_pixel(int px, int py, const struct image_view *view)
{
    uint8_t a[WIDTH * HEIGHT * 3], b[WIDTH * HEIGHT * 3];
    struct image_pixels x = picture(a, 3, 100), y = picture(b, 3, 100);
    b[(py * WIDTH + px) * 3 + 1] = 160;
    struct image_error e = image_error_pair(&x, &y, view);
    assert_true(e.max_abs == 60);
    assert_true(fabs(e.mean_abs - 60.0 / (3 * WIDTH * HEIGHT)) < 1e-12);
    assert_true(fabs(e.rmse - 60 / sqrt(3 * WIDTH * HEIGHT)) < 1e-12);
    return e.weighted_rmse;
}

// One wrong pixel: its share is w / sum w, computed here from the definition.
static void weight_follows_gaze(void **state)
{
    (void)state;
    const double deg = 57.29577951308232;
    struct image_view view = {1.2, 0.8, 0.5, 0.9, 10, -5}; // asymmetric
    double gx = tan(10 / deg), gy = tan(-5 / deg) / cos(10 / deg), sum = 0, at[2] = {0, 0};
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            double u = (x + 0.5) / WIDTH * 2.0 - 1.2, v = 0.9 - (y + 0.5) / HEIGHT * 1.4;
            double dot = (u * gx + v * gy + 1) / sqrt((u * u + v * v + 1) * (gx * gx + gy * gy + 1));
            double w = pow(2.3 / (acos(fmin(1, dot)) * deg + 2.3), 2);
            sum += 3 * w;
            if (x == 27 && y == 20)
                at[0] = w;
            if (x == 2 && y == 3)
                at[1] = w;
        }
    assert_true(fabs(one_pixel(27, 20, &view) - 60 * sqrt(at[0] / sum)) < 1e-6);
    assert_true(fabs(one_pixel(2, 3, &view) - 60 * sqrt(at[1] / sum)) < 1e-6);
    assert_true(one_pixel(27, 20, &view) > 3 * one_pixel(2, 3, &view));
    view.gaze_x_deg = (double)NAN; // no gaze: plain
    assert_true(fabs(one_pixel(2, 3, &view) - 60 / sqrt(3 * WIDTH * HEIGHT)) < 1e-12);
}

static void sums_join(void **state)
{
    (void)state;
    uint8_t a[WIDTH * HEIGHT * 3], b[WIDTH * HEIGHT * 3];
    struct image_pixels x = picture(a, 3, 0), y = picture(b, 3, 30);
    struct image_error_sum sum = {0};
    assert_true(isnan(image_error_result(&sum).rmse));
    assert_true(image_error_add(&sum, &x, &y, &straight));
    assert_true(image_error_add(&sum, &x, &x, &straight));
    struct image_error e = image_error_result(&sum);
    assert_true(e.mean_abs == 15 && e.max_abs == 30 && fabs(e.rmse - 30 / sqrt(2)) < 1e-12);
    assert_true(fabs(e.weighted_rmse - 30 / sqrt(2)) < 1e-12);
}

static void gaze_direction_is_zero_eccentricity(void **state)
{
    (void)state;
    struct image_view view = {1, 1, 1, 1, 45, 0};
    assert_true(fabs(image_eccentricity_deg(&view, 100, 100, 100, 50)) < 1e-9); // the right edge's middle
    assert_true(fabs(image_eccentricity_deg(&view, 100, 100, 50, 50) - 45) < 1e-9);
    assert_true(fabs(image_eccentricity_deg(&view, 100, 100, 0, 50) - 90) < 1e-9);
}

static void refuses_bad_input(void **state)
{
    (void)state;
    uint8_t a[WIDTH * HEIGHT * 4];
    struct image_pixels good = picture(a, 3, 1), bad = good;
    struct image_error_sum sum = {0};
    bad.width--;
    assert_false(image_error_add(&sum, &good, &bad, NULL));
    bad = good;
    bad.channels = 2;
    assert_false(image_error_add(&sum, &good, &bad, NULL));
    bad = good;
    bad.row_bytes = WIDTH;
    assert_false(image_error_add(&sum, &bad, &good, NULL));
    bad = good;
    bad.height = good.height = 0;
    assert_false(image_error_add(&sum, &bad, &good, NULL));
    good = picture(a, 3, 1);
    struct image_view closed = straight;
    closed.tan_left = (double)NAN;
    assert_false(image_error_add(&sum, &good, &good, &closed));
    closed.tan_left = -1;
    assert_false(image_error_add(&sum, &good, &good, &closed));
    assert_int_equal(sum.values, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cutoff_has_published_values),
        cmocka_unit_test(equal_images),
        cmocka_unit_test(constant_difference),
        cmocka_unit_test(weight_follows_gaze),
        cmocka_unit_test(sums_join),
        cmocka_unit_test(gaze_direction_is_zero_eccentricity),
        cmocka_unit_test(refuses_bad_input),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
