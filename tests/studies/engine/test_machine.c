// The session driven by scripted events and frames, with exact times.
#include "studies/engine/machine.h"

#include "tests/studies/engine/sample_design.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

#define MS INT64_C(1000000)
#define FRAME (MS * 25 / 2) // 12.5 ms: ten frames are one fade

struct rig {
    struct protocol *protocol;
    struct plan *plan;
    struct machine *machine;
    struct machine_view view;
    int64_t now;
};

static struct rig rig_of(const char *design, const struct machine_start *start)
{
    char error[PROTOCOL_ERROR] = "";
    struct rig rig = {.protocol = sample_design("[atrium]", design, error, sizeof error)};
    assert_string_equal(error, "");
    rig.plan = plan_create(rig.protocol, 1, 0);
    rig.machine = machine_create(rig.plan, start);
    assert_non_null(rig.machine);
    return rig;
}

static void rig_free(struct rig *rig)
{
    machine_destroy(rig->machine);
    plan_destroy(rig->plan);
    protocol_destroy(rig->protocol);
}

static void event_at(struct rig *rig, int64_t at, enum machine_event_kind kind, int32_t value)
{
    machine_event(rig->machine, at, &(struct machine_event){kind, value});
    rig->now = at;
    machine_look(rig->machine, &rig->view);
}

static void event(struct rig *rig, enum machine_event_kind kind, int32_t value)
{
    event_at(rig, rig->now, kind, value);
}

static void frame_at(struct rig *rig, int64_t at)
{
    rig->now = at;
    machine_frame(rig->machine, at, &rig->view);
}

static void frames(struct rig *rig, int count)
{
    for (int i = 0; i < count; i++)
        frame_at(rig, rig->now + FRAME);
}

// The next record, which must be of this kind.
static struct machine_record record(struct rig *rig, enum machine_record_kind kind)
{
    struct machine_record record;
    assert_true(machine_next_record(rig->machine, &record));
    assert_string_equal(machine_record_name(record.kind), machine_record_name(kind));
    return record;
}

static void no_record(struct rig *rig)
{
    struct machine_record record;
    if (machine_next_record(rig->machine, &record))
        assert_string_equal(machine_record_name(record.kind), "no record");
}

static void drain(struct rig *rig)
{
    struct machine_record record;
    while (machine_next_record(rig->machine, &record))
        ;
}

static void screen(const struct rig *rig, enum machine_screen wanted)
{
    assert_string_equal(machine_screen_name(rig->view.screen), machine_screen_name(wanted));
}

static void level(const struct rig *rig, double wanted)
{
    assert_true(fabs(rig->view.fade - wanted) < 1e-12);
}

// To the first frame of the first trial, at a time that is no round number.
static void start_first_trial(struct rig *rig)
{
    event(rig, MACHINE_YES, 0);
    event(rig, MACHINE_START, 0);
    screen(rig, MACHINE_READY);
    event(rig, MACHINE_START, 0);
    screen(rig, MACHINE_STIMULUS);
    drain(rig);
    frame_at(rig, 123456789);
    assert_int_equal(record(rig, MACHINE_TRIAL_STARTED).at_ns, 123456789);
    no_record(rig);
}

// Through the rating before to the first frame of the first toggle trial.
static void start_toggle_trial(struct rig *rig)
{
    start_first_trial(rig);
    frames(rig, 20);
    event(rig, MACHINE_START, 0);
    event(rig, MACHINE_RATE, 5);
    event(rig, MACHINE_ANSWER_STORED, 0);
    frames(rig, 40);
    screen(rig, MACHINE_READY);
    event(rig, MACHINE_START, 0);
    drain(rig);
    frames(rig, 1);
    assert_int_equal(record(rig, MACHINE_TRIAL_STARTED).at_ns, rig->now);
    assert_true(rig->view.trial_started);
    level(rig, 1);
}

#define TWO "  factors: {epsilon: [0.2, 0.1]}\n"

