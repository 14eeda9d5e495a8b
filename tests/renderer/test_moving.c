// Moving objects in time_warped: they appear in time, leave no ghosts, share the work out over frames; and the
// mixed mode, in which they are drawn as `regular` draws them.
#include "tests/renderer/blocks.h"
#include "tests/renderer/stage.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { WIDTH = 96, HEIGHT = 80, COUNT = WIDTH * HEIGHT };
enum { IN_TIME = 9 }; // frames: 100 ms at 90 Hz
static const double step_s = 1.0 / 90;
static const double gaze_deg = -35; // to the left: what happens on the right is beyond full trust

// A gray wall stands at the right; a red box glides out from behind it, waits and glides back, or jumps both
// ways.
static const struct block_key glide[] = {
    {0, 2.4f, 0, -5}, {0.2f, 2.4f, 0, -5}, {0.6f, 4.8f, 0, -5}, {0.9f, 4.8f, 0, -5}, {1.3f, 2.4f, 0, -5}};
static const struct block_key jump[] = {{0, 2.4f, 0, -5},    {0.2f, 2.4f, 0, -5},    {0.2001f, 4.8f, 0, -5},
                                        {0.9f, 4.8f, 0, -5}, {0.9001f, 2.4f, 0, -5}, {1.3f, 2.4f, 0, -5}};

// The box at two sizes: its rectangle is more or less than 1/64 of the image (passes/movers).
static const struct dvec3 large = {0.4, 0.6, 0.4}, small = {0.25, 0.4, 0.25};

static struct scene *corner(const struct block_key *keys, uint32_t key_count, const struct dvec3 *box)
{
    const struct block list[] = {
        {.middle = {0, -2, -6}, .half = {9, 0.2, 6}, .colour = {0.2f, 0.4f, 0.2f}},
        {.middle = {1.8, 0, -4}, .half = {0.9, 1.6, 0.1}, .colour = {0.4f, 0.4f, 0.4f}},
        {.middle = {2.4, 0, -5},
         .half = box ? *box : large,
         .colour = {0.8f, 0.02f, 0.02f},
         .keys = keys,
         .key_count = key_count},
    };
    return blocks_scene(
        &(struct blocks){.list = list, .count = box ? 3 : 2, .target = {0, 0, -1}, .sky = 0.3f});
}

static struct frame frame_at(const struct stage *stage, const struct scene *scene, uint64_t number,
                             double time_s)
{
    struct frame frame = stage_frame(stage, scene, number, 0, gaze_deg, 0);
    frame.moving = true;
    frame.animation_s = time_s;
    return frame;
}

struct corner_stage {
    struct scene *scene, *empty;
    struct renderer_scene *uploaded, *empty_uploaded;
    struct renderer_option *regular, *without; // the latter without the box
    uint8_t *bare;                             // its picture, left eye
};

static struct corner_stage open_corner(struct stage *stage, const struct block_key *keys, uint32_t key_count,
                                       const struct dvec3 *box, const struct renderer_settings *settings)
{
    struct corner_stage c = {.scene = corner(keys, key_count, box), .empty = corner(keys, key_count, NULL)};
    c.uploaded = renderer_scene_create(stage->renderer, c.scene);
    c.empty_uploaded = renderer_scene_create(stage->renderer, c.empty);
    assert_true(c.uploaded && c.empty_uploaded);
    c.regular = stage_option_set(stage, c.uploaded, "regular", settings);
    c.without = stage_option_set(stage, c.empty_uploaded, "regular", NULL);
    const struct frame frame = frame_at(stage, c.empty, 0, 0);
    assert_true(renderer_draw(c.without, &frame, NULL));
    c.bare = stage_read(stage, c.without, EYE_LEFT);
    return c;
}

static void close_corner(struct corner_stage *c)
{
    free(c->bare);
    renderer_option_destroy(c->regular);
    renderer_option_destroy(c->without);
    renderer_scene_destroy(c->uploaded);
    renderer_scene_destroy(c->empty_uploaded);
    scene_destroy(c->scene);
    scene_destroy(c->empty);
}

