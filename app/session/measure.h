// The image error of the options as shown, against the reference drawn for the same frames: what the simulated
// observer sees. Weighted by eccentricity (analysis/image/error.h), both eyes and all measured frames pooled by
// what was drawn (mode and every parameter, so that each level of a staircase has its own), scene, and metric.
//
// Use: measure_create -> measure_due and measure_take after each full frame -> measure_error.
// Does not: write to the store, show anything; frames drawn for it are no stimulus frames.
#ifndef APP_SESSION_MEASURE_H
#define APP_SESSION_MEASURE_H

#include "renderer/renderer.h"
#include "studies/engine/machine.h"

#include <stdbool.h>
#include <stdint.h>

// The store's measured_error.metric: "wrmse", 0 to 1 (black against white), and the settings of rendering that
// are not at their defaults, since they make another picture: "wrmse;ssao=on;taa=on".
enum { MEASURE_METRIC = 192 };
void measure_metric(const struct protocol *protocol, const struct protocol_settings *settings,
                    char out[MEASURE_METRIC]);

// What errors are pooled over.
struct measure_key {
    int64_t condition_id; // the store's
    uint32_t scene;       // an index of the caller's
    char metric[MEASURE_METRIC];
};

struct measure;
struct measure *measure_create(uint32_t width, uint32_t height); // NULL: out of memory
void measure_destroy(struct measure *measure);                   // NULL is fine

// Whether this full frame is one to measure: the 2nd, 4th and 6th of a condition in a trial, then each 8th.
bool measure_due(struct measure *measure, const struct machine_view *view, int64_t condition_id);
// The same of an option's full frames counted by the caller, from 1.
bool measure_at(uint64_t count);
// Draws the frame with the reference and adds the difference. False where memory, drawing or reading failed.
bool measure_take(struct measure *measure, const struct measure_key *key, struct renderer_option *option,
                  struct renderer_option *reference, const struct frame *frame);
// NaN where nothing was measured yet.
double measure_error(const struct measure *measure, const struct measure_key *key);
// The next key that was measured since it was last taken here, with its error. False: none.
bool measure_next_changed(struct measure *measure, struct measure_key *out_key, double *out_error);
void measure_not_stored(struct measure *measure, const struct measure_key *key); // gives it back

#endif
