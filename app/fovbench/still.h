// Flicker while camera, gaze and objects stand still: how much more each pixel varies in time than in the
// reference.
#ifndef APP_FOVBENCH_STILL_H
#define APP_FOVBENCH_STILL_H

#include "app/fovbench/lineup.h"

// Draws every mode beside the first for as many frames as a block has, after those that are not measured, at
// the walk's start and with the gaze of its first frame. As many modes at once as fit into STILL_BYTES.
// out_flicker: one for each mode, in levels of 0..255 of linear luminance. False after a sentence on stderr.
bool still_measure(struct lineup *lineup, const struct walk *walk, const struct scene *scene, uint64_t frames,
                   const char *progress_name, double *out_flicker);

#define STILL_BYTES (512.0 * 1024 * 1024)

#endif
