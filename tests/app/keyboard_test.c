// Which key means what on which screen.
#include "app/response/keyboard.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static const struct plan_trial toggle_trial = {.kind = PROTOCOL_TOGGLE}, rate_trial = {.kind = PROTOCOL_RATE};
static const struct plan_trial adjust_trial = {.kind = PROTOCOL_ADJUST},
                               pair_trial = {.kind = PROTOCOL_SEQUENTIAL};
static const struct protocol_question prefer = {.type = PROTOCOL_ASK_CHOICE};
static const struct protocol_question compare = {.type = PROTOCOL_ASK_CHOICE, .equal = true};
static const struct protocol_question ten = {.type = PROTOCOL_ASK_RATING, .scale_min = 1, .scale_max = 10};
static const struct protocol_question seven = {.type = PROTOCOL_ASK_RATING, .scale_min = -3, .scale_max = 3};

// What one key gives on a screen, with a keyboard of its own.
static void expect(enum machine_screen screen, const struct plan_trial *trial, int key, bool last_page,
                   enum keyboard_meaning meaning, enum machine_event_kind kind, int32_t value)
{
    struct keyboard keyboard = {0};
    static const double adjusted[PROTOCOL_ADJUSTED];
    struct machine_view view = {.screen = screen, .trial = trial};
    view.may_go_on = trial == &rate_trial || trial == &adjust_trial;
    view.adjusted = trial == &adjust_trial ? adjusted : NULL;
    view.question = trial == &pair_trial         ? &compare
                    : screen == MACHINE_QUESTION ? &ten
                    : trial == &toggle_trial     ? &prefer
                                                 : NULL;
    struct machine_event event = {.kind = MACHINE_ANSWER_STORED, .value = -99};
    assert_int_equal(keyboard_press(&keyboard, &view, last_page, key, &event), meaning);
    if (meaning == KEYBOARD_EVENT) {
        assert_int_equal(event.kind, kind);
        assert_int_equal(event.value, value);
    }
}

static void stimulus_keys(void **state)
{
    (void)state;
    expect(MACHINE_STIMULUS, &toggle_trial, GLFW_KEY_SPACE, true, KEYBOARD_EVENT, MACHINE_TOGGLE_KEY, 0);
    expect(MACHINE_STIMULUS, &toggle_trial, GLFW_KEY_LEFT, true, KEYBOARD_EVENT, MACHINE_CHOOSE, PLAN_SLOT_A);
    expect(MACHINE_STIMULUS, &toggle_trial, GLFW_KEY_1, true, KEYBOARD_EVENT, MACHINE_CHOOSE, PLAN_SLOT_A);
    expect(MACHINE_STIMULUS, &toggle_trial, GLFW_KEY_RIGHT, true, KEYBOARD_EVENT, MACHINE_CHOOSE, PLAN_SLOT_B);
    expect(MACHINE_STIMULUS, &toggle_trial, GLFW_KEY_KP_2, true, KEYBOARD_EVENT, MACHINE_CHOOSE, PLAN_SLOT_B);
    expect(MACHINE_STIMULUS, &toggle_trial, GLFW_KEY_ENTER, true, KEYBOARD_NOTHING, 0, 0);
    expect(MACHINE_STIMULUS, &toggle_trial, GLFW_KEY_3, true, KEYBOARD_NOTHING, 0, 0);
    expect(MACHINE_STIMULUS, &rate_trial, GLFW_KEY_ENTER, true, KEYBOARD_EVENT, MACHINE_START, 0);
    expect(MACHINE_STIMULUS, &rate_trial, GLFW_KEY_SPACE, true, KEYBOARD_NOTHING, 0, 0);
    expect(MACHINE_STIMULUS, &rate_trial, GLFW_KEY_1, true, KEYBOARD_NOTHING, 0, 0);
}

