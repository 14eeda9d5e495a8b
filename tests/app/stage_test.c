// The stage of adjust and staircase trials and of repeated ones: what it draws is what the trial says. Exit 77
// where no device can draw.
#include "app/fovstudy/run_study.h"
#include "tests/app/command.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const char protocol[] =
    "fovstudy: 1\n"
    "name: live\n"
    "title: Values that change\n"
    "seed: 3\n"
    "scenes: [atrium]\n"
    "options:\n"
    "  warped: {mode: time_warped, epsilon: 0.1}\n"
    "  regular: {mode: regular}\n"
    "reference: regular\n"
    "settings: {rest_s: 0, confirm_s: 0, question: prefer, moving_objects: on, fixation: moving, foveate: "
    "target}\n"
    "questions:\n"
    "  prefer: {text: \"Which is the original?\", correct: reference}\n"
    "instructions: Choose.\n"
    "consent: {version: \"1\", text: Yes?}\n"
    "blocks:\n"
    "  - name: one\n"
    "    kind: adjust\n"
    "    options: [warped, regular]\n"
    "    adjust: {epsilon: {start: [0.5, 0.5], step: 0.05}, fovea_deg: {start: [10, 10], step: 15, max: 29}}\n"
    "  - name: two\n"
    "    kind: staircase\n"
    "    options: [warped, regular]\n"
    "    staircase: {parameter: epsilon, method: 1up2down, larger: easier, level: {min: 0.1, max: 1}, start: "
    "0.6,\n"
    "                steps: [0.2], trials: 4}\n"
    "  - {name: three, kind: toggle, options: [warped, regular]}\n";

enum { WIDTH = 48, HEIGHT = 54 };
#define MS 1000000

struct rig {
    struct run_study study;
    struct run_view view;
    struct plan *plan;
    struct machine *machine;
    struct stage *stage;
    struct machine_view look;
    int64_t now_ns;
    uint64_t number;
    char error[RUN_ERROR];
};

static void prepare(struct rig *rig)
{
    machine_look(rig->machine, &rig->look);
    const enum machine_screen s = rig->look.screen;
    const bool soon =
        s == MACHINE_INSTRUCTIONS || s == MACHINE_READY || s == MACHINE_REST || s == MACHINE_STIMULUS;
    if (rig->look.trial && soon && !stage_prepare(rig->stage, &rig->look, rig->error, sizeof rig->error))
        fail_msg("%s", rig->error);
}

static void event(struct rig *rig, enum machine_event_kind kind, int32_t value)
{
    struct machine_record record;
    machine_event(rig->machine, rig->now_ns, &(struct machine_event){kind, value});
    while (machine_next_record(rig->machine, &record))
        continue;
    prepare(rig);
}

// Frames as the session shows them; draws those in which an option is seen.
static void frames(struct rig *rig, int count)
{
    for (int i = 0; i < count; i++) {
        struct machine_record record;
        struct fixation_place at;
        struct fovea_use use = {.known = false};
        struct pose head;
        rig->now_ns += 50 * MS;
        prepare(rig);
        machine_frame(rig->machine, rig->now_ns, &rig->look);
        while (machine_next_record(rig->machine, &record))
            continue;
        if (rig->look.screen != MACHINE_STIMULUS || rig->look.fade >= 1)
            continue;
        assert_true(targets_fixation(stage_targets(rig->stage), &rig->look, &at));
        fovea_on(at.point, VIEWING_DEFAULT_IPD_M, &use);
        stage_adjust(rig->stage, &rig->look);
        const struct frame frame = stage_frame(rig->stage, &rig->look, rig->number++, &use, &head);
        assert_true(renderer_draw(stage_option(rig->stage, rig->look.slot), &frame, NULL));
    }
}

static int open_rig(void **state)
{
    char folder[512], file[600];
    struct rig *rig = calloc(1, sizeof *rig);
    if (!rig)
        return -1;
    command_folder("stage", folder, sizeof folder);
    snprintf(file, sizeof file, "%s/protocol.yaml", folder);
    FILE *out = fopen(file, "w");
    assert_true(out && fputs(protocol, out) >= 0 && fclose(out) == 0);
    const struct run_options options = {.protocol = file,
                                        .participant = "p1",
                                        .display = "headless",
                                        .scenes = {{"atrium", "town:triangles=20000"}},
                                        .scene_count = 1,
                                        .width = WIDTH,
                                        .height = HEIGHT,
                                        .fov_deg = VIEWING_DEFAULT_FOV_DEG,
                                        .refresh_hz = 20};
    if (!run_study_init(&rig->study, &options, rig->error, sizeof rig->error) ||
        !run_view_init(&rig->view, &options, rig->study.protocol, rig->error, sizeof rig->error))
        fail_msg("%s", rig->error);
    rig->plan = plan_create(rig->study.protocol, 3, 0);
    rig->machine = machine_create(rig->plan, &(struct machine_start){.consented = true});
    rig->stage = stage_create(&(struct stage_desc){.renderer = rig->view.renderer,
                                                   .plan = rig->plan,
                                                   .scenes = rig->view.scenes,
                                                   .scene_count = rig->view.scene_count,
                                                   .fov = rig->view.fov,
                                                   .ipd_m = VIEWING_DEFAULT_IPD_M,
                                                   .moving_setting = STUDY_MOVING_OBJECTS,
                                                   .ssao_setting = STUDY_SSAO,
                                                   .taa_setting = STUDY_TAA});
    *state = rig;
    return rig->plan && rig->machine && rig->stage ? 0 : -1;
}

