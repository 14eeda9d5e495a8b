// Thresholds and adjusted values as one JSON object.
#ifndef ANALYSIS_TOOLS_THRESHOLDS_JSON_H
#define ANALYSIS_TOOLS_THRESHOLDS_JSON_H

#include "analysis/report/adjusted.h"
#include "analysis/report/thresholds.h"

#include <stdio.h>

void thresholds_json(FILE *out, const struct sample *sample, const struct thresholds *thresholds,
                     const struct adjusted *adjusted);

#endif
