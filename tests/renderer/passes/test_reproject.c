// Reprojection (splat or points, and resolve) against brute force, and at its hard places.
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
    struct reproject pass, points; // the atomic splat and the rasteriser's points
    struct warp warp;              // what history 0 is warped by
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
    desc.points = true;
    assert_true(reproject_init(&b->points, &desc));
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
    reproject_finish(&b->points);
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

static void record(struct bed *b, const struct reproject *pass, uint32_t from)
{
    VkCommandBuffer cmd = rig_begin(&b->rig);
    reproject_record(pass, cmd, from, (float)b->warp.drop_deg, b->warp.drop_moving);
    rig_end(&b->rig, cmd);
}

// Both ways of splatting give the same bytes.
static void record_both(struct bed *b)
{
    const size_t count = 2 * count_of(b), bytes = count * sizeof *b->result;
    record(b, &b->pass, 0);
    rig_download(&b->rig, &b->position[1], sizeof *b->result, b->result);
    rig_download(&b->rig, &b->colour[1], sizeof *b->colours, b->colours);
    float(*positions)[4] = malloc(bytes);
    uint8_t(*colours)[4] = malloc(count * sizeof *colours);
    assert_true(positions && colours);
    memset(positions, 0xa5, bytes); // every pixel must be written
    rig_upload(&b->rig, &b->position[1], sizeof *positions, positions);
    record(b, &b->points, 0);
    rig_download(&b->rig, &b->position[1], sizeof *positions, positions);
    rig_download(&b->rig, &b->colour[1], sizeof *colours, colours);
    assert_memory_equal(positions, b->result, bytes);
    assert_memory_equal(colours, b->colours, count * sizeof *colours);
    free(positions);
    free(colours);
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
    record_both(b);
    for (uint32_t i = 0; i < 2 * count; i++) {
        const uint8_t *c = b->colours[i];
        b->sources[i] = (c[0] | c[1] << 8 | c[2] << 16) - 1;
        assert_int_equal(c[3], b->sources[i] >= 0 ? 255 : 0);
        for (int k = 0; k < 4; k++)
            assert_true(isfinite(b->result[i][k]));
    }
}

static void add(struct warp_verdict *sum, const struct warp_verdict *v)
{
    sum->pixels += v->pixels;
    sum->covered += v->covered;
    sum->certain += v->certain;
    sum->shows += v->shows;
    sum->undecided += v->undecided;
    sum->wrong += v->wrong;
    sum->worst_error = fmax(sum->worst_error, v->worst_error);
}

static void tell(const char *what, const struct warp_verdict *v)
{
    print_message("%s: %u pixels, %u covered, %u show through, %u undecided, %.2f %% with one possible answer; "
                  "positions within %.1e\n",
                  what, v->pixels, v->covered, v->shows, v->undecided, 100.0 * v->certain / v->pixels,
                  v->worst_error);
}

static struct warp_verdict judge(const struct bed *b)
{
    struct warp_verdict sum = {0};
    for (int eye = 0; eye < EYES; eye++) {
        const size_t at = (size_t)eye * count_of(b);
        struct warp_verdict v = warp_judge(&b->warp, eye, b->sources + at, (const float(*)[4])(b->result + at));
        add(&sum, &v);
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
            add(&sum, &v);
        }
        bed_close(&b);
    }
    tell("random points", &sum);
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
        record(&b, &b.pass, (frame + 1) % 2);
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

