// Mean and SD of values that come one by one (Welford 1962). A zeroed struct is empty.
#ifndef ANALYSIS_GAZE_RUNNING_H
#define ANALYSIS_GAZE_RUNNING_H

#include <stdint.h>

struct gaze_running {
    int64_t n;
    double mean, squares; // about the mean
};

void gaze_running_add(struct gaze_running *running, double value);
void gaze_running_join(struct gaze_running *to, const struct gaze_running *from);
double gaze_running_mean(const struct gaze_running *running); // NaN for no value
double gaze_running_sd(const struct gaze_running *running);   // n - 1; NaN for fewer than two

#endif
