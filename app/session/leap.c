#include "app/session/leap.h"

#include <math.h>

// Gaze that is simulated comes by frames too, and its queue must not overflow meanwhile.
enum { LEAP_SECONDS = 10 };

int64_t leap_time_ns(const struct leap *leap, int64_t frame)
{
    return (int64_t)llround((double)frame * 1e9 / leap->step_hz);
}

static bool same_view(const struct machine_view *a, const struct machine_view *b)
{
    return a->screen == b->screen && a->phase == b->phase && a->trial_index == b->trial_index &&
           a->attempt == b->attempt && a->slot == b->slot && a->fade == b->fade &&
           a->trial_started == b->trial_started && a->may_choose == b->may_choose &&
           a->may_go_on == b->may_go_on && a->question == b->question && a->subject == b->subject &&
           a->showing == b->showing && a->marker == b->marker && a->done == b->done && a->total == b->total;
}

// The first frame at or after a time.
static int64_t frame_at(const struct leap *leap, int64_t time_ns)
{
    int64_t frame = (int64_t)floor((double)time_ns * 1e-9 * leap->step_hz) - 1;
    while (leap_time_ns(leap, frame) < time_ns)
        frame++;
    return frame;
}

int64_t leap_next(struct leap *leap, int64_t frame, const struct machine *machine,
                  const struct machine_view *view, const struct observer *observer, bool busy)
{
    bool still = !busy && same_view(view, &leap->last) && observer->events == leap->events &&
                 observer->armed == leap->armed;
    leap->last = *view;
    leap->events = observer->events;
    leap->armed = observer->armed;
    int64_t due_ns = machine_next_ns(machine);
    if (observer->armed && observer->due_ns < due_ns)
        due_ns = observer->due_ns;
    if (!still || due_ns <= leap_time_ns(leap, frame) || due_ns == INT64_MAX)
        return frame + 1;
    int64_t longest = frame + (int64_t)ceil(LEAP_SECONDS * leap->step_hz), before = frame_at(leap, due_ns) - 1;
    before = before < longest ? before : longest;
    return before > frame ? before : frame + 1;
}
