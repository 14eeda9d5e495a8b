// One running session: protocol, store, renderer, display, gaze and answers joined frame by frame.
//
// While the study file or the events file cannot be written the session stands still ("please wait"), keeps the
// answer that waits, tries again and goes on when it can.
//
// Use: prepare everything in a struct session_desc (fovstudy run does) -> session_run until it returns.
// Without a display nothing is drawn: time goes by steps of step_hz and a simulated observer answers from
// `errors`. Does not: own what the desc points to, parse options, create the session's rows (the caller did).
#ifndef APP_SESSION_SESSION_H
#define APP_SESSION_SESSION_H

#include "app/display/display.h"
#include "app/gaze/gaze_source.h"
#include "app/session/desk.h"
#include "app/session/errors.h"
#include "app/session/event_lines.h"
#include "app/session/stage.h"
#include "studies/engine/observer.h"
#include "studies/store/store.h"

#include <stdbool.h>
#include <stddef.h>

enum session_preflight {
    SESSION_PREFLIGHT_REAL, // where the clock is not simulated
    SESSION_PREFLIGHT_ALWAYS,
    SESSION_PREFLIGHT_NEVER // logged as an event
};

struct session_desc {
    const struct plan *plan;
    struct store *store;
    const struct store_session_ids *ids; // with condition_ids and trial_ids
    int64_t reference_id;                // the condition that errors are measured against
    const struct machine_start *start;   // where a resumed session goes on; NULL: from the beginning
    int64_t origin_ns;                   // the display's clock at the segment's time 0
    struct event_lines *lines;

    struct display *display; // NULL: nothing is drawn, and renderer and stage are NULL too
    struct renderer *renderer;
    struct stage *stage;
    const struct stage_scene *scenes; // the stage's
    size_t scene_count;
    struct viewing_fov fov; // of each eye
    double ipd_m;

    struct gaze_source *gaze;                   // NULL: the fovea stays straight ahead
    const struct observer_parameters *observer; // NULL: a person answers by keyboard
    uint32_t observer_subject;                  // from observer_subject of the participant's code
    const struct errors *errors;                // the observer's, where nothing is drawn
    double step_hz;                             // where nothing is drawn

    // Called once per screen or trial, e.g. to print progress; NULL: not.
    void (*progress)(void *user, const struct machine_view *view);
    void *progress_user;
    // One sentence for the experimenter while the session runs, e.g. on a full disk; NULL: not.
    void (*say)(void *user, const char *sentence);
    void *say_user;
    struct desk *desk; // the experimenter's; NULL: none
    // Before each block its options are drawn to see whether they hold the refresh rate (preflight.h).
    enum session_preflight preflight;
    uint32_t preflight_frames; // of each option; 0: PREFLIGHT_FRAMES
    uint64_t playback_bytes;   // of memory for prerendered pictures; 0: half of what is free
    double patience_s;         // how long trouble with the disk may last before the session fails; 0: for ever
};

enum session_result {
    SESSION_COMPLETE,
    SESSION_ENDED, // by the participant, or without consent
    SESSION_FAILED // one sentence in `error`; every answer that was acknowledged is stored
};

enum session_result session_run(const struct session_desc *desc, char *error, size_t error_size);

#endif
