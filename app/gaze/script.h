// A gaze written down in advance: fixations and saccades for stills and measurements (`--gaze script`).
#ifndef APP_GAZE_SCRIPT_H
#define APP_GAZE_SCRIPT_H

#include <stdint.h>

// Where both eyes look at a time: degrees in the head's frame, right and up positive, within +-20 and +-15
// degrees. Pure: the same seed and time give the same angles. No drift and no blinks, so that two runs compare
// frame by frame.
void gaze_script(uint64_t seed, double time_s, double *out_x_deg, double *out_y_deg);

#endif
