// Equivalence of each cell's preference with the null hypothesis, within a margin.
#ifndef ANALYSIS_TOOLS_CHOICES_EQUIVALENCE_H
#define ANALYSIS_TOOLS_CHOICES_EQUIVALENCE_H

#include "analysis/report/choices.h"
#include "analysis/tools/json.h"

// False where memory ran out. The member is "equivalence".
bool choices_equivalence_print(const struct choices *choices, double margin);
bool choices_equivalence_json(struct json *json, const struct choices *choices, double margin);

#endif
