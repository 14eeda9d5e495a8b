// What a trial shows: its scene on the GPU, its two options and its targets, made ready before the trial
// starts.
//
// Use: stage_create -> stage_prepare while the trial before it rests -> stage_adjust, stage_option, stage_frame
//      per frame
//      -> stage_destroy before the renderer. Each scene is uploaded once and stays while there is room.
// Does not: decide what is shown, present frames, keep time.
#ifndef APP_SESSION_STAGE_H
#define APP_SESSION_STAGE_H

#include "app/gaze/fovea.h"
#include "app/session/targets.h"
#include "renderer/renderer.h"
#include "studies/engine/machine.h"

#include <stdbool.h>
#include <stddef.h>

enum {
    STAGE_RESIDENT = 3,   // scenes on the GPU at once
    STAGE_EFFECTIVE = 256 // bytes of stage_effective's JSON
};

struct stage_scene {
    const char *name;    // as the protocol names it; borrowed
    const char *spec;    // what is shown for it: a built-in scene with parameters or a file; borrowed
    struct scene *scene; // borrowed
    struct renderer_scene *resident; // NULL: not on the GPU
    uint64_t used;                   // when, for choosing what leaves
    struct ray_scene *rays;          // the stage's; NULL: not needed yet
};

struct stage_desc {
    struct renderer *renderer;  // borrowed
    const struct plan *plan;    // borrowed
    struct stage_scene *scenes; // borrowed; name, spec and scene filled in, the rest zero
    size_t scene_count;
    struct viewing_fov fov; // of each eye
    double ipd_m;
    const struct mode_choice *reference; // copied; made for each trial, to measure against; NULL: not
    // Indices of the protocol's settings that let objects move and switch ambient occlusion and temporal
    // antialiasing on; -1: never.
    int moving_setting, ssao_setting, taa_setting;
};

struct stage;
struct stage *stage_create(const struct stage_desc *desc); // NULL: out of memory
void stage_destroy(struct stage *stage);                   // NULL is fine

// The options and targets of the view's trial, that is to come or runs; nothing where they are ready already.
// False with a sentence.
bool stage_prepare(struct stage *stage, const struct machine_view *view, char *error, size_t error_size);
// Gives the option under test the values it has in this frame. Values that contradict each other leave it as it
// was; stage_effective tells.
void stage_adjust(struct stage *stage, const struct machine_view *view);
// What an option is drawn with now; NULL: no such option.
const struct mode_choice *stage_now(const struct stage *stage, enum plan_slot slot);
// Where that differs from its condition, JSON ({"epsilon":0.13}), valid until the next change; else NULL.
const char *stage_effective(const struct stage *stage, enum plan_slot slot);
const struct targets *stage_targets(const struct stage *stage); // of the prepared trial
// One option on one scene, in slot a, with the reference: for measuring outside trials.
bool stage_prepare_option(struct stage *stage, const struct protocol_option *option,
                          const struct protocol_settings *settings, size_t scene, char *error,
                          size_t error_size);
struct renderer_option *stage_option(struct stage *stage, enum plan_slot slot); // NULL: none
struct renderer_option *stage_reference(struct stage *stage);                   // NULL: none

// One frame's inputs for the prepared trial.
struct frame stage_frame(const struct stage *stage, const struct machine_view *view, uint64_t number,
                         const struct fovea_use *fovea, struct pose *out_head);

// The option a condition of the plan stands for. False: the mode is unknown (the protocol was checked, so
// never).
bool stage_choice(const struct plan_condition *condition, struct mode_choice *out);

#endif
