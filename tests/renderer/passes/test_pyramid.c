// The pyramid (pull and fill) against the double-precision reference: levels, colours, depths, redraw map.
#include "tests/renderer/passes/pyramid_bed.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void any_image_agrees_with_the_reference(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{40, 36}, {33, 17}, {16, 16}, {70, 47}, {130, 20}};
    struct verdict sum = {0};
    size_t pixels = 0;
    for (size_t s = 0; s < countof(sizes); s++) {
        struct bed b;
        bed_open(&b, sizes[s][0], sizes[s][1]);
        struct pyramid unlimited = bed_make_unlimited(&b),
                       forced = bed_make(&b, &(struct fill_parameters){.epsilon = 0, .hole_decay = 1}, true);
        for (uint64_t seed = 0; seed < 8 * HOLES; seed++) {
            struct fill_parameters q;
            const bool force = seed / HOLES % 2;
            b.turns = force;
            bed_paint(&b, (enum holes)(seed % HOLES), 1000 * s + seed);
            bed_draw_parameters(&b, &q, seed / HOLES + 8 * seed + s);
            bed_use(force ? &forced : &unlimited, &q);
            for (size_t i = 0; i < b.count; i++)
                b.forced[i] = force && (i * 2654435761u + seed) % 7 == 0;
            bed_run(&b, force ? &forced : &unlimited, (uint32_t)seed % 2, force ? b.forced : NULL);
            struct verdict v = bed_judge(&b, &q);
            if (v.wrong_decisions || v.wrong_colours || v.wrong_positions)
                fail_msg(
                    "%u x %u, seed %u, epsilon %g, A %g, D %g: %u decisions, %u colours (%g) and %u positions "
                    "are wrong",
                    b.width, b.height, (unsigned)seed, q.epsilon, q.hole_decay, q.dynamic_decay,
                    v.wrong_decisions, v.wrong_colours, v.worst_colour, v.wrong_positions);
            sum.redrawn += v.redrawn;
            sum.kept_holes += v.kept_holes;
            sum.undecided += v.undecided;
            sum.worst_colour = fmax(sum.worst_colour, v.worst_colour);
            pixels += b.count;
        }
        pyramid_finish(&unlimited);
        pyramid_finish(&forced);
        bed_close(&b);
    }
    print_message("%zu pixels, %u redrawn, %u filled, %u too close to call; colours within %.3f of 255\n",
                  pixels, sum.redrawn, sum.kept_holes, sum.undecided, sum.worst_colour);
    assert_true(sum.kept_holes > pixels / 20 && sum.redrawn > pixels / 20 && sum.undecided < pixels / 200);
}

// Freshly drawn moving pixels that everything trusts: c_e = 1, so D^t falls under epsilon after P frames. Of
// any P frames exactly one redraws a pixel, the whole tile with it; over the image the turns are spread.
static void moving_pixels_are_redrawn_in_turns_of_whole_tiles(void **state)
{
    (void)state;
    static const struct {
        double epsilon, decay;
        uint32_t period; // the least P with D^P < epsilon
    } cases[] = {{0.2, 0.75, 6}, {0.2, 0.5, 3}, {0.05, 0.75, 11}, {0.5, 0.4, 1}};
    struct bed b;
    bed_open(&b, 130, 90);
    b.turns = true;
    bed_look(&b, 180, 0); // all is periphery
    struct pyramid pass = bed_make(&b, &(struct fill_parameters){.epsilon = 0, .hole_decay = 1}, true);
    for (size_t i = 0; i < b.count; i++) {
        b.positions[i][3] = i % 5 ? 2 : 1; // four in five move
        memcpy(b.colours[i], (const uint8_t[]){9, 9, 9, 255}, 4);
    }
    for (size_t c = 0; c < countof(cases); c++) {
        const struct fill_parameters q = {cases[c].epsilon, 10, 30, 0.6, cases[c].decay};
        uint32_t *redraws = calloc(b.count, sizeof *redraws), most = 0, all = 0;
        assert_non_null(redraws);
        bed_use(&pass, &q);
        for (b.turn = 7; b.turn < 7 + cases[c].period; b.turn++) {
            bed_run(&b, &pass, 0, b.forced);
            uint32_t now = 0;
            for (uint32_t i = 0; i < b.count; i++) {
                const uint32_t x = i % b.width & ~7u, y = i / b.width % b.height & ~7u;
                const uint32_t first = (i / (b.width * b.height) * b.height + y) * b.width + x;
                const uint32_t moving = first % 5 ? first : first + 1;
                assert_int_equal(b.map[i], i % 5 ? b.map[moving] : 0); // as the tile's first moving pixel
                redraws[i] += b.map[i];
                now += b.map[i];
            }
            most = now > most ? now : most;
            all += now;
        }
        for (size_t i = 0; i < b.count; i++)
            assert_int_equal(redraws[i], i % 5 != 0);
        print_message("period %u: at most %.0f %% of the moving pixels in one frame\n", cases[c].period,
                      100.0 * most / all);
        assert_true(most * cases[c].period < 2 * all);
        free(redraws);
    }
    pyramid_finish(&pass);
    bed_close(&b);
}

