// What every image measure must keep to, whatever the pictures: equal pictures, symmetry, more noise, rings
// that add up to the whole, and input that it must refuse.
#include "analysis/image/error.h"
#include "analysis/image/flicker_excess.h"
#include "analysis/image/flicker_still.h"
#include "analysis/image/flip.h"
#include "analysis/image/ssim.h"
#include "formula.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static struct image_rings *rings_for(uint32_t width, uint32_t height, const struct image_view *view)
{
    struct image_rings *rings = image_rings_create();
    assert_non_null(rings);
    assert_true(image_rings_set(rings, width, height, view));
    return rings;
}

static struct image_rings *formula_rings(void)
{
    return rings_for(FORMULA_WIDTH, FORMULA_HEIGHT, &formula_view);
}

// --- rings ---

static void rings_hold_their_pixels(void **state)
{
    (void)state;
    const double gazes[][2] = {{0, 0}, {7, -4}, {-35, 20}, {44, 44}, {120, 0}};
    for (int i = 0; i < 5; i++) {
        struct image_view view = {1.1, 0.9, 0.8, 0.9, gazes[i][0], gazes[i][1]};
        struct image_rings *rings = rings_for(97, 61, &view);
        uint64_t pixels = 0;
        for (int r = 0; r < IMAGE_RINGS; r++)
            pixels += formula_ring_pixels(rings, 61, r);
        assert_true(pixels == 97 * 61 && formula_ring_pixels(rings, 61, IMAGE_WHOLE) == pixels);
        for (uint32_t y = 0; y < 61; y++) {
            uint32_t count, x = 0;
            const struct image_ring_run *runs = image_rings_runs(rings, y, &count);
            for (uint32_t run = 0; run < count; run++) {
                assert_int_equal(runs[run].begin, x);
                for (; x < runs[run].end; x++) {
                    double e = image_eccentricity_deg(&view, 97, 61, x + 0.5, y + 0.5);
                    assert_true(e >= image_ring_limits_deg[runs[run].region] &&
                                e < image_ring_limits_deg[runs[run].region + 1]);
                    assert_true(fabs(image_rings_weights(rings, y)[x] - pow(2.3 / (e + 2.3), 2)) < 1e-14);
                }
            }
            assert_int_equal(x, 97);
        }
        image_rings_destroy(rings);
    }
}

static void rings_follow_the_view(void **state)
{
    (void)state;
    struct image_view view = formula_view;
    struct image_rings *rings = rings_for(64, 64, &view);
    uint64_t fovea = formula_ring_pixels(rings, 64, 0);
    assert_true(image_rings_set(rings, 64, 64, &view) && formula_ring_pixels(rings, 64, 0) == fovea);
    view.gaze_x_deg = 80; // out of the image
    assert_true(image_rings_set(rings, 64, 64, &view) && formula_ring_pixels(rings, 64, 0) == 0);
    assert_true(image_rings_set(rings, 32, 16, &formula_view) && image_rings_fit(rings, 32, 16));
    image_rings_destroy(rings);
}

// Without a gaze there is the whole image only, and every weight is 1.
static void no_gaze_no_rings(void **state)
{
    (void)state;
    struct image_view view = formula_view;
    view.gaze_y_deg = (double)NAN;
    struct image_rings *rings = rings_for(FORMULA_WIDTH, FORMULA_HEIGHT, &view);
    struct formula_picture a, b;
    struct image_pixels test = formula_test(&a, 0), reference = formula_reference(&b, 0);
    struct image_error_rings sums = {0};
    assert_true(image_error_rings_add(&sums, &test, &reference, rings));
    struct image_error whole = image_error_result(&sums.region[IMAGE_WHOLE]);
    assert_true(fabs(whole.psnr_db - whole.weighted_psnr_db) < 1e-12);
    assert_true(isnan(image_error_result(&sums.region[0]).rmse));
    struct image_ssim *ssim = image_ssim_create();
    struct image_ring_sum sum = {0};
    assert_true(image_ssim_add(ssim, &test, &reference, rings, &sum));
    assert_true(isnan(image_ring_mean(&sum, 1)) && image_ring_mean(&sum, IMAGE_WHOLE) < 1);
    image_ssim_destroy(ssim);
    image_rings_destroy(rings);
}

