// Reprojection (splat and resolve) against brute force, and at its hard places.
#include "renderer/passes/reproject/reproject.h"
#include "tests/renderer/passes/reproject_reference.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

struct bed {
    struct rig rig;
    uint32_t width, height;
    struct gpu_buffer motions;
    struct gpu_image position[2], colour[2];
    struct reproject pass;
    struct warp warp; // what history 0 is warped by
    float (*result)[4];
    uint8_t (*colours)[4];
    int64_t *sources;
};

static size_t count_of(const struct bed *b)
{
    return (size_t)b->width * b->height;
}

static void set_motion(struct bed *b, uint32_t id, const struct dmat4 *m)
{
    float *mapped = b->motions.mapped;
    for (int i = 0; i < 16; i++)
        mapped[16 * id + (uint32_t)i] = b->warp.motions[id][i] = (float)m->m[i];
}

static void bed_open(struct bed *b, uint32_t width, uint32_t height)
{
    *b = (struct bed){.width = width, .height = height};
    assert_true(rig_open(&b->rig));
    assert_true(gpu_buffer_create(b->rig.gpu, "motions", sizeof b->warp.motions,
                                  VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, GPU_HOST, &b->motions));
    struct reproject_desc desc = {
        .gpu = b->rig.gpu, .frame = &b->rig.frame, .motions = &b->motions, .width = width, .height = height};
    for (int i = 0; i < 2; i++) {
        b->position[i] = rig_image(&b->rig, VK_FORMAT_R32G32B32A32_SFLOAT, width, height);
        b->colour[i] = rig_image(&b->rig, VK_FORMAT_R8G8B8A8_UNORM, width, height);
        desc.position[i] = b->position[i].view;
        desc.colour[i] = b->colour[i].view;
    }
    assert_true(reproject_init(&b->pass, &desc));
    b->warp.view = rig_view_default(width, height);
    b->warp.positions = calloc(2 * count_of(b), sizeof *b->warp.positions);
    b->result = calloc(2 * count_of(b), sizeof *b->result);
    b->colours = calloc(2 * count_of(b), sizeof *b->colours);
    b->sources = calloc(2 * count_of(b), sizeof *b->sources);
    assert_true(b->warp.positions && b->result && b->colours && b->sources);
    const struct dmat4 identity = dmat4_identity();
    for (uint32_t id = 0; id < WARP_MOTIONS; id++)
        set_motion(b, id, &identity);
}

static void bed_close(struct bed *b)
{
    reproject_finish(&b->pass);
    for (int i = 0; i < 2; i++) {
        gpu_image_destroy(b->rig.gpu, &b->position[i]);
        gpu_image_destroy(b->rig.gpu, &b->colour[i]);
    }
    gpu_buffer_destroy(b->rig.gpu, &b->motions);
    free(b->warp.positions);
    free(b->result);
    free(b->colours);
    free(b->sources);
    rig_close(&b->rig);
}

static void record(struct bed *b, uint32_t from)
{
    VkCommandBuffer cmd = rig_begin(&b->rig);
    reproject_record(&b->pass, cmd, from, (float)b->warp.drop_deg, b->warp.drop_moving);
    rig_end(&b->rig, cmd);
}

// Every pixel's colour is its own number + 1, so that a result tells where it came from.
static void run(struct bed *b)
{
    const uint32_t count = (uint32_t)count_of(b);
    for (uint32_t i = 0; i < 2 * count; i++) {
        const uint32_t number = i % count + 1;
        const uint8_t colour[4] = {(uint8_t)number, (uint8_t)(number >> 8), (uint8_t)(number >> 16), 255};
        memcpy(b->colours[i], colour, sizeof colour);
    }
    rig_upload(&b->rig, &b->position[0], sizeof b->warp.positions[0], b->warp.positions);
    rig_upload(&b->rig, &b->colour[0], sizeof b->colours[0], b->colours);
    rig_frame(&b->rig, &b->warp.view);
    record(b, 0);
    rig_download(&b->rig, &b->position[1], sizeof b->result[0], b->result);
    rig_download(&b->rig, &b->colour[1], sizeof b->colours[0], b->colours);
    for (uint32_t i = 0; i < 2 * count; i++) {
        const uint8_t *c = b->colours[i];
        b->sources[i] = (c[0] | c[1] << 8 | c[2] << 16) - 1;
        assert_int_equal(c[3], b->sources[i] >= 0 ? 255 : 0);
        for (int k = 0; k < 4; k++)
            assert_true(isfinite(b->result[i][k]));
    }
}