static void test_nothing_before_consent(void **state)
{
    (void)state;
    struct rig rig = rig_of(TWO, NULL);
    for (int kind = 0; kind <= MACHINE_ANSWER_STORED; kind++)
        if (kind != MACHINE_YES && kind != MACHINE_NO && kind != MACHINE_ABORT_KEY)
            event(&rig, (enum machine_event_kind)kind, 1);
    frames(&rig, 1000);
    screen(&rig, MACHINE_CONSENT);
    assert_string_equal(rig.view.text, "c");
    no_record(&rig);
    event_at(&rig, rig.now + 7, MACHINE_YES, 0);
    assert_int_equal(record(&rig, MACHINE_CONSENT_GIVEN).at_ns, rig.now);
    screen(&rig, MACHINE_INSTRUCTIONS);
    assert_string_equal(rig.view.text, "i");
    rig_free(&rig);

    rig = rig_of(TWO, NULL);
    event(&rig, MACHINE_NO, 0);
    record(&rig, MACHINE_CONSENT_REFUSED);
    assert_false(record(&rig, MACHINE_ENDED).complete);
    screen(&rig, MACHINE_END);
    event(&rig, MACHINE_YES, 0);
    screen(&rig, MACHINE_END);
    no_record(&rig);
    rig_free(&rig);
}

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

static void test_pauses_are_taken_out(void **state)
{
    (void)state;
    struct rig rig = rig_of(TWO, NULL);
    start_toggle_trial(&rig);
    frames(&rig, 10);
    int64_t first_full = rig.now;
    event(&rig, MACHINE_TOGGLE_KEY, 0);
    drain(&rig);
    frames(&rig, 5); // in the fade, before the option changed
    enum plan_slot target = (enum plan_slot)(1 - (int)rig.view.slot);
    int64_t camera = rig.view.stimulus_ns;
    event(&rig, MACHINE_PAUSE, 0);
    record(&rig, MACHINE_EXPOSURE);
    assert_int_equal(record(&rig, MACHINE_PAUSE_BEGAN).trial, 1);
    screen(&rig, MACHINE_PAUSED);
    frame_at(&rig, rig.now + 3600000 * MS); // an hour
    assert_int_equal(rig.view.slot, PLAN_SLOT_NONE);
    event(&rig, MACHINE_TOGGLE_KEY, 0);
    no_record(&rig);
    event(&rig, MACHINE_PAUSE, 0);
    record(&rig, MACHINE_PAUSE_ENDED);
    frames(&rig, 1);
    level(&rig, 1);
    assert_int_equal(rig.view.slot, target); // the toggle that was under way is done
    assert_int_equal(rig.view.stimulus_ns, camera + FRAME);
    frames(&rig, 10);
    level(&rig, 0);
    event(&rig, MACHINE_CHOOSE, PLAN_SLOT_A);
    assert_int_equal(record(&rig, MACHINE_EXPOSURE).slot, target);
    assert_int_equal(record(&rig, MACHINE_CHOICE).reaction_ns, rig.now - first_full - 3600000 * MS);
    rig_free(&rig);
}

static void test_escape_asks_first(void **state)
{
    (void)state;
    struct rig rig = rig_of(TWO, NULL);
    start_toggle_trial(&rig);
    frames(&rig, 20);
    event(&rig, MACHINE_ABORT_KEY, 0);
    screen(&rig, MACHINE_ABORT);
    record(&rig, MACHINE_EXPOSURE);
    record(&rig, MACHINE_ABORT_ASKED);
    frames(&rig, 100);
    event(&rig, MACHINE_NO, 0);
    record(&rig, MACHINE_ABORT_DECLINED);
    screen(&rig, MACHINE_STIMULUS);
    frames(&rig, 11);
    level(&rig, 0);
    event(&rig, MACHINE_PAUSE, 0);
    event(&rig, MACHINE_ABORT_KEY, 0);
    screen(&rig, MACHINE_ABORT);
    event(&rig, MACHINE_ABORT_KEY, 0); // back to the pause
    screen(&rig, MACHINE_PAUSED);
    event(&rig, MACHINE_ABORT_KEY, 0);
    drain(&rig);
    event(&rig, MACHINE_YES, 0);
    assert_false(record(&rig, MACHINE_ENDED).complete);
    screen(&rig, MACHINE_END);
    assert_false(rig.view.complete);
    rig_free(&rig);
}