static void every_level_is_the_mean_and_contrast_of_its_inputs(void **state)
{
    (void)state;
    struct bed b;
    bed_open(&b, 70, 47);
    bed_look(&b, 0, 0);
    struct pyramid pass = bed_make_unlimited(&b);
    float(*level)[4] = malloc(b.count * sizeof *level * 4);
    float(*depths)[4] = malloc(b.count * sizeof *depths * 4);
    double worst = 0, worst_depth = 0;
    for (uint64_t seed = 0; seed < 2 * HOLES; seed++) {
        bed_paint(&b, (enum holes)(seed % HOLES), seed);
        bed_run(&b, &pass, 0, NULL);
        for (uint32_t eye = 0; eye < EYES; eye++) {
            const size_t at = eye * b.count / 2;
            struct fill_pyramid p =
                fill_build(b.width, b.height, &b.view.eyes[eye], (const uint8_t(*)[4])(b.colours + at),
                           (const float(*)[4])(b.positions + at));
            assert_int_equal(p.level_count, pass.confidence.levels);
            for (uint32_t m = 1; m <= p.level_count; m++) {
                const uint32_t width = pass.image.width >> (m - 1), height = pass.image.height >> (m - 1);
                rig_read_level(&b.rig, &pass.image, m - 1, &level[0][0]);
                rig_read_level(&b.rig, &pass.depth, m - 1, &depths[0][0]);
                for (uint32_t i = 0; i < width * height; i++) {
                    const uint32_t x = i % width, y = i / width;
                    const bool inside = x < p.levels[m].width && y < p.levels[m].height;
                    const double *expected = inside ? p.levels[m].texels[y * p.levels[m].width + x] : NULL;
                    for (int c = 0; c < 4; c++) {
                        const double got = (double)level[eye * width * height + i][c];
                        const double error = fabs(got - (expected ? expected[c] : 0));
                        assert_true(error < level_error);
                        worst = fmax(worst, error);
                    }
                    const float alpha = level[eye * width * height + i][3]; // nothing, or c_c
                    assert_true(alpha == 0 || (alpha >= 0.5f && alpha <= 1));
                    const double depth = (double)depths[eye * width * height + i][0];
                    if (!expected || expected[4] == 0) {
                        assert_true(depth == 0);
                        continue;
                    }
                    worst_depth = fmax(worst_depth, fabs(depth / expected[4] - 1));
                }
            }
            fill_free(&p);
        }
    }
    print_message("levels within %.1e, depths within %.1e of themselves\n", worst, worst_depth);
    assert_true(worst_depth < 1e-5);
    free(level);
    free(depths);
    pyramid_finish(&pass);
    bed_close(&b);
}