static struct warp_verdict judge(const struct bed *b)
{
    struct warp_verdict sum = {0};
    for (int eye = 0; eye < EYES; eye++) {
        const size_t at = (size_t)eye * count_of(b);
        struct warp_verdict v = warp_judge(&b->warp, eye, b->sources + at, (const float(*)[4])(b->result + at));
        sum.pixels += v.pixels;
        sum.covered += v.covered;
        sum.certain += v.certain;
        sum.wrong += v.wrong;
        sum.worst_error = fmax(sum.worst_error, v.worst_error);
    }
    return sum;
}

static void put(struct bed *b, size_t pixel, struct dvec3 p, double w)
{
    float *out = b->warp.positions[pixel];
    out[0] = (float)p.x;
    out[1] = (float)p.y;
    out[2] = (float)p.z;
    out[3] = (float)w;
}

// What the last frame may have left: pixels of a view at random distances, holes, background, moving objects.
static void scatter(struct bed *b, const struct rig_view *before, uint64_t seed)
{
    uint64_t random = seed;
    for (size_t i = 0; i < 2 * count_of(b); i++) {
        const struct rig_eye *e = &before->eyes[i / count_of(b)];
        const size_t pixel = i % count_of(b);
        const struct dvec3 ray = viewing_pixel_direction(
            &e->fov, b->width, b->height, (double)(pixel % b->width) + 0.5, (double)(pixel / b->width) + 0.5);
        struct dvec3 d = dquat_rotate(e->pose.orientation, ray);
        const double kind = rig_uniform(&random, 0, 1), distance = exp(rig_uniform(&random, log(0.1), log(50)));
        const struct dvec3 p = dvec3_sub(dvec3_add(e->pose.position, dvec3_scale(d, distance)), before->origin);
        if (kind < 0.1)
            put(b, i, p, 0);
        else if (kind < 0.25)
            put(b, i, d, -1);
        else if (kind < 0.5)
            put(b, i, p,
                2 + (double)rig_below(&random, WARP_MOTIONS - 1) + (double)rig_below(&random, 64) / 64);
        else if (kind < 0.55 && pixel > 0) // the same place twice
            memcpy(b->warp.positions[i], b->warp.positions[i - 1], sizeof b->warp.positions[i]);
        else
            put(b, i, p, 1);
    }
}

static void the_same_eye_sees_the_same(void **state)
{
    (void)state;
    struct bed b;
    bed_open(&b, 40, 36);
    scatter(&b, &b.warp.view, 1);
    for (size_t i = 0; i < 2 * count_of(&b); i++) { // no motion: nothing ages, nothing lies twice
        if (b.warp.positions[i][3] >= 2)
            b.warp.positions[i][3] = 1;
    }
    run(&b);
    uint32_t moved = 0;
    for (size_t i = 0; i < 2 * count_of(&b); i++) {
        const bool hole = b.warp.positions[i][3] == 0;
        const bool twice = i % count_of(&b) && memcmp(b.warp.positions[i], b.warp.positions[i - 1], 16) == 0;
        moved += twice;
        if (twice)
            continue;
        assert_int_equal(b.sources[i], hole ? -1 : (int64_t)(i % count_of(&b)));
        if (!hole)
            assert_memory_equal(b.result[i], b.warp.positions[i], sizeof b.result[i]);
    }
    assert_true(moved > 20);
    assert_int_equal(judge(&b).wrong, 0);
    bed_close(&b);
}

