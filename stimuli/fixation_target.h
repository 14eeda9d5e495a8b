// What the eyes are asked to rest on: a cross in the image's middle, or a sphere that moves over the image
// along a straight line, both at the scene's depth, so that both eyes' images converge on them.
//
// Weier et al. 2016, section 4.2: "a set of paths across the image plane was generated. A green sphere linearly
// moved along these paths, fitted to the according scene depth." Their analysis holds +-10.3 degrees
// horizontally and 11.68 vertically; our paths' ends lie on the ellipse within, so that nothing leaves it.
//
// Use: fixation_target_init -> fixation_target_measure once, while nobody waits -> fixation_target_at per frame
//      -> fixation_target_finish. Does not: draw, read a clock. Moving objects are not looked at for the depth.
#ifndef STIMULI_FIXATION_TARGET_H
#define STIMULI_FIXATION_TARGET_H

#include "stimuli/ray.h"
#include "stimuli/viewing.h"

#include <stdint.h>

#define FIXATION_MOST_X_DEG 10.3
#define FIXATION_MOST_Y_DEG 11.68
// Angular radius at any depth. Ours: a sphere of one degree covers the area of sharpest sight (the foveola is
// about 1.2 degrees across) and at 12 pixels a degree still reads as a ball; the cross is thin, so it is
// longer.
#define FIXATION_RADIUS_DEG 0.5
#define FIXATION_CROSS_DEG 0.75
// One way, where the flight has no end. With paths of 19 to 23 degrees that is about 2.6 degrees a second, well
// within smooth pursuit.
#define FIXATION_SWEEP_S 8.0
#define FIXATION_SAMPLE_S 0.1 // between two looks at the depth
#define FIXATION_NEAREST_M 0.5
#define FIXATION_FARTHEST_M 100.0

enum fixation_kind { FIXATION_NONE, FIXATION_CROSS, FIXATION_MOVING };

struct fixation_flight {
    const struct camera_path *path; // borrowed
    double start_s;                 // where on the path it begins
    bool still;                     // the head stays there
    double view_s;                  // how long it lasts from begin_s on; 0: until somebody ends it
    double begin_s;                 // when the movement begins, e.g. after the fade
};

struct fixation_target {
    enum fixation_kind kind;
    struct fixation_flight flight;
    double from[2], to[2]; // of the line, in the image plane at distance 1: right and up
    double sweep_s;        // one way
    double round_s;        // after which sphere and head are where they were; infinite for a timed flight
    uint32_t count;        // depths
    double *dioptres;      // owned; at i * FIXATION_SAMPLE_S
};

struct fixation_place {
    double x_deg, y_deg; // in the head's frame
    double distance_m;
    struct dvec3 point; // in the head's frame, metres
};

// The same seed gives the same path. Timed flights take the path once; others go back and forth, in times that
// divide the camera's round.
void fixation_target_init(struct fixation_target *target, enum fixation_kind kind,
                          const struct fixation_flight *flight, uint32_t seed);
// Looks up the scene's depth along the flight. False: out of memory; the depth is then FIXATION_FARTHEST_M.
bool fixation_target_measure(struct fixation_target *target, const struct ray_scene *rays);
void fixation_target_finish(struct fixation_target *target);
// time_s: since the flight began.
struct fixation_place fixation_target_at(const struct fixation_target *target, double time_s);
// How the head is then.
struct pose fixation_head(const struct fixation_flight *flight, double time_s);

#endif
