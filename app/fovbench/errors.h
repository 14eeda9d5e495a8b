// The errors of every mode of a line-up along its walk, against the first mode's picture of the same frame;
// with a supersampled reference, against that too.
//
// Use: errors_create -> after each frame was drawn, where errors_due, errors_take -> errors_result for each
// mode. Pictures are taken in pairs of neighbouring frames: the second of a pair is compared, and flicker is
// the change within the pair beyond the reference's own.
#ifndef APP_FOVBENCH_ERRORS_H
#define APP_FOVBENCH_ERRORS_H

#include "app/fovbench/lineup.h"
#include "app/fovbench/row.h"
#include "app/fovbench/supersample.h"

struct errors;

struct errors_desc {
    struct lineup *lineup;           // borrowed
    struct supersample *supersample; // borrowed; NULL: none
    const struct mode_choice *reference;
    const struct frame_eye *eye; // for the resolution in pixels per degree
    uint32_t width, height;
    uint64_t frames;              // that will be drawn
    uint64_t every;               // frames from one compared frame to the next, at least 1
    uint64_t supersampled_frames; // of those compared, spread evenly
};

struct errors *errors_create(const struct errors_desc *desc); // NULL after a sentence on stderr
void errors_destroy(struct errors *errors);                   // NULL is fine; before the line-up is finished

// Whether the n-th measured frame (from 0) is one of a pair.
bool errors_due(const struct errors *errors, uint64_t n);
// After the line-up drew `frame`, the n-th. The share of moving pixels, or NaN for the first of a pair. False
// after a sentence on stderr.
bool errors_take(struct errors *errors, const struct frame *frame, uint64_t n, double *out_moving_share);

// Fills the row's errors, rings and supersampled.
void errors_result(const struct errors *errors, size_t mode, struct row *row);

#endif
