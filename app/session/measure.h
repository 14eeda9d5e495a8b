// The image error of the options as shown, against the reference drawn for the same frames: what the simulated
// observer sees. Weighted by eccentricity (analysis/image/error.h), both eyes and all measured frames of a
// condition on a scene pooled.
//
// Use: measure_create -> measure_due and measure_take after each full frame -> measure_error.
// Does not: write to the store, show anything; frames drawn for it are no stimulus frames.
#ifndef APP_SESSION_MEASURE_H
#define APP_SESSION_MEASURE_H

#include "renderer/renderer.h"
#include "studies/engine/machine.h"

#include <stdbool.h>
#include <stdint.h>

#define MEASURE_METRIC "wrmse" // the store's measured_error.metric; 0 to 1 (black against white)

struct measure;
// scene_count scenes are told apart by the index the caller gives. NULL: out of memory.
struct measure *measure_create(uint32_t condition_count, uint32_t scene_count, uint32_t width, uint32_t height);
void measure_destroy(struct measure *measure); // NULL is fine

// Whether this full frame is one to measure: the 2nd, 4th and 6th of an option in a trial, then each 8th.
bool measure_due(struct measure *measure, const struct machine_view *view);
// The same of an option's full frames counted by the caller, from 1.
bool measure_at(uint64_t count);
// Draws the frame with the reference and adds the difference. False where drawing or reading failed.
bool measure_take(struct measure *measure, uint32_t condition, uint32_t scene, struct renderer_option *option,
                  struct renderer_option *reference, const struct frame *frame);
// The same for an option that a trial gives values of its own: kept for as long as trial, attempt and values
// stay.
bool measure_take_own(struct measure *measure, const struct mode_choice *values, struct renderer_option *option,
                      struct renderer_option *reference, const struct frame *frame);
// NaN where nothing was measured yet, or another attempt has begun since.
double measure_own_error(const struct measure *measure, const struct machine_view *view);
double measure_error(const struct measure *measure, uint32_t condition, uint32_t scene);

#endif
