// Motion vectors of `regular` against rays and projections in double precision.
#include "tests/renderer/blocks.h"
#include "tests/renderer/stage.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

enum { WIDTH = 100, HEIGHT = 84, COUNT = WIDTH * HEIGHT, BLOCKS = 3, FRAMES = 12 };
static const double step_s = 1.0 / 90;
static const struct block_key slide[] = {{0, -1.5f, 0, -4}, {1, 2, 0.6f, -3}};
static const struct block list[BLOCKS] = {
    {.middle = {0, -1.4, -5}, .half = {4, 0.1, 4}},
    {.middle = {1.2, 0.3, -6}, .half = {0.7, 0.9, 0.5}},
    {.middle = {-1.5, 0, -4}, .half = {0.5, 0.4, 0.6}, .keys = slide, .key_count = 2},
};

static struct dvec3 middle_at(int block, double time_s)
{
    const struct block *b = &list[block];
    if (!b->keys)
        return b->middle;
    const struct block_key *k = b->keys;
    return (struct dvec3){k[0].x + ((double)k[1].x - (double)k[0].x) * time_s,
                          k[0].y + ((double)k[1].y - (double)k[0].y) * time_s,
                          k[0].z + ((double)k[1].z - (double)k[0].z) * time_s};
}

static double along(struct dvec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

// Where a ray enters a block, in lengths of the ray; infinity: nowhere.
static double hit(int block, double time_s, struct dvec3 from, struct dvec3 ray)
{
    const struct dvec3 middle = middle_at(block, time_s);
    double enter = -HUGE_VAL, leave = HUGE_VAL;
    for (int axis = 0; axis < 3; axis++) {
        const double m = along(middle, axis) - along(from, axis), d = along(ray, axis);
        const double a = (m - along(list[block].half, axis)) / d, b = (m + along(list[block].half, axis)) / d;
        enter = fmax(enter, fmin(a, b));
        leave = fmin(leave, fmax(a, b));
    }
    return enter < leave && enter > 0 ? enter : HUGE_VAL;
}

static double halton(uint64_t index, uint64_t base)
{
    double value = 0, share = 1;
    for (; index; index /= base) {
        share /= (double)base;
        value += share * (double)(index % base);
    }
    return value;
}

static struct frame frame_at(const struct stage *stage, const struct scene *scene, uint64_t n)
{
    struct frame frame = stage_frame(stage, scene, n, 0, 0, 0);
    frame.moving = true;
    frame.animation_s = 0.1 + 3 * step_s * (double)n;
    const struct dvec3 ahead = {0.1 * sin(0.4 * (double)n), 0.06 * cos(0.3 * (double)n), -1};
    const struct pose head = {{0.02 * (double)n, 0.03 * sin((double)n), -0.03 * (double)n},
                              dquat_look(ahead, (struct dvec3){0, 1, 0})};
    for (int eye = 0; eye < EYES; eye++)
        frame.eyes[eye].pose = viewing_eye_pose(&head, eye, VIEWING_DEFAULT_IPD_M);
    return frame;
}

static struct dvec3 into_eye(const struct pose *pose, struct dvec3 v)
{
    const struct dquat q = pose->orientation;
    return dquat_rotate((struct dquat){-q.x, -q.y, -q.z, q.w}, v);
}

struct tally {
    uint32_t block[BLOCKS], background, edges, outside;
    double worst_px, worst_m; // metres per metre of distance
};

static void check_pixel(const struct frame *now, const struct frame *last, int eye, uint32_t i,
                        const float *found, const double jitter[2], struct tally *t)
{
    const struct frame_eye *e = &now->eyes[eye], *l = &last->eyes[eye];
    const double x = i % WIDTH + 0.5 - jitter[0], y = i / WIDTH + 0.5 - jitter[1];
    struct dvec3 ray = viewing_pixel_direction(&e->fov, WIDTH, HEIGHT, x, y);
    ray = dquat_rotate(e->pose.orientation, dvec3_scale(ray, -1 / ray.z)); // to a distance of 1
    int block = -1;
    double nearest = HUGE_VAL;
    for (int b = 0; b < BLOCKS; b++) {
        const double d = hit(b, now->animation_s, e->pose.position, ray);
        block = d < nearest ? b : block;
        nearest = fmin(nearest, d);
    }
    const bool drawn = found[3] > 0;
    if (drawn != (block >= 0) || (drawn && fabs(found[3] - nearest) > 1e-3 * nearest)) {
        t->edges++; // the rasteriser's snapped corners: another surface here
        return;
    }
    struct dvec3 then = ray;
    if (drawn) {
        then = dvec3_add(e->pose.position, dvec3_scale(ray, nearest));
        then =
            dvec3_add(then, dvec3_sub(middle_at(block, last->animation_s), middle_at(block, now->animation_s)));
        then = dvec3_sub(then, l->pose.position);
        t->worst_m = fmax(t->worst_m, fabs(found[3] - nearest) / nearest);
    }
    then = into_eye(&l->pose, then);
    double px, py;
    assert_true(viewing_pixel(&l->fov, WIDTH, HEIGHT, then, &px, &py));
    t->worst_px = fmax(t->worst_px, hypot(found[0] - jitter[0] - px, found[1] - jitter[1] - py));
    if (drawn) {
        t->worst_m = fmax(t->worst_m, fabs(found[2] + then.z) / -then.z);
        t->block[block]++;
    } else {
        assert_true(found[2] == 0 && found[3] == 0);
        t->background++;
    }
    t->outside += px < 0 || py < 0 || px > WIDTH || py > HEIGHT;
}

static void vectors_are_those_of_double_precision(void **state)
{
    struct stage *stage = *state;
    struct scene *scene =
        blocks_scene(&(struct blocks){.list = list, .count = BLOCKS, .target = {0, 0, -1}, .sky = 0.3f});
    struct renderer_scene *uploaded = renderer_scene_create(stage->renderer, scene);
    float *found = malloc(COUNT * 4 * sizeof *found);
    for (int jittered = 0; jittered < 2; jittered++) {
        const struct renderer_settings settings = {.motion = true, .taa = jittered};
        struct renderer_option *regular = stage_option_set(stage, uploaded, "regular", &settings);
        struct tally t = {0};
        struct frame last = frame_at(stage, scene, 0);
        assert_true(renderer_draw(regular, &last, NULL));
        for (uint64_t n = 1; n < FRAMES; n++) {
            const struct frame now = frame_at(stage, scene, n);
            const double jitter[2] = {jittered ? halton(n % 8 + 1, 2) - 0.5 : 0,
                                      jittered ? halton(n % 8 + 1, 3) - 0.5 : 0};
            assert_true(renderer_draw(regular, &now, NULL));
            for (int eye = 0; eye < EYES; eye++) {
                assert_true(renderer_read_motion(regular, eye, found));
                for (uint32_t i = 0; i < COUNT; i++)
                    check_pixel(&now, &last, eye, i, &found[4 * i], jitter, &t);
            }
            last = now;
        }
        print_message(
            "jitter %d: %u static, %u moving, %u background, %u edges, %u from outside; off by at most "
            "%.5f pixels, %.2g of the distance\n",
            jittered, t.block[0] + t.block[1], t.block[2], t.background, t.edges, t.outside, t.worst_px,
            t.worst_m);
        assert_true(t.block[0] > 1000 && t.block[1] > 1000 && t.block[2] > 1000 && t.background > 1000);
        assert_true(t.outside > 0);
        assert_true(t.edges < 2u * COUNT * (FRAMES - 1) / 1000);
        assert_true(t.worst_px < 1e-3 && t.worst_m < 1e-5);
        renderer_option_destroy(regular);
    }
    free(found);
    renderer_scene_destroy(uploaded);
    scene_destroy(scene);
}

// What stands still in a still picture stays where it is, whatever the jitter; a first frame has no motion.
static void a_still_picture_has_none(void **state)
{
    struct stage *stage = *state;
    struct scene *scene =
        blocks_scene(&(struct blocks){.list = list, .count = BLOCKS, .target = {0, 0, -1}, .sky = 0.3f});
    struct renderer_scene *uploaded = renderer_scene_create(stage->renderer, scene);
    const struct renderer_settings settings = {.motion = true, .taa = true};
    struct renderer_option *regular = stage_option_set(stage, uploaded, "regular", &settings);
    float *found = malloc(COUNT * 4 * sizeof *found);
    for (uint64_t n = 0; n < 9; n++) {
        struct frame frame = frame_at(stage, scene, 4);
        frame.number = n;
        assert_true(renderer_draw(regular, &frame, NULL));
        assert_true(renderer_read_motion(regular, EYE_RIGHT, found));
        for (uint32_t i = 0; i < COUNT; i++)
            assert_true(hypot(found[4 * i] - (i % WIDTH + 0.5), found[4 * i + 1] - (i / WIDTH + 0.5)) < 1e-3);
    }
    free(found);
    renderer_option_destroy(regular);
    renderer_scene_destroy(uploaded);
    scene_destroy(scene);
}

static void without_the_setting_there_are_none(void **state)
{
    struct stage *stage = *state;
    float *found = malloc(COUNT * 4 * sizeof *found);
    struct scene *scene =
        blocks_scene(&(struct blocks){.list = list, .count = BLOCKS, .target = {0, 0, -1}, .sky = 0.3f});
    struct renderer_scene *uploaded = renderer_scene_create(stage->renderer, scene);
    const struct renderer_settings settings = {.motion = true};
    struct renderer_option *options[] = {stage_option(stage, uploaded, "regular"),
                                         stage_option_set(stage, uploaded, "time_warped", &settings)};
    for (int i = 0; i < 2; i++) {
        const struct frame frame = frame_at(stage, scene, 0);
        assert_false(renderer_read_motion(options[i], EYE_LEFT, found)); // nothing is drawn yet
        assert_true(renderer_draw(options[i], &frame, NULL));
        assert_false(renderer_read_motion(options[i], EYE_LEFT, found));
        renderer_option_destroy(options[i]);
    }
    free(found);
    renderer_scene_destroy(uploaded);
    scene_destroy(scene);
}

static int open_stage(void **state)
{
    struct stage *stage = calloc(1, sizeof *stage);
    *state = stage;
    return stage && stage_open(stage, WIDTH, HEIGHT) ? 0 : -1;
}

static int close_stage(void **state)
{
    stage_close(*state);
    free(*state);
    return 0;
}

int main(void)
{
    struct stage probe;
    if (!stage_open(&probe, 16, 16))
        return 77;
    stage_close(&probe);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(vectors_are_those_of_double_precision),
        cmocka_unit_test(a_still_picture_has_none),
        cmocka_unit_test(without_the_setting_there_are_none),
    };
    return cmocka_run_group_tests(tests, open_stage, close_stage);
}
