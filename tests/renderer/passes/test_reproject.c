// Reprojection (splat or points, and resolve) against brute force, and at its hard places.
#include "tests/renderer/passes/reproject_bed.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void the_same_eye_sees_the_same(void **state)
{
    (void)state;
    struct bed b;
    bed_open(&b, 40, 36);
    bed_scatter(&b, &b.warp.view, 1);
    for (size_t i = 0; i < 2 * bed_pixels(&b); i++) { // no motion: nothing ages, nothing lies twice
        if (b.warp.positions[i][3] >= 2)
            b.warp.positions[i][3] = 1;
    }
    bed_run(&b);
    uint32_t moved = 0;
    for (size_t i = 0; i < 2 * bed_pixels(&b); i++) {
        const bool hole = b.warp.positions[i][3] == 0;
        const bool twice = i % bed_pixels(&b) && memcmp(b.warp.positions[i], b.warp.positions[i - 1], 16) == 0;
        moved += twice;
        if (twice)
            continue;
        assert_int_equal(b.sources[i], hole ? -1 : (int64_t)(i % bed_pixels(&b)));
        if (!hole)
            assert_memory_equal(b.result[i], b.warp.positions[i], sizeof b.result[i]);
    }
    assert_true(moved > 20);
    assert_int_equal(bed_judge(&b).wrong, 0);
    bed_close(&b);
}

static void vary(struct bed *b, uint64_t seed)
{
    uint64_t random = 1000 + seed;
    struct rig_view *v = &b->warp.view, before = rig_view_default(b->width, b->height);
    *v = before;
    b->warp.drop_deg = seed % 3 == 0 ? 0 : rig_uniform(&random, 1, 40);
    b->warp.drop_moving = seed % 4 == 2;
    if (seed % 4 == 1) // the origin moves, the positions are kept from the old one
        v->last_origin = before.origin = (struct dvec3){128, -64, 64};
    const struct dvec3 at = dvec3_add(v->last_origin, (struct dvec3){1, 2, -3});
    const struct dquat turn = rig_turn(&random, seed % 5 == 4 ? 6.28 : 0.2);
    const struct dvec3 step = {rig_uniform(&random, -0.3, 0.3), rig_uniform(&random, -0.3, 0.3),
                               rig_uniform(&random, -0.3, 0.3)};
    for (int eye = 0; eye < EYES; eye++) {
        struct rig_eye *now = &v->eyes[eye], *old = &before.eyes[eye];
        old->pose.position = dvec3_add(old->pose.position, at);
        now->pose.position = dvec3_add(old->pose.position, seed % 2 ? step : (struct dvec3){0, 0, 0});
        now->pose.orientation = turn;
        if (seed % 2) // off-centre frusta, as headsets have
            now->fov = (struct viewing_fov){1.3 - 0.5 * eye, 0.8 + 0.5 * eye, 1.2, 0.9};
        now->gaze_x_deg = seed == 7 ? NAN : rig_uniform(&random, -60, 60);
        now->gaze_y_deg = rig_uniform(&random, -60, 60);
    }
    for (uint32_t id = 1; id < WARP_MOTIONS; id++) {
        struct dmat4 m = dmat4_compose((struct dvec3){rig_uniform(&random, -0.1, 0.1), 0.05, 0},
                                       rig_turn(&random, 0.1), (struct dvec3){1, 1, 1});
        bed_set_motion(b, id, &m);
    }
    bed_scatter(b, &before, seed);
}

static void any_view_agrees_with_brute_force(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{40, 36}, {33, 17}, {16, 16}};
    struct warp_verdict sum = {0};
    for (uint64_t size = 0; size < 3; size++) {
        struct bed b;
        bed_open(&b, sizes[size][0], sizes[size][1]);
        for (uint64_t seed = 0; seed < 12; seed++) {
            vary(&b, 100 * size + seed);
            bed_run(&b);
            struct warp_verdict v = bed_judge(&b);
            if (v.wrong)
                fail_msg("size %u x %u, seed %u: %u pixels are wrong", b.width, b.height, (unsigned)seed,
                         v.wrong);
            bed_add(&sum, &v);
        }
        bed_close(&b);
    }
    bed_tell("random points", &sum);
    assert_true(sum.certain > 0.95 * sum.pixels && sum.covered > sum.pixels / 5 && sum.shows > 100);
    assert_true(sum.undecided < sum.pixels / 100);
}

