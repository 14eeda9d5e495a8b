// The members of a binomial test in JSON, the same wherever one is printed (DESIGN, the command line).
#ifndef ANALYSIS_TOOLS_BINOMIAL_JSON_H
#define ANALYSIS_TOOLS_BINOMIAL_JSON_H

#include "analysis/stats/binomial.h"
#include "analysis/tools/json.h"

void binomial_json(struct json *json, const struct stat_binomial *test);

#endif
