// What `fovstats choices` says of the levels of factors (analysis/report/choice_factors.h).
#ifndef ANALYSIS_TOOLS_CHOICES_FACTORS_H
#define ANALYSIS_TOOLS_CHOICES_FACTORS_H

#include "analysis/report/choice_factors.h"
#include "analysis/tools/json.h"

bool choices_factors_print(const struct choice_factors *factors); // false where memory ran out
void choices_factors_json(struct json *json, const struct choice_factors *factors); // "factor_tests"

#endif
