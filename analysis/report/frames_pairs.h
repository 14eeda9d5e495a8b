// The test option's frames against the reference's, trial by trial.
//
// In each trial that drew both, the median time of the test option's full frames (phase 'stimulus') less that
// of the reference's, their ratio, and the difference of the shares of late frames. A trial counts once,
// however many frames it has; a person's trials are averaged (ratios by their logarithms), and the interval is
// Student's t over people, whose trials belong together. Times are the GPU's, of trials without them the CPU's,
// of both options alike. Practice and excluded trials are left out.
#ifndef ANALYSIS_REPORT_FRAMES_PAIRS_H
#define ANALYSIS_REPORT_FRAMES_PAIRS_H

#include "analysis/report/sample.h"
#include "analysis/stats/ttest.h"

enum frames_measure { FRAMES_GPU, FRAMES_CPU, FRAMES_MEASURES };

// Over the people who have a trial in which it is known: a display may not tell its rate, a time may be 0.
struct frames_mean {
    size_t people;
    double mean;         // NaN for nobody
    struct stat_ttest t; // its interval is NaN for fewer than two people, or where all have the same value
};

struct frames_pair {
    size_t test, reference; // conditions
    enum frames_measure measure;
    size_t trials, people;
    struct frames_mean difference_ms, log_ratio, late; // late: of shares
};

struct frames_pairs {
    size_t count;
    struct frames_pair *pairs;
    bool simulated_clock; // of any frame: late frames are then that clock's
};

// frames_load fills them.
void frames_pairs_free(struct frames_pairs *pairs);

#endif
