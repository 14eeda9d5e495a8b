// What `fovstats frames` says of the test option's frames against the reference's.
#ifndef ANALYSIS_TOOLS_FRAMES_PAIRS_H
#define ANALYSIS_TOOLS_FRAMES_PAIRS_H

#include "analysis/report/frames_pairs.h"
#include "analysis/tools/json.h"

bool frames_pairs_print(const struct sample *sample, const struct frames_pairs *pairs, double conf);
void frames_pairs_json(struct json *json, const struct sample *sample, const struct frames_pairs *pairs);

#endif
