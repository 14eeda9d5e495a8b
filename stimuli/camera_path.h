// A camera path: a closed smooth curve flown at a given speed.
//
// Positions and viewing targets are closed Catmull-Rom curves through the same knots. The flight keeps the
// path's speed except where the view would turn faster than CAMERA_PATH_MAX_DEG_S; there it slows down.
#ifndef STIMULI_CAMERA_PATH_H
#define STIMULI_CAMERA_PATH_H

#include "stimuli/geometry.h"

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
    CAMERA_PATH_KNOTS = 64, // at most
    CAMERA_PATH_SAMPLES = 2048,
};

// DESIGN: scripted paths move at most 1.5 m/s and 30 deg/s.
#define CAMERA_PATH_MAX_M_S 1.5
#define CAMERA_PATH_MAX_DEG_S 30.0

struct camera_path_knot {
    struct dvec3 position; // metres, world, the point between the eyes
    struct dvec3 target;   // what the view is turned to
};

struct camera_path {
    struct camera_path_knot knots[CAMERA_PATH_KNOTS];
    uint32_t knot_count;                    // 1: a still camera
    double speed_m_s;                       // 0 < speed <= CAMERA_PATH_MAX_M_S
    double duration_s;                      // of one round; set by camera_path_finish
    double time_s[CAMERA_PATH_SAMPLES + 1]; // curve parameter i / CAMERA_PATH_SAMPLES is reached at time_s[i]
};

// Measures the curve and lays out the time table. False where there is no knot, a value is not finite, the
// speed is out of range or a target coincides with the curve.
bool camera_path_finish(struct camera_path *path);

// Pose of the head at a time; time repeats with duration_s. Upright: the head's x axis stays horizontal.
struct pose camera_path_pose(const struct camera_path *path, double time_s);

#ifdef __cplusplus
}
#endif
#endif
