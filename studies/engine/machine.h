// One session as a state machine: handed the time and the events, it says what is on screen and what to record.
//
// Use, once per frame:
//     machine_event(m, event_ns, &event)  for each key press, in order of time
//     machine_frame(m, frame_ns, &view)   decides what the frame shown at frame_ns contains; show it
//     while (machine_next_record(m, &record)) store it
// When a record is an answer (MACHINE_CHOICE, MACHINE_RATING, MACHINE_RESPONSES): commit it, write the event
// line, and only then send MACHINE_ANSWER_STORED; the next question, the confirmation and the next stimulus
// wait for that. Does not: read a clock, draw, write, know keys. Time is nanoseconds of the segment; a time
// before an earlier one counts as that earlier one (and is recorded once as MACHINE_CLOCK_BACK).
//
// A fade lasts from the last full frame of one option to the first full frame of the other; the option changes
// in the middle of the gray. Frames that come so late that none would be gray do not skip it: the next frame is
// gray and the way back starts there.
#ifndef STUDIES_ENGINE_MACHINE_H
#define STUDIES_ENGINE_MACHINE_H

#include "studies/engine/plan.h"
#include "studies/engine/staircase.h"

#include <stdbool.h>
#include <stdint.h>

// A trial is shown (STIMULUS), asked about (QUESTION, once for each of its asks that was not answered
// meanwhile), and confirmed. One that is flagged as bad or whose answer came too late is invalid and comes
// again after the plan.
//
// Trials are counted on: those of the plan, then the repetitions, each in its own place.

enum machine_screen {
    MACHINE_CONSENT,      // consent text; waits for YES (or NO, which ends the session)
    MACHINE_INSTRUCTIONS, // protocol.instructions, then each block's own; waits for START
    MACHINE_READY,        // before the first trial of a block; waits for START
    MACHINE_STIMULUS,     // view.slot with view.fade
    MACHINE_QUESTION,     // view.question; waits for RATE or CHOOSE
    MACHINE_STORING,      // an answer waits for ANSWER_STORED; gray
    MACHINE_CONFIRMATION, // "thank you", for confirm_ns
    MACHINE_REST,         // gray between trials, at least rest_ns, then START or by itself
    MACHINE_BREAK,        // the same, longer: the block's break_ns, then START
    MACHINE_PAUSED,       // waits for PAUSE or START
    MACHINE_ABORT,        // "really end?"; YES ends, NO goes back
    MACHINE_END           // complete or aborted
};
const char *machine_screen_name(enum machine_screen screen);

enum machine_event_kind {
    MACHINE_START, // go on; in a trial: to the question, or an adjustment is done
    MACHINE_TOGGLE_KEY,
    MACHINE_CHOOSE,      // value: PLAN_SLOT_A, PLAN_SLOT_B, or PLAN_SLOT_NONE for "equal"
    MACHINE_RATE,        // value: the rating or count
    MACHINE_ADJUST,      // value: steps of the current parameter, up or down
    MACHINE_ADJUST_NEXT, // value: that many parameters on or back
    MACHINE_YES,
    MACHINE_NO,
    MACHINE_PAUSE,
    MACHINE_FLAG, // the running trial, or the one just answered, is bad
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
    uint32_t trial_index;           // its place, counted on over repetitions
    uint32_t attempt;               // of that trial, from 1
    enum plan_slot slot;            // option to draw; NONE: no stimulus (full gray behind any text)
    int32_t condition;              // that option's index into plan.conditions, -1 for none
    double fade;                    // 0 the image, 1 gray; 1 means nothing need be rendered
    bool trial_started;             // this frame is the first of an attempt or of a showing (a camera cut)
    bool may_choose;        // STIMULUS: both options were seen long enough; REST, BREAK: START is taken now
    bool marker;            // between the two of a sequential trial: mark the middle
    uint32_t showing;       // sequential: 0 the first, 1 the second
    int64_t stimulus_ns;    // time on the trial's camera path: since its first frame, paused time taken out
    int64_t wait_ns;        // REST, BREAK: until START is taken
    double level;           // of a staircase's parameter in the running trial or the next; NaN: none
    const double *adjusted; // values of block.adjusts; NULL: not an adjust trial
    uint32_t adjusting;     // which one the keys change
    uint32_t adjust_count;  // how many the keys can change
    const char *text;       // consent, instructions or question text to show; NULL where the screen has none
    const struct protocol_question *question; // of QUESTION and of a toggle trial; else NULL
    enum plan_slot subject;                   // QUESTION: the option asked about; NONE: what was shown, or both
    bool may_go_on;                           // STIMULUS: START leads on
    int32_t last_value;                       // CONFIRMATION: the answer (slot or rating)
    uint32_t done, total;                     // trials answered and planned
    bool complete;                            // END: all were answered; false: aborted or no consent
};