static int close_rig(void **state)
{
    struct rig *rig = *state;
    stage_destroy(rig->stage);
    machine_destroy(rig->machine);
    plan_destroy(rig->plan);
    run_view_finish(&rig->view);
    run_study_finish(&rig->study);
    free(rig);
    return 0;
}

static void expect_effective(const struct rig *rig, const char *wanted)
{
    const char *effective = stage_effective(rig->stage, rig->look.trial->test_slot);
    if (wanted && effective)
        assert_string_equal(effective, wanted);
    assert_true((wanted == NULL) == (effective == NULL));
    assert_null(stage_effective(rig->stage, (enum plan_slot)(1 - (int)rig->look.trial->test_slot)));
}

static void show_slot(struct rig *rig, enum plan_slot slot)
{
    if (rig->look.slot != slot)
        event(rig, MACHINE_TOGGLE_KEY, 0);
    frames(rig, 14);
    assert_int_equal(rig->look.slot, slot);
    assert_true(rig->look.fade <= 0);
}

static void an_adjusted_value_is_drawn(struct rig *rig)
{
    event(rig, MACHINE_START, 0);
    event(rig, MACHINE_START, 0);
    frames(rig, 6);
    const enum plan_slot tested = rig->look.trial->test_slot;
    show_slot(rig, tested);
    expect_effective(rig, "{\"epsilon\":0.5}"); // where it starts
    event(rig, MACHINE_ADJUST, -2);
    frames(rig, 1);
    expect_effective(rig, "{\"epsilon\":0.4}");
    assert_true(fabs(stage_now(rig->stage, tested)->values[0] - 0.4) < 1e-12);
    event(rig, MACHINE_ADJUST, -6);
    frames(rig, 1);
    expect_effective(rig, NULL); // as the condition
    // Up to the end of its range, beyond which the mode would refuse it.
    event(rig, MACHINE_ADJUST_NEXT, 1);
    event(rig, MACHINE_ADJUST, 1);
    frames(rig, 1);
    expect_effective(rig, "{\"fovea_deg\":25}");
    event(rig, MACHINE_ADJUST, 1);
    frames(rig, 1);
    expect_effective(rig, "{\"fovea_deg\":29}");
    event(rig, MACHINE_ADJUST_NEXT, 1);
    frames(rig, 1);
    // What is changed while the other is looked at is there when it comes back.
    show_slot(rig, (enum plan_slot)(1 - (int)tested));
    event(rig, MACHINE_ADJUST, 1);
    show_slot(rig, tested);
    expect_effective(rig, "{\"epsilon\":0.15,\"fovea_deg\":29}");
}

// Each trial of it begins with the level that the answers before it lead to, ready before it starts.
static void staircases_begin_at_their_level(struct rig *rig)
{
    static const double levels[4] = {0.6, 0.6, 0.4, 0.4}; // down after two right ones
    for (int i = 0; i < 4; i++) {
        char wanted[32];
        assert_int_equal(rig->look.trial->kind, PROTOCOL_STAIRCASE);
        assert_true(fabs(rig->look.level - levels[i]) < 1e-12);
        snprintf(wanted, sizeof wanted, "{\"epsilon\":%g}", levels[i]);
        expect_effective(rig, wanted); // prepared while the trial is still to come
        const struct renderer_option *ready = stage_option(rig->stage, PLAN_SLOT_A);
        event(rig, MACHINE_START, 0);
        frames(rig, 4);
        assert_ptr_equal(stage_option(rig->stage, PLAN_SLOT_A), ready); // and not made again
        event(rig, MACHINE_TOGGLE_KEY, 0);
        frames(rig, 14);
        event(rig, MACHINE_CHOOSE, 1 - (int)rig->look.trial->test_slot);
        event(rig, MACHINE_ANSWER_STORED, 0);
        frames(rig, 2);
    }
}

static void trials_follow_their_kind(void **state)
{
    struct rig *rig = *state;
    prepare(rig);
    an_adjusted_value_is_drawn(rig);
    event(rig, MACHINE_START, 0);
    event(rig, MACHINE_ANSWER_STORED, 0);
    frames(rig, 2);
    staircases_begin_at_their_level(rig);
    // A flagged trial comes again after the plan, in a place of its own.
    assert_int_equal(rig->look.trial->kind, PROTOCOL_TOGGLE);
    const struct plan_trial *toggled = rig->look.trial;
    event(rig, MACHINE_START, 0);
    frames(rig, 6);
    expect_effective(rig, NULL);
    event(rig, MACHINE_FLAG, 0);
    frames(rig, 1);
    assert_true(rig->look.trial_index >= rig->plan->trial_count);
    assert_ptr_equal(rig->look.trial, toggled);
    event(rig, MACHINE_START, 0);
    frames(rig, 6);
    assert_int_equal(rig->look.screen, MACHINE_STIMULUS);
    event(rig, MACHINE_TOGGLE_KEY, 0);
    frames(rig, 14);
    event(rig, MACHINE_CHOOSE, PLAN_SLOT_A);
    event(rig, MACHINE_ANSWER_STORED, 0);
    frames(rig, 2);
    assert_int_equal(rig->look.screen, MACHINE_END);
    assert_true(rig->look.complete);
}

int main(void)
{
    if (command("fovstudy devices")->status != 0)
        return 77;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(trials_follow_their_kind),
    };
    return cmocka_run_group_tests(tests, open_rig, close_rig);
}
