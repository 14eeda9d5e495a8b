// Shared by events.c, velocity.c and dispersion.c only.
#ifndef ANALYSIS_GAZE_EVENTS_PRIVATE_H
#define ANALYSIS_GAZE_EVENTS_PRIVATE_H

#include "analysis/gaze/events.h"

struct gaze_search {
    const struct gaze_rules *rules;
    const struct gaze_point *points;
    size_t count;
    double *velocity;
    gaze_event_fn each;
    void *user;
};

void gaze_search_velocity(const struct gaze_search *search);
void gaze_search_dispersion(const struct gaze_search *search);

// The velocity of sample `i`, as gaze_velocities() has it, of at least two samples, and the time it is taken
// over.
double gaze_velocity_at(const struct gaze_point *points, size_t count, double window_ms, size_t i,
                        double *out_span_ms);

// Hands the event on, unless it is too short.
void gaze_found(const struct gaze_search *search, enum gaze_kind kind, size_t first, size_t last);

#endif
