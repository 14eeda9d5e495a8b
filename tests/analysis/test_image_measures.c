// The image measures against tests/reference/image_measures.csv: the same pictures, computed by R in double
// precision straight from the papers' equations (image_measures.R). Each test prints the largest error it saw.
#include "analysis/image/error.h"
#include "analysis/image/flicker_excess.h"
#include "analysis/image/flicker_still.h"
#include "analysis/image/flip.h"
#include "analysis/image/ssim.h"
#include "formula.h"
#include "reference.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// The absolute error, which must not exceed `most`; the largest is kept in `worst`.
static void compare(const char *name, double value, double most, double *worst)
{
    double error = fabs(value - reference_value("image_measures.csv", name));
    if (!(error <= most))
        fail_msg("%s: %.9g, reference %.9g, error %.2g", name, value,
                 reference_value("image_measures.csv", name), error);
    if (error > *worst)
        *worst = error;
}

static void compare_rings(const char *measure, const struct image_ring_sum *sum, double most, double *worst)
{
    for (int region = 0; region < IMAGE_REGIONS; region++) {
        char name[64];
        snprintf(name, sizeof name, "%s.%s", measure, formula_region_name(region));
        compare(name, image_ring_mean(sum, region), most, worst);
    }
}

static struct image_rings *formula_rings(void)
{
    struct image_rings *rings = image_rings_create();
    assert_non_null(rings);
    assert_true(image_rings_set(rings, FORMULA_WIDTH, FORMULA_HEIGHT, &formula_view));
    return rings;
}

static void psnr(void **state)
{
    (void)state;
    struct image_rings *rings = formula_rings();
    struct formula_picture a, b;
    struct image_pixels test = formula_test(&a, 0), reference = formula_reference(&b, 0);
    struct image_error_rings sums = {0};
    assert_true(image_error_rings_add(&sums, &test, &reference, rings));
    double worst = 0;
    for (int region = 0; region < IMAGE_REGIONS; region++) {
        struct image_error error = image_error_result(&sums.region[region]);
        char name[64];
        snprintf(name, sizeof name, "pixels.%s", formula_region_name(region));
        assert_true((double)formula_ring_pixels(rings, FORMULA_HEIGHT, region) ==
                    reference_value("image_measures.csv", name));
        assert_true(sums.region[region].values == 3 * formula_ring_pixels(rings, FORMULA_HEIGHT, region));
        snprintf(name, sizeof name, "psnr.%s", formula_region_name(region));
        compare(name, error.psnr_db, 1e-11, &worst);
        snprintf(name, sizeof name, "wpsnr.%s", formula_region_name(region));
        compare(name, error.weighted_psnr_db, 1e-11, &worst);
    }
    print_message("PSNR: within %.1e dB\n", worst);
    image_rings_destroy(rings);
}

static void ssim(void **state)
{
    (void)state;
    struct image_rings *rings = formula_rings();
    struct formula_picture a, b;
    struct image_pixels test = formula_test(&a, 0), reference = formula_reference(&b, 0);
    struct image_ssim *ssim = image_ssim_create();
    struct image_ring_sum sum = {0};
    assert_true(image_ssim_add(ssim, &test, &reference, rings, &sum));
    assert_true(sum.count[IMAGE_WHOLE] == (FORMULA_WIDTH - 10) * (FORMULA_HEIGHT - 10));
    double worst = 0;
    compare_rings("ssim", &sum, 1e-6, &worst);
    print_message("SSIM: within %.1e\n", worst);
    image_ssim_destroy(ssim);
    image_rings_destroy(rings);
}

static void flip_at(double ppd, double *worst)
{
    struct image_rings *rings = formula_rings();
    struct formula_picture a, b;
    struct image_pixels test = formula_test(&a, 0), reference = formula_reference(&b, 0);
    struct image_flip *flip = image_flip_create(ppd);
    struct image_ring_sum sum = {0};
    static float map[FORMULA_PX];
    assert_true(image_flip_add(flip, &test, &reference, rings, &sum, map));
    char name[64];
    snprintf(name, sizeof name, "flip%g", ppd);
    compare_rings(name, &sum, 1e-5, worst);
    const int pixels[] = {0, 100, 777, 1000, 1500, FORMULA_PX - 1};
    for (int i = 0; i < 6; i++) {
        snprintf(name, sizeof name, "flip%g.pixel%d", ppd, pixels[i]);
        compare(name, (double)map[pixels[i]], 1e-5, worst);
    }
    image_flip_destroy(flip);
    image_rings_destroy(rings);
}

