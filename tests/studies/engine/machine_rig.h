// A machine with its plan, driven by hand: events and frames at given times, records taken one by one.
#ifndef TESTS_STUDIES_MACHINE_RIG_H
#define TESTS_STUDIES_MACHINE_RIG_H

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

static inline struct rig rig_of(const char *design, const struct machine_start *start)
{
    char error[PROTOCOL_ERROR] = "";
    struct rig rig = {.protocol = sample_design("[atrium]", design, error, sizeof error)};
    assert_string_equal(error, "");
    rig.plan = plan_create(rig.protocol, 1, 0);
    rig.machine = machine_create(rig.plan, start);
    assert_non_null(rig.machine);
    return rig;
}

static inline void rig_free(struct rig *rig)
{
    machine_destroy(rig->machine);
    plan_destroy(rig->plan);
    protocol_destroy(rig->protocol);
}

static inline void event_at(struct rig *rig, int64_t at, enum machine_event_kind kind, int32_t value)
{
    machine_event(rig->machine, at, &(struct machine_event){kind, value});
    rig->now = at;
    machine_look(rig->machine, &rig->view);
}

static inline void event(struct rig *rig, enum machine_event_kind kind, int32_t value)
{
    event_at(rig, rig->now, kind, value);
}

static inline void frame_at(struct rig *rig, int64_t at)
{
    rig->now = at;
    machine_frame(rig->machine, at, &rig->view);
}

static inline void frames(struct rig *rig, int count)
{
    for (int i = 0; i < count; i++)
        frame_at(rig, rig->now + FRAME);
}

// The next record, which must be of this kind.
static inline struct machine_record record(struct rig *rig, enum machine_record_kind kind)
{
    struct machine_record record;
    assert_true(machine_next_record(rig->machine, &record));
    assert_string_equal(machine_record_name(record.kind), machine_record_name(kind));
    return record;
}

static inline void no_record(struct rig *rig)
{
    struct machine_record record;
    if (machine_next_record(rig->machine, &record))
        assert_string_equal(machine_record_name(record.kind), "no record");
}

static inline void drain(struct rig *rig)
{
    struct machine_record record;
    while (machine_next_record(rig->machine, &record))
        ;
}

static inline void screen(const struct rig *rig, enum machine_screen wanted)
{
    assert_string_equal(machine_screen_name(rig->view.screen), machine_screen_name(wanted));
}

static inline void level(const struct rig *rig, double wanted)
{
    assert_true(fabs(rig->view.fade - wanted) < 1e-12);
}

// To the first frame of the first trial, at a time that is no round number.
static inline void start_first_trial(struct rig *rig)
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
static inline void start_toggle_trial(struct rig *rig)
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

#endif
