// What `fovstats choices` says of cells in which somebody answered more than once.
#ifndef ANALYSIS_TOOLS_CHOICES_PEOPLE_H
#define ANALYSIS_TOOLS_CHOICES_PEOPLE_H

#include "analysis/report/choices.h"
#include "analysis/tools/json.h"

bool choices_people_print(const struct choices *choices); // false where memory ran out
// Members of the cell's object.
void choices_people_json(struct json *json, const struct choice_cell *cell, double conf);

#endif
