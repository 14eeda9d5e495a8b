// Time where nothing is drawn: frames are counted at a steady rate, and those in which nothing can change are
// left out.
//
// Times are what they would be frame by frame. A frame is left out only where the one before it changed
// nothing, and neither the machine nor the observer has anything due up to the frame after it: what lasts until
// the last frame before an event (an exposure, the origin of a fade) keeps that frame's time. Use: once per
// frame: leap_next with what the frame showed -> the next frame's number. Does not: read a clock.
#ifndef APP_SESSION_LEAP_H
#define APP_SESSION_LEAP_H

#include "studies/engine/observer.h"

#include <stdbool.h>
#include <stdint.h>

struct leap {
    double step_hz;
    struct machine_view last;
    uint32_t events; // of the observer, at the last frame
    bool armed;
};

int64_t leap_time_ns(const struct leap *leap, int64_t frame);
// busy: the frame had records to store, or other work that the next frame goes on with.
int64_t leap_next(struct leap *leap, int64_t frame, const struct machine *machine,
                  const struct machine_view *view, const struct observer *observer, bool busy);

#endif