static void flip(void **state)
{
    (void)state;
    double worst = 0;
    flip_at(1, &worst);
    flip_at(5.27, &worst);
    flip_at(20, &worst);
    flip_at(67.02, &worst);
    print_message("FLIP: within %.1e\n", worst);
}

// Black on white is 0.9674, green on blue the largest difference there is.
static void flip_of_solid_colours(void **state)
{
    (void)state;
    static const struct {
        uint8_t test[3], reference[3];
        const char *name;
    } pairs[] = {{{0, 0, 0}, {255, 255, 255}, "flip.black_white"},
                 {{0, 255, 0}, {0, 0, 255}, "flip.green_blue"},
                 {{128, 128, 128}, {120, 120, 120}, "flip.gray"}};
    struct image_rings *rings = formula_rings();
    double worst = 0;
    for (int i = 0; i < 3; i++)
        for (double ppd = 2; ppd <= 200; ppd *= 10) { // nothing to filter: the same at each
            const uint8_t *t = pairs[i].test, *r = pairs[i].reference;
            struct formula_picture a, b;
            struct image_pixels test = formula_solid(&a, t[0], t[1], t[2]);
            struct image_pixels reference = formula_solid(&b, r[0], r[1], r[2]);
            struct image_flip *flip = image_flip_create(ppd);
            struct image_ring_sum sum = {0};
            assert_true(image_flip_add(flip, &test, &reference, rings, &sum, NULL));
            compare(pairs[i].name, image_ring_mean(&sum, IMAGE_WHOLE), 1e-5, &worst);
            image_flip_destroy(flip);
        }
    print_message("FLIP of solid colours: within %.1e\n", worst);
    image_rings_destroy(rings);
}

static void flicker_excess(void **state)
{
    (void)state;
    struct image_rings *rings = formula_rings();
    struct image_flicker_excess *flicker = image_flicker_excess_create();
    struct image_ring_sum sum = {0};
    for (int t = 0; t < 4; t++) {
        struct formula_picture a, b;
        struct image_pixels test = formula_test(&a, t), reference = formula_reference(&b, t);
        static float motion[FORMULA_PX * 4];
        formula_motion(motion, t);
        assert_true(image_flicker_excess_add(flicker, &test, &reference, motion, rings, &sum));
    }
    double worst = 0;
    compare_rings("excess", &sum, 1e-5, &worst);
    for (int region = 0; region < IMAGE_REGIONS; region++) {
        char name[64];
        snprintf(name, sizeof name, "excess.count.%s", formula_region_name(region));
        assert_true((double)sum.count[region] == reference_value("image_measures.csv", name));
    }
    print_message("flicker excess: within %.1e levels\n", worst);
    image_flicker_excess_destroy(flicker);
    image_rings_destroy(rings);
}

static void transient_sensitivity(void **state)
{
    (void)state;
    double worst = 0;
    const double hz[] = {0, 1, 5, 11.25, 45};
    for (int i = 0; i < 5; i++) {
        char name[64];
        snprintf(name, sizeof name, "r_trans.%g", hz[i]);
        compare(name, image_transient_sensitivity(hz[i]), 1e-14, &worst);
    }
    assert_true(isnan(image_transient_sensitivity(-1)) && isnan(image_transient_sensitivity((double)NAN)));
}

static void flicker_still(void **state)
{
    (void)state;
    struct image_rings *rings = formula_rings();
    struct image_flicker_still *flicker = image_flicker_still_create(16, 90);
    struct image_flicker_still_sum sum = {0};
    for (int t = 0; t < 37; t++) { // two blocks; the rest does not count
        struct formula_picture a, b;
        struct image_pixels test = formula_test(&a, t), reference = formula_reference(&b, t);
        assert_true(image_flicker_still_add(flicker, &test, &reference, rings, &sum));
    }
    assert_true(sum.deviation.count[IMAGE_WHOLE] == 2 * FORMULA_PX);
    double worst = 0;
    compare_rings("still.deviation", &sum.deviation, 2e-6, &worst);
    compare_rings("still.weighted", &sum.weighted, 2e-6, &worst);
    print_message("flicker of a still view: within %.1e of white\n", worst);
    image_flicker_still_destroy(flicker);
    image_rings_destroy(rings);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(psnr),           cmocka_unit_test(ssim),
        cmocka_unit_test(flip),           cmocka_unit_test(flip_of_solid_colours),
        cmocka_unit_test(flicker_excess), cmocka_unit_test(transient_sensitivity),
        cmocka_unit_test(flicker_still),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
