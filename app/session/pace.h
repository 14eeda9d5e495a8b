// At which rate pictures follow each other where the screen's own is too fast for an option: whole parts of the
// refresh rate (90: 45, 30, 22.5 ...), so that every picture stays equally long. Between them the last is
// repeated.
//
// Pure: no clock, no drawing. Times in nanoseconds of the session, frame times in milliseconds.
#ifndef APP_SESSION_PACE_H
#define APP_SESSION_PACE_H

#include "studies/engine/plan.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define PACE_LATE_MOST 0.001 // share of late frames with which a rate still counts as held
#define PACE_LEAST_HZ 5.0    // fewer pictures a second are no motion

// Share of frames that take longer than `divisor` refreshes and `slack` of one: 0 where frames do not wait for
// the screen; 0.5 where they do, since their times are then whole refreshes give or take the clock.
double pace_late_share(const double *frame_ms, size_t count, double refresh_hz, uint32_t divisor, double slack);
// The smallest divisor whose rate these frames hold; 0: none down to PACE_LEAST_HZ.
uint32_t pace_held(const double *frame_ms, size_t count, double refresh_hz, double slack);

struct pace {
    double refresh_hz;   // 0: not known
    uint32_t divisor;    // 0 and 1: a picture each refresh
    uint64_t number;     // of the next picture; counts on where none is shown, so that gaps show
    enum plan_slot slot; // whose picture is on the screen; NONE: none
    int64_t begun_ns;    // when it was begun
    int64_t present_ns;  // when the last frame was presented; -1: not known
    int64_t picture_ns;  // when its picture first was; -1: none is on the screen
};

void pace_init(struct pace *pace, double refresh_hz);
// Whether this frame wants a new picture; else the last is repeated. `started`: the first of a showing.
bool pace_due(struct pace *pace, enum plan_slot slot, bool started, int64_t start_ns);
// After the frame was presented: whether it came late, against the rate that holds for it. A repeated picture
// never does: the next new one tells. `visible`: a picture was shown.
bool pace_late(struct pace *pace, bool visible, bool repeated, int64_t present_ns);

#endif
