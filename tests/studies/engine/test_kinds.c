// Every kind of trial through the machine, event by event: what is shown, asked and recorded.
#include "tests/studies/engine/machine_rig.h"

// A study of the one block given, without ratings around it.
static struct rig alone(const char *block, const struct machine_start *start)
{
    char text[4096], error[PROTOCOL_ERROR] = "";
    snprintf(text, sizeof text,
             "fovstudy: 1\nname: sample\ntitle: t\nseed: 0\nscenes: [atrium]\n"
             "options: {f: {mode: time_warped, epsilon: 0.1}, r: {mode: regular}}\nreference: r\n"
             "questions:\n  q: {text: Which?}\n  o: {text: Original?, correct: reference}\n"
             "  e: {text: Better?, equal: yes}\n  z: {text: How?, scale: [1, 10]}\n"
             "  y: {text: Sure?, scale: [-3, 3]}\n  n: {text: How many?, count: [0, 20]}\n"
             "instructions: i\nconsent: {version: 1, text: c}\nblocks:\n- name: main\n%s",
             block);
    struct rig rig = {.protocol =
                          protocol_parse("k", text, strlen(text), sample_catalogue(), error, sizeof error)};
    assert_string_equal(error, "");
    rig.plan = plan_create(rig.protocol, 1, 0);
    rig.machine = machine_create(rig.plan, start);
    assert_non_null(rig.machine);
    if (!start)
        event(&rig, MACHINE_YES, 0);
    event(&rig, MACHINE_START, 0);
    screen(&rig, MACHINE_READY);
    drain(&rig);
    return rig;
}

static void begin(struct rig *rig)
{
    event(rig, MACHINE_START, 0);
    frames(rig, 1);
    record(rig, MACHINE_TRIAL_STARTED);
}

static void stored(struct rig *rig)
{
    screen(rig, MACHINE_STORING);
    event(rig, MACHINE_ANSWER_STORED, 0);
}

// Until the other option is there in full.
static void toggle(struct rig *rig)
{
    event(rig, MACHINE_TOGGLE_KEY, 0);
    record(rig, MACHINE_TOGGLE);
    frames(rig, 40);
    record(rig, MACHINE_EXPOSURE);
}

static void test_ratings_after_a_choice(void **state)
{
    (void)state;
    struct rig rig =
        alone("  kind: toggle\n  options: [f, r]\n  settings: {question: q, ratings: [z, y]}\n", NULL);
    begin(&rig);
    frames(&rig, 10);
    toggle(&rig);
    event(&rig, MACHINE_CHOOSE, PLAN_SLOT_B);
    record(&rig, MACHINE_EXPOSURE);
    assert_false(record(&rig, MACHINE_CHOICE).ends_trial);
    no_record(&rig);
    stored(&rig);
    const int32_t values[4] = {7, 4, -2, 3};
    for (int i = 0; i < 4; i++) {
        screen(&rig, MACHINE_QUESTION);
        assert_int_equal(rig.view.subject, i % 2);
        assert_string_equal(rig.view.text, i < 2 ? "How?" : "Sure?");
        assert_int_equal(rig.view.done, 0);
        event(&rig, MACHINE_CHOOSE, PLAN_SLOT_A); // not asked
        event(&rig, MACHINE_RATE, values[i]);
        struct machine_record rating = record(&rig, MACHINE_RATING);
        assert_int_equal(rating.value, values[i]);
        assert_int_equal(rating.slot, i % 2);
        assert_string_equal(rating.question->name, i < 2 ? "z" : "y");
        assert_int_equal(rating.ends_trial, i == 3);
        if (i == 3)
            record(&rig, MACHINE_TRIAL_DONE);
        no_record(&rig);
        stored(&rig);
    }
    screen(&rig, MACHINE_CONFIRMATION);
    assert_int_equal(rig.view.done, 1);
    rig_free(&rig);
}

// What is answered stays answered: the trial is seen again, and the questions go on where they stopped.
static void test_questions_go_on_after_a_resume(void **state)
{
    (void)state;
    const uint32_t answers[1] = {2}, attempts[1] = {1};
    struct rig rig =
        alone("  kind: toggle\n  options: [f, r]\n  settings: {question: q, ratings: z}\n",
              &(struct machine_start){.consented = true, .answers = answers, .attempts = attempts});
    begin(&rig);
    assert_int_equal(rig.view.attempt, 2);
    frames(&rig, 10);
    assert_null(rig.view.question);
    event(&rig, MACHINE_CHOOSE, PLAN_SLOT_A);
    no_record(&rig);
    event(&rig, MACHINE_START, 0); // both must be seen first
    screen(&rig, MACHINE_STIMULUS);
    toggle(&rig);
    assert_true(rig.view.may_go_on);
    event(&rig, MACHINE_START, 0);
    record(&rig, MACHINE_EXPOSURE);
    screen(&rig, MACHINE_QUESTION);
    assert_int_equal(rig.view.subject, PLAN_SLOT_B);
    event(&rig, MACHINE_RATE, 2);
    assert_true(record(&rig, MACHINE_RATING).ends_trial);
    rig_free(&rig);
}

