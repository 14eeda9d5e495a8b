// Marks over both eyes: where they are told to be, the same over every picture and fade, smooth to a part of a
// pixel, and nothing where there are none.
#include "tests/renderer/stage.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { WIDTH = 96, HEIGHT = 80, BYTES = 4 * WIDTH * HEIGHT };

struct room {
    struct stage stage;
    struct scene *scene;
    struct renderer_scene *uploaded;
    struct renderer_option *regular, *coarse;
};

static int open_room(void **state)
{
    char error[512];
    struct room *r = calloc(1, sizeof *r);
    if (!r || !stage_open(&r->stage, WIDTH, HEIGHT))
        return -1;
    r->scene = scene_open("town:triangles=20000", error, sizeof error);
    if (!r->scene)
        fail_msg("%s", error);
    r->uploaded = renderer_scene_create(r->stage.renderer, r->scene);
    r->regular = stage_option(&r->stage, r->uploaded, "regular");
    r->coarse = stage_option(&r->stage, r->uploaded, "vrs:inner_deg=1,outer_deg=2");
    const struct frame frame = stage_frame(&r->stage, r->scene, 0, 3, 0, 0);
    *state = r;
    return renderer_draw(r->regular, &frame, NULL) && renderer_draw(r->coarse, &frame, NULL) ? 0 : -1;
}

static int close_room(void **state)
{
    struct room *r = *state;
    renderer_option_destroy(r->regular);
    renderer_option_destroy(r->coarse);
    renderer_scene_destroy(r->uploaded);
    scene_destroy(r->scene);
    stage_close(&r->stage);
    free(r);
    return 0;
}

// A round one, at another place in each eye.
static struct renderer_mark mark_at(enum renderer_mark_kind kind, double x, double y, double radius_px)
{
    struct renderer_mark mark = {.kind = kind, .opacity = {1, 1}, .colour = {0.2f, 0.8f, 0.2f}};
    for (int eye = 0; eye < EYES; eye++)
        mark.place[eye] = (struct viewing_disc){
            .x_px = x + 6 * eye, .y_px = y, .unit_from_px = {{1 / radius_px, 0}, {0, -1 / radius_px}}};
    return mark;
}

static void show(const struct room *r, struct renderer_option *option, double fade,
                 const struct renderer_mark *marks, uint32_t count, uint8_t *out[EYES])
{
    assert_true(renderer_set_marks(r->stage.renderer, marks, count));
    assert_true(renderer_show(r->stage.renderer, option, fade));
    for (int eye = 0; eye < EYES; eye++)
        assert_true(renderer_read_screen(r->stage.renderer, eye, out[eye]));
}

static void nothing_changes_without_marks(void **state)
{
    const struct room *r = *state;
    static uint8_t a[EYES][BYTES], b[EYES][BYTES], c[BYTES];
    const struct renderer_mark mark = mark_at(RENDERER_MARK_BALL, 40, 40, 9);
    show(r, r->regular, 0, NULL, 0, (uint8_t *[]){a[0], a[1]});
    show(r, r->regular, 0, &mark, 1, (uint8_t *[]){b[0], b[1]});
    show(r, r->regular, 0, NULL, 0, (uint8_t *[]){b[0], b[1]});
    for (int eye = 0; eye < EYES; eye++) {
        assert_memory_equal(a[eye], b[eye], BYTES);
        assert_true(renderer_read(r->regular, eye, c));
        assert_memory_equal(a[eye], c, BYTES);
    }
}

// Nothing farther than its rim and a pixel, in each eye around its own middle.
static void a_mark_is_where_it_is_told_to_be(void **state)
{
    const struct room *r = *state;
    static uint8_t bare[EYES][BYTES], with[EYES][BYTES];
    for (int kind = 0; kind < 2; kind++) {
        const struct renderer_mark mark = mark_at((enum renderer_mark_kind)kind, 40.3, 30.7, 9);
        show(r, r->regular, 0, NULL, 0, (uint8_t *[]){bare[0], bare[1]});
        show(r, r->regular, 0, &mark, 1, (uint8_t *[]){with[0], with[1]});
        for (int eye = 0; eye < EYES; eye++) {
            uint32_t changed = 0;
            for (int i = 0; i < WIDTH * HEIGHT; i++) {
                const double x = i % WIDTH + 0.5 - 40.3 - 6 * eye, y = i / WIDTH + 0.5 - 30.7;
                const bool differs = memcmp(&bare[eye][4 * i], &with[eye][4 * i], 4) != 0;
                changed += differs;
                if (differs)
                    assert_true(hypot(x, y) < 9 + (kind == RENDERER_MARK_CROSS ? 2.5 : 1.0));
            }
            assert_true(changed > (kind == RENDERER_MARK_BALL ? 240u : 60u));
        }
    }
}

