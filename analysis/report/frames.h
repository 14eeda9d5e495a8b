// How long frames took, by what was rendered and in which phase.
//
// GPU and CPU time are those the session measured; the interval is the time between the starts of two frames
// with successive numbers of one segment, counted to the later one. With a simulated clock the interval is that
// clock's and says nothing of the machine. Quantiles are of type 7 (quantile.h).
#ifndef ANALYSIS_REPORT_FRAMES_H
#define ANALYSIS_REPORT_FRAMES_H

#include "analysis/report/frames_pairs.h"

struct frame_times {
    size_t count; // frames with a value
    double *values;
    double median, p95, p99; // ms; NaN where count is 0
};

struct frame_group {
    size_t condition;  // SAMPLE_NONE: gray and text
    const char *label; // of the condition, "gray or text" for none
    const char *phase;
    int64_t frames, late, late_known; // late_known: frames whose display told its refresh rate
    struct frame_times gpu, cpu, interval;
    double shaded_px_mean; // NaN where not known
    double shaded_px_sum;
    int64_t shaded_frames;
};

struct frames {
    size_t group_count;
    struct frame_group *groups; // stimulus first, then by label: words rising, numbers falling
    int64_t frames, late, late_known;
    bool simulated_clock; // of any frame
};

// One pass over the frames for both. Where it fails, both are empty.
bool frames_load(struct frames *out, struct frames_pairs *pairs, struct sample *sample, double conf,
                 char *error, size_t error_size);
void frames_free(struct frames *frames);

#endif
