// What the participant reads: nothing but the letter tells the options apart, and it is there only while all is
// gray.
#include "app/session/screens.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static const struct protocol_settings settings = {.advance = PROTOCOL_ADVANCE_KEY};
static const struct protocol_question prefer = {.text = (char[]){"Which one do you prefer?"}};
static const struct protocol_question quality = {.type = PROTOCOL_ASK_RATING,
                                                 .text = (char[]){"How good?"},
                                                 .scale_min = 1,
                                                 .scale_max = 10,
                                                 .label_min = (char[]){"bad"},
                                                 .label_max = (char[]){"good"}};

static struct plan_trial trial_of(enum protocol_kind kind, int32_t a, int32_t b, enum plan_slot test)
{
    return (struct plan_trial){.kind = kind,
                               .resolved = &settings,
                               .option = {a, b},
                               .test_slot = test,
                               .scene = "town",
                               .factors = "{\"epsilon\":0.2}",
                               .first_shown = PLAN_SLOT_A};
}

// Two trials that differ only in which option is the foveated one read the same on every screen, at every fade.
static void no_screen_tells_the_options_apart(void **state)
{
    (void)state;
    struct plan_trial one = trial_of(PROTOCOL_TOGGLE, 1, 2, PLAN_SLOT_A);
    struct plan_trial other = trial_of(PROTOCOL_TOGGLE, 2, 1, PLAN_SLOT_B);
    for (int screen = MACHINE_CONSENT; screen <= MACHINE_END; screen++) {
        for (int step = 0; step <= 8; step++) {
            struct screen_state known = {.going_to = step % 2 ? PLAN_SLOT_A : PLAN_SLOT_B};
            struct machine_view view = {.screen = (enum machine_screen)screen,
                                        .trial = &one,
                                        .condition = 1,
                                        .slot = PLAN_SLOT_A,
                                        .fade = step / 8.0,
                                        .text = "text",
                                        .question = screen == MACHINE_QUESTION ? &quality : &prefer,
                                        .total = 9};
            static struct screen first, second;
            screen_of(&view, &known, &first);
            view.trial = &other;
            view.condition = 2;
            screen_of(&view, &known, &second);
            assert_true(screen_same(&first, &second));
        }
    }
}

static void the_letter_is_there_only_in_full_gray(void **state)
{
    (void)state;
    static struct screen screen;
    struct plan_trial trial = trial_of(PROTOCOL_TOGGLE, 1, 2, PLAN_SLOT_A);
    struct screen_state known = {.going_to = PLAN_SLOT_B};
    struct machine_view view = {.screen = MACHINE_STIMULUS, .trial = &trial, .slot = PLAN_SLOT_A};
    for (int step = 0; step < 100; step++) {
        view.fade = step / 100.0;
        screen_of(&view, &known, &screen);
        assert_false(screen.shown);
    }
    view.fade = 1.0;
    screen_of(&view, &known, &screen);
    assert_true(screen.shown);
    assert_string_equal(screen.title, "B"); // where the switch leads, from its first gray frame on
    assert_string_equal(screen.body, "");
    struct plan_trial rating = trial_of(PROTOCOL_RATE, 1, -1, PLAN_SLOT_A);
    view.trial = &rating;
    screen_of(&view, &known, &screen);
    assert_false(screen.shown); // one option only: no letter
}

static void every_waiting_screen_says_what_to_do(void **state)
{
    (void)state;
    static const enum machine_screen waiting[] = {MACHINE_CONSENT, MACHINE_INSTRUCTIONS, MACHINE_READY,
                                                  MACHINE_REST,    MACHINE_QUESTION,     MACHINE_PAUSED,
                                                  MACHINE_ABORT};
    for (int kind = PROTOCOL_TOGGLE; kind <= PROTOCOL_RATE; kind++) {
        struct plan_trial trial =
            trial_of((enum protocol_kind)kind, 1, kind == PROTOCOL_TOGGLE ? 2 : -1, PLAN_SLOT_A);
        for (size_t i = 0; i < sizeof waiting / sizeof waiting[0]; i++) {
            static struct screen screen;
            struct screen_state known = {.going_to = PLAN_SLOT_NONE, .selected = 0, .starts_trial = true};
            struct machine_view view = {.screen = waiting[i],
                                        .trial = &trial,
                                        .fade = 1.0,
                                        .text = "text",
                                        .question = waiting[i] == MACHINE_QUESTION ? &quality : &prefer};
            screen_of(&view, &known, &screen);
            assert_true(screen.shown);
            assert_true(strstr(screen.hint, "Enter") || strstr(screen.hint, "Y: "));
        }
    }
}

// Over whatever screen there is, and nothing else with it.
static void waiting_for_the_disk_says_so(void **state)
{
    (void)state;
    struct screen screen;
    struct screen_state waiting = {.going_to = PLAN_SLOT_A, .wait = true};
    for (int kind = MACHINE_CONSENT; kind <= MACHINE_END; kind++) {
        struct machine_view view = {.screen = (enum machine_screen)kind, .fade = 1};
        screen_of(&view, &waiting, &screen);
        assert_true(screen.shown);
        assert_string_equal(screen.title, "Please wait ...");
        assert_string_equal(screen.hint, "");
        assert_int_equal(screen.scale_max, 0);
    }
}

static void the_scale_comes_from_the_question(void **state)
{
    (void)state;
    static struct screen screen;
    struct plan_trial trial = trial_of(PROTOCOL_RATE, 1, -1, PLAN_SLOT_A);
    struct screen_state known = {.selected = 4};
    struct machine_view view = {.screen = MACHINE_QUESTION, .trial = &trial, .question = &quality, .fade = 1.0};
    screen_of(&view, &known, &screen);
    struct text_screen text = screen_text(&screen);
    assert_true(text.scale_min == 1 && text.scale_max == 10 && text.scale_selected == 4);
    assert_string_equal(text.scale_low, "bad");
    assert_string_equal(text.scale_high, "good");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_screen_tells_the_options_apart),
        cmocka_unit_test(the_letter_is_there_only_in_full_gray),
        cmocka_unit_test(every_waiting_screen_says_what_to_do),
        cmocka_unit_test(waiting_for_the_disk_says_so),
        cmocka_unit_test(the_scale_comes_from_the_question),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
