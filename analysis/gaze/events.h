// Fixations and saccades of one unbroken stretch of samples.
//
// Two ways, both of Salvucci, D. D. & Goldberg, J. H. (2000), Identifying fixations and saccades in
// eye-tracking protocols, ETRA 2000, 71-78:
//
// I-VT  Samples are fast where their velocity exceeds a threshold; runs of fast samples are saccades, runs of
//       others fixations. The velocity of a sample is the angle between the first and the last sample at most
//       half a window away from it (and at least its two neighbours), by the time between them. Two fixations
//       close in time and place are one, and the fast samples between them noise, as in Olsen, A. (2012), The
//       Tobii I-VT fixation filter, whose defaults are ours. Short runs are no event.
// I-DT  A fixation is the longest run of at least the minimum duration whose dispersion, (max x - min x) +
//       (max y - min y), stays within a threshold. It finds no saccades.
//
// An event at the edge of the stretch is `cut`: it began before or went on after it, so that its duration,
// amplitude and peak are lower bounds. Does not: tell pursuit from fixation (a slow pursuit is a fixation to
// I-VT), filter noise, or bridge gaps. Needs no memory but the caller's; one thread per call.
#ifndef ANALYSIS_GAZE_EVENTS_H
#define ANALYSIS_GAZE_EVENTS_H

#include "analysis/gaze/point.h"

#include <stddef.h>

enum gaze_method { GAZE_IVT, GAZE_IDT };
enum gaze_kind { GAZE_FIXATION, GAZE_SACCADE };

struct gaze_rules {
    enum gaze_method method;
    double velocity_deg_s;      // I-VT: fast above this; > 0
    double window_ms;           // I-VT: of the velocity; >= 0, 0: neighbours only
    double peak_ms;             // I-VT: the same of a saccade's peak velocity
    double dispersion_deg;      // I-DT; > 0
    double min_fixation_ms;     // >= 0
    double min_saccade_ms;      // I-VT; >= 0
    double merge_ms, merge_deg; // I-VT: fixations closer than both are one; merge_ms 0: none is
};

// velocity 30 deg/s, window 20 ms, fixations of at least 60 ms, merged within 75 ms and 0.5 deg: Olsen 2012.
// Saccades of at least 10 ms: shorter ones would be smaller than microsaccades by 21 ms + 2.2 ms/deg
// (Carpenter 1988), so they are noise. Peaks over 8 ms, the neighbours at 250 Hz: the 20 ms that find a saccade
// flatten its peak, so that c of a main sequence comes out up to twice too large
// (tests/reference/saccade_rate.R). I-DT: 1 deg and 100 ms, the upper and lower end of Salvucci & Goldberg's
// 0.5 to 1 deg and 100 to 200 ms.
struct gaze_rules gaze_rules(enum gaze_method method);

struct gaze_event {
    enum gaze_kind kind;
    size_t first, last;       // samples of the stretch
    int64_t start_ns, end_ns; // times of these
    double x_deg, y_deg;      // a fixation's mean, a saccade's last sample
    double amplitude_deg;     // saccade: from its first to its last sample; else NaN
    double peak_deg_s;        // saccade: the fastest sample's velocity over peak_ms; else NaN, also where
                              // peak_span_ms is above GAZE_VMAX_SPAN_MS
    double peak_span_ms;      // saccade: the time it and its neighbours' are really taken over, the longest
    bool cut;
};

typedef void (*gaze_event_fn)(void *user, const struct gaze_event *event, const struct gaze_point *points);

// `points`: finite, times strictly rising; `velocity`: room for `count` values, filled by I-VT with deg/s (NaN
// for a single sample), unused by I-DT. Events come in order of time. Cost is linear in `count`, for I-DT times
// the samples of a minimum duration at worst.
void gaze_events(const struct gaze_rules *rules, const struct gaze_point *points, size_t count,
                 double *velocity, gaze_event_fn each, void *user);

// The velocities alone.
void gaze_velocities(const struct gaze_point *points, size_t count, double window_ms, double *velocity);
// The time that a velocity is taken over, in ms, where samples come every `interval_ms` and none is missing.
// NaN for an interval that is not above 0.
double gaze_velocity_span_ms(double interval_ms, double window_ms);

// Up to which span peaks tell a main sequence: of simulated saccades (tests/reference/saccade_rate.R; Vmax 400
// to 700 deg/s, c 4 to 7 degrees, noise of 0.03 and 0.1 degrees) Vmax comes out at most 10 % wrong, and c, k
// and b of the fits at most 16 %. At 90 Hz Vmax is up to 21 % and at 60 Hz up to 57 % too large, and c two to
// four times.
#define GAZE_VMAX_SPAN_MS 17.5 // the neighbours of samples at 114 Hz
#define GAZE_SHAPE_SPAN_MS 8.5 // c, k and b; the neighbours at 235 Hz

#endif
