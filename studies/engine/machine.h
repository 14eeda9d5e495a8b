// One session as a state machine: handed the time and the events, it says what is on screen and what to record.
//
// Use, once per frame:
//     machine_event(m, event_ns, &event)  for each key press, in order of time
//     machine_frame(m, frame_ns, &view)   decides what the frame shown at frame_ns contains; show it
//     while (machine_next_record(m, &record)) store it
// When a record is an answer (MACHINE_CHOICE, MACHINE_RATING): commit it, write the event line, and only then
// send MACHINE_ANSWER_STORED; the confirmation and the next stimulus wait for that. Does not: read a clock,
// draw, write, know keys. Time is nanoseconds of the segment; a time before an earlier one counts as that
// earlier one (and is recorded once as MACHINE_CLOCK_BACK).
//
// A fade lasts from the last full frame of one option to the first full frame of the other; the option changes
// in the middle of the gray. Frames that come so late that none would be gray do not skip it: the next frame is
// gray and the way back starts there.
#ifndef STUDIES_ENGINE_MACHINE_H
#define STUDIES_ENGINE_MACHINE_H

#include "studies/engine/plan.h"

#include <stdbool.h>
#include <stdint.h>

enum machine_screen {
    MACHINE_CONSENT,      // consent text; waits for YES (or NO, which ends the session)
    MACHINE_INSTRUCTIONS, // protocol.instructions, then each block's own; waits for START
    MACHINE_READY,        // before the first trial of a block; waits for START
    MACHINE_STIMULUS,     // view.slot with view.fade
    MACHINE_QUESTION,     // view.question; waits for RATE
    MACHINE_STORING,      // an answer waits for ANSWER_STORED; gray
    MACHINE_CONFIRMATION, // "thank you", for confirm_ns
    MACHINE_REST,         // gray between trials, at least rest_ns, then START or by itself
    MACHINE_PAUSED,       // waits for PAUSE or START
    MACHINE_ABORT,        // "really end?"; YES ends, NO goes back
    MACHINE_END           // complete or aborted
};
const char *machine_screen_name(enum machine_screen screen);

enum machine_event_kind {
    MACHINE_START,
    MACHINE_TOGGLE_KEY,
    MACHINE_CHOOSE, // value: PLAN_SLOT_A or PLAN_SLOT_B
    MACHINE_RATE,   // value: the rating
    MACHINE_YES,
    MACHINE_NO,
    MACHINE_PAUSE,
    MACHINE_ABORT_KEY,
    MACHINE_ANSWER_STORED
};

struct machine_event {
    enum machine_event_kind kind;
    int32_t value;
};

enum machine_phase { MACHINE_PHASE_STIMULUS, MACHINE_PHASE_FADE, MACHINE_PHASE_QUESTION, MACHINE_PHASE_REST };
const char *machine_phase_name(enum machine_phase phase); // as the store's frame.phase

// What is on screen.
struct machine_view {
    enum machine_screen screen;
    enum machine_phase phase;
    const struct plan_trial *trial; // the running or next one; NULL when none is left
    uint32_t trial_index;           // into plan.trials
    uint32_t attempt;               // of that trial, from 1
    enum plan_slot slot;            // option to draw; NONE: no stimulus (full gray behind any text)
    int32_t condition;              // that option's index into plan.conditions, -1 for none
    double fade;                    // 0 the image, 1 gray; 1 means nothing need be rendered
    bool trial_started;             // this frame is the first of an attempt (a camera cut)
    bool may_choose;                // STIMULUS: both options were seen fully; REST: START is taken now
    int64_t stimulus_ns; // time on the trial's camera path: since its first frame, paused time taken out
    const char *text;    // consent, instructions or question text to show; NULL where the screen has none
    const struct protocol_question *question; // of QUESTION and of a toggle trial; else NULL
    int32_t last_value;                       // CONFIRMATION: the answer (slot or rating)
    uint32_t done, total;                     // trials answered and planned
    bool complete;                            // END: all were answered; false: aborted or no consent
};

enum machine_record_kind {
    MACHINE_CONSENT_GIVEN, // at_ns; before any trial
    MACHINE_CONSENT_REFUSED,
    MACHINE_TRIAL_STARTED,  // at_ns: the first frame of the attempt
    MACHINE_TRIAL_DONE,     // at_ns: the answer; comes right after its answer record
    MACHINE_EXPOSURE,       // one stretch of one option
    MACHINE_TOGGLE,         // slot: the option it goes to
    MACHINE_TOGGLE_IGNORED, // during a fade
    MACHINE_CHOICE_EARLY,   // slot: a decision before both were seen; not taken
    MACHINE_CHOICE,         // an answer to store
    MACHINE_RATING,         // an answer to store
    MACHINE_PAUSE_BEGAN,
    MACHINE_PAUSE_ENDED,
    MACHINE_ABORT_ASKED,
    MACHINE_ABORT_DECLINED,
    MACHINE_CLOCK_BACK, // value_ns: by how much
    MACHINE_ENDED       // complete
};
const char *machine_record_name(enum machine_record_kind kind); // a word for event lines: "trial_started"

struct machine_record {
    enum machine_record_kind kind;
    int64_t at_ns;
    uint32_t trial; // index into plan.trials; UINT32_MAX outside trials
    uint32_t attempt;
    enum plan_slot slot; // choice, toggle, exposure
    // choice and rating
    int32_t value;       // the rating
    int64_t reaction_ns; // from the first full frame of the attempt, pauses taken out
    uint32_t toggles;    // of this attempt, ignored ones not counted
    // exposure: frame times; first and last frame that showed any of it, and of those without fade (-1: none)
    int64_t start_ns, end_ns, full_start_ns, full_end_ns;
    int64_t value_ns;
    bool complete;
};

// Where a session begins or goes on. Zeroed: a new one.
struct machine_start {
    bool consented;           // consent is already stored (resume): no consent screen, no record
    const bool *done;         // one per plan trial: already answered; NULL: none
    const uint32_t *attempts; // attempts each trial already had; NULL: none
};

struct machine;
// The plan must outlive the machine. NULL: out of memory.
struct machine *machine_create(const struct plan *plan, const struct machine_start *start);
void machine_destroy(struct machine *machine); // NULL is fine

void machine_event(struct machine *machine, int64_t now_ns, const struct machine_event *event);
void machine_frame(struct machine *machine, int64_t now_ns, struct machine_view *out_view);
// The view as the last frame left it, without a new one; screen and trial already follow later events.
void machine_look(const struct machine *machine, struct machine_view *out_view);
bool machine_next_record(struct machine *machine, struct machine_record *out_record); // false: none waits

#endif
