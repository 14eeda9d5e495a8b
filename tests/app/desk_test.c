// The experimenter's panel: what it says, what it hides, what its keys mean, and notes typed on a terminal.
#define _XOPEN_SOURCE 600 // a pseudo-terminal
#include "app/fovstudy/ask.h"
#include "app/session/desk.h"

#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static struct protocol protocol = {.name = "calibration", .block_count = 1, .blocks = {{.name = "decisions"}}};
static struct plan_condition conditions[2] = {{.mode = "time_warped", .parameters = "{\"epsilon\":0.1}"},
                                              {.mode = "regular", .parameters = "{}"}};
static const struct plan plan = {
    .protocol = &protocol, .number = 4, .conditions = conditions, .condition_count = 2};
static const struct fovea_use gaze = {
    .x_deg = {-3.25, -3.0}, .y_deg = {1.5, 1.5}, .known = true, .age_ns = 12000000, .sample_id = 7};
static const struct desk_frames frames = {.p50_ms = 11.1, .p99_ms = 12.3, .count = 4311, .late = 2};

static struct plan_trial trial_of(int32_t a, int32_t b, enum plan_slot test)
{
    return (struct plan_trial){.kind = PROTOCOL_TOGGLE, .scene = "town", .option = {a, b}, .test_slot = test};
}

static void says_where_the_session_is(void **state)
{
    (void)state;
    char text[DESK_TEXT];
    struct plan_trial trial = trial_of(0, 1, PLAN_SLOT_A);
    struct desk_desc desc = {.plan = &plan, .participant = "P07", .refresh_hz = 90, .has_gaze = true};
    struct machine_view view = {
        .screen = MACHINE_STIMULUS, .trial = &trial, .trial_index = 4, .attempt = 2, .done = 4, .total = 11};
    desk_text(&desc, &view, &gaze, &frames, NULL, text);
    assert_string_equal(text, "calibration, participant P07 (number 5)   stimulus\n"
                              "trial    5 (4 of 11 done)   decisions, toggle   scene town   attempt 2\n"
                              "gaze       -3.2   +1.5 deg   tracked, 12 ms old\n"
                              "frames   11.1 ms median, 12.3 ms p99, 2 of 4311 late\n");
    desk_text(&desc, &view, &(struct fovea_use){.known = true, .lost = true}, &frames, "the disk is full",
              text);
    assert_non_null(strstr(text, "LOST"));
    assert_non_null(strstr(text, "TROUBLE  the disk is full\n"));
}

// Two sessions that differ only in which option is under test look the same, unless unblinded.
static void hides_the_options(void **state)
{
    (void)state;
    char one[DESK_TEXT], other[DESK_TEXT];
    struct plan_trial a = trial_of(0, 1, PLAN_SLOT_A), b = trial_of(1, 0, PLAN_SLOT_B);
    struct desk_desc desc = {.plan = &plan, .participant = "P07"};
    for (int slot = PLAN_SLOT_A; slot <= PLAN_SLOT_B; slot++) {
        struct machine_view view = {
            .screen = MACHINE_STIMULUS, .trial = &a, .slot = (enum plan_slot)slot, .condition = a.option[slot]};
        desk_text(&desc, &view, &gaze, &frames, NULL, one);
        view.trial = &b;
        view.condition = b.option[slot];
        desk_text(&desc, &view, &gaze, &frames, NULL, other);
        assert_string_equal(one, other);
    }
    desc.unblind = true;
    desk_text(&desc, &(struct machine_view){.trial = &b}, &gaze, &frames, NULL, one);
    assert_non_null(strstr(one, "b        time_warped {\"epsilon\":0.1}\n"));
}

static void expect(char key, enum machine_screen screen, enum desk_command command,
                   enum machine_event_kind kind)
{
    struct machine_event event = {.kind = MACHINE_ANSWER_STORED};
    assert_int_equal(desk_key(key, &(struct machine_view){.screen = screen}, &event), command);
    if (command == DESK_EVENT)
        assert_int_equal(event.kind, kind);
}

