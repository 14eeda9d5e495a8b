// What the protocol planned, with its results and all that they come from.
#ifndef ANALYSIS_TOOLS_PLANNED_RESULTS_H
#define ANALYSIS_TOOLS_PLANNED_RESULTS_H

#include "analysis/report/planned.h"

struct planned_results {
    struct plans plans;
    struct ratings ratings;
    struct thresholds thresholds;
    struct adjusted adjusted;
    struct planned planned;
};

// False with a sentence; free what was loaded then too.
bool planned_results_load(struct planned_results *out, struct sample *sample, double conf, char *error,
                          size_t error_size);
void planned_results_free(struct planned_results *results);

#endif