enum machine_record_kind {
    MACHINE_CONSENT_GIVEN, // at_ns; before any trial
    MACHINE_CONSENT_REFUSED,
    MACHINE_TRIAL_STARTED,  // at_ns: the first frame of the attempt; level
    MACHINE_TRIAL_DONE,     // at_ns: the answer; comes right after the trial's last answer record
    MACHINE_TRIAL_INVALID,  // flagged or too late (late tells); `again` is the place where it comes again
    MACHINE_TRIAL_SKIPPED,  // its staircase has ended
    MACHINE_EXPOSURE,       // one stretch of one option
    MACHINE_TOGGLE,         // slot: the option it goes to
    MACHINE_TOGGLE_IGNORED, // during a fade
    MACHINE_CHOICE_EARLY,   // slot: a decision before both were seen long enough; not taken
    MACHINE_ADJUSTED,       // parameter, number: its value from now on
    MACHINE_CHOICE,         // an answer to store: slot (NONE: equal), correct, step
    MACHINE_RATING,         // an answer to store: question, slot (NONE: the scene), value, step
    MACHINE_RESPONSES,      // an answer to store: a count, or all values of an adjustment
    MACHINE_PAUSE_BEGAN,
    MACHINE_PAUSE_ENDED,
    MACHINE_ABORT_ASKED,
    MACHINE_ABORT_DECLINED,
    MACHINE_CLOCK_BACK, // value_ns: by how much
    MACHINE_ENDED       // complete
};
bool machine_is_answer(enum machine_record_kind kind);
const char *machine_record_name(enum machine_record_kind kind); // a word for event lines: "trial_started"

struct machine_record {
    enum machine_record_kind kind;
    int64_t at_ns;
    uint32_t trial; // place, counted on over repetitions; UINT32_MAX outside trials
    uint32_t attempt;
    enum plan_slot slot; // choice, rating, toggle, exposure
    // answers
    bool ends_trial; // the last one of its trial
    int32_t value;   // the rating or count
    const struct protocol_question *question;
    int32_t correct;     // choice: 1 right, 0 wrong, -1 a preference
    int32_t expected;    // count: the right one
    int64_t reaction_ns; // from when the answer could be given, pauses taken out
    uint32_t toggles;    // of this attempt, ignored ones not counted
    bool has_step;
    struct staircase_step step;
    // trial started (number_count: its values are an answer already), adjusted, responses of an adjustment
    double level;       // NaN: no staircase
    uint32_t parameter; // index into block.adjusts
    double numbers[PROTOCOL_ADJUSTED];
    uint32_t number_count; // 0: a count
    // exposure: frame times; first and last frame that showed any of it, and of those without fade (-1: none)
    int64_t start_ns, end_ns, full_start_ns, full_end_ns;
    int64_t value_ns;
    uint32_t again; // UINT32_MAX: nowhere
    bool late;
    bool complete;
};

// Where a session begins or goes on. Zeroed: a new one.
struct machine_start {
    bool consented;           // consent is already stored (resume): no consent screen, no record
    const bool *done;         // one per trial, repetitions too: nothing is left to do; NULL: none
    const uint32_t *attempts; // attempts each trial already had; NULL: none
    const uint32_t *answers;  // answers each trial already has; NULL: none
    const int32_t *outcomes;  // of staircase trials, -1: no answer; NULL: none
    const double (*adjusted)[PROTOCOL_ADJUSTED]; // that adjust trials have as an answer; NULL: none
    const uint32_t *repeats;                     // trials that come after the plan: which each repeats
    uint32_t repeat_count;
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
// When something passes by time alone: at the first frame at or after it. INT64_MIN: at the next frame, as
// within a fade; INT64_MAX: never, it waits for an event. Frames before it look as the last one did.
int64_t machine_next_ns(const struct machine *machine);
// What a slot of the running or next trial shows, a staircase's level and adjusted values in place. False:
// nothing.
bool machine_option(const struct machine *machine, enum plan_slot slot, struct protocol_option *out);
// The plan's trial at a place counted on over repetitions.
const struct plan_trial *machine_trial(const struct machine *machine, uint32_t place);
// A trial's answers in their order: question and subject of each; false: no more.
struct machine_ask {
    const struct protocol_question *question; // NULL: the values of an adjustment
    enum plan_slot subject;
};
bool machine_ask(const struct plan *plan, const struct plan_trial *trial, uint32_t index,
                 struct machine_ask *out);

#endif
