// The machine's insides, shared by its two files: machine.c (screens and events) and stimulus.c (what a trial
// shows).
#ifndef STUDIES_ENGINE_MACHINE_STATE_H
#define STUDIES_ENGINE_MACHINE_STATE_H

#include "studies/engine/machine.h"

#define STIMULUS_NOT_YET INT64_MIN // a fade whose first frame is still to come

enum fade { FADE_NONE, FADE_IN, FADE_SWITCH };

struct stimulus {
    bool starting;          // the next frame is the attempt's first
    bool began_now;         // the last frame was
    int64_t start_ns;       // first frame
    int64_t full_ns;        // first full frame, -1 before it
    int64_t last_full_ns;   // latest full frame
    int64_t paused_ns;      // since start_ns, taken out of the camera's time
    int64_t paused_full_ns; // since full_ns, taken out of the reaction time
    int64_t camera_ns;      // the last frame's time on the path
    enum plan_slot slot;    // shown, and from FADE_SWITCH's middle on the new one
    enum plan_slot target;
    enum fade fade;
    int64_t fade_ns; // origin of the fade
    bool gray_shown;
    double level;
    bool seen[2];
    uint32_t toggles;
    bool exposed; // an exposure is open
    struct machine_record exposure;
};

struct machine {
    const struct plan *plan;
    bool *done;
    uint32_t *attempts;
    int64_t now_ns;
    bool clock_back;            // told already
    enum machine_screen screen; // below any pause or abort question
    int64_t since_ns;           // of CONFIRMATION and REST
    bool paused, asking;
    int64_t suspended_ns; // since when either
    bool complete;
    uint32_t trial;       // plan.trial_count: none left
    uint32_t shown_block; // block whose beginning was announced; UINT32_MAX: none
    const char *text;     // of INSTRUCTIONS
    int32_t last_value;
    struct stimulus stimulus;
    struct machine_record *records; // a queue from first to last
    uint32_t record_first, record_count, record_capacity;
};

struct machine_record *machine_push(struct machine *machine, enum machine_record_kind kind, int64_t at_ns);

uint32_t machine_next_trial(const struct machine *machine); // the first without an answer; trial_count: none
bool machine_may_go_on(const struct machine *machine);      // REST has lasted long enough

void stimulus_begin(struct machine *machine);
void stimulus_frame(struct machine *machine, int64_t now_ns);
void stimulus_toggle(struct machine *machine, int64_t now_ns);
void stimulus_close_exposure(struct machine *machine);
// After a pause: the option that was chosen last comes back out of the gray.
void stimulus_resume(struct machine *machine, int64_t paused_ns);
int64_t stimulus_reaction(const struct machine *machine, int64_t now_ns);

#endif
