// The values that a trial gives its option under test: a staircase's level, or what the participant has set.
//
// Use: live_choice on the condition's choice -> draw with it -> live_effective says what differs.
#ifndef APP_SESSION_LIVE_H
#define APP_SESSION_LIVE_H

#include "renderer/mode.h"
#include "studies/engine/plan.h"

#include <stdbool.h>
#include <stddef.h>

// Whether the participant changes the option under test while looking at it.
bool live_adjusts(const struct plan_trial *trial);
// Changes the values of the option in a slot, where it is the one under test. level: NaN: none; adjusted: one
// per entry of block.adjusts, NULL: none.
void live_choice(const struct protocol *protocol, const struct plan_trial *trial, enum plan_slot slot,
                 double level, const double *adjusted, struct mode_choice *choice);
bool live_same(const struct mode_choice *a, const struct mode_choice *b);
// What differs from the condition as JSON, {"epsilon":0.13}. False: nothing does, or it does not fit.
bool live_effective(const struct mode_choice *condition, const struct mode_choice *now, char *out,
                    size_t out_size);

#endif
