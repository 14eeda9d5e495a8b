// The screens around the trials: consent, ratings, rest, pauses, the abort question, the end, a continuation.
#include "tests/studies/engine/machine_rig.h"

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
    assert_int_equal(rating.reaction_ns, 1); // from the question on, without the pause
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
    rig = rig_of(SAMPLE_NINE, &(struct machine_start){.consented = true, .done = done, .attempts = attempts});
    event(&rig, MACHINE_START, 0);
    event(&rig, MACHINE_START, 0);
    frames(&rig, 1);
    struct machine_record started = record(&rig, MACHINE_TRIAL_STARTED);
    assert_int_equal(started.trial, 2);
    assert_int_equal(started.attempt, 3);
    rig_free(&rig);

    for (int i = 0; i < 11; i++)
        done[i] = true;
    rig = rig_of(SAMPLE_NINE, &(struct machine_start){.consented = true, .done = done});
    event(&rig, MACHINE_START, 0);
    assert_true(record(&rig, MACHINE_ENDED).complete);
    rig_free(&rig);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_nothing_before_consent),
        cmocka_unit_test(test_pauses_are_taken_out),
        cmocka_unit_test(test_escape_asks_first),
        cmocka_unit_test(test_a_rating),
        cmocka_unit_test(test_timed_viewing_and_rest),
        cmocka_unit_test(test_a_whole_session_and_its_continuation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
