// A toggle trial frame by frame, with exact times: fades, toggles, decisions, late frames, odd clocks.
#include "tests/studies/engine/machine_rig.h"

static void test_a_fade_frame_by_frame(void **state)
{
    (void)state;
    struct rig rig = rig_of(TWO, NULL);
    start_toggle_trial(&rig);
    const struct plan_trial *trial = rig.view.trial;
    assert_int_equal(rig.view.slot, trial->first_shown);
    for (int i = 1; i <= 10; i++) { // out of the gray
        frames(&rig, 1);
        level(&rig, 1 - i / 10.0);
        assert_false(rig.view.trial_started);
    }
    frames(&rig, 8);
    int64_t last_full = rig.now;
    enum plan_slot other = (enum plan_slot)(1 - (int)trial->first_shown);
    event_at(&rig, last_full + 3 * MS, MACHINE_TOGGLE_KEY, 0);
    assert_int_equal(record(&rig, MACHINE_TOGGLE).slot, other);
    for (int i = 1; i <= 40; i++) {
        frame_at(&rig, last_full + i * FRAME);
        level(&rig, i <= 10 ? i / 10.0 : i <= 30 ? 1 : 1 - (i - 30) / 10.0);
        assert_int_equal(rig.view.slot,
                         i < 20 ? trial->first_shown : other); // changes in the middle of the gray
        assert_int_equal(rig.view.condition, trial->option[rig.view.slot]);
        assert_int_equal(rig.view.phase, i < 40 ? MACHINE_PHASE_FADE : MACHINE_PHASE_STIMULUS);
    }
    assert_true(rig.view.may_choose);
    struct machine_record exposure = record(&rig, MACHINE_EXPOSURE);
    assert_int_equal(exposure.slot, trial->first_shown);
    assert_int_equal(exposure.full_end_ns, last_full);
    assert_int_equal(exposure.full_start_ns, last_full - 8 * FRAME);
    assert_int_equal(exposure.start_ns, last_full - 17 * FRAME);
    assert_int_equal(exposure.end_ns, last_full + 9 * FRAME);
    assert_int_equal(exposure.attempt, 1);
    assert_int_equal(exposure.trial, 1);
    no_record(&rig);
    rig_free(&rig);
}

static void test_toggles_at_the_edges_of_a_fade(void **state)
{
    (void)state;
    struct rig rig = rig_of(TWO, NULL);
    start_toggle_trial(&rig);
    event(&rig, MACHINE_TOGGLE_KEY, 0); // during the fade in
    record(&rig, MACHINE_TOGGLE_IGNORED);
    frames(&rig, 9);
    event_at(&rig, rig.now + FRAME, MACHINE_TOGGLE_KEY,
             0); // in the nanosecond of the first full frame, before it
    record(&rig, MACHINE_TOGGLE_IGNORED);
    frame_at(&rig, rig.now);
    level(&rig, 0);
    event(&rig, MACHINE_TOGGLE_KEY, 0); // in the same nanosecond, after it
    record(&rig, MACHINE_TOGGLE);
    event(&rig, MACHINE_TOGGLE_KEY, 0); // twice in one nanosecond
    record(&rig, MACHINE_TOGGLE_IGNORED);
    int64_t origin = rig.now;
    frames(&rig, 39);
    event(&rig, MACHINE_TOGGLE_KEY, 0);
    record(&rig, MACHINE_EXPOSURE);
    record(&rig, MACHINE_TOGGLE_IGNORED);
    assert_false(rig.view.may_choose);
    frames(&rig, 1);
    assert_int_equal(rig.now - origin, 500 * MS);
    level(&rig, 0);
    event(&rig, MACHINE_TOGGLE_KEY, 0);
    record(&rig, MACHINE_TOGGLE);
    frames(&rig, 40);
    record(&rig, MACHINE_EXPOSURE);
    event(&rig, MACHINE_CHOOSE, PLAN_SLOT_B);
    record(&rig, MACHINE_EXPOSURE);
    assert_int_equal(record(&rig, MACHINE_CHOICE).toggles, 2); // ignored ones do not count
    rig_free(&rig);
}

