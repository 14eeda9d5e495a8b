// Measures the image error of one condition on one scene outside the trials: a stretch of the scene's path with
// scripted gaze, each option's frames against the reference's. Nothing is shown or logged.
#ifndef APP_SESSION_PROBE_H
#define APP_SESSION_PROBE_H

#include "app/session/measure.h"
#include "app/session/session.h"

// Adds to `measure`. False with a sentence.
bool probe(const struct session_desc *desc, struct measure *measure, uint32_t condition, uint32_t scene,
           char *error, size_t error_size);

#endif