static void pixels_per_degree(void **state)
{
    (void)state;
    struct image_view view = {1, 1, 1.1917535925942099, 1.1917535925942099, 0, 0}; // tan 50 degrees
    // 720 / (2 tan 50) * pi / 180 = 5.272218; the width is 640 / 720 of the height in tangents too
    view.tan_left = view.tan_right = view.tan_up * 640 / 720;
    assert_true(fabs(image_pixels_per_degree(&view, 640, 720) - 5.272218474) < 1e-6);
    assert_true(fabs(image_pixels_per_degree(&view, 1280, 1440) - 2 * 5.272218474) < 1e-6);
    // By finite differences of the angle between pixels at the middle of an asymmetric frustum.
    view = (struct image_view){1.4, 0.8, 0.5, 1.2, 0, 0};
    double x = (0.8 - 1.4) / 2, y = (1.2 - 0.5) / 2, deg = 180 / 3.14159265358979323846;
    view.gaze_x_deg = atan(x) * deg;
    view.gaze_y_deg = atan2(y, hypot(x, 1)) * deg;
    double step = 0.01; // pixels
    double along_x = step / image_eccentricity_deg(&view, 500, 300, 250 + step, 150);
    double along_y = step / image_eccentricity_deg(&view, 500, 300, 250, 150 + step);
    assert_true(fabs(image_pixels_per_degree(&view, 500, 300) / sqrt(along_x * along_y) - 1) < 1e-4);
    view.tan_left = -2;
    assert_true(isnan(image_pixels_per_degree(&view, 500, 300)));
    assert_true(isnan(image_pixels_per_degree(&formula_view, 0, 300)));
}

// --- one frame: error, SSIM and FLIP ---

struct measured {
    struct image_error_rings error;
    struct image_ring_sum ssim, flip;
};

static struct measured measure(const struct image_pixels *test, const struct image_pixels *reference)
{
    struct measured m = {0};
    struct image_rings *rings = formula_rings();
    struct image_ssim *ssim = image_ssim_create();
    struct image_flip *flip = image_flip_create(12);
    assert_true(image_error_rings_add(&m.error, test, reference, rings));
    assert_true(image_ssim_add(ssim, test, reference, rings, &m.ssim));
    assert_true(image_flip_add(flip, test, reference, rings, &m.flip, NULL));
    image_flip_destroy(flip);
    image_ssim_destroy(ssim);
    image_rings_destroy(rings);
    return m;
}

static void equal_images(void **state)
{
    (void)state;
    struct formula_picture a, b;
    struct image_pixels test = formula_test(&a, 0), same = formula_test(&b, 0);
    struct measured m = measure(&test, &same);
    for (int region = 0; region < IMAGE_REGIONS; region++) {
        struct image_error error = image_error_result(&m.error.region[region]);
        assert_true(isinf(error.psnr_db) && isinf(error.weighted_psnr_db) && error.psnr_db > 0);
        assert_true(image_ring_mean(&m.ssim, region) == 1);
        assert_true(image_ring_mean(&m.flip, region) == 0);
    }
}

static void symmetric(void **state)
{
    (void)state;
    struct formula_picture a, b;
    struct image_pixels test = formula_test(&a, 0), reference = formula_reference(&b, 0);
    struct measured m = measure(&test, &reference), n = measure(&reference, &test);
    assert_memory_equal(&m.error, &n.error, sizeof m.error);
    for (int region = 0; region < IMAGE_REGIONS; region++) {
        assert_true(fabs(m.ssim.sum[region] - n.ssim.sum[region]) < 1e-6 * (double)m.ssim.count[region]);
        assert_true(fabs(m.flip.sum[region] - n.flip.sum[region]) < 1e-6 * (double)m.flip.count[region]);
    }
}

static void more_noise_is_worse(void **state)
{
    (void)state;
    struct formula_picture a, b;
    struct image_pixels reference = formula_reference(&b, 0);
    double psnr = (double)INFINITY, weighted = psnr, ssim = 1, flip = 0;
    for (int amplitude = 2; amplitude <= 64; amplitude *= 2) {
        struct image_pixels test = formula_noisy(&a, 1, amplitude);
        struct measured m = measure(&test, &reference);
        struct image_error error = image_error_result(&m.error.region[IMAGE_WHOLE]);
        assert_true(error.psnr_db < psnr && error.weighted_psnr_db < weighted);
        assert_true(image_ring_mean(&m.ssim, IMAGE_WHOLE) < ssim);
        assert_true(image_ring_mean(&m.flip, IMAGE_WHOLE) > flip);
        psnr = error.psnr_db;
        weighted = error.weighted_psnr_db;
        ssim = image_ring_mean(&m.ssim, IMAGE_WHOLE);
        flip = image_ring_mean(&m.flip, IMAGE_WHOLE);
    }
    assert_true(flip < 1 && ssim > 0);
}

