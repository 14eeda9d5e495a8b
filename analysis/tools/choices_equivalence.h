// Equivalence of each cell's preference with the null hypothesis, within a margin.
#ifndef ANALYSIS_TOOLS_CHOICES_EQUIVALENCE_H
#define ANALYSIS_TOOLS_CHOICES_EQUIVALENCE_H

#include "analysis/report/choices.h"
#include "analysis/tools/json.h"

bool choices_equivalence_print(const struct choices *choices, double margin); // false where memory ran out
void choices_equivalence_json(struct json *json, const struct choices *choices, double margin); // "equivalence"

#endif
