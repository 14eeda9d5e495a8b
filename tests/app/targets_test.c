// What lies over a trial's frames: the target in both eyes at its depth, the marker, the spheres, and when each
// is there; and the values that a trial gives its option.
#include "app/session/live.h"
#include "app/session/targets.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { SIDE = 720 };

struct rig {
    struct scene *scene;
    struct ray_scene *rays;
    struct protocol_settings settings;
    struct plan_trial trial;
    struct targets targets;
    struct targets_view eyes;
};

static int open_rig(void **state)
{
    char error[512];
    struct rig *rig = calloc(1, sizeof *rig);
    if (!rig)
        return -1;
    rig->scene = scene_open("town:triangles=20000", error, sizeof error);
    rig->rays = rig->scene ? ray_scene_create(rig->scene) : NULL;
    rig->eyes = (struct targets_view){viewing_symmetric_fov(100, SIDE, SIDE), SIDE, SIDE, 0.063};
    *state = rig;
    return rig->rays ? 0 : -1;
}

static int close_rig(void **state)
{
    struct rig *rig = *state;
    targets_finish(&rig->targets);
    ray_scene_destroy(rig->rays);
    scene_destroy(rig->scene);
    free(rig);
    return 0;
}

static void prepare(struct rig *rig, enum protocol_kind kind, enum protocol_fixation fixation, uint32_t spheres)
{
    targets_finish(&rig->targets);
    rig->settings = (struct protocol_settings){.fixation = fixation,
                                               .view_ns = 4000000000,
                                               .fade_from_gray_ns = 125000000,
                                               .fade_to_gray_ns = 125000000};
    rig->trial = (struct plan_trial){
        .kind = kind, .resolved = &rig->settings, .seed = 9, .target_seed = 4, .spheres = {spheres, spheres}};
    assert_true(targets_prepare(&rig->targets, &(struct targets_desc){.trial = &rig->trial,
                                                                      .rays = rig->rays,
                                                                      .path = &rig->scene->path,
                                                                      .fov = rig->eyes.fov,
                                                                      .ipd_m = rig->eyes.ipd_m}));
}

static struct machine_view view_at(const struct rig *rig, double time_s, double fade)
{
    return (struct machine_view){.screen = MACHINE_STIMULUS,
                                 .trial = &rig->trial,
                                 .slot = PLAN_SLOT_A,
                                 .fade = fade,
                                 .stimulus_ns = (int64_t)(time_s * 1e9)};
}

static uint32_t marks_of(const struct rig *rig, const struct machine_view *view, struct renderer_mark *out)
{
    const struct pose head = targets_head(&rig->trial, &rig->scene->path, (double)view->stimulus_ns * 1e-9);
    return targets_marks(&rig->targets, view, &head, &rig->eyes, out, RENDERER_MARKS);
}

// The distance at which both eyes' lines meet, from the images' disparity.
static double met_at(const struct rig *rig, const struct renderer_mark *mark)
{
    const double tan_per_px = (rig->eyes.fov.tan_left + rig->eyes.fov.tan_right) / SIDE;
    return rig->eyes.ipd_m / ((mark->place[EYE_LEFT].x_px - mark->place[EYE_RIGHT].x_px) * tan_per_px);
}

static void the_target_is_at_its_depth_in_both_eyes(void **state)
{
    struct rig *rig = *state;
    struct renderer_mark marks[RENDERER_MARKS];
    for (int moving = 0; moving < 2; moving++) {
        prepare(rig, PROTOCOL_TASK, moving ? PROTOCOL_FIXATION_MOVING : PROTOCOL_FIXATION_CROSS, 0);
        for (double t = 0; t < 4.2; t += 0.3) {
            struct fixation_place at;
            const struct machine_view view = view_at(rig, t, 0);
            assert_true(targets_fixation(&rig->targets, &view, &at));
            assert_int_equal(marks_of(rig, &view, marks), 1);
            assert_int_equal(marks[0].kind, moving ? RENDERER_MARK_BALL : RENDERER_MARK_CROSS);
            // along the head's axis; a ball's ellipse has its middle a little off its centre's direction
            const double forward_m = -at.point.z;
            if (fabs(1 / met_at(rig, &marks[0]) - 1 / forward_m) > 0.002)
                fail_msg("%g s: %.3f m in the images, %.3f m", t, met_at(rig, &marks[0]), forward_m);
        }
    }
}

