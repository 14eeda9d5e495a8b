// A direction of the gaze at a time, and the angle between two of them.
//
// Angles are degrees in the head's frame, of one eye: x = atan2(x, -z), y = atan2(y, hypot(x, z)), right and up
// positive, as the store has them. Times are nanoseconds of one clock.
#ifndef ANALYSIS_GAZE_POINT_H
#define ANALYSIS_GAZE_POINT_H

#include <stdbool.h>
#include <stdint.h>

struct gaze_point {
    int64_t time_ns;
    double x_deg, y_deg;
    double unit[3]; // the same direction; x right, y up, z back
};

struct gaze_point gaze_point(int64_t time_ns, double x_deg, double y_deg);

// The direction in which an eye `right_m` metres to the right of the head's middle (the left eye: below 0) sees
// what lies `distance_m` metres away in a direction from that middle. NaN where one of the numbers is NaN, or
// the point lies in the eye.
struct gaze_point gaze_point_from_eye(const struct gaze_point *from_middle, double distance_m, double right_m);

// Degrees between two directions, 0 to 180; NaN where one is not finite. Accurate for the smallest and the
// largest angles (Kahan: 2 atan2(|a - b|, |a + b|)).
double gaze_angle_deg(const struct gaze_point *a, const struct gaze_point *b);

#endif
