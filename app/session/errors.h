// The image error of each option on each scene, for a simulated observer that sees no frames: from the study
// file, where an earlier session measured it, else from a file.
//
// The file is text, one line per option and scene: SCENE,ERROR,MODE[:p=v,...] (the option is the rest of the
// line; empty lines and lines that begin with # are skipped). ERROR is what measured_error holds:
// eccentricity-weighted RMSE against the protocol's reference, 0 to 1 (black against white). The reference
// itself has 0.
#ifndef APP_SESSION_ERRORS_H
#define APP_SESSION_ERRORS_H

#include "studies/engine/observer.h"
#include "studies/store/store.h"

#include <stdbool.h>
#include <stddef.h>

struct errors {
    const struct plan *plan; // borrowed
    double *slots;           // [trial][2]; owned
};

// Reads what every trial of the plan needs; `file` "" for none. condition_ids and reference_id as in the store;
// specs say what is shown for each of the protocol's scenes, in its order: the store keeps errors by that, a
// file by name. False with a sentence that names the first option without an error.
bool errors_init(struct errors *errors, const struct plan *plan, struct store *store,
                 const int64_t *condition_ids, int64_t reference_id, const char *const *specs, const char *file,
                 char *error, size_t error_size);
void errors_finish(struct errors *errors);
struct observer_errors errors_of(const struct errors *errors, uint32_t trial);

#endif
