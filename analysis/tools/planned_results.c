#include "analysis/tools/planned_results.h"

#include <stdio.h>

bool planned_results_load(struct planned_results *out, struct sample *sample, double conf, char *error,
                          size_t error_size)
{
    *out = (struct planned_results){0};
    if (!plans_load(&out->plans, sample)) {
        snprintf(error, error_size, "not enough memory");
        return false;
    }
    const struct planned_sources sources = {&out->ratings, &out->thresholds, &out->adjusted};
    return ratings_load(&out->ratings, sample, conf, false, error, error_size) &&
           thresholds_load(&out->thresholds, sample, &(struct threshold_options){.conf = conf}, error,
                           error_size) &&
           adjusted_load(&out->adjusted, sample, conf, error, error_size) &&
           planned_load(&out->planned, sample, &out->plans, &sources, conf, error, error_size);
}

void planned_results_free(struct planned_results *results)
{
    planned_free(&results->planned);
    adjusted_free(&results->adjusted);
    thresholds_free(&results->thresholds);
    ratings_free(&results->ratings);
    plans_free(&results->plans);
}
