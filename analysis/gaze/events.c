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
        for (size_t i = first; i <= last; i++)
            event.peak_deg_s =
                fmax(event.peak_deg_s, gaze_velocity_at(s->points, s->count, s->rules->peak_ms, i));
    }
    s->each(s->user, &event, s->points);
}