static void test_one_after_the_other(void **state)
{
    (void)state;
    struct rig rig = alone("  kind: sequential\n  options: [f, r]\n"
                           "  settings: {question: e, view_s: 2, gap_s: 1, spheres: [2, 5], count: n}\n",
                           NULL);
    begin(&rig);
    for (uint32_t showing = 0; showing < 2; showing++) {
        if (showing == 1)
            frames(&rig, 1); // the gap's last frame; the second showing begins with this one
        assert_int_equal(rig.view.slot, showing);
        assert_int_equal(rig.view.showing, showing);
        assert_true(rig.view.trial_started);
        assert_int_equal(rig.view.stimulus_ns, 0);
        level(&rig, 1);
        frames(&rig, 10);
        level(&rig, 0);
        event(&rig, MACHINE_TOGGLE_KEY, 0);
        event(&rig, MACHINE_CHOOSE, PLAN_SLOT_A);
        event(&rig, MACHINE_START, 0);
        frames(&rig, 160); // 2 s from the first full frame
        level(&rig, 0);
        frames(&rig, 5);
        level(&rig, 0.5);
        if (showing == 0) {
            frames(&rig, 5);
            level(&rig, 1);
            assert_true(rig.view.marker);
            assert_int_equal(rig.view.slot, PLAN_SLOT_NONE);
            struct machine_record exposure = record(&rig, MACHINE_EXPOSURE);
            assert_int_equal(exposure.slot, PLAN_SLOT_A);
            assert_int_equal(exposure.full_end_ns - exposure.full_start_ns, 2000 * MS);
            frames(&rig, 79);
            assert_true(rig.view.marker);
        }
    }
    no_record(&rig);
    frames(&rig, 6);
    record(&rig, MACHINE_EXPOSURE);
    screen(&rig, MACHINE_QUESTION);
    assert_string_equal(rig.view.text, "Better?");
    event_at(&rig, rig.now + 700 * MS, MACHINE_CHOOSE, PLAN_SLOT_NONE);
    struct machine_record choice = record(&rig, MACHINE_CHOICE);
    assert_int_equal(choice.slot, PLAN_SLOT_NONE);
    assert_int_equal(choice.correct, -1);
    assert_true(choice.reaction_ns >= 700 * MS && choice.reaction_ns <= 700 * MS + FRAME);
    stored(&rig);
    assert_string_equal(rig.view.text, "How many?");
    event(&rig, MACHINE_RATE, 6);
    struct machine_record count = record(&rig, MACHINE_RESPONSES);
    assert_int_equal(count.value, 6);
    assert_int_equal(count.expected, rig.plan->trials[0].spheres[0] + rig.plan->trials[0].spheres[1]);
    assert_true(count.expected >= 4 && count.expected <= 10 && count.ends_trial);
    rig_free(&rig);
}

static void test_several_questions_of_one_option(void **state)
{
    (void)state;
    struct rig rig = alone("  kind: rate\n  options: [f]\n  settings: {question: [z, y], view_s: 8}\n", NULL);
    begin(&rig);
    frames(&rig, 10);
    event(&rig, MACHINE_START, 0); // timed: nothing ends it early
    frames(&rig, 639);
    screen(&rig, MACHINE_STIMULUS);
    frames(&rig, 1);
    screen(&rig, MACHINE_QUESTION);
    record(&rig, MACHINE_EXPOSURE);
    event(&rig, MACHINE_RATE, 3);
    struct machine_record first = record(&rig, MACHINE_RATING);
    assert_int_equal(first.slot, PLAN_SLOT_NONE);
    assert_false(first.ends_trial);
    stored(&rig);
    event(&rig, MACHINE_RATE, 4); // beyond the second scale
    event(&rig, MACHINE_RATE, -3);
    assert_true(record(&rig, MACHINE_RATING).ends_trial);
    rig_free(&rig);
}

