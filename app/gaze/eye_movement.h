// How an eye moves over a scene: fixations, saccades, drift, tremor and blinks, as pure functions of a seed and
// time.
//
// Use: eye_movement_fixation for where the scan path is; eye_movement_tremble and eye_movement_blink for what a
// tracker sees on top. Same seed and time, same answer, on every machine; nothing is kept between calls.
// Does not: follow the content of the picture, or model smooth pursuit and vestibular movements.
#ifndef APP_GAZE_EYE_MOVEMENT_H
#define APP_GAZE_EYE_MOVEMENT_H

#include <stdbool.h>
#include <stdint.h>

// Targets stay within these angles of straight ahead.
#define EYE_MOVEMENT_MAX_X_DEG 20.0
#define EYE_MOVEMENT_MAX_Y_DEG 15.0

// The main sequence: duration in seconds and peak velocity in degrees per second of a saccade of this
// amplitude.
double saccade_duration_s(double amplitude_deg);
double saccade_peak_deg_s(double amplitude_deg);
// The part of the way, 0..1, that a saccade of this amplitude has gone at `time_s` after its onset.
double saccade_progress(double amplitude_deg, double time_s);

// One fixation and the saccade that led to it.
struct eye_movement_step {
    double onset_s;      // of the saccade
    double x_deg, y_deg; // the fixation
    double from_x_deg, from_y_deg;
};

// The step that holds at a time >= 0 (times below 0 count as 0).
struct eye_movement_step eye_movement_step(uint64_t seed, double time_s);
// Where the scan path is: fixation or on the way to it.
void eye_movement_scan(uint64_t seed, double time_s, double *out_x_deg, double *out_y_deg);
// Drift and tremor of one eye, to be added.
void eye_movement_tremble(uint64_t seed, int eye, double time_s, double *out_x_deg, double *out_y_deg);
// Whether the lids are closed.
bool eye_movement_blink(uint64_t seed, double time_s);

#endif
