// The measured frames of one mode, and what is said about them.
//
// Quantiles are analysis/stats' (type 7 of Hyndman & Fan); counts of work are means over the frames.
#ifndef APP_FOVBENCH_SERIES_H
#define APP_FOVBENCH_SERIES_H

#include "renderer/frame.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct sample {
    double gpu_ms, cpu_ms;
    uint64_t shaded_px, triangles, frustum_triangles, submodels, frustum_submodels;
    enum frame_redraw redraw;
    double moving_share; // of the pixels of both eyes, NaN where it was not measured
};

struct series {
    struct sample *samples; // owned
    size_t count, capacity;
};

bool series_init(struct series *series, size_t capacity); // false: no memory
void series_finish(struct series *series);
void series_add(struct series *series, const struct frame_stats *stats); // at most `capacity` times

struct series_times {
    double gpu_ms_median, gpu_ms_p95, gpu_ms_p99, cpu_ms_median;
};

struct series_work { // means over the frames
    double shaded_px, triangles, frustum_triangles, submodels, frustum_submodels;
    double moving_share; // over the frames that have it; NaN for none
    uint64_t redraws[FRAME_REDRAW_CAUSES];
};

bool series_times(const struct series *series, struct series_times *out); // false: no memory
void series_work(const struct series *series, struct series_work *out);

// How many times as long as `own` the reference took on the same frames: the median of the frames' ratios, and
// an interval that holds the true median with at least 95 %, from the order statistics under the binomial
// distribution (David & Nagaraja 2003, Order Statistics, 7.1). It takes frames as independent, which neighbours
// are not quite. Low and high are NaN for fewer than 6 frames.
struct series_ratio {
    double median, low, high;
};

bool series_ratio(const struct series *reference, const struct series *own, struct series_ratio *out);
struct series_ratio series_median_interval(const double *sorted, size_t count);

// Times by name of pass, one for each frame; a pass that a frame left out took no time in it.
struct pass_series {
    const char *names[FRAME_TIMERS];
    double *ms; // owned, [pass][capacity]
    size_t pass_count, count, capacity;
};

bool pass_series_init(struct pass_series *passes, size_t capacity); // false: no memory
void pass_series_finish(struct pass_series *passes);
void pass_series_add(struct pass_series *passes, const struct frame_stats *stats);
double pass_series_median_ms(struct pass_series *passes,
                             size_t pass); // sorts the pass's times; NaN for no frame

#endif