// Red enough over the picture without the box.
static bool shows_box(const uint8_t *picture, const uint8_t *bare, uint32_t pixel)
{
    return picture[4 * pixel] - picture[4 * pixel + 1] > 60 && bare[4 * pixel] - bare[4 * pixel + 1] < 20;
}

struct appearance {
    uint32_t pixels;        // of the box, standing outside
    int seen_after;         // frames from its first pixel in `regular` until half of its pixels there show
    int gone_after;         // frames from its last pixel in `regular` until none shows
    uint32_t worst_missing; // of the pixels that have shown it for 9 frames, while it moves
};

// `phase`: the number of the first frame, so that the box comes out in every turn.
static struct appearance watch(struct stage *stage, struct corner_stage *c, const char *mode, uint64_t phase,
                               const struct renderer_settings *settings)
{
    struct appearance a = {.seen_after = -1, .gone_after = -1};
    struct renderer_option *warped = stage_option_set(stage, c->uploaded, mode, settings);
    uint8_t held[COUNT] = {0}; // frames in a row that `regular` has shown the box here
    int out = -1, in = -1;
    for (int n = 0; n < 118; n++) {
        const struct frame frame = frame_at(stage, c->scene, phase + (uint64_t)n, n * step_s);
        assert_true(renderer_draw(warped, &frame, NULL));
        assert_true(renderer_draw(c->regular, &frame, NULL));
        uint8_t *w = stage_read(stage, warped, EYE_LEFT), *r = stage_read(stage, c->regular, EYE_LEFT);
        uint32_t truth = 0, shown = 0, both = 0, missing = 0;
        for (uint32_t i = 0; i < COUNT; i++) {
            const bool is = shows_box(r, c->bare, i), has = shows_box(w, c->bare, i);
            held[i] = (uint8_t)(is ? held[i] + (held[i] < 200) : 0);
            truth += is;
            shown += has;
            both += is && has;
            missing += held[i] > IN_TIME && !has;
        }
        a.pixels = truth > a.pixels ? truth : a.pixels;
        a.worst_missing = missing > a.worst_missing ? missing : a.worst_missing;
        if (truth && out < 0)
            out = n;
        if (out >= 0 && in < 0 && !truth)
            in = n;
        if (out >= 0 && a.seen_after < 0 && truth && 2 * both >= truth)
            a.seen_after = n - out;
        if (in >= 0 && a.gone_after < 0 && !shown)
            a.gone_after = n - in;
        if (in >= 0 && a.gone_after >= 0 && n - in > IN_TIME)
            assert_int_equal(shown, 0); // and nothing comes back
        free(w);
        free(r);
    }
    renderer_option_destroy(warped);
    return a;
}

static void a_box_from_behind_a_wall_shows_in_time_and_leaves_no_ghost(void **state)
{
    struct stage *stage = *state;
    const struct renderer_settings plain = {0}, filtered = {.ssao = true, .taa = true};
    const struct {
        const char *name;
        const struct block_key *keys;
        uint32_t key_count;
        const struct dvec3 *box;
        const struct renderer_settings *settings;
        uint32_t pixels, late; // at least, and 1 in so many of them at most
    } ways[] = {{"glide", glide, 5, &large, &plain, 60, 8},
                {"jump", jump, 6, &large, &plain, 60, 8},
                {"glide with TAA and SSAO", glide, 5, &large, &filtered, 60, 4},
                {"small glide", glide, 5, &small, &plain, 25, 4},
                {"small jump", jump, 6, &small, &plain, 25, 8}};
    for (size_t way = 0; way < sizeof ways / sizeof *ways; way++) {
        struct corner_stage c =
            open_corner(stage, ways[way].keys, ways[way].key_count, ways[way].box, ways[way].settings);
        for (uint64_t phase = 0; phase < 6; phase++) {
            const struct appearance a = watch(stage, &c, "time_warped", phase, ways[way].settings);
            print_message("%s, phase %d: %u pixels, seen after %d frames, gone after %d, %u late at worst\n",
                          ways[way].name, (int)phase, a.pixels, a.seen_after, a.gone_after, a.worst_missing);
            assert_true(a.pixels > ways[way].pixels);
            assert_in_range(a.seen_after, 0, IN_TIME);
            assert_in_range(a.gone_after, 0, IN_TIME);
            // its outline, more of a small one, where points round to one side or the other, and the filter's
            // share of each counts
            assert_true(a.worst_missing <= a.pixels / ways[way].late);
        }
        close_corner(&c);
    }
}