// With 100 deg of view nothing that was seen is still in sight, unless the turn is about the axis of sight.
static void a_half_turn_leaves_nothing(void **state)
{
    (void)state;
    struct bed b;
    bed_open(&b, 45, 36);
    const struct rig_view before = rig_view_default(b.width, b.height);
    for (uint64_t seed = 0; seed < 3; seed++) {
        scatter(&b, &before, 80 + seed);
        for (size_t i = 0; i < 2 * count_of(&b); i++) // objects may come round
            b.warp.positions[i][3] = fminf(b.warp.positions[i][3], 1);
        b.warp.view = before;
        for (int eye = 0; eye < EYES; eye++)
            b.warp.view.eyes[eye].pose.orientation =
                seed == 2 ? (struct dquat){0, 0, 1, 0} : (struct dquat){seed == 1, seed == 0, 0, 0};
        run(&b);
        const struct warp_verdict v = judge(&b);
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
    scatter(&b, &b.warp.view, 90);
    for (size_t g = 0; g < countof(gazes); g++) {
        for (size_t d = 0; d < countof(drops); d++) {
            for (int eye = 0; eye < EYES; eye++) {
                b.warp.view.eyes[eye].gaze_x_deg = gazes[g][0];
                b.warp.view.eyes[eye].gaze_y_deg = gazes[g][1];
            }
            b.warp.drop_deg = drops[d];
            run(&b);
            const struct warp_verdict v = judge(&b);
            assert_int_equal(v.wrong, 0);
            assert_true(!isnan(gazes[g][0]) || drops[d] == 0 || v.covered == 0); // all is fovea
            assert_true(gazes[g][0] != 180 || v.covered > v.pixels / 2);
            add(&sum, &v);
        }
    }
    tell("gazes", &sum);
    bed_close(&b);
}

static void moving_objects_may_be_dropped(void **state)
{
    (void)state;
    struct bed b;
    bed_open(&b, 40, 36);
    scatter(&b, &b.warp.view, 91);
    b.warp.drop_moving = true;
    run(&b);
    uint32_t moving = 0;
    for (size_t i = 0; i < 2 * count_of(&b); i++) {
        moving += b.warp.positions[i][3] >= 2;
        assert_true(b.result[i][3] < 2);
    }
    assert_true(moving > 300);
    assert_int_equal(judge(&b).wrong, 0);
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

// --- surfaces: flat pieces at right angles to z before the background ---

enum { PIECES = 8 };

struct piece {
    double left, right, bottom, top, z; // metres, world
};

struct stage {
    uint32_t count;
    struct piece pieces[PIECES];
};

// What a pixel of a view sees: its position, reproject.h.
static void see(const struct stage *s, const struct rig_view *view, size_t pixel, float out[4])
{
    const size_t count = (size_t)view->width * view->height;
    const struct rig_eye *e = &view->eyes[pixel / count];
    const double x = (double)(pixel % view->width) + 0.5, y = (double)(pixel % count / view->width) + 0.5;
    const struct dvec3 d =
        dquat_rotate(e->pose.orientation, viewing_pixel_direction(&e->fov, view->width, view->height, x, y));
    double nearest = HUGE_VAL;
    for (uint32_t i = 0; i < s->count; i++) {
        const struct piece *p = &s->pieces[i];
        const double t = (p->z - e->pose.position.z) / d.z;
        const double at_x = e->pose.position.x + t * d.x, at_y = e->pose.position.y + t * d.y;
        if (t > 0 && t < nearest && at_x > p->left && at_x < p->right && at_y > p->bottom && at_y < p->top)
            nearest = t;
    }
    const bool background = nearest == HUGE_VAL;
    const struct dvec3 p = background
                               ? dvec3_normalise(d)
                               : dvec3_sub(dvec3_add(e->pose.position, dvec3_scale(d, nearest)), view->origin);
    out[0] = (float)p.x;
    out[1] = (float)p.y;
    out[2] = (float)p.z;
    out[3] = background ? -1.f : 1.f;
}

static void see_all(struct bed *b, const struct stage *s, const struct rig_view *view)
{
    for (size_t i = 0; i < 2 * count_of(b); i++)
        see(s, view, i, b->warp.positions[i]);
}

static void step_eyes(struct rig_view *view, struct dvec3 step)
{
    for (int eye = 0; eye < EYES; eye++)
        view->eyes[eye].pose.position = dvec3_add(view->eyes[eye].pose.position, step);
}

// Several frames in a row, each from what the last one left, every one judged.
static void surfaces_agree_with_brute_force(void **state)
{
    (void)state;
    struct bed b;
    struct warp_verdict sum = {0};
    bed_open(&b, 45, 36);
    for (uint64_t seed = 0; seed < 8; seed++) {
        uint64_t random = seed;
        struct stage s = {.count = PIECES};
        for (int i = 0; i < PIECES; i++) {
            const double z = -exp(rig_uniform(&random, log(0.5), log(20))), size = -z * 0.6;
            const double x = rig_uniform(&random, z, -z), y = rig_uniform(&random, z, -z);
            s.pieces[i] = (struct piece){x - size, x + size, y - size, y + size, z};
        }
        b.warp.view = rig_view_default(b.width, b.height);
        see_all(&b, &s, &b.warp.view);
        const struct dvec3 step = {rig_uniform(&random, -0.05, 0.05), rig_uniform(&random, -0.05, 0.05),
                                   rig_uniform(&random, -0.08, 0.02)};
        for (int frame = 0; frame < 4; frame++) {
            step_eyes(&b.warp.view, step);
            run(&b);
            struct warp_verdict v = judge(&b);
            if (v.wrong)
                fail_msg("seed %u, frame %d: %u pixels are wrong", (unsigned)seed, frame, v.wrong);
            add(&sum, &v);
            memcpy(b.warp.positions, b.result, 2 * count_of(&b) * sizeof *b.result);
        }
    }
    tell("surfaces", &sum);
    assert_true(sum.certain > 0.95 * sum.pixels && sum.shows > 100);
    bed_close(&b);
}

// A hole's level in the pyramid: how far off the next valid pixel is.
static uint32_t hole_level(const struct bed *b, size_t pixel)
{
    const size_t eye = pixel / count_of(b) * count_of(b);
    const uint32_t x = (uint32_t)(pixel - eye) % b->width, y = (uint32_t)(pixel - eye) / b->width;
    for (uint32_t m = 0; m < 16; m++) {
        for (uint32_t v = y >> m << m; v < ((y >> m) + 1) << m && v < b->height; v++)
            for (uint32_t u = x >> m << m; u < ((x >> m) + 1) << m && u < b->width; u++)
                if (b->result[eye + v * b->width + u][3] != 0)
                    return m;
    }
    return 16;
}

// Everything farther than the wall that is seen within its outline, a pixel inside the rim that the wall's
// outermost samples may have: `rim_m`, the size of a pixel on the wall when it was drawn.
static uint32_t count_leaks(const struct bed *b, const struct piece *wall, double rim_m)
{
    uint32_t leaks = 0;
    for (size_t i = 0; i < 2 * count_of(b); i++) {
        const struct rig_eye *e = &b->warp.view.eyes[i / count_of(b)];
        const size_t pixel = i % count_of(b);
        bool inside = true;
        for (int corner = 0; corner < 4; corner++) {
            const double x = (double)(pixel % b->width) + (corner & 1 ? 1.5 : -0.5),
                         y = (double)(pixel / b->width) + (corner & 2 ? 1.5 : -0.5);
            const struct dvec3 d = viewing_pixel_direction(&e->fov, b->width, b->height, x, y);
            const double t = (wall->z - e->pose.position.z) / d.z;
            const double at_x = e->pose.position.x + t * d.x, at_y = e->pose.position.y + t * d.y;
            inside &= at_x > wall->left + rim_m && at_x < wall->right - rim_m && at_y > wall->bottom + rim_m &&
                      at_y < wall->top - rim_m;
        }
        const float w = b->result[i][3];
        leaks += inside && w != 0 && (w < 0 || (double)b->result[i][2] < wall->z - 0.01);
    }
    return leaks;
}

struct dolly {
    uint32_t leaks, worst_frame, redrawn;
};

// Towards `stage` until its first piece is 2.4 times as large. Holes of a level and above are drawn anew, as
// the confidence would have it; 16: none.
static struct dolly run_dolly(struct bed *b, const struct stage *stage, double step_m, uint32_t redrawn_level)
{
    struct dolly d = {0};
    const double start_m = -stage->pieces[0].z;
    b->warp.view = rig_view_default(b->width, b->height);
    const struct viewing_fov *f = &b->warp.view.eyes[0].fov;
    const double rim_m = start_m * (f->tan_up + f->tan_down) / b->height;
    see_all(b, stage, &b->warp.view);
    while (start_m < 2.4 * (start_m + b->warp.view.eyes[0].pose.position.z - step_m)) {
        step_eyes(&b->warp.view, (struct dvec3){0, 0, -step_m});
        rig_upload(&b->rig, &b->position[0], sizeof *b->warp.positions, b->warp.positions);
        rig_frame(&b->rig, &b->warp.view);
        record(b, &b->pass, 0);
        rig_download(&b->rig, &b->position[1], sizeof *b->result, b->result);
        const uint32_t leaks = count_leaks(b, &stage->pieces[0], rim_m);
        d.leaks += leaks;
        d.worst_frame = leaks > d.worst_frame ? leaks : d.worst_frame;
        for (size_t p = 0; p < 2 * count_of(b); p++) {
            memcpy(b->warp.positions[p], b->result[p], sizeof b->result[p]);
            if (redrawn_level < 16 && b->result[p][3] == 0 && hole_level(b, p) >= redrawn_level) {
                see(stage, &b->warp.view, p, b->warp.positions[p]);
                d.redrawn++;
            }
        }
    }
    return d;
}

static void a_dolly_towards_a_wall_lets_nothing_through(void **state)
{
    (void)state;
    struct bed b;
    bed_open(&b, 96, 80);
    // the wall alone before the sky, and before a far plane
    static const struct stage stages[] = {{1, {{-1, 1.2, -0.9, 0.8, -3}}},
                                          {2, {{-1, 1.2, -0.9, 0.8, -3}, {-300, 300, -300, 300, -100}}}};
    static const double steps_m[] = {0.008, 0.02, 0.05, 0.1};
    for (size_t k = 0; k < countof(stages); k++) {
        for (size_t i = k; i < countof(steps_m); i++) {
            const struct dolly kept = run_dolly(&b, &stages[k], steps_m[i], 16),
                               redrawn = run_dolly(&b, &stages[k], steps_m[i], 1);
            print_message("%g m a frame before %s: %u leaks without redraws; %u, at most %u in a frame, with "
                          "%u holes redrawn\n",
                          steps_m[i], k ? "a plane" : "the sky", kept.leaks, redrawn.leaks, redrawn.worst_frame,
                          redrawn.redrawn);
            assert_int_equal(kept.leaks, 0);
            // Redrawn pixels crowd with older ones, the rim's last are lost to those before them, and what is
            // drawn beyond them then has the sky between: a gap as real as any for one who sees pixels only.
            assert_true(redrawn.worst_frame <= 30);
        }
    }
    bed_close(&b);
}

// Two slits, 1 and 2 pixels wide, upright and level, between surfaces at 2 m.
static struct stage slits(const struct rig_view *view)
{
    const struct viewing_fov *f = &view->eyes[0].fov;
    const double px = 2 * (f->tan_left + f->tan_right) / view->width, left = -2 * f->tan_left;
    const double top = 2 * f->tan_up, end = 50;
    // pieces between pixel columns 10 | 11..30 | 32..60 | 61.., the last cut by rows 20 and 22..23
    return (struct stage){6,
                          {{-end, left + 11 * px, -end, end, -2},
                           {left + 12 * px, left + 31 * px, -end, end, -2},
                           {left + 33 * px, left + 60 * px, -end, end, -2},
                           {left + 60 * px, end, top - 20 * px, end, -2},
                           {left + 60 * px, end, top - 40 * px, top - 21 * px, -2},
                           {left + 60 * px, end, -end, top - 42 * px, -2}}};
}

static uint32_t background_of(const struct bed *b, const float (*positions)[4])
{
    uint32_t count = 0;
    for (size_t i = 0; i < 2 * count_of(b); i++)
        count += positions[i][3] < 0;
    return count;
}

static void real_gaps_stay(void **state)
{
    (void)state;
    struct bed b;
    bed_open(&b, 96, 80);
    struct rig_view before = rig_view_default(b.width, b.height);
    for (int eye = 0; eye < EYES; eye++)
        before.eyes[eye].pose.position = (struct dvec3){0, 0, 0};
    const struct stage s = slits(&before);
    const double px = 2 * (before.eyes[0].fov.tan_left + before.eyes[0].fov.tan_right) / before.width;
    see_all(&b, &s, &before);
    const uint32_t all = background_of(&b, (const float(*)[4])b.warp.positions);
    assert_true(all == 2 * (3 * 80 + 3 * 36));
    // in pixels of the surfaces, a frame; the last is a step ahead that spreads the image's rim as much
    static const double moves[][3] = {{0, 0, 0},      {0.08, 0, 0}, {0, 0.08, 0}, {0.05, -0.07, 0},
                                      {-0.3, 0.2, 0}, {0, 0.9, 0},  {0.9, 0, 0},  {0, 0, -0.3}};
    for (size_t m = 0; m < countof(moves); m++) {
        b.warp.view = before;
        see_all(&b, &s, &before);
        for (int frame = 0; frame < 6; frame++) {
            step_eyes(&b.warp.view, (struct dvec3){moves[m][0] * px, moves[m][1] * px, moves[m][2] * px});
            run(&b);
            if (m == 0)
                assert_memory_equal(b.result, b.warp.positions, 2 * count_of(&b) * sizeof *b.result);
            memcpy(b.warp.positions, b.result, 2 * count_of(&b) * sizeof *b.result);
        }
        const uint32_t left = background_of(&b, (const float(*)[4])b.result);
        assert_true(m < 4 ? left == all : left > all / 20);
        print_message("six frames of (%g, %g, %g) px: %u of %u gap pixels left\n", moves[m][0], moves[m][1],
                      moves[m][2], left, all);
    }
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
        cmocka_unit_test(surfaces_agree_with_brute_force),
        cmocka_unit_test(a_dolly_towards_a_wall_lets_nothing_through),
        cmocka_unit_test(real_gaps_stay),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
