// What fovstats gaze said of s.db in the working folder, a study that gaze_study wrote.
#ifndef TESTS_ANALYSIS_GAZE_SAID_H
#define TESTS_ANALYSIS_GAZE_SAID_H

#include "program.h"

// One person, as gaze_study takes its numbers.
void gaze_said_make(const char *trials, const char *seconds, const char *gaze_hz, const char *frame_hz);
// fovstats gaze s.db --simulated OPTION; fails the test where that fails.
struct program_result gaze_said(const char *option);
void gaze_said_part(const char *option, const char *part); // it says `part`

// The number after the first "key": that follows the first `after` in a JSON text; NaN for null.
double gaze_said_after(const char *json, const char *after, const char *key);
// That of the first person's first eye.
double gaze_said_number(const struct program_result *r, const char *key);
void gaze_said_close(double value, double expected, double within);

#endif
