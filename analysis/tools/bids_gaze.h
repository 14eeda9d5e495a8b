// The two halves of the gaze's export: rows (bids_gaze.c) and what describes them (bids_recording.c).
#ifndef ANALYSIS_TOOLS_BIDS_GAZE_H
#define ANALYSIS_TOOLS_BIDS_GAZE_H

#include "analysis/gaze/track.h"
#include "analysis/tools/bids_private.h"

enum { BIDS_EYES = 3 }; // left, right, one direction for both

enum gaze_column {
    GAZE_SEGMENT,
    GAZE_TRIAL,
    GAZE_ATTEMPT,
    GAZE_DEVICE,
    GAZE_HOST,
    GAZE_EYE,
    GAZE_X,
    GAZE_Y,
    GAZE_PUPIL,
    GAZE_VALID,
    GAZE_CONFIDENCE,
    GAZE_COLUMNS
};

struct bids_recording { // an eye in a run
    struct gaze_quality quality;
    int64_t samples, events;
    int64_t start_ns; // when the first sample arrived, on the run's clock
};

void bids_recording_name(const struct bids *bids, size_t run, size_t eye, const char *suffix,
                         char out[BIDS_PATH_SIZE]);
// The JSON files of a recording and of its events, where it has any.
bool bids_describe_recording(struct bids *bids, size_t run, size_t eye, const struct bids_recording *recording,
                             double frequency_hz);

#endif