static void keys_mean(void **state)
{
    (void)state;
    expect('s', MACHINE_READY, DESK_EVENT, MACHINE_START);
    expect('s', MACHINE_PAUSED, DESK_EVENT, MACHINE_START);
    expect('s', MACHINE_STIMULUS, DESK_NOTHING, 0); // would end a rating's view
    expect('s', MACHINE_CONSENT, DESK_NOTHING, 0);
    expect('y', MACHINE_CONSENT, DESK_NOTHING, 0); // nobody consents for somebody else
    expect('p', MACHINE_STIMULUS, DESK_EVENT, MACHINE_PAUSE);
    expect('f', MACHINE_STIMULUS, DESK_EVENT, MACHINE_FLAG);
    expect('f', MACHINE_REST, DESK_EVENT, MACHINE_FLAG);
    expect('a', MACHINE_QUESTION, DESK_EVENT, MACHINE_ABORT_KEY);
    expect('y', MACHINE_ABORT, DESK_EVENT, MACHINE_YES);
    expect('n', MACHINE_ABORT, DESK_EVENT, MACHINE_NO);
    expect('x', MACHINE_STIMULUS, DESK_NOTHING, 0);
}

static void notes_are_typed_on_a_terminal(void **state)
{
    (void)state;
    int master = posix_openpt(O_RDWR | O_NOCTTY);
    assert_true(master >= 0 && grantpt(master) == 0 && unlockpt(master) == 0);
    int slave = open(ptsname(master), O_RDWR | O_NOCTTY);
    FILE *out = fdopen(dup(slave), "w");
    struct desk_desc desc = {.out = out, .in = slave, .plan = &plan, .participant = "P07"};
    struct desk *desk = desk_open(&desc);
    struct machine_view view = {.screen = MACHINE_STIMULUS};
    struct machine_event event;
    char note[DESK_NOTE] = "";
    assert_non_null(desk);
    assert_int_equal(desk_take(desk, &view, &event, note), DESK_NOTHING);
    const char keys[] = "nheadset slippee\x7f"
                        "d\nf";
    assert_int_equal(write(master, keys, sizeof keys - 1), sizeof keys - 1);
    assert_int_equal(desk_take(desk, &view, &event, note), DESK_NOTED);
    assert_string_equal(note, "headset slipped");
    assert_int_equal(desk_take(desk, &view, &event, note), DESK_EVENT);
    assert_int_equal(event.kind, MACHINE_FLAG);
    assert_int_equal(write(master, "nnever mind\x1bp", 13), 13);
    assert_int_equal(desk_take(desk, &view, &event, note), DESK_EVENT);
    assert_int_equal(event.kind, MACHINE_PAUSE);
    desk_frame(desk, 11.0, false);
    desk_show(desk, 0, &view, &gaze, NULL);
    char panel[4096];
    ssize_t size = read(master, panel, sizeof panel - 1);
    assert_true(size > 0);
    panel[size] = '\0';
    assert_non_null(strstr(panel, "P07"));
    assert_non_null(strstr(panel, "f flag the trial as bad"));
    desk_close(desk);
    fclose(out);
    close(slave);
    close(master);
    assert_null(desk_open(&(struct desk_desc){.out = stdout, .in = open("/dev/null", O_RDONLY)}));
}

static void attributes_are_asked_until_they_fit(void **state)
{
    (void)state;
    char input[] = "abc\n12\n27\n\nsometimes\nnever\n", json[64], told[1024] = "";
    const struct protocol_attribute age = {.name = "age",
                                           .type = PROTOCOL_INTEGER,
                                           .required = true,
                                           .prompt = (char[]){"Age"},
                                           .unit = "years",
                                           .min = 18,
                                           .max = 99};
    const struct protocol_attribute often = {.name = "often",
                                             .type = PROTOCOL_CHOICE,
                                             .prompt = (char[]){"How often"},
                                             .choices = {"never", "daily"},
                                             .choice_count = 2};
    FILE *in = fmemopen(input, sizeof input - 1, "r"), *out = fmemopen(told, sizeof told, "w");
    assert_true(ask_attribute(in, out, &age, json, sizeof json));
    assert_string_equal(json, "27");
    assert_true(ask_attribute(in, out, &often, json, sizeof json));
    assert_string_equal(json, ""); // left out
    assert_true(ask_attribute(in, out, &often, json, sizeof json));
    assert_string_equal(json, "\"never\"");
    assert_false(ask_attribute(in, out, &age, json, sizeof json));
    fclose(in);
    fclose(out);
    assert_non_null(strstr(told, "Age [years]: age is a whole number, not 'abc'\n"));
    assert_non_null(strstr(told, "How often (never, daily) (may stay empty): "));
    assert_non_null(strstr(told, "often is 'sometimes'; give never, daily"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(says_where_the_session_is),
        cmocka_unit_test(hides_the_options),
        cmocka_unit_test(keys_mean),
        cmocka_unit_test(attributes_are_asked_until_they_fit),
        cmocka_unit_test(notes_are_typed_on_a_terminal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
