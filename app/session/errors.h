// The image error of each option on each scene, for a simulated observer that sees no frames: from the study
// file, where an earlier session measured it, else from a file.
//
// The file is text, one line per option and scene: SCENE[;SETTING=VALUE...],ERROR,MODE[:p=v,...] (the option is
// the rest of the line; empty lines and lines that begin with # are skipped). Settings of rendering that are
// not at their defaults make another picture, and follow the scene in the order of `fovstudy check`'s settings:
// "town;ssao=on;taa=on". ERROR is what measured_error holds: eccentricity-weighted RMSE against the protocol's
// reference, 0 to 1 (black against white). The reference itself has 0.
//
// What was never measured, a level of a staircase or an adjusted value, lies on the straight line between the
// nearest known errors of options that differ in that parameter alone, and beyond the last one stays there.
// Where several parameters are adjusted, their effects add up.
//
// Use: errors_init -> errors_at -> errors_finish. Does not: write.
#ifndef APP_SESSION_ERRORS_H
#define APP_SESSION_ERRORS_H

#include "studies/engine/observer.h"
#include "studies/store/store.h"

#include <stdbool.h>
#include <stddef.h>

struct errors_table;

struct errors {
    const struct plan *plan;    // borrowed
    const char *const *specs;   // borrowed
    const char *file;           // "": none; borrowed
    double *slots;              // [trial][2], NaN: it depends on the trial's course; owned
    struct errors_table *table; // owned
};

// Reads what every trial of the plan needs; `file` "" for none. reference_id as in the store; specs say what is
// shown for each of the protocol's scenes, in its order: the store keeps errors by that, a file by name. They
// must outlive the errors. False with a sentence that names the first option without an error.
bool errors_init(struct errors *errors, const struct plan *plan, struct store *store, int64_t reference_id,
                 const char *const *specs, const char *file, char *error, size_t error_size);
void errors_finish(struct errors *errors);
// Of the running trial as it is now; 0 outside trials.
struct observer_errors errors_at(const struct errors *errors, const struct machine *machine);

#endif
