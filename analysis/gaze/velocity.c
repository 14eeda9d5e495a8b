// I-VT: see events.h.
#include "analysis/gaze/events_private.h"

#include <math.h>

void gaze_velocities(const struct gaze_point *points, size_t count, double window_ms, double *velocity)
{
    double half_ns = window_ms * 1e6 / 2;
    size_t from = 0, to = 0;
    if (count == 1)
        velocity[0] = NAN;
    for (size_t i = 0; count > 1 && i < count; i++) {
        while (from + 1 < i && (double)(points[i].time_ns - points[from].time_ns) > half_ns)
            from++;
        if (to < i + 1 && i + 1 < count)
            to = i + 1;
        while (to + 1 < count && (double)(points[to + 1].time_ns - points[i].time_ns) <= half_ns)
            to++;
        velocity[i] = gaze_angle_deg(&points[from], &points[to]) /
                      ((double)(points[to].time_ns - points[from].time_ns) / 1e9);
    }
}

double gaze_velocity_at(const struct gaze_point *points, size_t count, double window_ms, size_t i,
                        double *out_span_ms)
{
    double half_ns = window_ms * 1e6 / 2;
    size_t from = i ? i - 1 : 0, to = i + 1 < count ? i + 1 : i;
    while (from > 0 && (double)(points[i].time_ns - points[from - 1].time_ns) <= half_ns)
        from--;
    while (to + 1 < count && (double)(points[to + 1].time_ns - points[i].time_ns) <= half_ns)
        to++;
    *out_span_ms = (double)(points[to].time_ns - points[from].time_ns) / 1e6;
    return gaze_angle_deg(&points[from], &points[to]) / (*out_span_ms / 1e3);
}

double gaze_velocity_span_ms(double interval_ms, double window_ms)
{
    if (!(interval_ms > 0))
        return NAN;
    // a window that is a multiple of the interval holds its ends, whatever the last digit says
    return 2 * fmax(1, floor(window_ms / 2 / interval_ms * (1 + 1e-9))) * interval_ms;
}

// Samples first to last; last < first: none.
struct run {
    bool some;
    size_t first, last;
    double x_sum, y_sum; // of a fixation's samples
};

static void extend(struct run *run, const struct gaze_point *points, size_t last)
{
    for (size_t i = run->some ? run->last + 1 : run->first; i <= last; i++) {
        run->x_sum += points[i].x_deg;
        run->y_sum += points[i].y_deg;
    }
    run->some = true;
    run->last = last;
}

static struct gaze_point centre(const struct run *run)
{
    double n = (double)(run->last - run->first + 1);
    return gaze_point(0, run->x_sum / n, run->y_sum / n);
}

static bool same_fixation(const struct gaze_search *s, const struct run *before, const struct run *after)
{
    double apart_ns = (double)(s->points[after->first].time_ns - s->points[before->last].time_ns);
    if (s->rules->merge_ms <= 0 || apart_ns > s->rules->merge_ms * 1e6)
        return false;
    struct gaze_point a = centre(before), b = centre(after);
    return gaze_angle_deg(&a, &b) <= s->rules->merge_deg;
}

static void emit(const struct gaze_search *s, const struct run *fixation, const struct run *saccade)
{
    if (fixation->some)
        gaze_found(s, GAZE_FIXATION, fixation->first, fixation->last);
    if (saccade->some)
        gaze_found(s, GAZE_SACCADE, saccade->first, saccade->last);
}

// Runs come alternately slow and fast; a fixation waits until the next one is known not to be its other part.
void gaze_search_velocity(const struct gaze_search *s)
{
    struct run fixation = {.some = false}, saccade = {.some = false};
    if (s->count < 2)
        return;
    gaze_velocities(s->points, s->count, s->rules->window_ms, s->velocity);
    for (size_t first = 0, next; first < s->count; first = next) {
        bool fast = s->velocity[first] > s->rules->velocity_deg_s;
        for (next = first + 1; next < s->count && (s->velocity[next] > s->rules->velocity_deg_s) == fast;)
            next++;
        if (fast) {
            saccade = (struct run){.some = true, .first = first, .last = next - 1};
            continue;
        }
        struct run slow = {.first = first};
        extend(&slow, s->points, next - 1);
        if (fixation.some && same_fixation(s, &fixation, &slow)) {
            extend(&fixation, s->points, next - 1);
        } else {
            emit(s, &fixation, &saccade);
            fixation = slow;
        }
        saccade.some = false;
    }
    emit(s, &fixation, &saccade);
}
