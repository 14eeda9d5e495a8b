// One frame's inputs and what came of it. Plain data, shared by the application, the modes and the passes.
#ifndef RENDERER_FRAME_H
#define RENDERER_FRAME_H

#include "stimuli/geometry.h"
#include "stimuli/viewing.h"

#include <stdbool.h>
#include <stdint.h>

struct frame_eye {
    struct pose pose;       // world
    struct viewing_fov fov; // may be asymmetric
    double gaze_x_deg,
        gaze_y_deg; // what the fovea follows, this eye's frame (viewing.h); not finite: see below
};

// A gaze that is not a number means no valid gaze: a foveated mode then treats every pixel as foveal.
struct frame {
    uint64_t number;    // counts up by one per frame of a run; a gap forgets earlier frames
    bool moving;        // objects move; false: they stand still at animation_s and count as static
    double animation_s; // scene time for moving objects
    struct frame_eye eyes[EYES];
    bool cut;           // camera cut: nothing from earlier frames may be used
    bool gaze_returned; // the gaze was lost for longer than a blink until now: kept pixels may be foveal ones
};

enum { FRAME_TIMERS = 32 };

// Why a mode with history did not use it.
enum frame_redraw {
    FRAME_REDRAW_NONE, // it did, or the mode has none
    FRAME_REDRAW_FIRST,
    FRAME_REDRAW_CUT,
    FRAME_REDRAW_GAP,    // frames in between were not drawn: an option switch, a pause
    FRAME_REDRAW_MOTION, // objects started or stopped to move
    FRAME_REDRAW_GAZE,   // the gaze came back
    FRAME_REDRAW_CAUSES
};

struct frame_stats {
    uint64_t shaded_px;         // pixels of both eyes whose shading ran or whose background was written
    uint64_t triangles;         // submitted to the rasteriser after culling, both eyes
    uint64_t submodels;         // draws after culling, both eyes
    double gpu_ms;              // first to last time stamp of the frame
    double cpu_ms;              // recording and submitting
    uint64_t frustum_triangles; // the same without foveated culling
    uint64_t frustum_submodels;
    uint64_t
        moving_px; // of both eyes, whose surface belongs to a moving object; 0 unless settings.motion is on
    enum frame_redraw redraw;
    uint32_t timer_count;
    struct {
        const char *name; // constant string, the pass
        double ms;
    } timers[FRAME_TIMERS];
};

#endif
