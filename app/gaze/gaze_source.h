// Where gaze samples come from: one interface, one table of kinds.
//
// Use: gaze_open("sim", &desc, ...) -> gaze_poll each frame until it returns 0 -> gaze_close.
// Does not: store samples, filter them or decide what the fovea follows. One thread.
// Adding a kind: a file with one `const struct gaze_kind` and one line in gaze_source.c.
#ifndef APP_GAZE_GAZE_SOURCE_H
#define APP_GAZE_GAZE_SOURCE_H

#include "stimuli/viewing.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { GAZE_BATCH = 64 }; // a good capacity for one gaze_poll

#define GAZE_SIMULATED_RATE_HZ 120.0 // a common rate of trackers in headsets (HTC Vive Pro Eye, FOVE: 120 Hz)

// What a source may need; each kind says which.
struct gaze_desc {
    uint64_t seed;      // sim
    double rate_hz;     // sim; 0: GAZE_SIMULATED_RATE_HZ
    double ipd_m;       // sim: the eyes converge on what they fixate; 0: parallel
    const char *detail; // what follows the colon: "replay:FILE"; NULL where nothing does
    // mouse: the cursor in pixels of the eye image it is over; false where it is over none. borrowed
    bool (*cursor)(void *user, double *out_x_px, double *out_y_px);
    void *cursor_user;
    struct viewing_fov fov; // mouse
    uint32_t width, height; // mouse, of one eye
};

struct gaze_source;

struct gaze_kind {
    const char *name;
    const char *description;
    // NULL with one sentence in `error`.
    struct gaze_source *(*create)(const struct gaze_desc *desc, char *error, size_t error_size);
    // Samples that arrived up to now_ns (since the segment's origin, never decreasing), oldest first.
    size_t (*poll)(struct gaze_source *source, int64_t now_ns, struct gaze_sample *out, size_t capacity);
    void (*destroy)(struct gaze_source *source);
};

// Each kind's source begins with this.
struct gaze_source {
    const struct gaze_kind *kind;
};

extern const struct gaze_kind *const gaze_kinds[]; // NULL-terminated
extern const struct gaze_kind gaze_mouse, gaze_simulated;

// "mouse", "sim" or "NAME:DETAIL". NULL with one sentence in `error`.
struct gaze_source *gaze_open(const char *spec, const struct gaze_desc *desc, char *error, size_t error_size);
size_t gaze_poll(struct gaze_source *source, int64_t now_ns, struct gaze_sample *out, size_t capacity);
void gaze_close(struct gaze_source *source); // NULL is fine

#endif
