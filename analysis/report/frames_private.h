// Shared by frames.c and frames_pairs.c only: pairs are made of the frames that frames.c reads, as they arrive.
#ifndef ANALYSIS_REPORT_FRAMES_PRIVATE_H
#define ANALYSIS_REPORT_FRAMES_PRIVATE_H

#include "analysis/report/frames_pairs.h"

// A trial that shows two options: 0 the test option, 1 the reference.
struct frames_trial {
    int64_t id, attempt, condition_id[2];
    size_t person, test, reference;
};

struct frames_arriving { // of one trial
    double *ms[2][FRAMES_MEASURES];
    size_t count[2][FRAMES_MEASURES];
    size_t frames[2], late[2];
    bool late_known;
};

struct frames_value { // one per trial
    size_t person, test, reference;
    enum frames_measure measure;
    double values[3]; // difference in ms, log ratio, late; NaN where not known
};

struct frames_pairing { // zero but for the sample at first
    struct sample *sample;
    size_t file;
    struct frames_trial *trials; // of the file, by id
    size_t trial_count;
    const struct frames_trial *trial; // whose frames arrive
    struct frames_arriving times;
    struct frames_value *values;
    size_t value_count;
    bool simulated_clock;
};

// Each: false where memory ran out, or the reader failed. A file's frames in the order of their ids.
bool frames_pairing_begin(struct frames_pairing *pairing, size_t file);
bool frames_pairing_frame(struct frames_pairing *pairing, const struct store_frame_row *row);
bool frames_pairing_end(struct frames_pairing *pairing); // of the file; always called, frees its trials
bool frames_pairing_finish(struct frames_pairing *pairing, struct frames_pairs *out, double conf); // frees all

#endif
