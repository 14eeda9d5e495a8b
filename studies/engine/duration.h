// How long a participant's session is expected to take: what the protocol fixes, and for what the participant
// paces the medians of a simulated observer. Does not: know loading times, or how long people read.
#ifndef STUDIES_ENGINE_DURATION_H
#define STUDIES_ENGINE_DURATION_H

#include "studies/engine/observer.h"
#include "studies/engine/plan.h"

// Seconds. A staircase counts all the trials that it may take.
struct duration {
    double looking; // at full images
    double fading;  // and gray between the two of a sequential trial
    double answers; // questions on screens of their own
    double screens; // consent, instructions, "begin", "answer stored"
    double resting; // rests and breaks
    double total;
};

void duration_of(const struct plan *plan, const struct observer_parameters *pace, struct duration *out);

#endif