static void vary(struct bed *b, uint64_t seed)
{
    uint64_t random = 1000 + seed;
    struct rig_view *v = &b->warp.view, before = rig_view_default(b->width, b->height);
    *v = before;
    b->warp.drop_deg = seed % 3 == 0 ? 0 : rig_uniform(&random, 1, 40);
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
        set_motion(b, id, &m);
    }
    scatter(b, &before, seed);
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
            run(&b);
            struct warp_verdict v = judge(&b);
            if (v.wrong)
                fail_msg("size %u x %u, seed %u: %u pixels are wrong", b.width, b.height, (unsigned)seed,
                         v.wrong);
            sum.pixels += v.pixels;
            sum.covered += v.covered;
            sum.certain += v.certain;
            sum.worst_error = fmax(sum.worst_error, v.worst_error);
        }
        bed_close(&b);
    }
    print_message("%u pixels, %u covered, %.2f %% with one possible answer; positions within %.1e\n",
                  sum.pixels, sum.covered, 100.0 * sum.certain / sum.pixels, sum.worst_error);
    assert_true(sum.certain > 0.95 * sum.pixels && sum.covered > sum.pixels / 5);
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
    };
    uint32_t landed = 0, expected = 0;
    for (size_t i = 0; i < countof(points); i++) {
        put(&b, 3 * i, points[i].p, points[i].w);
        put(&b, count_of(&b) + 3 * i, points[i].p, points[i].w);
        expected += 2 * points[i].lands;
    }
    run(&b);
    for (size_t i = 0; i < 2 * count_of(&b); i++) {
        if (b.sources[i] < 0)
            continue;
        landed++;
        assert_true(points[b.sources[i] / 3].lands);
    }
    assert_int_equal(landed, expected);
    assert_int_equal(judge(&b).wrong, 0);
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
        memset(b.warp.positions, 0, 2 * count_of(&b) * sizeof *b.warp.positions);
        put(&b, 100, ray, -1);
        for (size_t i = 0; i < 5; i++) { // 1 mm apart at 2 m, both ways round
            const double distance = 2 + 1e-3 * (order ? 4 - (double)i : (double)i);
            put(&b, 200 + 50 * i, dvec3_add(e->pose.position, dvec3_scale(ray, distance)), 1);
        }
        const size_t nearest = order ? 400 : 200;
        memcpy(b.warp.positions[nearest + 7], b.warp.positions[nearest], sizeof b.warp.positions[0]);
        run(&b);
        assert_int_equal(b.sources[10 * 40 + 20], nearest);
        assert_int_equal(judge(&b).wrong, 0);
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
    scatter(&b, &b.warp.view, 5);
    const struct dmat4 identity = dmat4_identity();
    for (uint32_t id = 0; id < WARP_MOTIONS; id++)
        set_motion(&b, id, &identity);
    for (size_t i = 0; i < 2 * count_of(&b); i++) {
        if (b.warp.positions[i][3] >= 2)
            b.warp.positions[i][3] = floorf(b.warp.positions[i][3]);
    }
    run(&b);
    float(*first)[4] = malloc(2 * count_of(&b) * sizeof *first);
    memcpy(first, b.result, 2 * count_of(&b) * sizeof *first);
    for (uint32_t frame = 2; frame <= 80; frame++) {
        record(&b, (frame + 1) % 2);
        if (frame != 2 && frame != 63 && frame != 64 && frame != 80)
            continue;
        rig_download(&b.rig, &b.position[frame % 2], sizeof b.result[0], b.result);
        for (size_t i = 0; i < 2 * count_of(&b); i++) {
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
        scatter(&b, &b.warp.view, 60 + i);
        struct dmat4 m = dmat4_identity();
        for (int k = 0; k < 16; k++)
            m.m[k] = k % 4 == 3 ? m.m[k] : bad[i];
        set_motion(&b, 3, &m);
        run(&b); // which fails if anything that came out is not finite
        struct warp_verdict v = judge(&b);
        if (v.wrong)
            fail_msg("a motion of %g: %u pixels are wrong", bad[i], v.wrong);
    }
    bed_close(&b);
}

static void runs_repeat(void **state)
{
    (void)state;
    struct bed b;
    bed_open(&b, 40, 36);
    vary(&b, 3);
    run(&b);
    int64_t *first = malloc(2 * count_of(&b) * sizeof *first);
    memcpy(first, b.sources, 2 * count_of(&b) * sizeof *first);
    for (int i = 0; i < 5; i++) {
        run(&b);
        assert_memory_equal(first, b.sources, 2 * count_of(&b) * sizeof *first);
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
        cmocka_unit_test(runs_repeat),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