// Beyond the limit A^m < epsilon: those holes are redrawn whatever they hold.
static void the_limit_of_levels_changes_nothing(void **state)
{
    (void)state;
    static const double cases[][2] = {{0.2, 0.6}, {0.05, 0.6}, {0.1, 0.6}, {0.5, 0.6},
                                      {0.7, 0.6}, {0.2, 0.3},  {0.2, 0.9}, {0.3, 0}};
    struct bed b;
    bed_open(&b, 130, 20);
    struct pyramid unlimited = bed_make_unlimited(&b);
    uint8_t *map = malloc(b.count), (*result)[4] = malloc(b.count * sizeof *result);
    uint32_t kept = 0, shorter = 0, off = 0;
    for (size_t i = 0; i < countof(cases); i++) {
        const struct fill_parameters q = {cases[i][0], 10, 30, cases[i][1], 0.75};
        struct pyramid limited = bed_make(&b, &q, false);
        shorter += limited.confidence.levels < unlimited.confidence.levels;
        // the first level left out is worth less than epsilon, the last kept one is not (level 1 always stays)
        const double last = pow(q.hole_decay, limited.confidence.levels);
        assert_true(last >= q.epsilon || limited.confidence.levels == 1);
        for (uint64_t seed = 0; seed < 2 * HOLES; seed++) {
            bed_paint(&b, (enum holes)(seed % HOLES), 50 * i + seed);
            bed_look(&b, seed < HOLES ? 30 : -90, 10);
            bed_use(&unlimited, &q);
            bed_run(&b, &unlimited, 0, NULL);
            memcpy(map, b.map, b.count);
            memcpy(result, b.result, b.count * sizeof *result);
            bed_run(&b, &limited, 0, NULL);
            assert_memory_equal(map, b.map, b.count);
            for (size_t k = 0; k < b.count; k++) {
                kept += !map[k] && b.positions[k][3] == 0;
                for (int c = 0; c < 4 && !map[k]; c++)
                    off += b.result[k][c] != result[k][c];
            }
        }
        pyramid_finish(&limited);
    }
    print_message("%u kept holes, %u colour values differ; %u of %u pyramids are shorter\n", kept, off, shorter,
                  countof(cases));
    assert_true(kept > 1000 && shorter >= 6);
    assert_int_equal(off, 0);
    free(map);
    free(result);
    pyramid_finish(&unlimited);
    bed_close(&b);
}

static uint32_t redrawn_with(struct bed *b, struct pyramid *pass, const struct fill_parameters *q)
{
    uint32_t sum = 0;
    bed_use(pass, q);
    bed_run(b, pass, 1, NULL);
    for (size_t i = 0; i < b->count; i++)
        sum += b->map[i];
    return sum;
}

static void the_ends_of_epsilon_and_no_gaze(void **state)
{
    (void)state;
    struct bed b;
    bed_open(&b, 40, 36);
    struct pyramid pass = bed_make_unlimited(&b);
    struct fill_parameters q = paper;
    for (int holes = 0; holes < HOLES; holes++) {
        bed_paint(&b, (enum holes)holes, 9);
        bed_look(&b, 0, 0);
        q.epsilon = 0;
        assert_int_equal(redrawn_with(&b, &pass, &q), 0);
        for (size_t i = 0; holes != ALL_HOLES && i < b.count; i++)
            assert_int_equal(b.result[i][3], 255); // one valid pixel fills all
        q.epsilon = 1;
        assert_int_equal(redrawn_with(&b, &pass, &q), b.count);
        bed_look(&b, NAN, 0);
        q.epsilon = 1e-6;
        assert_int_equal(redrawn_with(&b, &pass, &q), b.count);
        // far beyond the image's edge everything valid and at rest is trusted
        bed_look(&b, 180, 0);
        q = paper;
        if (holes == NO_HOLES) {
            for (size_t i = 0; i < b.count; i++)
                b.positions[i][3] = 1;
            assert_int_equal(redrawn_with(&b, &pass, &q), 0);
        }
    }
    pyramid_finish(&pass);
    bed_close(&b);
}