static void test_adjusting(void **state)
{
    (void)state;
    struct rig rig =
        alone("  kind: adjust\n  options: [f, r]\n"
              "  adjust: {epsilon: {start: [0.2, 0.4], step: 0.05, max: 0.5}, fovea_deg: {start: [8, 8], "
              "step: 1}}\n",
              NULL);
    begin(&rig);
    frames(&rig, 10);
    double start = rig.view.adjusted[0];
    assert_true(start >= 0.2 && start <= 0.4 + 1e-12);
    event(&rig, MACHINE_ADJUST, 1);
    struct machine_record step = record(&rig, MACHINE_ADJUSTED);
    assert_true(step.parameter == 0 && fabs(step.numbers[0] - start - 0.05) < 1e-12);
    for (int i = 0; i < 9; i++)
        event(&rig, MACHINE_ADJUST, 1);
    drain(&rig);
    assert_true(rig.view.adjusted[0] <= 0.5 && rig.view.adjusted[0] > 0.5 - 1e-12); // its end
    event(&rig, MACHINE_ADJUST_NEXT, 1);
    event(&rig, MACHINE_ADJUST, -1);
    assert_int_equal(record(&rig, MACHINE_ADJUSTED).parameter, 1);
    event(&rig, MACHINE_START, 0); // the other was not seen
    screen(&rig, MACHINE_STIMULUS);
    toggle(&rig);
    event(&rig, MACHINE_START, 0);
    record(&rig, MACHINE_EXPOSURE);
    struct machine_record values = record(&rig, MACHINE_RESPONSES);
    assert_true(values.number_count == 2 && values.numbers[1] == 7 && values.ends_trial);
    rig_free(&rig);
}

#define STAIRS                                                                                                 \
    "  kind: staircase\n  options: [f, r]\n  settings: {question: o}\n"                                        \
    "  staircase: {parameter: epsilon, method: 1up2down, larger: easier, level: {min: 0.1, max: 1}, start: "   \
    "0.5, "                                                                                                    \
    "steps: [0.1], trials: 6, reversals: 3}\n"

// One answer, right or wrong; the level of the trial, which is known while it is to come.
static double climb(struct rig *rig, bool right)
{
    machine_look(rig->machine, &rig->view);
    const bool coming = rig->view.screen == MACHINE_READY || rig->view.screen == MACHINE_REST;
    const double announced = rig->view.level;
    begin(rig);
    double shown = rig->view.level;
    assert_true(!coming || announced == shown);
    frames(rig, 10);
    toggle(rig);
    enum plan_slot tested = rig->view.trial->test_slot;
    event(rig, MACHINE_CHOOSE, right ? 1 - (int)tested : (int)tested);
    record(rig, MACHINE_EXPOSURE);
    struct machine_record choice = record(rig, MACHINE_CHOICE);
    assert_int_equal(choice.correct, right);
    assert_true(choice.has_step && choice.step.level == shown && choice.step.outcome == (uint32_t)right);
    record(rig, MACHINE_TRIAL_DONE);
    stored(rig);
    frames(rig, 41);
    return shown;
}

static void test_a_staircase(void **state)
{
    (void)state;
    struct rig rig = alone(STAIRS, NULL);
    assert_true(climb(&rig, true) == 0.5);
    assert_true(climb(&rig, true) == 0.5);
    assert_true(climb(&rig, false) == 0.4); // a reversal
    double level = climb(&rig, true);
    assert_true(level == 0.5);
    assert_true(climb(&rig, true) == level); // the second
    assert_true(fabs(climb(&rig, false) - 0.4) < 1e-12);
    screen(&rig, MACHINE_END);
    rig_free(&rig);

    // The same outcomes from the store lead to the same level; an ended one leaves its trials out.
    const int32_t outcomes[6] = {1, 1, 0, -1, -1, -1};
    const bool done[6] = {true, true, true, false, false, false};
    rig = alone(STAIRS, &(struct machine_start){.consented = true, .done = done, .outcomes = outcomes});
    assert_true(climb(&rig, false) == 0.5);
    assert_true(fabs(climb(&rig, true) - 0.6) < 1e-12);
    rig_free(&rig);
}

static void test_an_ended_staircase_leaves_its_trials_out(void **state)
{
    (void)state;
    struct rig rig =
        alone("  kind: staircase\n  options: [f, r]\n  settings: {question: o}\n"
              "  staircase: {parameter: epsilon, method: 1up2down, larger: easier, level: {min: 0.1, max: "
              "1}, start: 0.5, steps: [0.1], trials: 9, reversals: 2}\n",
              NULL);
    climb(&rig, false);
    climb(&rig, true);
    climb(&rig, true);  // down again: the first reversal
    climb(&rig, false); // the second
    for (int i = 4; i < 9; i++)
        assert_int_equal(record(&rig, MACHINE_TRIAL_SKIPPED).trial, i);
    assert_true(record(&rig, MACHINE_ENDED).complete);
    rig_free(&rig);
}

