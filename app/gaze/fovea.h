// What the fovea follows: the last valid sample of each eye, held through blinks.
//
// Use: zero a struct fovea, fovea_sample each sample in order, fovea_at per frame.
// A sample that is not valid changes nothing. Past FOVEA_HOLD_NS without a valid one the direction is still
// held (a jump of the sharp region would be seen), but counts as lost. Before the first valid sample there is
// none: NaN.
#ifndef APP_GAZE_FOVEA_H
#define APP_GAZE_FOVEA_H

#include "stimuli/viewing.h"

#include <stdbool.h>
#include <stdint.h>

// Longer than any spontaneous blink (100 to 400 ms, Schiffman 2001, Sensation and Perception).
#define FOVEA_HOLD_NS 500000000

struct fovea {
    struct {
        bool known;
        double x_deg, y_deg;
        int64_t host_ns;
        int64_t sample_id; // the store's id of the sample, 0 where it has none
    } eyes[EYES];
};

struct fovea_use {
    double x_deg[EYES], y_deg[EYES]; // head's frame; NaN before the first valid sample
    bool lost;
    int64_t sample_id; // the newest sample used, 0: none
    int64_t age_ns;    // of that sample at the frame; meaningful where `known`
    bool known;
};

void fovea_sample(struct fovea *fovea, const struct gaze_sample *sample, int64_t sample_id);
void fovea_at(const struct fovea *fovea, int64_t now_ns, struct fovea_use *out);
// What the fovea is where it follows something shown, not the eyes: each eye's direction of a point in the
// head's frame (metres), so that both converge on it.
void fovea_on(struct dvec3 point, double ipd_m, struct fovea_use *out);
// Whether this frame is the first with a gaze after frames without: then the held fovea was where nobody
// looked, and what was kept around it may be coarse where the eye is now. `was_lost`: false at first, kept by
// the caller.
bool fovea_returned(bool *was_lost, const struct fovea_use *use);

#endif
