// Flicker by sequences whose flicker is known, and input that the measures over rings must refuse.
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

static float motion[FORMULA_PX * 4];

static struct image_rings *formula_rings(void)
{
    struct image_rings *rings = image_rings_create();
    assert_non_null(rings);
    assert_true(image_rings_set(rings, FORMULA_WIDTH, FORMULA_HEIGHT, &formula_view));
    return rings;
}

// Everything stays where it is, at 2 m.
static void stand_still(void)
{
    for (int i = 0; i < FORMULA_PX; i++) {
        motion[4 * i] = (float)(i % FORMULA_WIDTH) + 0.5f;
        motion[4 * i + 1] = (float)(i / FORMULA_WIDTH) + 0.5f;
        motion[4 * i + 2] = motion[4 * i + 3] = 2;
    }
}

// Two frames of solid gray, the test's and the reference's levels.
static struct image_ring_sum two_grays(const uint8_t test[2], const uint8_t reference[2])
{
    struct image_rings *rings = formula_rings();
    struct image_flicker_excess *flicker = image_flicker_excess_create();
    struct image_ring_sum sum = {0};
    for (int t = 0; t < 2; t++) {
        struct formula_picture a, b;
        struct image_pixels x = formula_solid(&a, test[t], test[t], test[t]);
        struct image_pixels y = formula_solid(&b, reference[t], reference[t], reference[t]);
        assert_true(image_flicker_excess_add(flicker, &x, &y, motion, rings, &sum));
    }
    image_flicker_excess_destroy(flicker);
    image_rings_destroy(rings);
    return sum;
}

static void only_more_change_counts(void **state)
{
    (void)state;
    stand_still();
    struct image_ring_sum sum = two_grays((uint8_t[]){100, 130}, (uint8_t[]){100, 110});
    assert_true(sum.count[IMAGE_WHOLE] == FORMULA_PX);
    for (int region = 0; region < IMAGE_REGIONS; region++)
        assert_true(fabs(image_ring_mean(&sum, region) - 20) < 1e-4);
    sum = two_grays((uint8_t[]){100, 110}, (uint8_t[]){100, 130}); // calmer than the reference
    assert_true(image_ring_mean(&sum, IMAGE_WHOLE) == 0);
    sum = two_grays((uint8_t[]){50, 50}, (uint8_t[]){200, 200}); // wrong, but steady
    assert_true(image_ring_mean(&sum, IMAGE_WHOLE) == 0);
}

static void uncovered_pixels_are_masked(void **state)
{
    (void)state;
    stand_still();
    for (int i = 0; i < FORMULA_PX; i += 3) // expected farther than what the frame before saw there
        motion[4 * i + 2] = 2.1f;
    struct image_ring_sum sum = two_grays((uint8_t[]){100, 130}, (uint8_t[]){100, 100});
    assert_true(sum.count[IMAGE_WHOLE] == FORMULA_PX - FORMULA_PX / 3);
    for (int i = 0; i < FORMULA_PX; i++) // within the tolerance
        motion[4 * i + 2] = 2.03f;
    sum = two_grays((uint8_t[]){100, 130}, (uint8_t[]){100, 100});
    assert_true(sum.count[IMAGE_WHOLE] == FORMULA_PX);
    for (int i = 0; i < FORMULA_PX; i++) // background now, a surface before; and the other way round
        motion[4 * i + 2] = 0;
    sum = two_grays((uint8_t[]){100, 130}, (uint8_t[]){100, 100});
    assert_true(sum.count[IMAGE_WHOLE] == 0 && isnan(image_ring_mean(&sum, IMAGE_WHOLE)));
    for (int i = 0; i < FORMULA_PX; i++)
        motion[4 * i + 3] = 0;
    sum = two_grays((uint8_t[]){100, 130}, (uint8_t[]){100, 100});
    assert_true(sum.count[IMAGE_WHOLE] == FORMULA_PX); // background before and after
}

