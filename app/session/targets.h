// What a trial lays over its pictures, the same for both options: the fixation target, the marker between two
// showings, and the spheres to count.
//
// Use: targets_prepare while nobody waits -> per frame targets_fixation, targets_marks -> targets_finish.
// Does not: draw, store.
#ifndef APP_SESSION_TARGETS_H
#define APP_SESSION_TARGETS_H

#include "renderer/renderer.h"
#include "stimuli/fixation_target.h"
#include "stimuli/spheres.h"
#include "studies/engine/machine.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct targets {
    struct fixation_target fixation; // of trials without one a cross that only the marker uses
    bool fixates;                    // the pictures have a target too
    struct spheres spheres[2];       // of each showing
};

struct targets_desc {
    const struct plan_trial *trial;
    const struct ray_scene *rays;
    const struct camera_path *path;
    struct viewing_fov fov; // of each eye
    double ipd_m;
};

struct targets_view {
    struct viewing_fov fov;
    uint32_t width, height; // per eye
    double ipd_m;
};

// Whether a trial has anything of this. Where not, a zeroed struct does, and no rays are needed.
bool targets_needed(const struct plan_trial *trial);
// False: out of memory; there are no targets then.
bool targets_prepare(struct targets *targets, const struct targets_desc *desc);
void targets_finish(struct targets *targets); // a zeroed one is fine
// Where a trial's camera is.
struct pose targets_head(const struct plan_trial *trial, const struct camera_path *path, double time_s);

// False where the frame's pictures have no target.
bool targets_fixation(const struct targets *targets, const struct machine_view *view,
                      struct fixation_place *out);
// What lies over this frame, at most `capacity` marks; returns how many.
uint32_t targets_marks(const struct targets *targets, const struct machine_view *view, const struct pose *head,
                       const struct targets_view *eyes, struct renderer_mark *out, uint32_t capacity);
// Where a sphere of a showing stands, as JSON: {"showing":0,"sphere":1,"of":9,"at":[x,y,z],"colour":"red",...}.
// False: too small, or there is no such sphere.
bool targets_sphere_json(const struct targets *targets, uint32_t showing, uint32_t sphere, char *out,
                         size_t out_size);

#endif