static void test_a_rating(void **state)
{
    (void)state;
    struct rig rig = rig_of(TWO, NULL);
    start_first_trial(&rig);
    frames(&rig, 9);
    event(&rig, MACHINE_START, 0); // nothing was seen yet
    event(&rig, MACHINE_TOGGLE_KEY, 0);
    event(&rig, MACHINE_CHOOSE, 0);
    screen(&rig, MACHINE_STIMULUS);
    no_record(&rig);
    frames(&rig, 1);
    int64_t first_full = rig.now;
    frames(&rig, 3);
    event(&rig, MACHINE_START, 0);
    assert_int_equal(record(&rig, MACHINE_EXPOSURE).full_end_ns, rig.now);
    screen(&rig, MACHINE_QUESTION);
    assert_string_equal(rig.view.text, "How?");
    event(&rig, MACHINE_RATE, 0);
    event(&rig, MACHINE_RATE, 11);
    event(&rig, MACHINE_CHOOSE, 0);
    screen(&rig, MACHINE_QUESTION);
    event(&rig, MACHINE_PAUSE, 0);
    frame_at(&rig, rig.now + 1000 * MS);
    event(&rig, MACHINE_START, 0);
    screen(&rig, MACHINE_QUESTION);
    event_at(&rig, rig.now + 1, MACHINE_RATE, 10);
    record(&rig, MACHINE_PAUSE_BEGAN);
    record(&rig, MACHINE_PAUSE_ENDED);
    struct machine_record rating = record(&rig, MACHINE_RATING);
    assert_int_equal(rating.value, 10);
    assert_int_equal(rating.reaction_ns, rig.now - first_full - 1000 * MS);
    record(&rig, MACHINE_TRIAL_DONE);
    screen(&rig, MACHINE_STORING);
    rig_free(&rig);
}

static void test_timed_viewing_and_rest(void **state)
{
    (void)state;
    const char text[] = "fovstudy: 1\nname: t\ntitle: t\nseed: 0\nscenes: [atrium]\nreference: r\n"
                        "options: {f: {mode: time_warped}, r: {mode: regular}}\nquestions: {z: {text: How?, "
                        "scale: [1, 7]}, q: {text: W}}\n"
                        "instructions: i\nconsent: {version: 1, text: c}\n"
                        "settings: {question: z, view_s: 0.2, rest_s: 0.3, confirm_s: 0, advance: auto, fade: "
                        "{from_gray_s: 0}}\n"
                        "blocks: [{name: a, kind: rate, options: [f]}, {name: b, kind: toggle, options: [f, "
                        "r], repetitions: 2, "
                        "instructions: now, settings: {question: q, fade: {to_gray_s: 0, gray_s: 0}}}]\n";
    char error[PROTOCOL_ERROR] = "";
    struct rig rig = {.protocol =
                          protocol_parse("t", text, strlen(text), sample_catalogue(), error, sizeof error)};
    assert_string_equal(error, "");
    rig.plan = plan_create(rig.protocol, 1, 0);
    rig.machine = machine_create(rig.plan, &(struct machine_start){.consented = true});
    machine_look(rig.machine, &rig.view);
    screen(&rig, MACHINE_INSTRUCTIONS);
    event_at(&rig, 0, MACHINE_START, 0);
    event(&rig, MACHINE_START, 0);
    frame_at(&rig, 1000);
    level(&rig, 0); // no fade in
    event(&rig, MACHINE_START, 0);
    screen(&rig, MACHINE_STIMULUS); // viewing time is fixed
    frame_at(&rig, 1000 + 200 * MS - 1);
    screen(&rig, MACHINE_STIMULUS);
    frame_at(&rig, 1000 + 200 * MS);
    screen(&rig, MACHINE_QUESTION);
    event(&rig, MACHINE_RATE, 7);
    event(&rig, MACHINE_ANSWER_STORED, 0);
    frames(&rig, 1);
    screen(&rig, MACHINE_INSTRUCTIONS); // the next block's
    assert_string_equal(rig.view.text, "now");
    event(&rig, MACHINE_START, 0);
    frames(&rig, 1);
    level(&rig, 0);
    event(&rig, MACHINE_TOGGLE_KEY, 0);
    frames(&rig, 1);
    level(&rig, 0); // without any fade the options change at once
    event(&rig, MACHINE_CHOOSE, 0);
    event(&rig, MACHINE_ANSWER_STORED, 0);
    int64_t stored = rig.now;
    frame_at(&rig, stored + 300 * MS - 1);
    screen(&rig, MACHINE_REST);
    assert_false(rig.view.may_choose);
    event(&rig, MACHINE_START, 0);
    screen(&rig, MACHINE_REST);
    frame_at(&rig, stored + 300 * MS);
    screen(&rig, MACHINE_STIMULUS);
    rig_free(&rig);
}