static void places_outside_are_masked(void **state)
{
    (void)state;
    stand_still();
    for (int i = 0; i < FORMULA_PX; i++)
        motion[4 * i] -= 2.25f;
    struct image_ring_sum sum = two_grays((uint8_t[]){100, 130}, (uint8_t[]){100, 100});
    assert_true(sum.count[IMAGE_WHOLE] == (FORMULA_WIDTH - 3) * FORMULA_HEIGHT);
    stand_still();
    motion[0] = NAN;
    motion[5] = INFINITY;
    motion[8] = -1e30f;
    motion[14] = NAN; // no distance is background
    sum = two_grays((uint8_t[]){100, 130}, (uint8_t[]){100, 100});
    assert_true(sum.count[IMAGE_WHOLE] == FORMULA_PX - 4);
}

// A picture that moves by whole pixels as its motion says does not flicker; standing motion would say it does.
static void motion_is_followed(void **state)
{
    (void)state;
    for (int moving = 0; moving < 2; moving++) {
        stand_still();
        for (int i = 0; moving && i < FORMULA_PX; i++)
            motion[4 * i] += 3;
        struct image_rings *rings = formula_rings();
        struct image_flicker_excess *flicker = image_flicker_excess_create();
        struct image_ring_sum sum = {0};
        struct formula_picture a, b;
        struct image_pixels test = formula_test(&a, 0), reference = formula_solid(&b, 9, 9, 9);
        assert_true(image_flicker_excess_add(flicker, &test, &reference, motion, rings, &sum));
        assert_true(isnan(image_ring_mean(&sum, IMAGE_WHOLE))); // the first frame
        memmove(a.data, a.data + 9, sizeof a.data - 9);         // three pixels to the left
        assert_true(image_flicker_excess_add(flicker, &test, &reference, motion, rings, &sum));
        double mean = image_ring_mean(&sum, IMAGE_WHOLE);
        assert_true(moving ? mean < 1e-4 : mean > 5);
        image_flicker_excess_cut(flicker);
        uint64_t before = sum.count[IMAGE_WHOLE];
        assert_true(image_flicker_excess_add(flicker, &test, &reference, motion, rings, &sum));
        assert_true(sum.count[IMAGE_WHOLE] == before);
        image_flicker_excess_destroy(flicker);
        image_rings_destroy(rings);
    }
}

// --- still views ---

// Two blocks of n frames that are white for half of each period and then black, against a steady gray; or,
// swapped, the steady gray against them.
static struct image_flicker_still_sum blinking(uint32_t n, uint32_t period, bool swapped)
{
    struct image_rings *rings = formula_rings();
    struct image_flicker_still *flicker = image_flicker_still_create(n, 90);
    assert_non_null(flicker);
    struct image_flicker_still_sum sum = {0};
    for (uint32_t t = 0; t < 2 * n; t++) {
        struct formula_picture a, b;
        uint8_t level = t % period < period / 2 ? 255 : 0;
        struct image_pixels test = formula_solid(&a, level, level, level);
        struct image_pixels steady = formula_solid(&b, 128, 128, 128);
        assert_true(image_flicker_still_add(flicker, swapped ? &steady : &test, swapped ? &test : &steady,
                                            rings, &sum));
    }
    image_flicker_still_destroy(flicker);
    image_rings_destroy(rings);
    return sum;
}

