#include "app/session/pace.h"

double pace_late_share(const double *frame_ms, size_t count, double refresh_hz, uint32_t divisor, double slack)
{
    size_t late = 0;
    double most_ms = (divisor + slack) * 1e3 / refresh_hz;
    for (size_t i = 0; i < count; i++)
        late += frame_ms[i] > most_ms;
    return count ? (double)late / (double)count : 0.0;
}

uint32_t pace_held(const double *frame_ms, size_t count, double refresh_hz, double slack)
{
    for (uint32_t divisor = 1; divisor == 1 || refresh_hz / divisor >= PACE_LEAST_HZ; divisor++)
        if (pace_late_share(frame_ms, count, refresh_hz, divisor, slack) <= PACE_LATE_MOST)
            return divisor;
    return 0;
}

void pace_init(struct pace *pace, double refresh_hz)
{
    *pace = (struct pace){
        .refresh_hz = refresh_hz, .divisor = 1, .slot = PLAN_SLOT_NONE, .present_ns = -1, .picture_ns = -1};
}

// By time, not by counting: a picture that took two refreshes to draw is due again at once where two are a
// period.
bool pace_due(struct pace *pace, enum plan_slot slot, bool started, int64_t start_ns)
{
    bool same = pace->divisor > 1 && pace->refresh_hz > 0.0 && slot == pace->slot && !started;
    if (same && (double)(start_ns - pace->begun_ns) < (pace->divisor - 0.5) * 1e9 / pace->refresh_hz)
        return false;
    pace->slot = slot;
    pace->begun_ns = start_ns;
    return true;
}

bool pace_late(struct pace *pace, bool visible, bool repeated, int64_t present_ns)
{
    bool paced = visible && pace->divisor > 1;
    int64_t since_ns = paced && pace->picture_ns >= 0 ? pace->picture_ns : pace->present_ns;
    double periods = (paced ? pace->divisor : 1) + 0.5;
    bool late = !repeated && since_ns >= 0 && pace->refresh_hz > 0.0 &&
                (double)(present_ns - since_ns) > periods * 1e9 / pace->refresh_hz;
    pace->present_ns = present_ns;
    if (!visible) {
        pace->slot = PLAN_SLOT_NONE;
        pace->picture_ns = -1;
    } else if (!repeated) {
        pace->picture_ns = present_ns;
    }
    pace->number += !repeated;
    return late;
}
