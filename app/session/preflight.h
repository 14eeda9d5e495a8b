// Draws each option of a block along its path, before the block, to see which rate it holds: participants would
// judge judder instead of pictures.
//
// A frame's time is drawing, showing and, on a real display, waiting for it: measured by the real clock, also
// where the session's is simulated. What is shown meanwhile is gray with a text. Of an option that is played
// back the upload is measured, which is all it does while it is shown. An option of a staircase or an
// adjustment is drawn with the parameters that the protocol gives it.
//
// Use: preflight_block; results go into the store as events "preflight", JSON
// {"condition":1,"scene":"town","block":"one","frames":1000,"late":0.0,"p50_ms":..,"p95_ms":..,"p99_ms":..,"hz":90},
// hz the largest whole part of the refresh rate that the option holds, 0: none; and to the experimenter.
#ifndef APP_SESSION_PREFLIGHT_H
#define APP_SESSION_PREFLIGHT_H

#include "app/session/show.h"

// A thousand, so that PACE_LATE_MOST is one frame; of a slow option as many as PREFLIGHT_S gives, at least
// PREFLIGHT_LEAST. The first PREFLIGHT_WARM count for nothing: drivers compile and caches fill.
enum { PREFLIGHT_FRAMES = 1000, PREFLIGHT_LEAST = 30, PREFLIGHT_WARM = 5 };
#define PREFLIGHT_S 20.0

enum preflight_result {
    PREFLIGHT_PASSED,  // *out_divisor: of the refresh rate, the block's common rate; 1 unless it is paced
    PREFLIGHT_REFUSED, // a sentence in `error`, also where something failed
    PREFLIGHT_STOPPED, // somebody pressed Escape
    PREFLIGHT_CLOSED   // the window was closed
};

// Leaves the stage with other options than before; at_ns: the session's time.
enum preflight_result preflight_block(struct show *show, uint32_t block, int64_t at_ns, uint32_t *out_divisor,
                                      char *error, size_t error_size);

#endif
