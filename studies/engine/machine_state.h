// The machine's insides, shared by its files: machine.c (screens and events), course.c (which trial, which
// question), stimulus.c (what a trial shows), view.c.
#ifndef STUDIES_ENGINE_MACHINE_STATE_H
#define STUDIES_ENGINE_MACHINE_STATE_H

#include "studies/engine/machine.h"

#define STIMULUS_NOT_YET INT64_MIN // a fade whose first frame is still to come

enum fade { FADE_NONE, FADE_IN, FADE_SWITCH, FADE_OUT, FADE_GAP };

struct stimulus {
    bool starting;          // the next frame is the attempt's first
    bool began_now;         // the last frame was, or the first of a showing
    int64_t start_ns;       // first frame of the attempt, or of the second showing
    int64_t full_ns;        // first full frame since, -1 before it
    int64_t last_full_ns;   // latest full frame
    int64_t last_frame_ns;  // latest frame, full or not
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
    int64_t seen_ns[2]; // full, over the attempt
    uint32_t showing;
    bool shown; // a sequential trial's second showing is over
    uint32_t toggles;
    bool exposed; // an exposure is open
    struct machine_record exposure;
};

// One staircase: a cell of a staircase block.
struct course_staircase {
    uint32_t block, cell;
    struct staircase *staircase;
};

struct machine {
    const struct plan *plan;
    // one per place
    bool *done;
    uint32_t *attempts, *answers;
    uint32_t *repeats; // the plan's trial at each place after the plan's
    uint32_t repeat_count, capacity;
    struct course_staircase *staircases;
    uint32_t staircase_count;
    int64_t now_ns;
    bool clock_back;            // told already
    enum machine_screen screen; // below any pause or abort question
    int64_t since_ns;           // of CONFIRMATION, REST and BREAK
    int64_t asked_ns;           // of QUESTION: when the answer could be given, pauses taken out
    bool paused, asking;
    int64_t suspended_ns; // since when either
    bool complete;
    uint32_t trial;       // place; the count of places: none left
    uint32_t last_trial;  // answered last, for its flag; UINT32_MAX: none
    uint32_t shown_block; // block whose beginning was announced; UINT32_MAX: none
    uint32_t broken;      // place before which a break was taken; UINT32_MAX: none
    const char *text;     // of INSTRUCTIONS
    int32_t last_value;
    double level; // of the running trial's staircase; NaN: none
    double adjusted[PROTOCOL_ADJUSTED];
    uint32_t adjusting;
    struct stimulus stimulus;
    struct machine_record *records; // a queue from first to last
    uint32_t record_first, record_count, record_capacity;
};

struct machine_record *machine_push(struct machine *machine, enum machine_record_kind kind, int64_t at_ns);
const struct plan_trial *machine_running(const struct machine *machine);
const struct protocol_block *machine_block(const struct machine *machine);
void machine_end(struct machine *machine, bool complete);
bool machine_may_go_on(const struct machine *machine); // REST or BREAK has lasted long enough
int64_t machine_rest_ns(const struct machine *machine);

// course.c
uint32_t course_places(const struct machine *machine);
bool course_create(struct machine *machine, const struct machine_start *start);
void course_destroy(struct machine *machine);
uint32_t course_next(const struct machine *machine); // the first place that is not done; course_places: none
void course_begin(struct machine *machine);          // the trial at machine.trial
double course_level(const struct machine *machine,
                    uint32_t place); // of its staircase, if it came now; NaN: none
// Towards the first trial that is left: its block's beginning where that is new, a break where one is due, else
// REST.
void course_go_on(struct machine *machine, enum machine_screen same_block);
void course_ask(struct machine *machine); // the stimulus is over: the next question, or the trial is done
void course_answer(struct machine *machine, enum machine_record_kind kind, int32_t value);
void course_stored(struct machine *machine);
void course_invalid(struct machine *machine, uint32_t place, bool late);

void stimulus_begin(struct machine *machine);
void stimulus_frame(struct machine *machine, int64_t now_ns);
void stimulus_toggle(struct machine *machine, int64_t now_ns);
void stimulus_close_exposure(struct machine *machine);
// After a pause: the option that was chosen last comes back out of the gray.
void stimulus_resume(struct machine *machine, int64_t paused_ns);
int64_t stimulus_reaction(const struct machine *machine, int64_t now_ns);
bool stimulus_seen(const struct machine *machine);                      // all options, each long enough
bool stimulus_timed_out(const struct machine *machine, int64_t now_ns); // its time is over

#endif