static void blinking_has_its_deviation(void **state)
{
    (void)state;
    // Black and white in turn: deviation 0.5; at 45 Hz all of it is at one frequency.
    struct image_flicker_still_sum sum = blinking(16, 2, false);
    for (int region = 0; region < IMAGE_REGIONS; region++) {
        assert_true(fabs(image_ring_mean(&sum.deviation, region) - 0.5) < 1e-6);
        double expected = 0.5 * image_transient_sensitivity(45);
        assert_true(fabs(image_ring_mean(&sum.weighted, region) - expected) < 1e-6);
    }
    sum = blinking(18, 18, false); // 5 Hz and its odd harmonics: 9 frames white, 9 black
    double square = 0;
    for (int k = 1; k <= 9; k += 2) { // |X_k| / N of a square wave of 18 samples: 1 / (18 sin(pi k / 18))
        double r = image_transient_sensitivity(5 * k), x = 1 / (18 * sin(3.14159265358979323846 * k / 18));
        square += (k == 9 ? 1 : 2) * r * r * x * x;
    }
    assert_true(fabs(image_ring_mean(&sum.deviation, IMAGE_WHOLE) - 0.5) < 1e-6);
    assert_true(fabs(image_ring_mean(&sum.weighted, IMAGE_WHOLE) - sqrt(square)) < 1e-6);
    struct image_flicker_still_sum swapped = blinking(18, 18, true);
    assert_true(image_ring_mean(&swapped.weighted, 1) == -image_ring_mean(&sum.weighted, 1));
    sum = blinking(15, 1, false); // never white; an odd block
    assert_true(image_ring_mean(&sum.deviation, 2) == 0 && image_ring_mean(&sum.weighted, 2) == 0);
}

static void weighted_grows_with_noise(void **state)
{
    (void)state;
    double before = 0;
    for (int amplitude = 4; amplitude <= 32; amplitude *= 2) {
        struct image_rings *rings = formula_rings();
        struct image_flicker_still *flicker = image_flicker_still_create(8, 90);
        struct image_flicker_still_sum sum = {0};
        for (int t = 0; t < 8; t++) {
            struct formula_picture a, b;
            struct image_pixels test = formula_noisy(&a, t, amplitude), reference = formula_reference(&b, 0);
            assert_true(image_flicker_still_add(flicker, &test, &reference, rings, &sum));
        }
        double weighted = image_ring_mean(&sum.weighted, IMAGE_WHOLE);
        assert_true(weighted > before && weighted < image_ring_mean(&sum.deviation, IMAGE_WHOLE));
        before = weighted;
        image_flicker_still_destroy(flicker);
        image_rings_destroy(rings);
    }
}

static void another_size_cuts_a_block(void **state)
{
    (void)state;
    struct image_rings *rings = formula_rings();
    struct image_flicker_still *flicker = image_flicker_still_create(4, 90);
    struct image_flicker_still_sum sum = {0};
    for (int t = 0; t < 6; t++) {
        struct formula_picture a;
        struct image_pixels image = formula_test(&a, t);
        image.height -= t >= 3;
        assert_true(image_rings_set(rings, image.width, image.height, &formula_view));
        assert_true(image_flicker_still_add(flicker, &image, &image, rings, &sum));
    }
    assert_true(sum.deviation.count[IMAGE_WHOLE] == 0 && isnan(image_ring_mean(&sum.deviation, 0)));
    image_flicker_still_destroy(flicker);
    image_rings_destroy(rings);
}

// --- bad input ---

// Every measure refuses the pair, and no sum changes.
static void refuse(const struct image_pixels *test, const struct image_pixels *reference,
                   const struct image_rings *rings)
{
    struct image_ssim *ssim = image_ssim_create();
    struct image_flip *flip = image_flip_create(12);
    struct image_flicker_excess *excess = image_flicker_excess_create();
    struct image_flicker_still *still = image_flicker_still_create(4, 90);
    struct image_error_rings sums = {0};
    struct image_ring_sum sum = {0};
    struct image_flicker_still_sum still_sum = {0};
    stand_still();
    assert_false(image_error_rings_add(&sums, test, reference, rings));
    assert_false(image_ssim_add(ssim, test, reference, rings, &sum));
    assert_false(image_flip_add(flip, test, reference, rings, &sum, NULL));
    assert_false(image_flicker_excess_add(excess, test, reference, motion, rings, &sum));
    assert_false(image_flicker_still_add(still, test, reference, rings, &still_sum));
    for (int region = 0; region < IMAGE_REGIONS; region++)
        assert_true(sums.region[region].values == 0 && isnan(image_ring_mean(&sum, region)));
    image_ssim_destroy(ssim);
    image_flip_destroy(flip);
    image_flicker_excess_destroy(excess);
    image_flicker_still_destroy(still);
}

