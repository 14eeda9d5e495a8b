// What `fovstats choices` says of effects on choices that are no preference.
#ifndef ANALYSIS_TOOLS_CHOICES_EFFECTS_H
#define ANALYSIS_TOOLS_CHOICES_EFFECTS_H

#include "analysis/report/effects.h"
#include "analysis/tools/json.h"

bool choices_effects_print(const struct effects *effects); // false where memory ran out
void choices_effects_json(struct json *json, const struct effects *effects);

#endif