// Surfaces are red, the background is blue: a hole filled from a block of pixels with any surface in it has no
// blue, and one filled from the background alone has no red.
static void the_background_does_not_bleed(void **state)
{
    (void)state;
    struct bed b;
    bed_open(&b, 70, 47);
    struct pyramid pass = bed_make_unlimited(&b);
    uint32_t beside_surface = 0, background = 0;
    for (uint64_t seed = 0; seed < 4 * HOLES; seed++) {
        uint64_t random = seed;
        bed_paint(&b, (enum holes)(seed % HOLES), seed);
        bed_look(&b, 0, 0);
        for (size_t i = 0; i < b.count; i++) {
            const uint8_t shade = (uint8_t)(64 + rig_below(&random, 190));
            const bool surface = b.positions[i][3] > 0;
            memcpy(b.colours[i], (const uint8_t[]){surface ? shade : 0, 0, surface ? 0 : shade, 255}, 4);
        }
        bed_run(&b, &pass, 0, NULL); // epsilon 0: every hole is kept
        for (size_t i = 0; i < b.count; i++) {
            if (b.positions[i][3] != 0)
                continue;
            const size_t eye = i / (b.count / 2) * (b.count / 2);
            const uint32_t x = (uint32_t)(i - eye) % b.width, y = (uint32_t)(i - eye) / b.width;
            bool any = false, surface = false;
            for (uint32_t m = 1; m < 8 && !any; m++) {
                for (uint32_t v = y >> m << m; v < ((y >> m) + 1) << m && v < b.height; v++) {
                    for (uint32_t u = x >> m << m; u < ((x >> m) + 1) << m && u < b.width; u++) {
                        const float w = b.positions[eye + v * b.width + u][3];
                        any |= w != 0;
                        surface |= w > 0;
                    }
                }
            }
            if (!any)
                continue;
            beside_surface += surface;
            background += !surface;
            assert_int_equal(b.result[i][surface ? 2 : 0], 0);
            assert_true(b.result[i][surface ? 0 : 2] >= 63);
            assert_true((b.after[i][0] > 0) == surface);
        }
    }
    print_message("%u holes filled beside surfaces, %u from the background alone\n", beside_surface,
                  background);
    assert_true(beside_surface > 10000 && background > 1000);
    pyramid_finish(&pass);
    bed_close(&b);
}

// What was not filled loses nothing by contrast or size: m = 0. Whatever its colours, a pixel that was kept and
// is at rest has c = c_e.
static void only_holes_lose_by_contrast_and_size(void **state)
{
    (void)state;
    struct bed b;
    bed_open(&b, 40, 36);
    struct pyramid pass = bed_make_unlimited(&b);
    const struct fill_parameters q = {0.999, 10, 30, 0.6, 0.75};
    bed_paint(&b, SPECKLED, 3); // noise of full contrast
    bed_look(&b, 180, 0);
    bed_use(&pass, &q);
    bed_run(&b, &pass, 0, NULL);
    for (size_t i = 0; i < b.count; i++)
        assert_int_equal(b.map[i], b.positions[i][3] == 0 || b.positions[i][3] >= 2);
    pyramid_finish(&pass);
    bed_close(&b);
}

int main(void)
{
    struct rig probe;
    if (!rig_open(&probe))
        return 77;
    rig_close(&probe);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_image_agrees_with_the_reference),
        cmocka_unit_test(moving_pixels_are_redrawn_in_turns_of_whole_tiles),
        cmocka_unit_test(every_level_is_the_mean_and_contrast_of_its_inputs),
        cmocka_unit_test(the_limit_of_levels_changes_nothing),
        cmocka_unit_test(the_ends_of_epsilon_and_no_gaze),
        cmocka_unit_test(the_background_does_not_bleed),
        cmocka_unit_test(only_holes_lose_by_contrast_and_size),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
