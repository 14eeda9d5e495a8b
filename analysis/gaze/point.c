#include "analysis/gaze/point.h"

#include <math.h>

#define RADIANS (M_PI / 180)

struct gaze_point gaze_point(int64_t time_ns, double x_deg, double y_deg)
{
    double x = x_deg * RADIANS, y = y_deg * RADIANS;
    return (struct gaze_point){time_ns, x_deg, y_deg, {sin(x) * cos(y), sin(y), -cos(x) * cos(y)}};
}

struct gaze_point gaze_point_from_eye(const struct gaze_point *from_middle, double distance_m, double right_m)
{
    double x = distance_m * from_middle->unit[0] - right_m, y = distance_m * from_middle->unit[1];
    double ahead = -distance_m * from_middle->unit[2], across = hypot(x, ahead);
    if (!(hypot(across, y) > 0))
        return gaze_point(from_middle->time_ns, (double)NAN, (double)NAN);
    return gaze_point(from_middle->time_ns, atan2(x, ahead) / RADIANS, atan2(y, across) / RADIANS);
}

double gaze_angle_deg(const struct gaze_point *a, const struct gaze_point *b)
{
    double apart = 0, together = 0;
    for (int i = 0; i < 3; i++) {
        double d = a->unit[i] - b->unit[i], s = a->unit[i] + b->unit[i];
        apart += d * d;
        together += s * s;
    }
    return 2 * atan2(sqrt(apart), sqrt(together)) / RADIANS;
}
