// Draws one frame of the session, shows it and logs it.
#ifndef APP_SESSION_SHOW_H
#define APP_SESSION_SHOW_H

#include "app/session/measure.h"
#include "app/session/overlay.h"
#include "app/session/pace.h"
#include "app/session/playback.h"
#include "app/session/record.h"
#include "app/session/session.h"

struct show {
    const struct session_desc *desc;
    struct overlay overlay;
    struct measure *measure;   // NULL: errors are not measured
    struct playback *playback; // owned; NULL: nothing is prerendered
    struct pace pace;
    uint64_t number;                 // of the next frame
    bool gaze_lost;                  // at the last frame that was drawn
    double frame_ms;                 // from the frame before to this one, as shown; NaN for the first
    bool late;                       // this one
    struct protocol_option adjusted; // the latest that errors were asked of
    int64_t adjusted_id;             // its condition, 0: none
};

// False: out of memory.
bool show_init(struct show *show, const struct session_desc *desc);
void show_finish(struct show *show);
// At the end of a segment, an event of how many frames were submitted: the rows of `frame` are held against it,
// and a segment without it did not end by itself.
void show_tell_submitted(const struct show *show);

// False with a sentence. `recorder` says which trial runs.
bool show_frame(struct show *show, const struct machine_view *view, const struct screen_state *state,
                const struct fovea *fovea, const struct recorder *recorder, int64_t start_ns, char *error,
                size_t error_size);

// Where the fovea is in a frame that foveates a target; false: it does not, or there is none.
bool show_target_fovea(const struct show *show, const struct machine_view *view, struct fovea_use *out);
// As a frame of nothing but text, without a row of its own: for what the session waits for.
bool show_text(struct show *show, const struct screen *screen);

// What the measured frames say about the options of the running trial, as they are now: a staircase's level,
// adjusted values. 0 where nothing was measured.
struct observer_errors show_errors(struct show *show, const struct machine_view *view,
                                   const struct recorder *recorder);
// Writes the errors that were measured since it was last called into the store.
bool show_store_errors(struct show *show, char *error, size_t error_size);
// Measures and stores what this participant did not see, since those who answer without frames may get it.
bool show_measure_rest(struct show *show, char *error, size_t error_size);

#endif