static void refuses_bad_input(void **state)
{
    (void)state;
    struct formula_picture a;
    struct image_pixels good = formula_test(&a, 0), bad = good;
    struct image_rings *rings = formula_rings(), *none = image_rings_create();
    bad.height--;
    refuse(&good, &bad, rings);
    refuse(&bad, &bad, rings); // equal, but not the rings' size
    bad = good;
    bad.width = 0;
    refuse(&bad, &bad, none);
    bad = good;
    bad.data = NULL;
    refuse(&bad, &good, rings);
    bad = good;
    bad.channels = 1;
    refuse(&good, &bad, rings);
    refuse(&good, &good, none); // rings never set
    struct image_view closed = formula_view;
    closed.tan_up = (double)INFINITY;
    assert_false(image_rings_set(rings, FORMULA_WIDTH, FORMULA_HEIGHT, &closed));
    refuse(&good, &good, rings); // and emptied by a view that cannot be
    assert_false(image_rings_set(rings, 0, 5, &formula_view));
    image_rings_destroy(rings);
    image_rings_destroy(none);
}

static void small_images(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{10, 40}, {40, 10}, {11, 11}, {1, 1}, {3, 2}};
    struct formula_picture a, b;
    for (int i = 0; i < 5; i++) {
        struct image_pixels test = formula_test(&a, 0), reference = formula_reference(&b, 0);
        test.width = reference.width = sizes[i][0];
        test.height = reference.height = sizes[i][1];
        struct image_rings *rings = image_rings_create();
        assert_true(image_rings_set(rings, sizes[i][0], sizes[i][1], &formula_view));
        struct image_ssim *ssim = image_ssim_create();
        struct image_flip *flip = image_flip_create(67.02); // its filters are wider than the image
        struct image_ring_sum similar = {0}, different = {0};
        assert_int_equal(image_ssim_add(ssim, &test, &reference, rings, &similar), i == 2);
        assert_true(i == 2 ? similar.count[IMAGE_WHOLE] == 1 : isnan(image_ring_mean(&similar, IMAGE_WHOLE)));
        assert_true(image_flip_add(flip, &test, &reference, rings, &different, NULL));
        double mean = image_ring_mean(&different, IMAGE_WHOLE);
        assert_true(mean > 0 && mean < 1);
        image_ssim_destroy(ssim);
        image_flip_destroy(flip);
        image_rings_destroy(rings);
    }
}

static void refuses_bad_settings(void **state)
{
    (void)state;
    assert_null(image_flip_create(0.5));
    assert_null(image_flip_create(241));
    assert_null(image_flip_create((double)NAN));
    assert_null(image_flicker_still_create(3, 90));
    assert_null(image_flicker_still_create(257, 90));
    assert_null(image_flicker_still_create(32, 0));
    assert_null(image_flicker_still_create(32, (double)NAN));
    struct image_flip *sharpest = image_flip_create(240);
    assert_non_null(sharpest);
    image_flip_destroy(sharpest);
    image_flip_destroy(NULL);
    image_ssim_destroy(NULL);
    image_rings_destroy(NULL);
    image_flicker_excess_destroy(NULL);
    image_flicker_still_destroy(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(only_more_change_counts),
        cmocka_unit_test(uncovered_pixels_are_masked),
        cmocka_unit_test(places_outside_are_masked),
        cmocka_unit_test(motion_is_followed),
        cmocka_unit_test(blinking_has_its_deviation),
        cmocka_unit_test(weighted_grows_with_noise),
        cmocka_unit_test(another_size_cuts_a_block),
        cmocka_unit_test(refuses_bad_input),
        cmocka_unit_test(small_images),
        cmocka_unit_test(refuses_bad_settings),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
