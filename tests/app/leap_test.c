// Passing over frames in which nothing can change gives the records that every frame gives, to the nanosecond:
// for every kind of trial, at several rates, with missed deadlines.
#include "app/session/leap.h"
#include "tests/studies/protocol/sample_catalogue.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { RECORDS = 8192, TEXT = 16384, FRAMES = 400000 };

struct course {
    struct machine_record records[RECORDS];
    uint32_t count;
    int64_t frames; // that were looked at
};

static struct protocol *load(void)
{
    static char text[TEXT];
    char error[PROTOCOL_ERROR] = "";
    FILE *file = fopen(SOURCE_DIR "/tests/app/kinds.yaml", "r");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    char *setting = strstr(text, "ssao: on"); // the sample catalogue has no ambient occlusion
    assert_non_null(setting);
    memcpy(setting, "        ", strlen("ssao: on"));
    setting[-2] = ' ';
    struct protocol *protocol =
        protocol_parse("kinds.yaml", text, strlen(text), sample_catalogue(), error, sizeof error);
    assert_string_equal(error, "");
    return protocol;
}

// The larger epsilon, the larger the error; the reference has none.
static struct observer_errors errors_now(const struct machine *machine)
{
    struct observer_errors errors = {{0.0, 0.0}};
    struct protocol_option option;
    for (int slot = 0; slot < 2; slot++)
        if (machine_option(machine, (enum plan_slot)slot, &option) && option.mode == 1)
            errors.slot[slot] = option.values[0];
    return errors;
}

static bool answer(struct machine *machine, struct observer *observer, int64_t now)
{
    int64_t at_ns = 0;
    bool any = false;
    struct machine_view view;
    struct machine_event event;
    machine_look(machine, &view);
    struct observer_errors errors = errors_now(machine);
    while (observer_next(observer, now, &view, &errors, &at_ns, &event)) {
        machine_event(machine, at_ns, &event);
        machine_look(machine, &view);
        errors = errors_now(machine);
        any = true;
    }
    return any;
}

static bool take(struct machine *machine, int64_t now, struct course *course)
{
    uint32_t before = course->count;
    while (machine_next_record(machine, &course->records[course->count])) {
        bool answered = machine_is_answer(course->records[course->count].kind);
        assert_true(++course->count < RECORDS);
        if (answered)
            machine_event(machine, now, &(struct machine_event){MACHINE_ANSWER_STORED, 0});
    }
    return course->count > before;
}

static void play(const struct plan *plan, double step_hz, double late, bool leaps, struct course *course)
{
    struct observer observer;
    struct observer_parameters parameters;
    struct machine_view view = {.screen = MACHINE_CONSENT};
    struct leap leap = {.step_hz = step_hz};
    struct machine *machine = machine_create(plan, NULL);
    assert_non_null(machine);
    observer_defaults(&parameters);
    parameters.late = late;
    parameters.threshold = 0.3;
    observer_start(&observer, &parameters, plan->seed, plan->number);
    course->count = 0;
    course->frames = 0;
    int64_t frame = 0;
    while (view.screen != MACHINE_END) {
        int64_t now = leap_time_ns(&leap, frame);
        answer(machine, &observer, now);
        machine_frame(machine, now, &view);
        bool busy = take(machine, now, course);
        frame = leaps ? leap_next(&leap, frame, machine, &view, &observer, busy) : frame + 1;
        assert_true(++course->frames < FRAMES);
    }
    assert_true(view.complete);
    machine_destroy(machine);
}

static void expect_same(const struct machine_record *a, const struct machine_record *b)
{
    assert_int_equal(a->kind, b->kind);
    assert_int_equal(a->at_ns, b->at_ns);
    assert_int_equal(a->trial, b->trial);
    assert_int_equal(a->attempt, b->attempt);
    assert_int_equal(a->slot, b->slot);
    assert_int_equal(a->value, b->value);
    assert_int_equal(a->reaction_ns, b->reaction_ns);
    assert_int_equal(a->start_ns, b->start_ns);
    assert_int_equal(a->end_ns, b->end_ns);
    assert_int_equal(a->full_start_ns, b->full_start_ns);
    assert_int_equal(a->full_end_ns, b->full_end_ns);
    assert_true(a->numbers[0] == b->numbers[0]);
}

static void leaps_change_nothing(void **state)
{
    (void)state;
    static const double rates_hz[] = {90.0, 20.0, 72.3};
    struct protocol *protocol = load();
    struct course *every = malloc(sizeof *every), *leapt = malloc(sizeof *leapt);
    assert_true(every && leapt);
    int64_t all = 0, few = 0;
    for (uint32_t number = 0; number < 6; number++) {
        struct plan *plan = plan_create(protocol, protocol->seed, number);
        assert_non_null(plan);
        double late = number % 2 ? 0.2 : 0.0, rate_hz = rates_hz[number % 3];
        play(plan, rate_hz, late, false, every);
        play(plan, rate_hz, late, true, leapt);
        for (uint32_t i = 0; i < every->count && i < leapt->count; i++)
            expect_same(&every->records[i], &leapt->records[i]);
        assert_int_equal(every->count, leapt->count);
        all += every->frames;
        few += leapt->frames;
        plan_destroy(plan);
    }
    printf("%lld of %lld frames were looked at\n", (long long)few, (long long)all);
    assert_true(2 * few < all);
    free(every);
    free(leapt);
    protocol_destroy(protocol);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(leaps_change_nothing)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