static void the_cross_gives_way_to_a_letter_only(void **state)
{
    struct rig *rig = *state;
    struct renderer_mark marks[RENDERER_MARKS];
    static const struct {
        enum protocol_kind kind;
        enum protocol_fixation fixation;
        double fade;
        uint32_t count;
    } cases[] = {
        {PROTOCOL_TOGGLE, PROTOCOL_FIXATION_CROSS, 0.5, 1},
        {PROTOCOL_TOGGLE, PROTOCOL_FIXATION_CROSS, 1, 0},
        {PROTOCOL_TOGGLE, PROTOCOL_FIXATION_MOVING, 1, 1},
        {PROTOCOL_SEQUENTIAL, PROTOCOL_FIXATION_CROSS, 1, 1},
        {PROTOCOL_RATE, PROTOCOL_FIXATION_CROSS, 1, 1},
        {PROTOCOL_TOGGLE, PROTOCOL_FIXATION_FREE, 0, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        prepare(rig, cases[i].kind, cases[i].fixation, 0);
        const struct machine_view view = view_at(rig, 1, cases[i].fade);
        assert_int_equal(marks_of(rig, &view, marks), cases[i].count);
    }
}

static void nothing_lies_over_other_screens(void **state)
{
    struct rig *rig = *state;
    struct renderer_mark marks[RENDERER_MARKS];
    struct fixation_place at;
    prepare(rig, PROTOCOL_SEQUENTIAL, PROTOCOL_FIXATION_CROSS, 5);
    for (int screen = MACHINE_CONSENT; screen <= MACHINE_END; screen++) {
        struct machine_view view = view_at(rig, 1, 1);
        view.screen = (enum machine_screen)screen;
        view.slot = PLAN_SLOT_NONE;
        assert_int_equal(marks_of(rig, &view, marks), 0);
        assert_false(targets_fixation(&rig->targets, &view, &at));
    }
}

// A cross in the middle between two showings, whatever the fixation, where the eyes will be wanted next.
static void the_marker_is_a_cross(void **state)
{
    struct rig *rig = *state;
    struct renderer_mark marks[RENDERER_MARKS];
    for (int fixation = PROTOCOL_FIXATION_FREE; fixation <= PROTOCOL_FIXATION_MOVING; fixation++) {
        prepare(rig, PROTOCOL_SEQUENTIAL, (enum protocol_fixation)fixation, 3);
        struct machine_view view = view_at(rig, 4.3, 1);
        view.slot = PLAN_SLOT_NONE;
        view.marker = true;
        assert_int_equal(marks_of(rig, &view, marks), 1);
        assert_int_equal(marks[0].kind, RENDERER_MARK_CROSS);
        const double depth_m = fixation_target_at(&rig->targets.fixation, 0).distance_m;
        assert_true(fabs(marks[0].place[0].x_px + marks[0].place[1].x_px - SIDE) < 1e-6);
        assert_true(fabs(marks[0].place[0].y_px - SIDE / 2.0) < 1e-6);
        assert_true(fabs(1 / met_at(rig, &marks[0]) - 1 / depth_m) < 0.001);
    }
}

// They are where the world has them, fade with it, and each showing has its own.
static void spheres_stand_in_the_world(void **state)
{
    struct rig *rig = *state;
    struct renderer_mark full[RENDERER_MARKS], faded[RENDERER_MARKS];
    prepare(rig, PROTOCOL_SEQUENTIAL, PROTOCOL_FIXATION_FREE, 6);
    for (uint32_t showing = 0; showing < 2; showing++) {
        const struct spheres *spheres = &rig->targets.spheres[showing];
        for (uint32_t i = 0; i < spheres->count; i++) {
            struct machine_view view = view_at(rig, spheres->all[i].from_s + 0.3, 0);
            view.showing = showing;
            const struct pose head =
                targets_head(&rig->trial, &rig->scene->path, (double)view.stimulus_ns * 1e-9);
            const uint32_t count = marks_of(rig, &view, full);
            bool found = false;
            for (uint32_t k = 0; k < count; k++) {
                const struct pose eye = viewing_eye_pose(&head, EYE_RIGHT, rig->eyes.ipd_m);
                const struct dquat q = eye.orientation;
                double x, y;
                assert_true(viewing_pixel(&rig->eyes.fov, SIDE, SIDE,
                                          dquat_rotate((struct dquat){-q.x, -q.y, -q.z, q.w},
                                                       dvec3_sub(spheres->all[i].position, eye.position)),
                                          &x, &y));
                const struct viewing_disc *place = &full[k].place[EYE_RIGHT];
                found = found || (hypot(place->x_px - x, place->y_px - y) < 1.0 &&
                                  full[k].opacity[EYE_RIGHT] > 0.99 && full[k].opacity[EYE_LEFT] > 0.99);
            }
            assert_true(found);
            view.fade = 0.75;
            assert_int_equal(marks_of(rig, &view, faded), count);
            for (uint32_t k = 0; k < count; k++)
                assert_true(fabs(faded[k].fade - 0.75) < 1e-12 && full[k].fade <= 0 &&
                            fabs(faded[k].opacity[0] - full[k].opacity[0]) <= 0);
            view.fade = 1;
            assert_int_equal(marks_of(rig, &view, faded), 0);
        }
    }
    assert_true(dvec3_length(dvec3_sub(rig->targets.spheres[0].all[0].position,
                                       rig->targets.spheres[1].all[0].position)) > 1e-3);
}

static void where_they_stand_is_told(void **state)
{
    struct rig *rig = *state;
    char text[256];
    prepare(rig, PROTOCOL_TASK, PROTOCOL_FIXATION_FREE, 2);
    assert_true(targets_sphere_json(&rig->targets, 0, 1, text, sizeof text));
    assert_non_null(strstr(text, "{\"showing\":0,\"sphere\":2,\"of\":2,\"at\":["));
    assert_false(targets_sphere_json(&rig->targets, 0, 2, text, sizeof text));
    assert_false(targets_sphere_json(&rig->targets, 0, 0, text, 40));
}

static void values_of_the_option_under_test(void **state)
{
    (void)state;
    struct protocol *protocol = calloc(1, sizeof *protocol);
    char error[256], text[128];
    struct mode_choice condition, now;
    const double adjusted[2] = {0.13, 25};
    assert_true(mode_parse("time_warped", &condition, error, sizeof error));
    protocol->blocks[0].staircase.parameter = 0;
    protocol->blocks[0].adjusts[1].parameter = 2;
    protocol->blocks[0].adjust_count = 2;
    struct plan_trial trial = {.kind = PROTOCOL_ADJUST, .test_slot = PLAN_SLOT_B};
    now = condition;
    live_choice(protocol, &trial, PLAN_SLOT_A, NAN, adjusted, &now);
    assert_true(live_same(&now, &condition));
    assert_false(live_effective(&condition, &now, text, sizeof text));
    live_choice(protocol, &trial, PLAN_SLOT_B, NAN, adjusted, &now);
    assert_true(live_effective(&condition, &now, text, sizeof text));
    assert_string_equal(text, "{\"epsilon\":0.13,\"periphery_deg\":25}");
    assert_false(live_effective(&condition, &now, text, 12));
    trial.kind = PROTOCOL_STAIRCASE;
    now = condition;
    live_choice(protocol, &trial, PLAN_SLOT_B, 0.5, adjusted, &now);
    assert_true(live_effective(&condition, &now, text, sizeof text));
    assert_string_equal(text, "{\"epsilon\":0.5}");
    now = condition;
    live_choice(protocol, &trial, PLAN_SLOT_B, NAN, NULL, &now);
    assert_true(live_same(&now, &condition));
    free(protocol);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_target_is_at_its_depth_in_both_eyes),
        cmocka_unit_test(the_cross_gives_way_to_a_letter_only),
        cmocka_unit_test(nothing_lies_over_other_screens),
        cmocka_unit_test(the_marker_is_a_cross),
        cmocka_unit_test(spheres_stand_in_the_world),
        cmocka_unit_test(where_they_stand_is_told),
        cmocka_unit_test(values_of_the_option_under_test),
    };
    return cmocka_run_group_tests(tests, open_rig, close_rig);
}
