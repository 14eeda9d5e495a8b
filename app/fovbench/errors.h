// The errors of every mode of a line-up along its walk, against the first mode's picture of the same frame.
//
// Use: errors_create -> errors_due before each frame is drawn; after it was drawn errors_take where it is due
// ->
//      errors_result for each mode.
// Pictures are taken in pairs of neighbouring frames: the second of a pair is compared, and flicker is the
// change within the pair beyond the reference's own.
#ifndef APP_FOVBENCH_ERRORS_H
#define APP_FOVBENCH_ERRORS_H

#include "app/fovbench/lineup.h"
#include "app/fovbench/row.h"

struct errors;

struct errors_desc {
    struct lineup *lineup; // borrowed
    uint32_t width, height;
    uint64_t every; // frames from one compared frame to the next, at least 2
};

struct errors *errors_create(const struct errors_desc *desc); // NULL after a sentence on stderr
void errors_destroy(struct errors *errors);                   // NULL is fine

// Whether the n-th measured frame (from 0) is one of a pair.
bool errors_due(const struct errors *errors, uint64_t n);
// After the line-up drew `frame`, the n-th. False after a sentence on stderr.
bool errors_take(struct errors *errors, const struct frame *frame, uint64_t n);

uint64_t errors_frames(const struct errors *errors); // compared so far
void errors_result(const struct errors *errors, size_t mode, struct row_error *out,
                   struct row_error out_rings[ROW_RINGS]);

#endif