static void test_a_flag_and_a_deadline_bring_the_trial_again(void **state)
{
    (void)state;
    struct rig rig =
        alone("  kind: toggle\n  options: [f, r]\n  order: fixed\n  factors: {epsilon: [0.2, 0.1]}\n"
              "  settings: {question: q, deadline_s: 3, rest_s: 0, advance: key}\n",
              NULL);
    begin(&rig);
    frames(&rig, 11);
    event(&rig, MACHINE_FLAG, 0);
    record(&rig, MACHINE_EXPOSURE);
    struct machine_record bad = record(&rig, MACHINE_TRIAL_INVALID);
    assert_true(bad.trial == 0 && !bad.late && bad.again == 2);
    screen(&rig, MACHINE_REST);
    assert_int_equal(rig.view.trial_index, 1);
    begin(&rig);
    frames(&rig, 10 + 240); // three seconds from the first full frame
    screen(&rig, MACHINE_STIMULUS);
    frames(&rig, 1);
    screen(&rig, MACHINE_REST);
    record(&rig, MACHINE_EXPOSURE);
    bad = record(&rig, MACHINE_TRIAL_INVALID);
    assert_true(bad.late && bad.trial == 1 && bad.again == 3);
    assert_int_equal(rig.view.total, 4);
    assert_ptr_equal(rig.view.trial, &rig.plan->trials[0]);
    begin(&rig);
    frames(&rig, 10);
    toggle(&rig);
    event(&rig, MACHINE_CHOOSE, PLAN_SLOT_A);
    record(&rig, MACHINE_EXPOSURE);
    assert_int_equal(record(&rig, MACHINE_CHOICE).trial, 2);
    record(&rig, MACHINE_TRIAL_DONE);
    stored(&rig);
    event(&rig, MACHINE_FLAG, 0); // after the answer: the answer stays, the trial is bad
    bad = record(&rig, MACHINE_TRIAL_INVALID);
    assert_true(bad.trial == 2 && bad.again == 4);
    event(&rig, MACHINE_FLAG, 0); // once
    no_record(&rig);
    rig_free(&rig);
}

static void test_least_exposure(void **state)
{
    (void)state;
    struct rig rig =
        alone("  kind: toggle\n  options: [f, r]\n  settings: {question: q, min_exposure_s: 1}\n", NULL);
    begin(&rig);
    frames(&rig, 10 + 80);
    toggle(&rig);
    frames(&rig, 79);
    assert_false(rig.view.may_choose);
    event(&rig, MACHINE_CHOOSE, PLAN_SLOT_A);
    record(&rig, MACHINE_CHOICE_EARLY);
    frames(&rig, 1);
    assert_true(rig.view.may_choose);
    event(&rig, MACHINE_CHOOSE, PLAN_SLOT_A);
    record(&rig, MACHINE_EXPOSURE);
    record(&rig, MACHINE_CHOICE);
    rig_free(&rig);
}

static void test_breaks_catch_and_null(void **state)
{
    (void)state;
    struct rig rig = alone("  kind: toggle\n  options: [f, r]\n  factors: {epsilon: [0.2, 0.1]}\n  null: 1\n"
                           "  catch: {count: 1, option: f, parameters: {f: {epsilon: 1}}}\n  break_every: 2\n"
                           "  break_s: 10\n  settings: {question: q, rest_s: 0}\n",
                           NULL);
    for (int i = 0; i < 4; i++) {
        if (i == 2) {
            screen(&rig, MACHINE_BREAK);
            event(&rig, MACHINE_START, 0);
            screen(&rig, MACHINE_BREAK);
            assert_true(rig.view.wait_ns > 9000 * MS);
            frame_at(&rig, rig.now + 10000 * MS);
        }
        begin(&rig);
        const struct plan_trial *trial = rig.view.trial;
        frames(&rig, 10);
        toggle(&rig);
        event(&rig, MACHINE_CHOOSE, 1 - (int)trial->test_slot);
        record(&rig, MACHINE_EXPOSURE);
        struct machine_record choice = record(&rig, MACHINE_CHOICE);
        assert_int_equal(choice.correct, trial->role == PROTOCOL_CATCH ? 1 : -1);
        if (trial->role == PROTOCOL_NULL)
            assert_int_equal(trial->option[0], trial->option[1]);
        record(&rig, MACHINE_TRIAL_DONE);
        stored(&rig);
        frames(&rig, 41);
    }
    assert_true(record(&rig, MACHINE_ENDED).complete);
    rig_free(&rig);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ratings_after_a_choice),
        cmocka_unit_test(test_questions_go_on_after_a_resume),
        cmocka_unit_test(test_one_after_the_other),
        cmocka_unit_test(test_several_questions_of_one_option),
        cmocka_unit_test(test_adjusting),
        cmocka_unit_test(test_a_staircase),
        cmocka_unit_test(test_an_ended_staircase_leaves_its_trials_out),
        cmocka_unit_test(test_a_flag_and_a_deadline_bring_the_trial_again),
        cmocka_unit_test(test_least_exposure),
        cmocka_unit_test(test_breaks_catch_and_null),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