// Inside it hides the picture, so it is the same over another option, in a fade, and in the gray.
static void a_mark_is_the_same_over_every_picture(void **state)
{
    const struct room *r = *state;
    static uint8_t one[EYES][BYTES], other[EYES][BYTES];
    struct renderer_option *options[] = {r->coarse, r->regular, NULL};
    const double fades[] = {0, 0.5, 1};
    const struct renderer_mark mark = mark_at(RENDERER_MARK_BALL, 50, 40, 12);
    show(r, r->regular, 0, &mark, 1, (uint8_t *[]){one[0], one[1]});
    for (int k = 0; k < 3; k++) {
        show(r, options[k], fades[k], &mark, 1, (uint8_t *[]){other[0], other[1]});
        for (int eye = 0; eye < EYES; eye++)
            for (int i = 0; i < WIDTH * HEIGHT; i++)
                if (hypot(i % WIDTH + 0.5 - 50 - 6 * eye, i / WIDTH + 0.5 - 40) < 11)
                    assert_memory_equal(&one[eye][4 * i], &other[eye][4 * i], 4);
    }
}

static double light_at(const uint8_t *rgba, double x, double y)
{
    const uint8_t *p = &rgba[4 * ((int)y * WIDTH + (int)x)];
    return 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2];
}

// Lit from the upper left, dark at the rim; the cross is light within dark edges, on white and on black.
static void it_reads_as_a_ball_or_a_cross(void **state)
{
    const struct room *r = *state;
    static uint8_t seen[EYES][BYTES];
    struct renderer_mark marks[3] = {mark_at(RENDERER_MARK_BALL, 48, 40, 14)};
    show(r, NULL, 1, marks, 1, (uint8_t *[]){seen[0], seen[1]});
    const double middle = light_at(seen[0], 48, 40), bright = light_at(seen[0], 44, 34),
                 dark = light_at(seen[0], 54, 48), rim = light_at(seen[0], 48 + 13.3, 40);
    assert_true(bright > middle + 10 && middle > dark + 30 && rim < 40);
    for (int white = 0; white < 2; white++) {
        // grounds: a huge ball would be shaded, so the overlay is not it either; two crosses as wide as the
        // image
        struct renderer_mark ground = mark_at(RENDERER_MARK_CROSS, 48, 40, 2000);
        ground.colour[0] = ground.colour[1] = ground.colour[2] = white ? 1.0f : 0.0f;
        marks[0] = ground;
        marks[1] = mark_at(RENDERER_MARK_CROSS, 48.5, 40.5, 9);
        marks[1].colour[0] = marks[1].colour[1] = marks[1].colour[2] = 0.95f;
        show(r, NULL, 1, marks, 2, (uint8_t *[]){seen[0], seen[1]});
        assert_true(light_at(seen[0], 48, 40) > 180 && light_at(seen[0], 54, 40) > 180);
        assert_true(light_at(seen[0], 52, 41) < 145); // the edge, a pixel below
        assert_true(fabs(light_at(seen[0], 48, 70) - (white ? 255 : 0)) < 2);
    }
}

// Moved by a part of a pixel its light moves by that part.
static void it_moves_by_parts_of_a_pixel(void **state)
{
    const struct room *r = *state;
    static uint8_t bare[EYES][BYTES], with[EYES][BYTES];
    show(r, NULL, 1, NULL, 0, (uint8_t *[]){bare[0], bare[1]});
    double first = 0;
    for (int step = 0; step <= 8; step++) {
        const struct renderer_mark mark = mark_at(RENDERER_MARK_CROSS, 40 + step / 8.0, 40, 8);
        show(r, NULL, 1, &mark, 1, (uint8_t *[]){with[0], with[1]});
        double sum = 0, moment = 0;
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            const double light = fabs((double)with[0][4 * i] - (double)bare[0][4 * i]);
            sum += light;
            moment += light * (i % WIDTH + 0.5);
        }
        if (step == 0)
            first = moment / sum;
        if (fabs(moment / sum - first - step / 8.0) > 0.08)
            fail_msg("moved by %g pixels it lies %.3f farther", step / 8.0, moment / sum - first);
    }
}

static void each_eye_has_its_opacity(void **state)
{
    const struct room *r = *state;
    static uint8_t bare[EYES][BYTES], with[EYES][BYTES], half[EYES][BYTES];
    struct renderer_mark mark = mark_at(RENDERER_MARK_BALL, 50, 40, 12);
    mark.opacity[EYE_LEFT] = 0;
    mark.place[EYE_LEFT].x_px = NAN; // not looked at
    show(r, r->regular, 0, NULL, 0, (uint8_t *[]){bare[0], bare[1]});
    show(r, r->regular, 0, &mark, 1, (uint8_t *[]){with[0], with[1]});
    assert_memory_equal(bare[EYE_LEFT], with[EYE_LEFT], BYTES);
    assert_memory_not_equal(bare[EYE_RIGHT], with[EYE_RIGHT], BYTES);
    mark.opacity[EYE_RIGHT] = 0.5;
    show(r, r->regular, 0, &mark, 1, (uint8_t *[]){half[0], half[1]});
    for (int i = 0; i < BYTES; i++) {
        const int low = bare[1][i] < with[1][i] ? bare[1][i] : with[1][i],
                  high = bare[1][i] < with[1][i] ? with[1][i] : bare[1][i];
        assert_true(half[1][i] >= low - 1 && half[1][i] <= high + 1);
    }
}