static void expect_partition(const struct image_ring_sum *sum)
{
    double total = 0;
    uint64_t count = 0;
    for (int r = 0; r < IMAGE_RINGS; r++) {
        if (sum->count[r])
            total += image_ring_mean(sum, r) * (double)sum->count[r];
        count += sum->count[r];
    }
    assert_true(count == sum->count[IMAGE_WHOLE] && count > 0);
    assert_true(fabs(total / (double)count - image_ring_mean(sum, IMAGE_WHOLE)) < 1e-12);
}

static void rings_add_up(void **state)
{
    (void)state;
    struct formula_picture a, b;
    struct image_pixels test = formula_test(&a, 0), reference = formula_reference(&b, 0);
    struct measured m = measure(&test, &reference);
    expect_partition(&m.ssim);
    expect_partition(&m.flip);
    struct image_error_sum total = {0};
    for (int r = 0; r < IMAGE_RINGS; r++) {
        total.values += m.error.region[r].values;
        total.square += m.error.region[r].square;
        total.weight += m.error.region[r].weight;
    }
    const struct image_error_sum *whole = &m.error.region[IMAGE_WHOLE];
    assert_true(total.values == whole->values && total.square == whole->square);
    assert_true(fabs(total.weight - whole->weight) < 1e-9 * whole->weight);
    // and the whole is what the measure without rings says
    struct image_error one = image_error_pair(&test, &reference, &formula_view),
                       all = image_error_result(whole);
    assert_true(one.rmse == all.rmse && one.mean_abs == all.mean_abs && one.max_abs == all.max_abs);
    assert_true(fabs(one.weighted_rmse - all.weighted_rmse) < 1e-12);
}

static void frames_and_layouts_join(void **state)
{
    (void)state;
    struct formula_picture a, b;
    struct image_pixels test = formula_test(&a, 0), reference = formula_reference(&b, 0);
    static uint8_t padded[FORMULA_HEIGHT][FORMULA_WIDTH * 4 + 20];
    for (int y = 0; y < FORMULA_HEIGHT; y++)
        for (int x = 0; x < FORMULA_WIDTH; x++)
            memcpy(&padded[y][4 * x], &a.data[3 * (y * FORMULA_WIDTH + x)], 3);
    struct image_pixels rgba = {padded[0], FORMULA_WIDTH, FORMULA_HEIGHT, 4, sizeof padded[0]};
    struct measured m = measure(&test, &reference), n = measure(&rgba, &reference);
    assert_memory_equal(&m, &n, sizeof m);
    struct image_ring_sum twice = m.flip;
    struct image_rings *rings = formula_rings();
    struct image_flip *flip = image_flip_create(12);
    assert_true(image_flip_add(flip, &rgba, &reference, rings, &twice, NULL));
    image_flip_destroy(flip);
    image_rings_destroy(rings);
    assert_true(image_ring_mean(&twice, 2) == image_ring_mean(&m.flip, 2));
    assert_true(twice.count[IMAGE_WHOLE] == 2 * FORMULA_PX);
}

// A change in one place is seen there only: at 12 pixels per degree FLIP reaches two pixels, SSIM five.
static void far_pixels_do_not_care(void **state)
{
    (void)state;
    struct formula_picture a, b;
    struct image_pixels test = formula_reference(&a, 0), reference = formula_reference(&b, 0);
    a.data[3 * (20 * FORMULA_WIDTH + 30)] ^= 0x80;
    struct image_rings *rings = formula_rings();
    struct image_flip *flip = image_flip_create(12);
    struct image_ring_sum sum = {0};
    static float map[FORMULA_PX];
    assert_true(image_flip_add(flip, &test, &reference, rings, &sum, map));
    double total = 0;
    for (int i = 0; i < FORMULA_PX; i++) {
        int x = i % FORMULA_WIDTH, y = i / FORMULA_WIDTH;
        total += (double)map[i];
        assert_true(map[i] >= 0 && map[i] <= 1);
        if (abs(x - 30) > 2 || abs(y - 20) > 2)
            assert_true(map[i] == 0);
    }
    assert_true(map[20 * FORMULA_WIDTH + 30] > 0.1f);
    assert_true(fabs(total - sum.sum[IMAGE_WHOLE]) < 1e-9);
    image_flip_destroy(flip);
    image_rings_destroy(rings);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rings_hold_their_pixels),
        cmocka_unit_test(rings_follow_the_view),
        cmocka_unit_test(no_gaze_no_rings),
        cmocka_unit_test(pixels_per_degree),
        cmocka_unit_test(equal_images),
        cmocka_unit_test(symmetric),
        cmocka_unit_test(more_noise_is_worse),
        cmocka_unit_test(rings_add_up),
        cmocka_unit_test(frames_and_layouts_join),
        cmocka_unit_test(far_pixels_do_not_care),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
