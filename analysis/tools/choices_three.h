// What `fovstats choices` says of answers of three kinds (analysis/report/choice_three.h).
#ifndef ANALYSIS_TOOLS_CHOICES_THREE_H
#define ANALYSIS_TOOLS_CHOICES_THREE_H

#include "analysis/report/choice_three.h"
#include "analysis/tools/json.h"

// False where memory ran out.
bool choices_three_print(const struct choices *choices);
bool choices_three_json(struct json *json, const struct choices *choices); // "three_way"

#endif
