#include "app/session/probe.h"

#include "app/gaze/script.h"

#include <stdio.h>

// As many frames as a look at one option takes in a session at the headless rates used for rehearsal (about a
// second at 15 to 25 Hz), and as many measured as such a look gives.
enum { PROBE_FRAMES = 20, PROBE_EVERY = 5 };

static struct frame frame_at(const struct session_desc *desc, uint32_t scene, uint64_t number)
{
    double refresh_hz = desc->display->refresh_hz > 0.0 ? desc->display->refresh_hz : DISPLAY_HEADLESS_HZ;
    double time_s = (double)number / refresh_hz, x_deg = 0.0, y_deg = 0.0;
    struct pose head = camera_path_pose(&desc->scenes[scene].scene->path, time_s);
    struct frame frame = {.number = number, .cut = number == 0};
    gaze_script(desc->plan->seed, time_s, &x_deg, &y_deg);
    for (int eye = 0; eye < EYES; eye++)
        frame.eyes[eye] = (struct frame_eye){.pose = viewing_eye_pose(&head, eye, desc->ipd_m),
                                             .fov = desc->fov,
                                             .gaze_x_deg = x_deg,
                                             .gaze_y_deg = y_deg};
    return frame;
}

bool probe(const struct session_desc *desc, struct measure *measure, uint32_t condition, uint32_t scene,
           char *error, size_t error_size)
{
    if (!stage_prepare_condition(desc->stage, condition, scene, error, error_size))
        return false;
    struct renderer_option *option = stage_option(desc->stage, PLAN_SLOT_A);
    for (uint64_t number = 0; number < PROBE_FRAMES; number++) {
        struct frame_stats stats;
        struct frame frame = frame_at(desc, scene, number);
        bool measured = number % PROBE_EVERY == PROBE_EVERY - 1;
        if (!renderer_draw(option, &frame, &stats) ||
            (measured &&
             !measure_take(measure, condition, scene, option, stage_reference(desc->stage), &frame))) {
            snprintf(error, error_size, "the image error on '%s' could not be measured",
                     desc->scenes[scene].name);
            return false;
        }
    }
    return true;
}
