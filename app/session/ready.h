// What must be ready before a trial beyond its options on the stage: its block's preflight, its prerendered
// pictures. Also says at which rate its pictures follow each other.
//
// Use: a zeroed struct ready; before each frame on whose screen a trial is to come, ready_make. It draws for as
// long as the participant would otherwise see a trial that is not ready, else a little at a time while they
// read.
#ifndef APP_SESSION_READY_H
#define APP_SESSION_READY_H

#include "app/session/show.h"

struct ready {
    uint32_t divisors[PROTOCOL_BLOCKS]; // of the refresh rate, the rate of each block; 0: no preflight yet
    bool warned;                        // that there is none
    bool done;                          // all is ready for this attempt:
    uint32_t trial, attempt;
};

enum ready_result {
    READY_DONE,
    READY_LATER,   // some is left to do, and the participant can go on reading
    READY_STOPPED, // Escape was pressed; what is left is done when it is asked for again
    READY_CLOSED,  // the window was closed
    READY_FAILED   // a sentence in `error`
};

// at_ns: the session's time.
enum ready_result ready_make(struct ready *ready, struct show *show, const struct machine_view *view,
                             int64_t at_ns, char *error, size_t error_size);

#endif