// Everything has a moving id and stands still: a room of one piece, or a wall of 36 before it.
static struct scene *all_moving(bool pieces)
{
    struct block list[37];
    static struct block_key keys[37][2];
    uint32_t count = 0;
    list[count++] = (struct block){.half = {8, 8, 8}, .colour = {0.3f, 0.3f, 0.5f}, .inside_out = true};
    for (int i = 0; pieces && i < 36; i++)
        list[count++] = (struct block){.middle = {2.4 * (i % 6 - 2.5), 2.4 * (i / 6 - 2.5), -5},
                                       .half = {1.2, 1.2, 0.2},
                                       .colour = {0.1f + 0.02f * (float)i, 0.5f, 0.3f}};
    for (uint32_t i = 0; i < count; i++) {
        const struct dvec3 m = list[i].middle;
        for (int k = 0; k < 2; k++)
            keys[i][k] = (struct block_key){(float)k, (float)m.x, (float)m.y, (float)m.z};
        list[i].keys = keys[i];
        list[i].key_count = 2;
    }
    return blocks_scene(&(struct blocks){.list = list, .count = count, .target = {0, 0, -1}, .sky = 0.3f});
}

struct load {
    double mean, most; // shares of all pixels shaded in a frame
};

static struct load load_of(struct stage *stage, const struct scene *scene, struct renderer_scene *uploaded,
                           const char *mode)
{
    struct load load = {0};
    struct renderer_option *warped = stage_option(stage, uploaded, mode);
    for (uint64_t n = 0; n < 70; n++) {
        struct frame_stats stats;
        struct frame frame = stage_frame(stage, scene, n, 0, 0, 0);
        frame.moving = true;
        assert_true(renderer_draw(warped, &frame, &stats));
        if (n < 10)
            continue;
        const double share = (double)stats.shaded_px / (2 * COUNT);
        load.mean += share / 60;
        load.most = fmax(load.most, share);
    }
    renderer_option_destroy(warped);
    return load;
}

static void a_screen_full_of_moving_objects_is_shared_out(void **state)
{
    struct stage *stage = *state;
    const char *names[] = {"time_warped", "time_warped:dynamic_decay=0", "time_warped:dynamic_decay=1"};
    struct load load[2][3];
    for (int pieces = 0; pieces < 2; pieces++) {
        struct scene *scene = all_moving(pieces);
        struct renderer_scene *uploaded = renderer_scene_create(stage->renderer, scene);
        for (int i = 0; i < 3; i++) {
            load[pieces][i] = load_of(stage, scene, uploaded, names[i]);
            print_message("%s, %s: %.1f %% shaded, %.1f %% at most\n", pieces ? "37 pieces" : "one piece",
                          names[i], 100 * load[pieces][i].mean, 100 * load[pieces][i].most);
        }
        const struct load *l = load[pieces];
        // a sixth of the trusted periphery a frame, more between, all of the fovea
        assert_true(l[0].mean < 0.25 && l[0].most < 1.25 * l[0].mean);
        assert_true(l[1].mean > 0.9999); // no trust in what is one frame old
        // nothing ages, but what may be hidden behind the moving surfaces has its turns
        assert_true(l[2].mean <= l[0].mean && l[2].most < 1.25 * l[2].mean);
        renderer_scene_destroy(uploaded);
        scene_destroy(scene);
    }
}

// A head that sways by a centimetre, so that what stands still is reprojected from elsewhere.
static void sway(struct frame *frame, int n)
{
    for (int eye = 0; eye < EYES; eye++)
        frame->eyes[eye].pose.position.x += 0.01 * sin(0.3 * n);
}

struct mixed {
    uint64_t box, wrong, extra, unmarked; // pixels over all frames
    double shaded;                        // mean share
};