// To the end, the store answering late; and again from the middle.
static void test_a_whole_session_and_its_continuation(void **state)
{
    (void)state;
    struct rig rig = rig_of(SAMPLE_NINE, NULL);
    uint32_t answers = 0, ended = 0;
    for (int i = 0; i < 20000 && !ended; i++) {
        frames(&rig, 1);
        struct machine_record each;
        while (machine_next_record(rig.machine, &each)) {
            assert_true(each.kind != MACHINE_TRIAL_STARTED || each.trial == answers);
            answers += each.kind == MACHINE_CHOICE || each.kind == MACHINE_RATING;
            ended += each.kind == MACHINE_ENDED;
        }
        event(&rig, MACHINE_YES, 0);
        event(&rig, MACHINE_START, 0);
        if (i % 50 == 0)
            event(&rig, MACHINE_TOGGLE_KEY, 0);
        if (i % 200 == 199)
            event(&rig, MACHINE_CHOOSE, PLAN_SLOT_A);
        event(&rig, MACHINE_RATE, 6);
        if (i % 20 == 0)
            event(&rig, MACHINE_ANSWER_STORED, 0);
    }
    assert_int_equal(answers, 11);
    screen(&rig, MACHINE_END);
    assert_true(rig.view.complete);
    rig_free(&rig);

    bool done[11] = {true, true, false, true};
    uint32_t attempts[11] = {1, 1, 2, 1};
    rig = rig_of(SAMPLE_NINE, &(struct machine_start){true, done, attempts});
    event(&rig, MACHINE_START, 0);
    event(&rig, MACHINE_START, 0);
    frames(&rig, 1);
    struct machine_record started = record(&rig, MACHINE_TRIAL_STARTED);
    assert_int_equal(started.trial, 2);
    assert_int_equal(started.attempt, 3);
    rig_free(&rig);

    for (int i = 0; i < 11; i++)
        done[i] = true;
    rig = rig_of(SAMPLE_NINE, &(struct machine_start){true, done, NULL});
    event(&rig, MACHINE_START, 0);
    assert_true(record(&rig, MACHINE_ENDED).complete);
    rig_free(&rig);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_nothing_before_consent),
        cmocka_unit_test(test_a_fade_frame_by_frame),
        cmocka_unit_test(test_toggles_at_the_edges_of_a_fade),
        cmocka_unit_test(test_a_decision_from_key_to_next_trial),
        cmocka_unit_test(test_fades_with_odd_frame_times),
        cmocka_unit_test(test_a_stall_does_not_skip_the_gray),
        cmocka_unit_test(test_a_clock_that_stands_or_goes_back),
        cmocka_unit_test(test_pauses_are_taken_out),
        cmocka_unit_test(test_escape_asks_first),
        cmocka_unit_test(test_a_rating),
        cmocka_unit_test(test_timed_viewing_and_rest),
        cmocka_unit_test(test_a_whole_session_and_its_continuation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