static void only_what_is_in_front_lands(void **state)
{
    (void)state;
    struct bed b;
    bed_open(&b, 40, 36);
    for (int eye = 0; eye < EYES; eye++)
        b.warp.view.eyes[eye].pose.position = (struct dvec3){0, 0, 0};
    static const struct {
        struct dvec3 p;
        double w;
        bool lands;
    } points[] = {
        {{0.1, 0.1, 1}, 1, false},       // behind
        {{0, 0, 0}, 1, false},           // in the eye
        {{0.3, 0.2, -1e-30}, 1, false},  // beside the eye
        {{0.01, 0, -0.0499}, 1, false},  // before the near plane
        {{0.02, 0.02, -0.05}, 1, true},  // on it
        {{5, 0.1, -1}, 1, false},        // right of the image
        {{0, -1.2, -1}, 1, false},       // below
        {{0.4, 0.3, -1e6}, 1, true},     // far
        {{0.6, 0.0, -0.8}, -1, true},    // the background
        {{0, 0, 1}, -1, false},          // behind
        {{1, 0, 0}, -1, false},          // at right angles
        {{0.8, 0.6, -1e-8}, -1, false},  // nearly so
        {{-0.2, 0.3, -1}, 0, false},     // a filled hole
        {{-0.2, -0.3, 1e30}, 1, false},  //
        {{-1e30, 1e30, -1e30}, 1, true}, // 45 deg left and up
        {{-INFINITY, 1, -1}, 1, false},  // at infinity
        {{1, 1, -INFINITY}, 1, false},   //
        {{NAN, 1, -1}, 1, false},        // nowhere
    };
    uint32_t landed = 0, expected = 0;
    for (size_t i = 0; i < countof(points); i++) {
        bed_put(&b, 3 * i, points[i].p, points[i].w);
        bed_put(&b, bed_pixels(&b) + 3 * i, points[i].p, points[i].w);
        expected += 2 * points[i].lands;
    }
    bed_run(&b);
    for (size_t i = 0; i < 2 * bed_pixels(&b); i++) {
        if (b.sources[i] < 0)
            continue;
        landed++;
        assert_true(points[b.sources[i] / 3].lands);
    }
    assert_int_equal(landed, expected);
    assert_int_equal(bed_judge(&b).wrong, 0);
    bed_close(&b);
}

static void the_nearest_wins_and_of_equals_the_first(void **state)
{
    (void)state;
    struct bed b;
    bed_open(&b, 40, 36);
    const struct rig_eye *e = &b.warp.view.eyes[0];
    const struct dvec3 ray = viewing_pixel_direction(&e->fov, 40, 36, 20.5, 10.5);
    for (int order = 0; order < 2; order++) {
        memset(b.warp.positions, 0, 2 * bed_pixels(&b) * sizeof *b.warp.positions);
        bed_put(&b, 100, ray, -1);
        for (size_t i = 0; i < 5; i++) { // 1 mm apart at 2 m, both ways round
            const double distance = 2 + 1e-3 * (order ? 4 - (double)i : (double)i);
            bed_put(&b, 200 + 50 * i, dvec3_add(e->pose.position, dvec3_scale(ray, distance)), 1);
        }
        const size_t nearest = order ? 400 : 200;
        memcpy(b.warp.positions[nearest + 7], b.warp.positions[nearest], sizeof b.warp.positions[0]);
        bed_run(&b);
        assert_int_equal(b.sources[10 * 40 + 20], nearest);
        assert_int_equal(bed_judge(&b).wrong, 0);
    }
    bed_close(&b);
}

// Kept for many frames without motion of the eye, points stay in their place to the last bit; those on moving
// objects grow older up to 63 frames.
static void positions_do_not_drift_and_ages_end(void **state)
{
    (void)state;
    struct bed b;
    bed_open(&b, 33, 17);
    bed_scatter(&b, &b.warp.view, 5);
    const struct dmat4 identity = dmat4_identity();
    for (uint32_t id = 0; id < WARP_MOTIONS; id++)
        bed_set_motion(&b, id, &identity);
    for (size_t i = 0; i < 2 * bed_pixels(&b); i++) {
        if (b.warp.positions[i][3] >= 2)
            b.warp.positions[i][3] = floorf(b.warp.positions[i][3]);
    }
    bed_run(&b);
    float(*first)[4] = malloc(2 * bed_pixels(&b) * sizeof *first);
    memcpy(first, b.result, 2 * bed_pixels(&b) * sizeof *first);
    for (uint32_t frame = 2; frame <= 80; frame++) {
        bed_record(&b, &b.pass, (frame + 1) % 2);
        if (frame != 2 && frame != 63 && frame != 64 && frame != 80)
            continue;
        rig_download(&b.rig, &b.position[frame % 2], sizeof b.result[0], b.result);
        for (size_t i = 0; i < 2 * bed_pixels(&b); i++) {
            assert_memory_equal(b.result[i], first[i], 3 * sizeof(float));
            const float age = (float)(frame < 63 ? frame : 63);
            const float w = first[i][3] >= 2 ? floorf(first[i][3]) + age / 64 : first[i][3];
            assert_true(b.result[i][3] == w);
        }
    }
    free(first);
    bed_close(&b);
}

// An object scaled to nothing has no inverse: its motion is not a number. Its points vanish, the others stay.
static void an_impossible_motion_loses_its_object_only(void **state)
{
    (void)state;
    struct bed b;
    bed_open(&b, 40, 36);
    static const double bad[] = {NAN, INFINITY, -INFINITY, 1e38};
    for (size_t i = 0; i < countof(bad); i++) {
        bed_scatter(&b, &b.warp.view, 60 + i);
        struct dmat4 m = dmat4_identity();
        for (int k = 0; k < 16; k++)
            m.m[k] = k % 4 == 3 ? m.m[k] : bad[i];
        bed_set_motion(&b, 3, &m);
        bed_run(&b); // which fails if anything that came out is not finite
        struct warp_verdict v = bed_judge(&b);
        if (v.wrong)
            fail_msg("a motion of %g: %u pixels are wrong", bad[i], v.wrong);
    }
    bed_close(&b);
}