static void test_a_decision_from_key_to_next_trial(void **state)
{
    (void)state;
    struct rig rig = rig_of(TWO, NULL);
    start_toggle_trial(&rig);
    frames(&rig, 10);
    int64_t first_full = rig.now;
    event(&rig, MACHINE_CHOOSE, PLAN_SLOT_A);
    assert_int_equal(record(&rig, MACHINE_CHOICE_EARLY).slot, PLAN_SLOT_A);
    screen(&rig, MACHINE_STIMULUS);
    event(&rig, MACHINE_TOGGLE_KEY, 0);
    frames(&rig, 39); // the other has been seen, but not fully
    event(&rig, MACHINE_CHOOSE, PLAN_SLOT_A);
    drain(&rig);
    screen(&rig, MACHINE_STIMULUS);
    frames(&rig, 1);
    event(&rig, MACHINE_CHOOSE, 2);
    event(&rig, MACHINE_RATE, 5);
    event(&rig, MACHINE_START, 0);
    no_record(&rig);
    event_at(&rig, first_full + 600 * MS + 1, MACHINE_CHOOSE, PLAN_SLOT_B);
    record(&rig, MACHINE_EXPOSURE);
    struct machine_record choice = record(&rig, MACHINE_CHOICE);
    assert_int_equal(choice.slot, PLAN_SLOT_B);
    assert_int_equal(choice.reaction_ns, 600 * MS + 1);
    assert_int_equal(choice.toggles, 1);
    assert_int_equal(choice.trial, 1);
    assert_int_equal(record(&rig, MACHINE_TRIAL_DONE).trial, 1);
    no_record(&rig);

    screen(&rig, MACHINE_STORING); // however long the store takes, and whatever is pressed
    event(&rig, MACHINE_PAUSE, 0);
    event(&rig, MACHINE_ABORT_KEY, 0);
    event(&rig, MACHINE_CHOOSE, PLAN_SLOT_A);
    frames(&rig, 500);
    screen(&rig, MACHINE_STORING);
    assert_int_equal(rig.view.done, 1);
    no_record(&rig);
    event(&rig, MACHINE_ANSWER_STORED, 0);
    screen(&rig, MACHINE_CONFIRMATION);
    assert_int_equal(rig.view.last_value, PLAN_SLOT_B);
    assert_int_equal(rig.view.done, 2);
    int64_t stored = rig.now;
    event_at(&rig, stored + 100 * MS, MACHINE_PAUSE, 0);
    event_at(&rig, stored + 900 * MS, MACHINE_PAUSE, 0);
    drain(&rig);
    frame_at(&rig, stored + 1300 * MS - 1);
    screen(&rig, MACHINE_CONFIRMATION);
    frame_at(&rig, stored + 1300 * MS);
    screen(&rig, MACHINE_REST);
    assert_int_equal(rig.view.trial_index, 2);
    assert_true(rig.view.may_choose);
    event(&rig, MACHINE_START, 0);
    frames(&rig, 1);
    assert_int_equal(record(&rig, MACHINE_TRIAL_STARTED).trial, 2);
    rig_free(&rig);
}

// Frames of every length from 1 to 120 ms: the half second holds to within the frame that ends it, and the
// options never meet without gray.
static void test_fades_with_odd_frame_times(void **state)
{
    (void)state;
    struct rig rig = rig_of(TWO, NULL);
    start_toggle_trial(&rig);
    uint32_t random = 7;
    int64_t full_end = -1, longest = 0;
    enum plan_slot last = rig.view.slot;
    bool gray = true;
    uint32_t toggles = 0, checked = 0;
    for (int i = 0; i < 60000; i++) {
        random = random * 1664525u + 1013904223u;
        int64_t length = 1 * MS + (int64_t)(random >> 8) % (119 * MS);
        if (rig.view.fade <= 0 && random % 3 == 0) {
            event_at(&rig, rig.now + length / 3, MACHINE_TOGGLE_KEY, 0);
            toggles++;
            frame_at(&rig, rig.now + length - length / 3);
        } else {
            frame_at(&rig, rig.now + length);
        }
        longest = rig.view.fade > 0 ? length : longest;
        gray = gray || rig.view.fade >= 1;
        if (rig.view.fade < 1 && rig.view.slot != last) {
            assert_true(gray);
            last = rig.view.slot;
            gray = false;
        }
        struct machine_record each;
        while (machine_next_record(rig.machine, &each)) {
            if (each.kind != MACHINE_EXPOSURE)
                continue;
            if (full_end >= 0 && each.full_start_ns >= 0) {
                int64_t gap = each.full_start_ns - full_end;
                assert_true(gap >= 500 * MS && gap < 620 * MS);
                checked++;
            }
            full_end = each.full_end_ns;
        }
    }
    assert_true(toggles > 1000 && checked > toggles - 5);
    rig_free(&rig);
}

static void test_a_stall_does_not_skip_the_gray(void **state)
{
    (void)state;
    struct rig rig = rig_of(TWO, NULL);
    start_toggle_trial(&rig);
    frames(&rig, 12);
    enum plan_slot before = rig.view.slot;
    event_at(&rig, rig.now + 1, MACHINE_TOGGLE_KEY, 0);
    frame_at(&rig, rig.now + 3000 * MS);
    level(&rig, 1);
    assert_int_not_equal(rig.view.slot, before);
    frames(&rig, 9);
    level(&rig, 0.1);
    frames(&rig, 1);
    level(&rig, 0);
    rig_free(&rig);
}

static void test_a_clock_that_stands_or_goes_back(void **state)
{
    (void)state;
    struct rig rig = rig_of(TWO, NULL);
    start_toggle_trial(&rig);
    for (int i = 0; i < 50; i++)
        frame_at(&rig, rig.now); // stands
    level(&rig, 1);
    no_record(&rig);
    int64_t latest = rig.now;
    frame_at(&rig, latest - 5);
    assert_int_equal(record(&rig, MACHINE_CLOCK_BACK).value_ns, 5);
    frame_at(&rig, latest - 4);
    no_record(&rig); // told once
    level(&rig, 1);
    frame_at(&rig, latest + 125 * MS);
    level(&rig, 0);
    rig.now = latest + 125 * MS;
    frame_at(&rig, latest);
    record(&rig, MACHINE_CLOCK_BACK);
    level(&rig, 0);
    rig_free(&rig);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_fade_frame_by_frame),
        cmocka_unit_test(test_toggles_at_the_edges_of_a_fade),
        cmocka_unit_test(test_a_decision_from_key_to_next_trial),
        cmocka_unit_test(test_fades_with_odd_frame_times),
        cmocka_unit_test(test_a_stall_does_not_skip_the_gray),
        cmocka_unit_test(test_a_clock_that_stands_or_goes_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