static void keys_of_other_trials(void **state)
{
    (void)state;
    expect(MACHINE_STIMULUS, &adjust_trial, GLFW_KEY_SPACE, true, KEYBOARD_EVENT, MACHINE_TOGGLE_KEY, 0);
    expect(MACHINE_STIMULUS, &adjust_trial, GLFW_KEY_UP, true, KEYBOARD_EVENT, MACHINE_ADJUST, 1);
    expect(MACHINE_STIMULUS, &adjust_trial, GLFW_KEY_DOWN, true, KEYBOARD_EVENT, MACHINE_ADJUST, -1);
    expect(MACHINE_STIMULUS, &adjust_trial, GLFW_KEY_TAB, true, KEYBOARD_EVENT, MACHINE_ADJUST_NEXT, 1);
    expect(MACHINE_STIMULUS, &adjust_trial, GLFW_KEY_ENTER, true, KEYBOARD_EVENT, MACHINE_START, 0);
    expect(MACHINE_STIMULUS, &adjust_trial, GLFW_KEY_1, true, KEYBOARD_NOTHING, 0, 0);
    expect(MACHINE_QUESTION, &pair_trial, GLFW_KEY_LEFT, true, KEYBOARD_EVENT, MACHINE_CHOOSE, PLAN_SLOT_A);
    expect(MACHINE_QUESTION, &pair_trial, GLFW_KEY_DOWN, true, KEYBOARD_EVENT, MACHINE_CHOOSE, PLAN_SLOT_NONE);
    expect(MACHINE_QUESTION, &pair_trial, GLFW_KEY_2, true, KEYBOARD_EVENT, MACHINE_CHOOSE, PLAN_SLOT_B);
    expect(MACHINE_QUESTION, &toggle_trial, GLFW_KEY_E, true, KEYBOARD_NOTHING, 0, 0);
    expect(MACHINE_BREAK, &toggle_trial, GLFW_KEY_ENTER, true, KEYBOARD_EVENT, MACHINE_START, 0);
    expect(MACHINE_STIMULUS, &toggle_trial, GLFW_KEY_F12, true, KEYBOARD_EVENT, MACHINE_FLAG, 0);
    expect(MACHINE_CONSENT, &toggle_trial, GLFW_KEY_F12, true, KEYBOARD_NOTHING, 0, 0);
}

static void pause_and_abort_keys(void **state)
{
    (void)state;
    expect(MACHINE_STIMULUS, &toggle_trial, GLFW_KEY_P, true, KEYBOARD_EVENT, MACHINE_PAUSE, 0);
    expect(MACHINE_QUESTION, &rate_trial, GLFW_KEY_P, true, KEYBOARD_EVENT, MACHINE_PAUSE, 0);
    expect(MACHINE_PAUSED, &toggle_trial, GLFW_KEY_ENTER, true, KEYBOARD_EVENT, MACHINE_START, 0);
    expect(MACHINE_STIMULUS, &toggle_trial, GLFW_KEY_ESCAPE, true, KEYBOARD_EVENT, MACHINE_ABORT_KEY, 0);
    expect(MACHINE_ABORT, &toggle_trial, GLFW_KEY_Y, true, KEYBOARD_EVENT, MACHINE_YES, 0);
    expect(MACHINE_ABORT, &toggle_trial, GLFW_KEY_N, true, KEYBOARD_EVENT, MACHINE_NO, 0);
    expect(MACHINE_ABORT, &toggle_trial, GLFW_KEY_ENTER, true, KEYBOARD_NOTHING, 0, 0);
    expect(MACHINE_STIMULUS, &toggle_trial, GLFW_KEY_Y, true, KEYBOARD_NOTHING, 0, 0);
}

// Consent is a deliberate Y on the last page; Enter only turns pages.
static void reading_keys(void **state)
{
    (void)state;
    expect(MACHINE_CONSENT, NULL, GLFW_KEY_ENTER, false, KEYBOARD_NEXT, 0, 0);
    expect(MACHINE_CONSENT, NULL, GLFW_KEY_Y, false, KEYBOARD_NOTHING, 0, 0);
    expect(MACHINE_CONSENT, NULL, GLFW_KEY_ENTER, true, KEYBOARD_NOTHING, 0, 0);
    expect(MACHINE_CONSENT, NULL, GLFW_KEY_Y, true, KEYBOARD_EVENT, MACHINE_YES, 0);
    expect(MACHINE_CONSENT, NULL, GLFW_KEY_N, true, KEYBOARD_EVENT, MACHINE_NO, 0);
    expect(MACHINE_INSTRUCTIONS, NULL, GLFW_KEY_ENTER, false, KEYBOARD_NEXT, 0, 0);
    expect(MACHINE_INSTRUCTIONS, NULL, GLFW_KEY_ENTER, true, KEYBOARD_EVENT, MACHINE_START, 0);
    expect(MACHINE_INSTRUCTIONS, NULL, GLFW_KEY_LEFT, true, KEYBOARD_BACK, 0, 0);
    expect(MACHINE_READY, &toggle_trial, GLFW_KEY_KP_ENTER, true, KEYBOARD_EVENT, MACHINE_START, 0);
    expect(MACHINE_REST, &toggle_trial, GLFW_KEY_ENTER, true, KEYBOARD_EVENT, MACHINE_START, 0);
    expect(MACHINE_CONFIRMATION, &toggle_trial, GLFW_KEY_ENTER, true, KEYBOARD_NOTHING, 0, 0);
    expect(MACHINE_STORING, &toggle_trial, GLFW_KEY_1, true, KEYBOARD_NOTHING, 0, 0);
}

