#include "app/command/walk.h"

#include "app/command/options.h"
#include "app/gaze/script.h"
#include "stimuli/camera_path.h"
#include "stimuli/viewing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { GAZE_SEED = 1 };

bool walk_gaze_read(const char *text, struct walk_gaze *out)
{
    *out = (struct walk_gaze){.script = strcmp(text, "script") == 0};
    if (out->script || strcmp(text, "centre") == 0)
        return true;
    char *end = NULL;
    out->x_deg = strtod(text, &end);
    if (end == text || *end != ',')
        return false;
    const char *second = end + 1;
    out->y_deg = strtod(second, &end);
    return end != second && !*end && fabs(out->x_deg) <= 180 && fabs(out->y_deg) <= 90;
}

const char *walk_option(struct walk *walk, const char *name, const char *value)
{
    if (strcmp(name, "size") == 0)
        return options_size(value, &walk->width, &walk->height) ? NULL : "WIDTHxHEIGHT, 16 to 16384 each";
    if (strcmp(name, "gaze") == 0)
        return walk_gaze_read(value, &walk->gaze) ? NULL : "centre, script or X,Y in degrees";
    if (strcmp(name, "fov") == 0)
        return options_double(value, 1, 170, &walk->fov_deg) ? NULL : "a number of degrees from 1 to 170";
    return options_double(value, 0, 1e6, &walk->start_s) ? NULL : "a number of seconds from 0 to 1000000";
}

void walk_frame(const struct walk *walk, const struct scene *scene, uint64_t number, struct frame *out)
{
    const double time_s = walk->start_s + (double)number / WALK_FRAMES_PER_S;
    struct pose head = camera_path_pose(&scene->path, walk->still ? walk->start_s : time_s);
    double x_deg = walk->gaze.x_deg, y_deg = walk->gaze.y_deg;
    if (walk->gaze.script)
        gaze_script(GAZE_SEED, time_s, &x_deg, &y_deg);
    *out = (struct frame){.number = number, .moving = !walk->rest, .animation_s = walk->rest ? 0 : time_s};
    for (int eye = 0; eye < EYES; eye++)
        out->eyes[eye] =
            (struct frame_eye){.pose = viewing_eye_pose(&head, eye, VIEWING_DEFAULT_IPD_M),
                               .fov = viewing_symmetric_fov(walk->fov_deg, walk->width, walk->height),
                               .gaze_x_deg = x_deg,
                               .gaze_y_deg = y_deg};
}