// A mark of the world fades as the picture does: as if the picture had it.
static void it_may_fade_with_the_picture(void **state)
{
    const struct room *r = *state;
    static uint8_t clear[EYES][BYTES], gone[EYES][BYTES], half[EYES][BYTES], gray[EYES][BYTES];
    struct renderer_mark mark = mark_at(RENDERER_MARK_BALL, 50, 40, 12);
    show(r, r->regular, 0, &mark, 1, (uint8_t *[]){clear[0], clear[1]});
    mark.fade = 0.5;
    show(r, r->regular, 0.5, &mark, 1, (uint8_t *[]){half[0], half[1]});
    mark.fade = 1;
    show(r, r->regular, 1, &mark, 1, (uint8_t *[]){gone[0], gone[1]});
    show(r, NULL, 1, NULL, 0, (uint8_t *[]){gray[0], gray[1]});
    assert_memory_equal(gone[0], gray[0], BYTES);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        if (hypot(i % WIDTH + 0.5 - 50, i / WIDTH + 0.5 - 40) > 11)
            continue;
        for (int c = 0; c < 3; c++) {
            const double a = clear[0][4 * i + c] / 255.0, b = 128 / 255.0;
            const double linear = 0.5 * (a <= 0.04045 ? a / 12.92 : pow((a + 0.055) / 1.055, 2.4)) +
                                  0.5 * pow((b + 0.055) / 1.055, 2.4);
            assert_true(fabs(255 * (1.055 * pow(linear, 1 / 2.4) - 0.055) - half[0][4 * i + c]) < 1.6);
        }
    }
}

static void what_cannot_be_is_refused(void **state)
{
    const struct room *r = *state;
    static struct renderer_mark many[RENDERER_MARKS + 1];
    static uint8_t a[EYES][BYTES], b[EYES][BYTES];
    const struct renderer_mark good = mark_at(RENDERER_MARK_BALL, 30, 30, 9);
    for (uint32_t i = 0; i <= RENDERER_MARKS; i++)
        many[i] = good;
    show(r, NULL, 1, &good, 1, (uint8_t *[]){a[0], a[1]});
    assert_false(renderer_set_marks(r->stage.renderer, many, RENDERER_MARKS + 1));
    many[0].place[1].unit_from_px[1][0] = INFINITY;
    assert_false(renderer_set_marks(r->stage.renderer, many, 1));
    assert_true(renderer_show(r->stage.renderer, NULL, 1)); // the last good ones stay
    for (int eye = 0; eye < EYES; eye++) {
        assert_true(renderer_read_screen(r->stage.renderer, eye, b[eye]));
        assert_memory_equal(a[eye], b[eye], BYTES);
    }
    assert_true(renderer_set_marks(r->stage.renderer, NULL, 0));
}

// Text stays readable: it lies over them.
static void an_overlay_lies_over_marks(void **state)
{
    const struct room *r = *state;
    static uint8_t seen[EYES][BYTES], rgba[4 * 20 * 20];
    memset(rgba, 255, sizeof rgba);
    const struct renderer_overlay over = {
        .rgba = rgba, .width = 20, .height = 20, .left = {40, 40}, .top = {30, 30}};
    const struct renderer_mark mark = mark_at(RENDERER_MARK_BALL, 50, 40, 12);
    assert_true(renderer_set_overlay(r->stage.renderer, &over));
    show(r, NULL, 1, &mark, 1, (uint8_t *[]){seen[0], seen[1]});
    assert_true(light_at(seen[0], 50, 40) > 254);
    assert_true(renderer_set_overlay(r->stage.renderer, NULL));
    assert_true(renderer_set_marks(r->stage.renderer, NULL, 0));
}

int main(void)
{
    struct stage probe;
    if (!stage_open(&probe, 16, 16))
        return 77;
    stage_close(&probe);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_changes_without_marks),
        cmocka_unit_test(a_mark_is_where_it_is_told_to_be),
        cmocka_unit_test(a_mark_is_the_same_over_every_picture),
        cmocka_unit_test(it_reads_as_a_ball_or_a_cross),
        cmocka_unit_test(it_moves_by_parts_of_a_pixel),
        cmocka_unit_test(each_eye_has_its_opacity),
        cmocka_unit_test(it_may_fade_with_the_picture),
        cmocka_unit_test(what_cannot_be_is_refused),
        cmocka_unit_test(an_overlay_lies_over_marks),
    };
    return cmocka_run_group_tests(tests, open_room, close_room);
}
