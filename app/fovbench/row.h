// One line of what a run says: a mode with its parameters on a scene, at a size, with a gaze. Plain data that
// the table, the CSV, the JSON and the figure are written from.
#ifndef APP_FOVBENCH_ROW_H
#define APP_FOVBENCH_ROW_H

#include "app/fovbench/series.h"

#include <stdbool.h>
#include <stdint.h>

enum { ROW_RINGS = 4 }; // 0-5, 5-15, 15-30 and over 30 deg of eccentricity

// NaN where a measure was not taken; psnr_db and wpsnr_db are infinite for equal pictures.
struct row_error {
    double psnr_db, ssim, flip, wpsnr_db;
    double flicker_excess; // levels of 0..255
};

struct row_pass {
    const char *name; // constant string
    double median_ms;
};

struct row {
    char device[256], driver[528];
    const char *scene;      // borrowed
    const char *label;      // the mode as the command line had it, borrowed
    const char *mode;       // borrowed
    char parameters[512];   // JSON, every parameter resolved
    const char *gaze;       // borrowed
    uint32_t width, height; // pixels per eye
    bool ssao, taa, rest;
    uint64_t frames;
    struct series_times times;
    struct series_ratio ratio; // regular / this
    struct series_work work;
    double memory_mb; // of the mode's own targets and buffers, 1e6 bytes
    uint64_t error_frames;
    struct row_error error, rings[ROW_RINGS];
    double flicker_still;         // of 255
    uint32_t supersampled_factor; // per axis; 0: not compared
    uint64_t supersampled_frames;
    struct row_error supersampled; // against regular at factor^2 samples
    struct row_pass passes[FRAME_TIMERS];
    uint32_t pass_count;
    const char *pass_source; // constant string, how they were timed; NULL: they were not
};

#endif