static int32_t press(struct keyboard *keyboard, const struct machine_view *view, int key)
{
    struct machine_event event;
    keyboard_press(keyboard, view, true, key, &event);
    return keyboard_selected(keyboard, view);
}

static void ratings_are_marked_then_confirmed(void **state)
{
    (void)state;
    struct keyboard keyboard = {0};
    struct machine_event event;
    struct machine_view view = {.screen = MACHINE_QUESTION, .trial = &rate_trial, .question = &ten};
    assert_int_equal(keyboard_selected(&keyboard, &view), 0); // nothing is suggested
    assert_int_equal(keyboard_press(&keyboard, &view, true, GLFW_KEY_ENTER, &event), KEYBOARD_NOTHING);
    for (int digit = 1; digit <= 9; digit++)
        assert_int_equal(press(&keyboard, &view, GLFW_KEY_0 + digit), digit);
    assert_int_equal(press(&keyboard, &view, GLFW_KEY_0), 10);
    assert_int_equal(press(&keyboard, &view, GLFW_KEY_RIGHT), 10);
    assert_int_equal(press(&keyboard, &view, GLFW_KEY_DOWN), 9);
    assert_int_equal(keyboard_press(&keyboard, &view, true, GLFW_KEY_ENTER, &event), KEYBOARD_EVENT);
    assert_true(event.kind == MACHINE_RATE && event.value == 9);
    for (int i = 0; i < 20; i++)
        press(&keyboard, &view, GLFW_KEY_LEFT);
    assert_int_equal(keyboard_selected(&keyboard, &view), 1);
}

static void a_count_may_have_several_digits(void **state)
{
    (void)state;
    static const struct protocol_question twenty = {
        .type = PROTOCOL_ASK_COUNT, .scale_min = 0, .scale_max = 20};
    struct keyboard keyboard = {0};
    struct machine_view view = {.screen = MACHINE_QUESTION, .trial = &rate_trial, .question = &twenty};
    assert_int_equal(press(&keyboard, &view, GLFW_KEY_1), 1);
    assert_int_equal(press(&keyboard, &view, GLFW_KEY_7), 17);
    assert_int_equal(press(&keyboard, &view, GLFW_KEY_3), 3); // 173 are too many: a new number
    assert_int_equal(press(&keyboard, &view, GLFW_KEY_RIGHT), 4);
    assert_int_equal(press(&keyboard, &view, GLFW_KEY_2), 2); // not 42, nor after an arrow
    assert_int_equal(press(&keyboard, &view, GLFW_KEY_0), 20);
}

static void a_mark_does_not_live_on_to_the_next_question(void **state)
{
    (void)state;
    struct keyboard keyboard = {0};
    struct machine_event event;
    struct machine_view view = {
        .screen = MACHINE_QUESTION, .trial = &rate_trial, .question = &ten, .trial_index = 0};
    assert_int_equal(press(&keyboard, &view, GLFW_KEY_8), 8);
    view.trial_index = 5;
    assert_int_equal(keyboard_selected(&keyboard, &view), 0);
    assert_int_equal(keyboard_press(&keyboard, &view, true, GLFW_KEY_ENTER, &event), KEYBOARD_NOTHING);
    assert_int_equal(press(&keyboard, &view, GLFW_KEY_RIGHT), 5); // arrows begin in the middle
}

static void a_scale_around_zero_works(void **state)
{
    (void)state;
    struct keyboard keyboard = {0};
    struct machine_view view = {.screen = MACHINE_QUESTION, .trial = &rate_trial, .question = &seven};
    assert_int_equal(press(&keyboard, &view, GLFW_KEY_LEFT), 0);
    assert_int_equal(press(&keyboard, &view, GLFW_KEY_LEFT), -1);
    assert_int_equal(press(&keyboard, &view, GLFW_KEY_0), 0);
    assert_int_equal(press(&keyboard, &view, GLFW_KEY_9), 0); // beyond the scale: ignored
    assert_int_equal(press(&keyboard, &view, GLFW_KEY_3), 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stimulus_keys),
        cmocka_unit_test(keys_of_other_trials),
        cmocka_unit_test(pause_and_abort_keys),
        cmocka_unit_test(reading_keys),
        cmocka_unit_test(ratings_are_marked_then_confirmed),
        cmocka_unit_test(a_count_may_have_several_digits),
        cmocka_unit_test(a_mark_does_not_live_on_to_the_next_question),
        cmocka_unit_test(a_scale_around_zero_works),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