// With 100 deg of view nothing that was seen is still in sight, unless the turn is about the axis of sight.
static void a_half_turn_leaves_nothing(void **state)
{
    (void)state;
    struct bed b;
    bed_open(&b, 45, 36);
    const struct rig_view before = rig_view_default(b.width, b.height);
    for (uint64_t seed = 0; seed < 3; seed++) {
        bed_scatter(&b, &before, 80 + seed);
        for (size_t i = 0; i < 2 * bed_pixels(&b); i++) // objects may come round
            b.warp.positions[i][3] = fminf(b.warp.positions[i][3], 1);
        b.warp.view = before;
        for (int eye = 0; eye < EYES; eye++)
            b.warp.view.eyes[eye].pose.orientation =
                seed == 2 ? (struct dquat){0, 0, 1, 0} : (struct dquat){seed == 1, seed == 0, 0, 0};
        bed_run(&b);
        const struct warp_verdict v = bed_judge(&b);
        assert_int_equal(v.wrong, 0);
        assert_true(seed == 2 ? v.covered > v.pixels / 4 : v.covered == 0);
    }
    bed_close(&b);
}

// Gaze ahead, in a corner, outside the image, at right angles, beyond, behind, none: within drop_deg of it, and
// nowhere else, nothing lands.
static void the_fovea_is_dropped_wherever_it_is(void **state)
{
    (void)state;
    static const double gazes[][2] = {{0, 0},  {49, 49},   {-80, 10}, {90, 0},
                                      {0, 90}, {120, -20}, {180, 0},  {(double)NAN, 0}};
    static const double drops[] = {0, 10, 45, 90};
    struct bed b;
    struct warp_verdict sum = {0};
    bed_open(&b, 33, 30);
    bed_scatter(&b, &b.warp.view, 90);
    for (size_t g = 0; g < countof(gazes); g++) {
        for (size_t d = 0; d < countof(drops); d++) {
            for (int eye = 0; eye < EYES; eye++) {
                b.warp.view.eyes[eye].gaze_x_deg = gazes[g][0];
                b.warp.view.eyes[eye].gaze_y_deg = gazes[g][1];
            }
            b.warp.drop_deg = drops[d];
            bed_run(&b);
            const struct warp_verdict v = bed_judge(&b);
            assert_int_equal(v.wrong, 0);
            assert_true(!isnan(gazes[g][0]) || drops[d] == 0 || v.covered == 0); // all is fovea
            assert_true(gazes[g][0] != 180 || v.covered > v.pixels / 2);
            bed_add(&sum, &v);
        }
    }
    bed_tell("gazes", &sum);
    bed_close(&b);
}

static void moving_objects_may_be_dropped(void **state)
{
    (void)state;
    struct bed b;
    bed_open(&b, 40, 36);
    bed_scatter(&b, &b.warp.view, 91);
    b.warp.drop_moving = true;
    bed_run(&b);
    uint32_t moving = 0;
    for (size_t i = 0; i < 2 * bed_pixels(&b); i++) {
        moving += b.warp.positions[i][3] >= 2;
        assert_true(b.result[i][3] < 2);
    }
    assert_true(moving > 300);
    assert_int_equal(bed_judge(&b).wrong, 0);
    bed_close(&b);
}

static void runs_repeat(void **state)
{
    (void)state;
    struct bed b;
    bed_open(&b, 40, 36);
    vary(&b, 3);
    bed_run(&b);
    int64_t *first = malloc(2 * bed_pixels(&b) * sizeof *first);
    memcpy(first, b.sources, 2 * bed_pixels(&b) * sizeof *first);
    for (int i = 0; i < 5; i++) {
        bed_run(&b);
        assert_memory_equal(first, b.sources, 2 * bed_pixels(&b) * sizeof *first);
    }
    free(first);
    bed_close(&b);
}

int main(void)
{
    struct rig probe;
    if (!rig_open(&probe))
        return 77;
    rig_close(&probe);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_same_eye_sees_the_same),
        cmocka_unit_test(any_view_agrees_with_brute_force),
        cmocka_unit_test(only_what_is_in_front_lands),
        cmocka_unit_test(the_nearest_wins_and_of_equals_the_first),
        cmocka_unit_test(positions_do_not_drift_and_ages_end),
        cmocka_unit_test(an_impossible_motion_loses_its_object_only),
        cmocka_unit_test(a_half_turn_leaves_nothing),
        cmocka_unit_test(the_fovea_is_dropped_wherever_it_is),
        cmocka_unit_test(moving_objects_may_be_dropped),
        cmocka_unit_test(runs_repeat),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
