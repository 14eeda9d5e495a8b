#include "app/gaze/script.h"

#include "app/gaze/eye_movement.h"

void gaze_script(uint64_t seed, double time_s, double *out_x_deg, double *out_y_deg)
{
    eye_movement_scan(seed, time_s, out_x_deg, out_y_deg);
}
