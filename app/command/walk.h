// A walk along a scene's camera path with a gaze: the frames of `fovstudy render` and `fovbench`.
//
// The definitions are DESIGN section 3's: 1/90 s a frame, the symmetric projection of a vertical field of view,
// a gaze that is a place of the image or the script of app/gaze. Pure: the same walk and number give the same
// frame.
#ifndef APP_COMMAND_WALK_H
#define APP_COMMAND_WALK_H

#include "renderer/frame.h"
#include "stimuli/scene.h"

#include <stdbool.h>
#include <stdint.h>

#define WALK_FRAMES_PER_S 90.0

struct walk_gaze {
    bool script;         // fixations and saccades, the same ones every time
    double x_deg, y_deg; // else
};

struct walk {
    struct walk_gaze gaze;
    uint32_t width, height; // pixels per eye
    double fov_deg;         // vertical
    double start_s;         // where on the path frame 0 is
    bool still;             // the camera stays at start_s
    bool rest;              // moving objects stay at their place of time 0
};

// "centre", "script" or "X,Y" in degrees, right and up positive.
bool walk_gaze_read(const char *text, struct walk_gaze *out);

// Takes the value of the option `name`: size, gaze, fov or start. NULL, or what was expected.
const char *walk_option(struct walk *walk, const char *name, const char *value);

void walk_frame(const struct walk *walk, const struct scene *scene, uint64_t number, struct frame *out);

#endif