static void mixed_frame(struct stage *stage, const struct corner_stage *c, struct renderer_option *warped,
                        struct mixed *m)
{
    uint8_t *w = stage_read(stage, warped, EYE_LEFT), *r = stage_read(stage, c->regular, EYE_LEFT);
    uint8_t *map = malloc(COUNT);
    assert_true(map && renderer_read_redraw_map(warped, EYE_LEFT, map));
    for (uint32_t i = 0; i < COUNT; i++) {
        const bool box = shows_box(r, c->bare, i);
        int most = 0;
        for (int k = 0; k < 3; k++)
            most = abs(w[4 * i + (uint32_t)k] - r[4 * i + (uint32_t)k]) > most
                       ? abs(w[4 * i + (uint32_t)k] - r[4 * i + (uint32_t)k])
                       : most;
        m->box += box;
        m->wrong += box && most > 1;
        m->unmarked += box && most <= 1 && !map[i];
        m->extra += !box && shows_box(w, c->bare, i);
    }
    free(w);
    free(r);
    free(map);
}

static void the_mixed_mode_draws_moving_objects_as_regular_does(void **state)
{
    struct stage *stage = *state;
    struct corner_stage c = open_corner(stage, glide, 5, &large, NULL);
    struct renderer_option *warped = stage_option(stage, c.uploaded, "time_warped:dynamic_objects=regular");
    struct mixed m = {0};
    uint64_t hidden = 0;
    for (int n = 0; n < 118; n++) {
        struct frame_stats stats;
        struct frame frame = frame_at(stage, c.scene, (uint64_t)n, n * step_s);
        sway(&frame, n);
        assert_true(renderer_draw(warped, &frame, &stats));
        assert_true(renderer_draw(c.regular, &frame, NULL));
        m.shaded += n ? (double)stats.shaded_px / (2 * COUNT) / 117 : 0;
        mixed_frame(stage, &c, warped, &m);
        if (n < 18) // behind the wall, which is reprojected
            hidden += m.extra;
    }
    print_message(
        "mixed: of %llu pixels of the box %llu are not regular's, %llu not marked; %llu beside it, %llu "
        "of them through the wall; %.1f %% shaded\n",
        (unsigned long long)m.box, (unsigned long long)m.wrong, (unsigned long long)m.unmarked,
        (unsigned long long)m.extra, (unsigned long long)hidden, 100 * m.shaded);
    assert_true(m.box > 2000 && m.wrong <= m.box / 25);
    assert_int_equal(m.unmarked, 0);
    assert_int_equal(hidden, 0);
    assert_true(m.extra <= m.box / 50);
    assert_true(m.shaded < 0.25);
    renderer_option_destroy(warped);
    close_corner(&c);
}

static void at_rest_the_mixed_mode_is_the_foveated_one(void **state)
{
    struct stage *stage = *state;
    struct corner_stage c = open_corner(stage, glide, 5, &large, NULL);
    struct renderer_option *mixed = stage_option(stage, c.uploaded, "time_warped:dynamic_objects=regular");
    struct renderer_option *foveated = stage_option(stage, c.uploaded, "time_warped");
    for (int n = 0; n < 12; n++) {
        struct frame_stats a, b;
        struct frame frame = frame_at(stage, c.scene, (uint64_t)n, 0.7);
        frame.moving = false;
        sway(&frame, n);
        assert_true(renderer_draw(mixed, &frame, &a));
        assert_true(renderer_draw(foveated, &frame, &b));
        assert_int_equal(a.shaded_px, b.shaded_px);
        assert_int_equal(stage_differ(stage, mixed, foveated).max, 0);
    }
    renderer_option_destroy(mixed);
    renderer_option_destroy(foveated);
    close_corner(&c);
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
        cmocka_unit_test(a_box_from_behind_a_wall_shows_in_time_and_leaves_no_ghost),
        cmocka_unit_test(a_screen_full_of_moving_objects_is_shared_out),
        cmocka_unit_test(the_mixed_mode_draws_moving_objects_as_regular_does),
        cmocka_unit_test(at_rest_the_mixed_mode_is_the_foveated_one),
    };
    return cmocka_run_group_tests(tests, open_stage, close_stage);
}
