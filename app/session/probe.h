// Measures the image error of what a session did not show, outside trials: a second of the scene's path with
// scripted gaze, like a look at it in a session.
#ifndef APP_SESSION_PROBE_H
#define APP_SESSION_PROBE_H

#include "app/session/measure.h"
#include "app/session/session.h"

// Each option of the plan with the settings of its trials on each scene; of a staircase and an adjustment both
// ends and the middle of its parameters, from which others interpolate. Only what `measure` does not hold yet;
// the reference's error, 0, goes to the store at once. False with a sentence.
bool probe_rest(const struct session_desc *desc, struct measure *measure, char *error, size_t error_size);

#endif
