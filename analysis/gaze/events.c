#include "analysis/gaze/events.h"

#include "analysis/gaze/events_private.h"

#include <math.h>

struct gaze_rules gaze_rules(enum gaze_method method)
{
    return (struct gaze_rules){.method = method,
                               .velocity_deg_s = 30,
                               .window_ms = 20,
                               .peak_ms = 8,
                               .dispersion_deg = 1,
                               .min_fixation_ms = method == GAZE_IVT ? 60 : 100,
                               .min_saccade_ms = 10,
                               .merge_ms = 75,
                               .merge_deg = 0.5};
}

void gaze_events(const struct gaze_rules *rules, const struct gaze_point *points, size_t count,
                 double *velocity, gaze_event_fn each, void *user)
{
    struct gaze_search search = {rules, points, count, velocity, each, user};
    if (rules->method == GAZE_IVT)
        gaze_search_velocity(&search);
    else
        gaze_search_dispersion(&search);
}

// Where samples are missing a velocity is taken over a longer time, and flattened. A sample that is faster than
// both its neighbours, all three over short times, is the peak of a velocity that rises and falls once; one
// beside a gap need not be, so that the longest of the three times says what the peak is worth.
static void find_peak(const struct gaze_search *s, struct gaze_event *event)
{
    const double window_ms = s->rules->peak_ms;
    size_t fastest = event->first;
    double peak = -1, span, longest = 0;
    for (size_t i = event->first; i <= event->last; i++) {
        double velocity = gaze_velocity_at(s->points, s->count, window_ms, i, &span);
        if (velocity > peak) {
            peak = velocity;
            fastest = i;
        }
    }
    for (size_t i = fastest ? fastest - 1 : 0; i <= fastest + 1 && i < s->count; i++) {
        gaze_velocity_at(s->points, s->count, window_ms, i, &span);
        longest = fmax(longest, span);
    }
    event->peak_span_ms = longest;
    event->peak_deg_s = longest <= GAZE_VMAX_SPAN_MS ? peak : (double)NAN;
}

void gaze_found(const struct gaze_search *s, enum gaze_kind kind, size_t first, size_t last)
{
    const struct gaze_point *from = &s->points[first], *to = &s->points[last];
    double least_ms = kind == GAZE_FIXATION ? s->rules->min_fixation_ms : s->rules->min_saccade_ms;
    if ((double)(to->time_ns - from->time_ns) < least_ms * 1e6)
        return;
    struct gaze_event event = {.kind = kind,
                               .first = first,
                               .last = last,
                               .start_ns = from->time_ns,
                               .end_ns = to->time_ns,
                               .x_deg = to->x_deg,
                               .y_deg = to->y_deg,
                               .amplitude_deg = NAN,
                               .peak_deg_s = NAN,
                               .peak_span_ms = NAN,
                               .cut = first == 0 || last + 1 == s->count};
    if (kind == GAZE_FIXATION) {
        event.x_deg = event.y_deg = 0;
        for (size_t i = first; i <= last; i++) {
            event.x_deg += s->points[i].x_deg;
            event.y_deg += s->points[i].y_deg;
        }
        event.x_deg /= (double)(last - first + 1);
        event.y_deg /= (double)(last - first + 1);
    } else {
        event.amplitude_deg = gaze_angle_deg(from, to);
        find_peak(s, &event);
    }
    s->each(s->user, &event, s->points);
}
